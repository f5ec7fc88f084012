"""Who asks, what he may see and do, and what is written down of it."""

from shaftprint.web.access._audit import Audit
from shaftprint.web.access._password import LONGEST, SHORTEST, hashed, is_right
from shaftprint.web.access._person import ALL, LOCAL, NOBODY, Person, Role, is_like_a_number
from shaftprint.web.access._sessions import COOKIE, KNOWN_S, LONGEST_S, Session, Sessions
from shaftprint.web.access._throttle import Throttle, network_of
from shaftprint.web.access._users import ROLES, Users, read_users, with_user

__all__ = [
    "ALL",
    "COOKIE",
    "KNOWN_S",
    "LOCAL",
    "LONGEST",
    "LONGEST_S",
    "NOBODY",
    "ROLES",
    "SHORTEST",
    "Audit",
    "Person",
    "Role",
    "Session",
    "Sessions",
    "Throttle",
    "Users",
    "hashed",
    "is_like_a_number",
    "is_right",
    "network_of",
    "read_users",
    "with_user",
]
