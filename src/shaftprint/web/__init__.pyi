from ._server import serve
from ._settings import Listen, Serving, listen_at
from .access._password import LONGEST, hashed
from .access._person import Person
from .access._users import ROLES, with_user

__all__ = [
    "LONGEST",
    "ROLES",
    "Listen",
    "Person",
    "Serving",
    "hashed",
    "listen_at",
    "serve",
    "with_user",
]
