"""The document of a fingerprint: kept byte by byte, compressed, and never inflated beyond what one may be long."""

import hashlib
import zlib
from typing import Final

from shaftprint.errors import StoreError

MOST_BYTES: Final = 16 * 2**20
"""Length of the longest document that is kept; a fingerprint of today has some 50 kB."""
SHOWN_HASH: Final = 12
"""Letters of a SHA-256 that are shown."""
# Level 6 saves a sixth of the space and takes three times as long.
_LEVEL = 1


def document_sha256(document: bytes) -> str:
    """Return the SHA-256 of a document, hexadecimal."""
    return hashlib.sha256(document).hexdigest()


def expect_length(document: bytes, *, named: str) -> None:
    """Refuse a document that is too long to be a fingerprint."""
    if len(document) > MOST_BYTES:
        raise StoreError(
            f"{named}: expected a fingerprint of at most {MOST_BYTES // 2**20} MiB, found {len(document) / 2**20:.1f}."
        )


def deflated(document: bytes) -> bytes:
    """Return a document as it is kept."""
    return zlib.compress(document, _LEVEL)


def inflated(kept: object, *, named: str) -> bytes:
    """Return a document from what is kept of it; what would be longer than a document may be is not inflated.

    Raises StoreError if it is damaged.
    """
    if not isinstance(kept, bytes):
        raise StoreError(f"{named}: expected a compressed document, found none; the store is damaged.")
    inflater = zlib.decompressobj()
    try:
        document = inflater.decompress(kept, MOST_BYTES)
    except zlib.error:
        raise StoreError(f"{named}: the compressed document cannot be inflated; the store is damaged.") from None
    if not inflater.eof or inflater.unused_data:
        raise StoreError(
            f"{named}: expected a compressed document of at most {MOST_BYTES // 2**20} MiB, found one that is longer "
            "or has another end; the store is damaged."
        )
    return document
