"""A server of pages: ships with a word for each, histories, comparisons, jobs and uploads, for browsers and programs.

It loads nothing that calculates. What is calculated from a user's file is calculated by processes beside it, which have
limits of memory and time; what somebody does not see is not there for him.
"""

from shaftprint.web._routes import ADDRESSES
from shaftprint.web._server import guarded, serve
from shaftprint.web._service import Service
from shaftprint.web._settings import Listen, Serving, listen_at
from shaftprint.web.access import ALL, LONGEST, ROLES, SHORTEST, Person, Role, hashed, with_user

__all__ = [
    "ADDRESSES",
    "ALL",
    "LONGEST",
    "ROLES",
    "SHORTEST",
    "Listen",
    "Person",
    "Role",
    "Service",
    "Serving",
    "guarded",
    "hashed",
    "listen_at",
    "serve",
    "with_user",
]
