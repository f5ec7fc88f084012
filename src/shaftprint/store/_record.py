"""What is kept of a fingerprint beside its document: where it belongs, and its numbers to be found quickly."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime, tzinfo
from typing import TYPE_CHECKING, Any

from shaftprint.errors import StoreError
from shaftprint.late import late
from shaftprint.store._document import document_sha256, expect_length
from shaftprint.store._nouns import StoredNumber, Trial
from shaftprint.store._stated import Stated, expect_stated, possible_time, ship_of, time_of_test
from shaftprint.store._text import LONGEST_TEXT, expect_short

with late():
    from shaftprint.fingerprint._json_file import parse_fingerprint

if TYPE_CHECKING:
    from shaftprint.fingerprint._conditions import ShipIdentity
    from shaftprint.fingerprint._line_fingerprint import LineFingerprint, SourceFile
    from shaftprint.identify.fit._estimate import Estimate


_LATEST = datetime(9000, 1, 1, tzinfo=UTC)


@dataclass(frozen=True, kw_only=True, slots=True)
class Record:
    """A fingerprint as it is put into the store."""

    ship: ShipIdentity
    """Ship and line."""
    trial: Trial
    """The test."""
    document: bytes
    """Content of the fingerprint's file."""
    sha256: str
    """Its SHA-256."""
    made_at: datetime
    """When the program made it."""
    structure: str
    """Name of the model structure."""
    version: str
    """Version of shaftprint that made it."""
    vessel_sha256: str | None
    """SHA-256 of the vessel file."""
    trustworthy: bool
    """Whether its numbers may be used."""
    numbers: tuple[StoredNumber, ...]
    """Its numbers."""
    stated: Mapping[str, Any]
    """What was stated by hand, for JSON."""


def record_of(
    document: bytes, stated: Stated, *, zone: tzinfo | None = None, named: str, now: datetime | None = None
) -> Record:
    """Return the record of a document.

    ``document``: content of a fingerprint's file. ``stated``: what was stated beside it. ``zone``: zone of times that
    have no offset; None where none was stated. ``named``: what the document is called in an error. ``now``: the present
    time, by which times are judged; by the clock of this computer where it is not given. Raises StoreError if ship,
    line or time of the test are missing, or a text cannot be kept; FingerprintError if the document is no fingerprint.
    """
    expect_length(document, named=named)
    fingerprint = parse_fingerprint(document, named=named)
    conditions = fingerprint.tested
    expect_stated(conditions, stated, zone, named=named)
    tested_at = time_of_test(conditions, stated.tested_at, zone, named=named, now=now)
    needs_time = conditions.tested_at is None or conditions.tested_at.tzinfo is None
    kept = replace(stated, tested_at=tested_at if needs_time else None)
    expect_short(conditions.place or None, "place", named=named, longest=LONGEST_TEXT)
    for text, what in ((fingerprint.structure, "name of a structure"), (fingerprint.shaftprint_version, "version")):
        expect_short(text, what, named=named)
    return Record(
        ship=ship_of(conditions, stated, named=named),
        trial=Trial(
            tested_at=tested_at,
            place=conditions.place or None,
            recording_sha256=_recording(fingerprint.sources),
            **conditions.of_ship_and_water(),
        ),
        document=document,
        sha256=document_sha256(document),
        # by the clock of whichever computer made it, right or wrong: any that can be shown
        made_at=possible_time(fingerprint.created, now=_LATEST, named=f"{named}: created"),
        structure=fingerprint.structure,
        version=fingerprint.shaftprint_version,
        vessel_sha256=next((_hash(one, named) for one in fingerprint.sources if one.role == "vessel"), None),
        trustworthy=fingerprint.verdict.trustworthy,
        numbers=numbers_of(fingerprint, named=named),
        stated=kept.content(),
    )


def _recording(sources: Sequence[SourceFile]) -> str | None:
    """Return the SHA-256 that stands for the recordings of a test."""
    hashes = sorted(one.sha256.lower() for one in sources if one.role == "recording")
    if len(hashes) == 1 and len(hashes[0]) == hashlib.sha256().digest_size * 2 and hashes[0].isalnum():
        return hashes[0]
    return hashlib.sha256("\n".join(hashes).encode(errors="replace")).hexdigest() if hashes else None


def _hash(source: SourceFile, named: str) -> str:
    expect_short(source.sha256, "SHA-256", named=named)
    return source.sha256


def numbers_of(fingerprint: LineFingerprint, *, named: str) -> tuple[StoredNumber, ...]:
    """Return the numbers of a fingerprint as they are kept, each name of a kind once.

    Raises StoreError if a name or unit cannot be kept, or a kind of numbers has a name twice.
    """
    trusted = frozenset(fingerprint.verdict.trusted)
    found: dict[tuple[str, str, str], StoredNumber] = {}
    for kind, quantities in fingerprint.numbers.items():
        for quantity in quantities:
            key = (kind, quantity.name, quantity.unit)
            if key in found:
                raise StoreError(f"{named}: expected each {kind} once, found {quantity.name[:100]!r} twice.")
            found[key] = _number(kind, quantity, trusted=quantity.name in trusted, named=named)
    return tuple(found.values())


def _number(kind: str, quantity: Estimate, *, trusted: bool, named: str) -> StoredNumber:
    expect_short(quantity.name, "name of a number", named=named)
    expect_short(quantity.unit, "unit", named=named)
    low, high = quantity.limits_95
    return StoredNumber(
        kind=kind,
        name=quantity.name,
        unit=quantity.unit,
        value=_known(quantity.value),
        std=_known(quantity.std),
        low=_known(low),
        high=_known(high),
        trusted=trusted,
    )


def _known(value: float) -> float | None:
    """Return a number as databases keep it: what is no number is missing in all of them."""
    return None if math.isnan(value) else value
