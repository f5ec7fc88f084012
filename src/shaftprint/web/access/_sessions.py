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
        if not cookie or len(cookie) > _MOST_LETTERS:
            return None
        try:
            content = self._signer().loads(cookie, max_age=LONGEST_S)
        except BadData:
            return None
        if not isinstance(content, list) or len(content) != 3 or not all(isinstance(one, str) for one in content):
            return None
        number, name, stamp = content
        if number in self._ended:
            return None
        return Session(number=number, person=self._person(name, stamp), token=self._token(number))

    def begin(self, person: Person | None = None) -> tuple[Session, str]:
        """Return a new session and its cookie."""
        number = secrets.token_urlsafe(16)
        if person is None and self.users is None:
            person = LOCAL
        signed_in = person is not None and person.password
        content = [number, person.name, _stamp(person)] if person is not None and signed_in else [number, "", ""]
        session = Session(number=number, person=person, token=self._token(number))
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

    def _signer(self) -> URLSafeTimedSerializer:
        return URLSafeTimedSerializer(self.key, salt="session")

    def _token(self, number: str) -> str:
        return hmac.new(self.key, f"token {number}".encode(), hashlib.sha256).hexdigest()


def _stamp(person: Person) -> str:
    return hashlib.sha256(person.password.encode()).hexdigest()[:16]
