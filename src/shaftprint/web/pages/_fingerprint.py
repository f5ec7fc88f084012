"""A fingerprint by its SHA-256, for whoever sees its ship."""

from shaftprint.store._nouns import StoredFingerprint
from shaftprint.store._overview import stored_fingerprint
from shaftprint.web._asked import Asked, NotThere

_HASH = 64


def fingerprint_of(asked: Asked, sha256: str) -> StoredFingerprint:
    """Return a fingerprint, if somebody sees its ship.

    Raises NotThere if there is none, or it was not given to him.
    """
    is_hash = len(sha256) == _HASH and all(letter in "0123456789abcdef" for letter in sha256)
    found = stored_fingerprint(asked.service.store, sha256) if is_hash else None
    if found is None or not asked.person.sees(found.line.ship):
        raise NotThere
    return found
