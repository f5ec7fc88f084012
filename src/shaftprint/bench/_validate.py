"""A drive's model against records that it was not identified from."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

from shaftprint.arguments import refusing_none
from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._fingerprint import identified_drive
from shaftprint.bench._fit import drive_time_settings
from shaftprint.errors import IdentificationError
from shaftprint.fingerprint import DriveFingerprint
from shaftprint.identify import Requirements
from shaftprint.time_domain import Record, RecordFit, output_error, with_noise_at

Outcome: TypeAlias = Literal["passes", "fails"]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ValidatedRecord:
    """One record beside what the model says of it."""

    fit: RecordFit
    """Data and model."""
    missed: Mapping[str, float]
    """What other values of its parameters or a model that is more flexible would explain of each output, unless by
    chance; root mean square over that of the motion."""
    outcome: Outcome
    """Whether it misses no more than a contradiction may be: see ``Requirements.largest_contradiction``."""


def identified_from(kept: DriveFingerprint, files: Sequence[str], records: Sequence[Record]) -> tuple[str, ...]:
    """Return the names of records that share time with those that a fingerprint was identified from.

    Parameters
    ----------
    files
        SHA-256 of each file; every one gave as many of the records, in their order.
    """
    each = len(records) // len(files)
    of = [file for file in files for _ in range(each)]
    if any(record.recording for record in kept.records):
        return tuple(
            record.name
            for file, record in zip(of, records, strict=True)
            if any(one.overlaps(file, float(record.time_s[0]), float(record.time_s[-1])) for one in kept.records)
        )
    # a fingerprint of an earlier version knows files only
    earlier = {source.sha256 for source in kept.sources if source.role == "recording"}
    return tuple(record.name for file, record in zip(of, records, strict=True) if file in earlier)


@refusing_none(IdentificationError)
def validate_drive(
    fingerprint: DriveFingerprint, one: EquippedDrive, records: Sequence[Record]
) -> tuple[ValidatedRecord, ...]:
    """Compare the model of a fingerprint with records; offsets and the start are found with each, nothing else.

    Parameters
    ----------
    fingerprint
        What was identified from other records.
    one
        The drive, with the structure that the fingerprint names.
    records
        Records that it was not identified from.

    Raises
    ------
    FingerprintError
        If the structure is not that of the fingerprint.
    IdentificationError
        If the simulation runs away.
    """
    model = identified_drive(fingerprint, one)
    settings, asked = drive_time_settings(one, records), Requirements()
    validated = []
    for number, record in enumerate(records, start=1):
        term = output_error(model.structure, record, settings=settings)
        term = with_noise_at(term, model.values, assumed=settings.assumed)
        part, _ = term.assessed(model.values, number)
        seen = [check for check in part.checks if check.p_value < asked.lowest_p_value]
        missed = {
            name: max((check.share for check in seen if check.output == name), default=0.0)
            for name in part.structure.outputs
        }
        large = [c for c in seen if c.share > max(asked.largest_contradiction, asked.visible_share * c.noise)]
        outcome: Outcome = "fails" if large else "passes"
        validated.append(ValidatedRecord(fit=part, missed=missed, outcome=outcome))
    return tuple(validated)
