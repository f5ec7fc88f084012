from ._server import serve
from ._settings import Listen, Serving
from .access._users import with_user

__all__ = [
    "Listen",
    "Serving",
    "serve",
    "with_user",
]
