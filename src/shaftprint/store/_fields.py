"""Fields of the records of an export, each read as what it must be."""

from datetime import UTC, datetime

from shaftprint.errors import StoreError
from shaftprint.store._text import expect_short


def short_text(text: object, what: str, *, longest: int | None = None) -> str:
    """Return a text that every database keeps; one with a length of its own may be empty.

    Raises TypeError if it is none; StoreError if it cannot be kept.
    """
    if not isinstance(text, str):
        raise TypeError(what)
    if longest is None:
        expect_short(text, what, named="record")
    else:
        expect_short(text or None, what, named="record", longest=longest)
    return text


def moment_of(text: object) -> datetime:
    """Return an instant in UTC.

    Raises TypeError, ValueError, StoreError if it is none.
    """
    if not isinstance(text, str):
        raise TypeError("time")
    moment = datetime.fromisoformat(text)
    if moment.tzinfo is None:
        raise ValueError("time")
    try:
        return moment.astimezone(UTC)
    except OverflowError:
        raise StoreError(f"expected a time of the calendar in UTC, found {text[:40]}") from None
