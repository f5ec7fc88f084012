"""The fingerprint of a drive that is no ship's: parameters with covariance, verdict and records, as a JSON record."""

import math
from datetime import datetime
from typing import ClassVar, Final, Literal, Self

from pydantic import Field

from shaftprint.fingerprint._conditions import ShipIdentity, Tested
from shaftprint.fingerprint._line_fingerprint import LineFingerprint
from shaftprint.fingerprint._number import Deviation
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.notebook._summary import Summary, shortened
from shaftprint.records import Record
from shaftprint.vessel._ship import LONGEST_NAME

DRIVE_SCHEMA: Final = "drive 1.3"
"""Version of the layout of a drive's fingerprint."""
LINE_OF_DRIVE: Final = "drive"
"""What its line is called in a store, where ships have port and starboard."""


class NoiseOfRecord(Record):
    """The colour of the noise of a record: a vector autoregression, outputs in the order of the fingerprint."""

    coefficients: tuple[tuple[tuple[float, ...], ...], ...]
    """What the noise keeps of each sample before, the latest first, shape (order, outputs, outputs)."""
    covariance: tuple[tuple[float, ...], ...]
    """Covariance of what comes anew with each sample, shape (outputs, outputs)."""


class DriveRecord(Record):
    """How well one record is explained."""

    name: str
    """What was done."""
    seconds: float
    """Length of what was used [s]."""
    rate_hz: float
    """Samples a second [Hz]."""
    fit_percent: dict[str, float]
    """FitPercent of each output (thesis eq. 2.41)."""
    fit_ceiling: dict[str, float]
    """FitPercent that the noise allows."""
    noise_std: dict[str, float]
    """Standard deviation of the noise of each output, in its unit."""
    noise: NoiseOfRecord | None = None
    """Its colour; None in files of earlier versions."""
    offset: dict[str, float] = Field(default_factory=dict)
    """What was added to the model of each output on average, in its unit; empty where no offset was found."""
    offset_std: dict[str, Deviation] = Field(default_factory=dict)
    """Standard deviation of that; infinite where the record does not tell it."""
    recording: str = ""
    """SHA-256 of the file that it is from; empty in files of earlier versions."""
    from_s: float = -math.inf
    """Time of its first sample [s]."""
    to_s: float = math.inf
    """Time of its last sample [s]."""

    def overlaps(self, recording: str, from_s: float, to_s: float) -> bool:
        """Return whether it is from a file, named by its SHA-256, and shares time with a stretch of that [s]."""
        return self.recording == recording and self.from_s < to_s and from_s < self.to_s


class DriveResponse(Record):
    """How well one frequency response is explained."""

    name: str
    """Name of its file."""
    lines: int
    """How many lines were fitted."""
    lowest_hz: float
    """Lowest of them [Hz]."""
    highest_hz: float
    """Highest of them [Hz]."""
    fit_percent: dict[str, float]
    """FitPercent of each output (thesis eq. 2.41)."""
    fit_ceiling: dict[str, float]
    """FitPercent that the stated deviations allow."""


class DriveFingerprint(LineFingerprint):
    """Parameters of one drive with uncertainty, and how well its records are explained."""

    noun: ClassVar[str] = "drive"

    kind: Literal["drive"] = "drive"
    """Tells it from the fingerprint of a ship."""
    schema_version: Literal["drive 1.0", "drive 1.1", "drive 1.2", "drive 1.3"] = DRIVE_SCHEMA
    """Version of this record's layout."""
    drive: str
    """Name of the drive."""
    tested_at: datetime | None = None
    """When its first record was made, as its file says or as stated; None where neither says, and in files of earlier
    versions. Without an offset it is what a clock showed in a zone that nobody stated."""
    inputs: dict[str, str]
    """Unit of each input by its name; empty where it is that of an own structure."""
    outputs: dict[str, str]
    """Unit of each output by its name."""
    records: tuple[DriveRecord, ...]
    """The records that were fitted."""
    responses: tuple[DriveResponse, ...] = ()
    """The frequency responses that were fitted in place of records."""
    p_value: float | None
    """Probability that a right structure fits as badly as this or worse; None where there is nothing to test."""
    starts: int
    """Starts of the search."""
    starts_at_optimum: int
    """How many of them reached the result."""
    inputs_hold: bool = False
    """Whether inputs held from sample to sample; else they went straight."""

    def summary(self) -> Summary:
        """Return of what it is, the verdict, and which numbers may be used."""
        verdict = self.verdict
        facts = {
            "structure": self.structure,
            "records": shortened([*(one.name for one in self.records), *(one.name for one in self.responses)]),
            "made": f"{self.created:%Y-%m-%d %H:%M %Z}, shaftprint {self.shaftprint_version}",
            "verdict": verdict.reason,
            "known well enough": f"{len(verdict.trusted)} of {len(verdict.trusted) + len(verdict.not_trusted)}: "
            + shortened(verdict.trusted),
        }
        return Summary(title=f"Fingerprint of the drive {self.drive}", facts=facts)

    @property
    def tested(self) -> Tested:
        """The drive by its name, and when it was tested; one whose name is too long is called in some other way."""
        is_short = 0 < len(self.drive) <= LONGEST_NAME
        return Tested(
            tested_at=self.tested_at, ship=ShipIdentity(name=self.drive, line=LINE_OF_DRIVE) if is_short else None
        )

    def dated(self, at: datetime) -> Self:
        """Return it with another time of the test."""
        return self.model_copy(update={"tested_at": at})

    @property
    def title(self) -> str:
        """Name of the drive."""
        return self.drive

    @property
    def numbers(self) -> dict[str, tuple[Estimate, ...]]:
        """All numbers; they have the units of the drive."""
        return {"physical value": (*self.parameters, *self.combinations)}


def is_of_a_drive(content: object) -> bool:
    """Return whether what a JSON file holds says that it is the fingerprint of a drive."""
    return isinstance(content, dict) and content.get("kind") == "drive"
