"""Who is behind a request: cookies that are signed, and tokens that a form of another page does not have."""

import hashlib
import hmac
import secrets
from dataclasses import dataclass, field
from typing import Final

from itsdangerous import BadData, URLSafeTimedSerializer

from shaftprint.web.access._person import LOCAL, Person
from shaftprint.web.access._users import Users

COOKIE: Final = "shaftprint"
"""Name of the cookie."""
LONGEST_S: Final = 12 * 3600
"""How long somebody stays signed in [s]."""
KNOWN_S: Final = 180 * 24 * 3600
"""How long a browser is known from which somebody signed in [s]."""
_MOST_LETTERS: Final = 2000
_MOST_ENDED: Final = 10_000


@dataclass(frozen=True, kw_only=True, slots=True)
class Session:
    """A browser that was here before, signed in or not."""

    number: str
    """What it is known by."""
    person: Person | None
    """Who signed in; None for nobody."""
    token: str
    """What every form of this browser carries."""
    known: Person | None = None
    """Who signed in from this browser before, and has the same password since."""

    def has(self, token: str) -> bool:
        """Return whether a token is that of this browser."""
        return hmac.compare_digest(self.token.encode(), token.encode("utf-8", "replace"))


@dataclass(slots=True)
class Sessions:
    """What makes and reads cookies."""

    key: bytes
    """Secret that they are signed with."""
    users: Users | None
    """Who may sign in; None where nobody has to."""
    _ended: dict[str, None] = field(default_factory=dict)

    def read(self, cookie: str | None) -> Session | None:
        """Return the session of a cookie; None where there is none, it is forged, or too old."""
        content = self._content(cookie, longest_s=LONGEST_S)
        if content is None or content[0] in self._ended:
            return None
        number, name, stamp, known, known_stamp = content
        return Session(
            number=number,
            person=self._person(name, stamp),
            token=self._token(number),
            known=self._known(known, known_stamp),
        )

    def known(self, cookie: str | None) -> Person | None:
        """Return who signed in from a browser before, however long ago his session ended; None for nobody."""
        content = self._content(cookie, longest_s=KNOWN_S)
        return None if content is None else self._known(*content[3:])

    def begin(self, person: Person | None = None, *, known: Person | None = None) -> tuple[Session, str]:
        """Return a new session and its cookie.

        ``person``: who signs in; None for nobody. ``known``: who signed in from this browser before.
        """
        number = secrets.token_urlsafe(16)
        if person is None and self.users is None:
            person = LOCAL
        known = person or known
        content = [number, *(_named(person) or ("", "")), *(_named(known) or ("", ""))]
        session = Session(number=number, person=person, token=self._token(number), known=known)
        return session, str(self._signer().dumps(content))

    def end(self, session: Session) -> None:
        """Let a session be valid no more, whoever has its cookie."""
        self._ended[session.number] = None
        while len(self._ended) > _MOST_ENDED:
            self._ended.pop(next(iter(self._ended)))

    def _person(self, name: str, stamp: str) -> Person | None:
        if self.users is None:
            return LOCAL
        person = self.users.named(name) if name else None
        # another password ends all sessions that the old one began
        return person if person is not None and hmac.compare_digest(_stamp(person), stamp) else None

    def _known(self, name: str, stamp: str) -> Person | None:
        return self._person(name, stamp) if self.users is not None else None

    def _content(self, cookie: str | None, *, longest_s: int) -> list[str] | None:
        if not cookie or len(cookie) > _MOST_LETTERS:
            return None
        try:
            content = self._signer().loads(cookie, max_age=longest_s)
        except BadData:
            return None
        is_whole = isinstance(content, list) and len(content) == 5 and all(isinstance(one, str) for one in content)
        return content if is_whole else None

    def _signer(self) -> URLSafeTimedSerializer:
        return URLSafeTimedSerializer(self.key, salt="session")

    def _token(self, number: str) -> str:
        return hmac.new(self.key, f"token {number}".encode(), hashlib.sha256).hexdigest()


def _named(person: Person | None) -> tuple[str, str] | None:
    return (person.name, _stamp(person)) if person is not None and person.password else None


def _stamp(person: Person) -> str:
    return hashlib.sha256(person.password.encode()).hexdigest()[:16]
