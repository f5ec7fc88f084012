from ._server import serve
from ._settings import Listen, Serving, listen_at
from .access._password import hashed
from .access._person import Person
from .access._users import with_user

__all__ = [
    "Listen",
    "Person",
    "Serving",
    "hashed",
    "listen_at",
    "serve",
    "with_user",
]
