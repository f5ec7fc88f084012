"""The fingerprint of a drive that is no ship's: parameters with covariance, verdict and records, as a JSON record."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Final, Literal, Self

import numpy as np
from pydantic import AwareDatetime, Field, ValidationError, model_validator

from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray
from shaftprint.errors import FingerprintError, ShaftprintError
from shaftprint.files import read_json, write_bytes
from shaftprint.fingerprint._covariance_check import covariance_fault
from shaftprint.fingerprint._fingerprint import SourceFile
from shaftprint.fingerprint._number import Deviation, Number
from shaftprint.identify.judgement._verdict import Verdict
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened
from shaftprint.publication._publish import complete
from shaftprint.records import Record, faults

DRIVE_SCHEMA: Final = "drive 1.2"
"""Version of the layout of a drive's fingerprint."""


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


class DriveFingerprint(Shown, Record):
    """Parameters of one drive with uncertainty, and how well its records are explained."""

    kind: Literal["drive"] = "drive"
    """Tells it from the fingerprint of a ship."""
    schema_version: Literal["drive 1.0", "drive 1.1", "drive 1.2"] = DRIVE_SCHEMA
    """Version of this record's layout."""
    shaftprint_version: str
    """Version of shaftprint that made it."""
    created: AwareDatetime
    """When it was made, with time zone."""
    sources: tuple[SourceFile, ...]
    """Recordings, drive file and own structure with their hashes."""
    drive: str
    """Name of the drive."""
    structure: str
    """Name of the model structure."""
    inputs: dict[str, str]
    """Unit of each input by its name; empty where it is that of an own structure."""
    outputs: dict[str, str]
    """Unit of each output by its name."""
    parameters: tuple[Number, ...]
    """Free parameters."""
    held: dict[str, float]
    """Parameters that were held, with their values."""
    priors: dict[str, Prior]
    """Parameters of which something was known before the test; it counts in the standard deviations."""
    covariance: tuple[tuple[float, ...], ...]
    """Covariance of the free parameters, in their order."""
    combinations: tuple[Number, ...]
    """Combinations of parameters."""
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
    verdict: Verdict
    """Whether the numbers may be used, and which of them."""
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

    @model_validator(mode="after")
    def _expect_covariance(self) -> Self:
        fault = covariance_fault(self.covariance, [quantity.std for quantity in self.parameters])
        if fault:
            raise ValueError(f"covariance: {fault}")
        return self

    @property
    def values(self) -> dict[str, float]:
        """Every parameter by its name, held ones too."""
        return self.held | {quantity.name: quantity.value for quantity in self.parameters}

    def covariance_of(self, names: Sequence[str]) -> FloatArray:
        """Return the covariance of some of the parameters, shape (names, names).

        Raises FingerprintError if one of them is not a free parameter.
        """
        order = [quantity.name for quantity in self.parameters]
        foreign = [name for name in names if name not in order]
        if foreign:
            raise FingerprintError(f"the fingerprint has no parameter {foreign[0]!r}; it has {', '.join(order)}.")
        places = [order.index(name) for name in names]
        return np.array(self.covariance).reshape(len(order), len(order))[np.ix_(places, places)]


def write_drive_fingerprint(fingerprint: DriveFingerprint, path: str | Path) -> None:
    """Write the fingerprint of a drive as JSON, whole or not at all; an existing file is replaced.

    Raises FingerprintError if the file cannot be written.
    """
    write_bytes(Path(path), drive_fingerprint_content(fingerprint), noun="fingerprint", error=FingerprintError)


def drive_fingerprint_content(fingerprint: DriveFingerprint) -> bytes:
    """Return what ``write_drive_fingerprint`` writes."""
    return (fingerprint.model_dump_json(indent=2) + "\n").encode()


@refusing_none(FingerprintError)
def read_drive_fingerprint(path: str | Path) -> DriveFingerprint:
    """Read the fingerprint of a drive from JSON; what was written comes back equal.

    Raises
    ------
    FingerprintError
        If the file is missing, is no fingerprint of a drive, or has fields that are wrong; all of them are listed.
    """
    json_path = Path(path)
    complete(json_path.parent)
    where = "name the file, or the folder in which identify has put it"
    text, content = read_json(json_path, noun="fingerprint", where=where, error=FingerprintError)
    if not is_of_a_drive(content):
        raise FingerprintError(
            f"{json_path}: expected the fingerprint of a drive, made with --drive, found another file; leave --drive "
            "out for that of a ship."
        )
    try:
        return DriveFingerprint.model_validate_json(text)
    except ValidationError as error:
        raise FingerprintError(f"{json_path} is not a fingerprint of schema {DRIVE_SCHEMA}: {faults(error)}.") from None
    except ShaftprintError as error:
        raise FingerprintError(f"{json_path} is not a fingerprint of schema {DRIVE_SCHEMA}: {error}") from None


def is_of_a_drive(content: object) -> bool:
    """Return whether what a JSON file holds says that it is the fingerprint of a drive."""
    return isinstance(content, dict) and content.get("kind") == "drive"
