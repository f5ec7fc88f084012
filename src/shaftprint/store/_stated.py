"""What a user states of a fingerprint whose file does not say it: which ship and line, and when it was tested."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime, tzinfo
from typing import TYPE_CHECKING, Any

from shaftprint.errors import StoreError
from shaftprint.late import late
from shaftprint.spelling import listed
from shaftprint.store._text import expect_short
from shaftprint.zones import in_zone, possible, utc_text

with late():
    from shaftprint.fingerprint._conditions import ShipIdentity
    from shaftprint.vessel._ship import is_imo_number

if TYPE_CHECKING:
    from shaftprint.fingerprint._conditions import Tested


@dataclass(frozen=True, kw_only=True, slots=True)
class Stated:
    """What was stated by hand beside a fingerprint; None where nothing was."""

    ship: str | None = None
    """Name of the ship."""
    imo_number: int | None = None
    """Its IMO number."""
    line: str | None = None
    """Which of its lines."""
    tested_at: datetime | None = None
    """When the recording began."""
    class_name: str | None = None
    """What its sister ships have in common."""

    def content(self) -> dict[str, Any]:
        """Return what was stated, for JSON."""
        at = None if self.tested_at is None else utc_iso(self.tested_at)
        fields = {"ship": self.ship, "imo_number": self.imo_number, "line": self.line, "tested_at": at}
        fields["class_name"] = self.class_name
        return {name: value for name, value in fields.items() if value is not None}


def utc_iso(moment: datetime) -> str:
    """Return an instant in UTC as text of one length, so that the order of texts is that of time."""
    return moment.astimezone(UTC).isoformat(timespec="microseconds").replace("+00:00", "Z")


def expect_stated(conditions: Tested, stated: Stated, zone: tzinfo | None, *, named: str) -> None:
    """Refuse a fingerprint of which neither its document nor who puts it in says ship, line and time.

    Raises StoreError, which names all that is missing at once.
    """
    ship, shown = conditions.ship, stated.tested_at or conditions.tested_at
    missing = [
        (noun, option)
        for is_missing, noun, option in (
            ((None if ship is None else ship.name) is None and stated.ship is None, "the name of its ship", "--ship"),
            ((None if ship is None else ship.line) is None and stated.line is None, "its shaft line", "--line"),
            (shown is None, "the time of the test", "--tested-at, such as 2026-03-31T09:30+02:00"),
        )
        if is_missing
    ]
    if not missing:
        return
    if shown is not None and shown.tzinfo is None and zone is None:
        missing.append((f"the offset of {shown.isoformat(sep=' ')} from UTC", "--time-zone, such as Europe/Amsterdam"))
    nouns, options = zip(*missing, strict=True)
    found, it = ("none", "it") if len(missing) == 1 else ("none of them", "them")
    raise StoreError(f"{named}: expected {listed(nouns)}, found {found}; state {it} with {listed(options)}.")


def time_of_test(
    conditions: Tested, stated: datetime | None, zone: tzinfo | None, *, named: str, now: datetime | None = None
) -> datetime:
    """Return when a test was made: as its document says, else as stated, one of which says it; nothing is guessed.

    Raises StoreError if it is no instant, they differ, or nothing can have been tested then.
    """
    return possible_time(_time_of_test(conditions, stated, zone, named=named), now=now, named=named)


def possible_time(moment: datetime, *, now: datetime | None, named: str) -> datetime:
    """Return a time that is kept.

    Raises StoreError if nothing can have been recorded or done then.
    """
    try:
        return possible(moment, now=now)
    except ValueError as error:
        raise StoreError(f"{named}: {error}; correct it.") from None


def _time_of_test(conditions: Tested, stated: datetime | None, zone: tzinfo | None, *, named: str) -> datetime:
    shown = conditions.tested_at
    if stated is not None:
        instant = _instant(stated, zone, named=named)
        if shown is not None and shown.tzinfo is not None and shown != instant:
            raise StoreError(
                f"{named}: it states that the test was made {utc_text(shown)}, and --tested-at says "
                f"{utc_text(instant)}; leave --tested-at out, or correct the conditions and identify once more."
            )
        return instant
    assert shown is not None  # noqa: S101 - expect_stated has refused it
    return _instant(shown, zone, named=named)


def _instant(shown: datetime, zone: tzinfo | None, *, named: str) -> datetime:
    if shown.tzinfo is not None:
        return shown
    if zone is None:
        raise StoreError(
            f"{named}: expected a time with its offset from UTC, found {shown.isoformat(sep=' ')}; state the zone "
            "with --time-zone, such as Europe/Amsterdam, or the time with --tested-at and its offset."
        )
    try:
        return in_zone(shown, zone)
    except ValueError as error:
        raise StoreError(f"{named}: {error}; state it with --tested-at and its offset.") from None


def ship_of(conditions: Tested, stated: Stated, *, named: str) -> ShipIdentity:
    """Return ship and line of a fingerprint: as its document says, what it leaves open as stated.

    Raises StoreError if they differ.
    """
    if stated.imo_number is not None and not is_imo_number(stated.imo_number):
        raise StoreError(
            f"--imo: expected seven digits of which the last checks the others, found {stated.imo_number}."
        )
    document = conditions.ship
    said = None if document is None else document.name
    name = _agreed(said, stated.ship, "--ship", "the name of its ship", named=named)
    line = _agreed(None if document is None else document.line, stated.line, "--line", "its shaft line", named=named)
    number = stated.imo_number
    if document is not None and document.imo_number is not None:
        number = document.imo_number
        if stated.imo_number not in (None, number):
            raise StoreError(f"{named}: it is of the ship with IMO {number}, and --imo says {stated.imo_number}.")
    class_name = stated.class_name
    if document is not None and document.class_name is not None:
        if class_name not in (None, document.class_name):
            raise StoreError(f"{named}: it is of the class {document.class_name}, and --class says {class_name}.")
        class_name = document.class_name
    for text, what in ((name, "name of a ship"), (line, "shaft line"), (class_name, "class of ships")):
        expect_short(text, what, named=named)
    return ShipIdentity(name=name, imo_number=number, class_name=class_name, line=line)


def _agreed(document: str | None, stated: str | None, option: str, noun: str, *, named: str) -> str:
    if document is not None and stated not in (None, document):
        raise StoreError(
            f"{named}: it states {document!r} as {noun}, and {option} says {stated!r}; leave {option} out."
        )
    return document or stated or ""
