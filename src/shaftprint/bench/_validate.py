"""A drive's model against records that it was not identified from."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._fingerprint import identified_drive
from shaftprint.bench._per_record import base_name, record_structure
from shaftprint.bench._time_settings import drive_time_settings
from shaftprint.errors import IdentificationError
from shaftprint.fingerprint._drive_fingerprint import DriveFingerprint
from shaftprint.identify.judgement._requirements import Requirements
from shaftprint.identify.search._settings import Settings
from shaftprint.time_domain._identify_in_time import TimeSettings, identify_in_time, output_error, with_noise_at
from shaftprint.time_domain._record import Record
from shaftprint.time_domain._record_fit import RecordFit

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

    ``files``: SHA-256 of each file; every one gave as many of the records, in their order.
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
    """Compare the model of a fingerprint with records.

    Offsets and the start are found with each, and parameters with own values in each record where the fingerprint has
    none of this one; nothing else.

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
    settings, asked = drive_time_settings(one, records), Requirements()
    validated = []
    for number, record in enumerate(records, start=1):
        beside = _found_beside(fingerprint, one, record, settings)
        model = identified_drive(fingerprint, one, record=record.name, beside=beside)
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


def _found_beside(
    fingerprint: DriveFingerprint, one: EquippedDrive, record: Record, settings: TimeSettings
) -> dict[str, float]:
    """Return the record's own values of parameters where a fingerprint has none: what fits beside all else."""
    kept, structure = fingerprint.values, record_structure(one, record.name)
    missing = [p for p in structure.free if p.name not in kept and "(" in p.name]
    if not missing:
        return {}
    of_others = {
        p.name: [value for name, value in kept.items() if base_name(name) == base_name(p.name)] for p in missing
    }
    fit = identify_in_time(
        [(structure.held_at(**{name: value for name, value in kept.items() if name in structure.names}), record)],
        rng=np.random.default_rng(0),
        settings=Settings(starts=1),
        time=settings,
        start={p.name: float(np.median(of_others[p.name] or [p.value])) for p in missing},
    )
    return {p.name: p.value for p in fit.parameters}
