"""Text that is kept in a database: no longer than an index takes, without the letter that PostgreSQL refuses."""

from typing import Final

from shaftprint.errors import StoreError

LONGEST_NAME: Final = 200
"""Letters of the longest name that is kept in an index."""
LONGEST_TEXT: Final = 4000
"""Letters of the longest note or place."""
LONGEST_SHOWN = 40


def expect_short(text: str | None, what: str, *, named: str, longest: int = LONGEST_NAME) -> None:
    """Refuse a text that not every database keeps.

    Raises StoreError if it is empty, is too long, or holds a NUL or half of a letter.
    """
    if text is None:
        return
    if not text or len(text) > longest:
        shown = f"{len(text)} letters, {text[:LONGEST_SHOWN]!r} ..." if text else "none"
        raise StoreError(f"{named}: expected a {what} of 1 to {longest} letters, found {shown}.")
    if "\0" in text or any("\ud800" <= letter <= "\udfff" for letter in text):
        raise StoreError(f"{named}: expected a {what} of letters, found {text[:LONGEST_SHOWN]!r}; correct it.")
