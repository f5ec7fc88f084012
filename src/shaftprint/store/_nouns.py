"""The nouns of the store: a ship, its shaft lines, what was done to them, their tests, and what was found each time."""

from dataclasses import dataclass
from datetime import datetime
from typing import Final, Literal, NamedTuple

KINDS: Final = (
    "docking",
    "propeller-polished",
    "propeller-changed",
    "governor-changed",
    "injectors-changed",
    "gauge-calibrated",
    "program-changed",
    "other",
)
"""What may have been done to a line between two tests, as ``drift`` knows it, which would load far more; a test holds
both against each other. ``other`` says it in its note."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Ship:
    """A ship, by the number that it keeps for life; small and inland ships have their name only."""

    name: str
    """Its name at its newest test."""
    imo_number: int | None = None
    """Its IMO number."""
    class_name: str | None = None
    """What its sister ships have in common."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Line:
    """A shaft line of a ship."""

    ship: Ship
    """The ship."""
    position: str
    """Which of its lines, such as ``port``."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Event:
    """What was done to a line at one time; the numbers that it affects may differ from then on."""

    line: Line
    """The line."""
    at: datetime
    """When it was done, with its offset from UTC."""
    kind: str
    """What was done, one of ``KINDS``."""
    numbers: tuple[str, ...] = ()
    """Names of the numbers that it affects; empty where nobody said which."""
    note: str = ""
    """What else is to be said."""
    withdrawn: str | None = None
    """Why it does not count any more; None for one that does. It stays in the record."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Trial:
    """One test of a line: when, where and in what water, and the recording that was made."""

    tested_at: datetime
    """When its recording began, with its offset from UTC."""
    place: str | None = None
    """Where it was made; this and the following are None where nobody stated them."""
    draught_m: float | None = None
    """Mean draught [m]."""
    trim_m: float | None = None
    """Draught aft minus draught forward [m]."""
    water_temperature_c: float | None = None
    """Temperature of the water [degrees Celsius]."""
    water_density_kg_m3: float | None = None
    """Density of the water [kg/m3]."""
    depth_m: float | None = None
    """Depth of the water [m]."""
    wind_m_s: float | None = None
    """Speed of the true wind [m/s]."""
    recording_sha256: str | None = None
    """SHA-256 of the recording; of several, that of their sorted SHA-256; None where the fingerprint names none."""


class StoredNumber(NamedTuple):
    """A number of a fingerprint, as it is kept to be found quickly; a tuple, for a history has thousands."""

    kind: str
    """What it is: parameter, combination, physical value, margin or calibration."""
    name: str
    """Its name, such as ``K_Q``."""
    unit: str
    """Its unit, ``-`` where there is none."""
    value: float | None
    """Estimate; None where it is no number."""
    std: float | None
    """Standard deviation; infinite where the test says nothing about it."""
    low: float | None
    """Lower end of the 95 % interval; None for an open end."""
    high: float | None
    """Upper end of the 95 % interval; None for an open end."""
    trusted: bool
    """Whether the verdict lets it be used."""


@dataclass(frozen=True, kw_only=True, slots=True)
class StoredFingerprint:
    """A fingerprint that is kept: of which test, made when and by what."""

    line: Line
    """The line."""
    trial: Trial
    """The test."""
    sha256: str
    """SHA-256 of the document, which is kept byte by byte."""
    made_at: datetime
    """When the program made it."""
    added_at: datetime
    """When it was put into the store."""
    structure: str
    """Name of the model structure."""
    version: str
    """Version of shaftprint that made it."""
    vessel_sha256: str | None
    """SHA-256 of the vessel file; None where it names none."""
    trustworthy: bool
    """Whether its numbers may be used."""
    supersedes: str | None
    """SHA-256 of the fingerprint of the same recording whose place it took; None where there is none."""
    superseded: bool
    """Whether a later one of the same recording has taken its place."""


@dataclass(frozen=True, kw_only=True, slots=True)
class HistoryEntry:
    """A test of a ship's history with what was found."""

    fingerprint: StoredFingerprint
    """The fingerprint."""
    numbers: tuple[StoredNumber, ...]
    """Its numbers, or those that were asked for."""


@dataclass(frozen=True, kw_only=True, slots=True)
class History:
    """What is known of a ship over the years, in the order of time."""

    ship: Ship
    """The ship."""
    entries: tuple[HistoryEntry, ...]
    """Its tests."""
    events: tuple[Event, ...]
    """What was done to it; what was withdrawn too, with the reason."""
    faults: "tuple[Fault, ...]" = ()
    """What of it is not as it was written."""


@dataclass(frozen=True, kw_only=True, slots=True)
class LineSummary:
    """A line with its newest test."""

    line: Line
    """The line."""
    tests: int
    """How many tests of it are kept."""
    tested_at: datetime | None
    """When the newest was made; None where there is none."""
    trustworthy: bool | None
    """Whether its numbers may be used."""
    number: StoredNumber | None
    """The number that was asked for, at the newest test."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Added:
    """What became of a fingerprint that was to be kept."""

    line: Line
    """The line that it is kept under."""
    sha256: str
    """SHA-256 of the document."""
    outcome: Literal["added", "supersedes", "superseded", "known"]
    """``added``: of a new test; ``supersedes``: it takes the place of an earlier one of the same recording;
    ``superseded``: a later one of the same recording was there; ``known``: the same document was there, and is not kept
    twice."""
    other: str | None = None
    """SHA-256 of that earlier or later one."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Fault:
    """A record that is not as it was written."""

    record: str
    """Which record."""
    found: str
    """What is wrong with it."""
