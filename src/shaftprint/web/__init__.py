"""A server of pages: ships with a word for each, histories, comparisons, jobs and uploads, for browsers and programs.

It loads nothing that calculates. What is calculated from a user's file is calculated by processes beside it, which have
limits of memory and time; what somebody does not see is not there for him.
"""

from shaftprint.web._door import Door
from shaftprint.web._kept import KeptJob, Upload
from shaftprint.web._rights import forbidden_by
from shaftprint.web._routes import ADDRESSES, routes_of
from shaftprint.web._server import guarded, serve
from shaftprint.web._service import Service
from shaftprint.web._settings import Listen, Serving, listen_at
from shaftprint.web._standing import Standing, standing_of
from shaftprint.web._strip import TimeAxis, strip
from shaftprint.web.access import ALL, LONGEST, ROLES, SHORTEST, Person, Role, hashed, with_user

__all__ = [
    "ADDRESSES",
    "ALL",
    "LONGEST",
    "ROLES",
    "SHORTEST",
    "Door",
    "KeptJob",
    "Listen",
    "Person",
    "Role",
    "Service",
    "Serving",
    "Standing",
    "TimeAxis",
    "Upload",
    "forbidden_by",
    "guarded",
    "hashed",
    "listen_at",
    "routes_of",
    "serve",
    "standing_of",
    "strip",
    "with_user",
]
