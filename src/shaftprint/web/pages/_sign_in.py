"""Signing in and out."""

from datetime import timedelta

from starlette.exceptions import HTTPException
from starlette.responses import Response

from shaftprint.web._asked import Asked, Moved, Shown
from shaftprint.web._endpoint import keep
from shaftprint.web._setting import answer_of
from shaftprint.web.access._password import LONGEST, is_right
from shaftprint.web.access._person import Person
from shaftprint.web.access._throttle import network_of

_WRONG = "Name or password is wrong."
_FORGOTTEN = timedelta(days=1)


async def sign_in_form(asked: Asked) -> Shown | Moved:
    """Return the page on which one signs in."""
    if asked.session.person is not None:
        return Moved(to="/", data={})
    return _form(asked, after=_own_path(asked.query("next", "/")), sentence="", status=200)


async def session(asked: Asked) -> Shown:
    """Return who is signed in, and the token for what a program sends."""
    person = asked.session.person
    said = (
        None if person is None else {"name": person.name, "role": person.role.name.lower(), "ships": list(person.ships)}
    )
    return Shown(template="refused.html.j2", title="Session", data={"person": said, "token": asked.session.token})


async def sign_in(asked: Asked) -> Response:
    """Sign somebody in."""
    users, throttle, now = asked.service.sessions.users, asked.service.throttle, asked.service.now().timestamp()
    if users is None:
        raise HTTPException(404)
    name, password = asked.fields.get("name", "")[:LONGEST], asked.fields.get("password", "")
    known, network = asked.session.known, network_of(asked.address)
    is_known = known is not None and known.name == name
    keys = (f"known {name}",) if is_known else (f"name {name} from {network}", f"address {network}")
    wait_s = throttle.wait_s(*keys, now=now)
    if wait_s > 0.0:
        asked.refused("had to wait before signing in", name=name)
        raise HTTPException(
            429,
            f"Too many wrong passwords; wait {wait_s:.0f} s and try again.",
            headers={"retry-after": f"{wait_s:.0f}"},
        )
    person = users.named(name)
    # noted before the slow part, so that many at one time count as many
    throttle.failed(*keys, now=now)
    right = await asked.read(is_right, password, None if person is None else person.password)
    if not right or person is None:
        asked.refused("gave a wrong password", name=name)
        if asked.is_api:
            raise HTTPException(401, _WRONG)
        return answer_of(
            asked, _form(asked, after=_own_path(asked.fields.get("next", "/")), sentence=_WRONG, status=401)
        )
    throttle.succeeded(*keys, now=now)
    return _signed_in(asked, person)


def _signed_in(asked: Asked, person: Person) -> Response:
    begun, cookie = asked.service.sessions.begin(person)
    asked.note("signed in", name=person.name)
    data = {"person": {"name": person.name, "role": person.role.name.lower()}, "token": begun.token}
    response = answer_of(asked, Moved(to=_own_path(asked.fields.get("next", "/")), data=data))
    keep(response, cookie, asked.service)
    return response


async def sign_out(asked: Asked) -> Response:
    """Sign somebody out."""
    at = asked.service.now()
    asked.service.sessions.end(asked.session)
    asked.service.kept.put_ended(asked.session.number, at.isoformat(), forget_before=(at - _FORGOTTEN).isoformat())
    asked.note("signed out")
    response = answer_of(asked, Moved(to="/sign-in" if asked.service.sessions.users else "/", data={}))
    _, cookie = asked.service.sessions.begin(known=asked.session.known)
    keep(response, cookie, asked.service)
    return response


def _form(asked: Asked, *, after: str, sentence: str, status: int) -> Shown:
    return Shown(
        template="sign-in.html.j2",
        title="Sign in",
        data={"sentence": sentence},
        drawn={"next": after},
        status=status,
    )


def _own_path(path: str) -> str:
    """Return a path of this server; whatever leads elsewhere leads to the first page."""
    is_own = path.startswith("/") and not path.startswith(("//", "/\\")) and path.isprintable() and "\\" not in path
    return path if is_own else "/"
