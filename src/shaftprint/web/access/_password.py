"""Passwords: hashed with argon2id, and compared in the same time whether somebody of that name is known or not."""

import threading
from typing import Final

from argon2 import PasswordHasher
from argon2.exceptions import Argon2Error, InvalidHashError

SHORTEST: Final = 12
"""Letters of the shortest password that is taken."""
LONGEST: Final = 200
# OWASP's second choice: 19 MiB each, so that a server stays small when somebody signs in
_HASHER: Final = PasswordHasher(time_cost=2, memory_cost=19 * 1024, parallelism=1)
# one at a time: who asks often must not take the memory of all
_ONE: Final = threading.Lock()
# of no password
_NOBODY: Final = "$argon2id$v=19$m=19456,t=2,p=1$izlkW+WQCnQcHL/Duf1aGA$dVueET7NL6ObqkUjyEQG9O6tZukhlYOF0mQTjg7d+9w"


def hashed(password: str) -> str:
    """Return the hash of a password, as it stands in the file of users."""
    return _HASHER.hash(password)


def is_hash(text: str) -> bool:
    """Return whether a text is a hash of argon2id."""
    if not text.startswith("$argon2id$"):
        return False
    try:
        _HASHER.check_needs_rehash(text)
    except InvalidHashError:
        return False
    return True


def is_right(password: str, known: str | None) -> bool:
    """Return whether a password is that of a hash; of nobody's hash it is not, after the same time.

    ``password``: what was typed. ``known``: hash of the password; None where nobody of that name is known.
    """
    with _ONE:
        try:
            return _HASHER.verify(known or _NOBODY, password[:LONGEST]) and known is not None
        except (Argon2Error, InvalidHashError):
            return False
