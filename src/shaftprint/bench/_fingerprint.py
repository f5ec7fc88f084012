"""From a fit of a drive to the record that is kept, and back to a model."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import datetime
from types import MappingProxyType

import numpy as np

import shaftprint
from shaftprint.arguments import refusing_none
from shaftprint.arrays import frozen_float
from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._fit import DriveFit
from shaftprint.bench._per_record import base_name, record_structure
from shaftprint.errors import FingerprintError
from shaftprint.fingerprint._drive_fingerprint import DriveFingerprint, DriveRecord, DriveResponse, NoiseOfRecord
from shaftprint.fingerprint._joint_numbers import JointNumbers, kept_together
from shaftprint.fingerprint._line_fingerprint import SourceFile
from shaftprint.fingerprint._model import IdentifiedModel
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.uncertainty._joint import joint_covariance
from shaftprint.models._structure import Structure
from shaftprint.time_domain._record_fit import RecordFit


@refusing_none(FingerprintError)
def drive_fingerprint(
    fit: DriveFit, *, sources: Sequence[SourceFile], now: datetime, tested_at: datetime | None = None
) -> DriveFingerprint:
    """Return what is kept of a fit.

    ``sources``: recordings, drive file and own structure with their hashes. ``now``: time of making, with time zone.
    ``tested_at``: when the first record was made; None where nobody says it.
    """
    identification, one = fit.identification, fit.equipped
    structure, parameters = one.structure, identification.objective.parameters
    return DriveFingerprint(
        shaftprint_version=shaftprint.__version__,
        created=now,
        sources=tuple(sources),
        drive=one.drive.name,
        tested_at=tested_at,
        structure=structure.name,
        inputs={name: one.units[name] for name in structure.inputs},
        outputs={name: one.units[name] for name in structure.outputs},
        parameters=tuple(_quantity(fit, estimate) for estimate in identification.parameters),
        held={p.name: p.value for p in parameters if p.held},
        priors=dict(identification.settings.priors),
        covariance=tuple(tuple(row) for row in identification.covariance.tolist()),
        combinations=tuple(_quantity(fit, estimate) for estimate in identification.combinations),
        records=_records(fit, sources),
        responses=_responses(fit),
        p_value=identification.p_value,
        starts=identification.settings.starts,
        starts_at_optimum=fit.agreeing,
        joint=_joint(fit),
        verdict=fit.verdict,
        inputs_hold=fit.inputs_hold,
    )


def _joint(fit: DriveFit) -> JointNumbers:
    """Return the covariance of what is of the drive, not of one record alone."""
    free = [estimate.name for estimate in fit.identification.parameters]
    bases = set(fit.equipped.structure.names)
    return kept_together(joint_covariance(fit.identification, [name for name in free if name in bases]))


def _quantity(fit: DriveFit, estimate: Estimate) -> Estimate:
    interval = fit.intervals.get(estimate.name)
    # the lines of drives have no roles in their files
    return replace(
        estimate,
        interval_95=None if interval is None else (interval.lower, interval.upper),
        interval_open=(False, False) if interval is None else (interval.lower_open, interval.upper_open),
        role=None,
    )


def _responses(fit: DriveFit) -> tuple[DriveResponse, ...]:
    return tuple(
        DriveResponse(
            name=name,
            lines=int(part.fitted.sum()),
            lowest_hz=float(part.response.frequency_hz[part.fitted].min()),
            highest_hz=float(part.response.frequency_hz[part.fitted].max()),
            fit_percent=dict(part.fit_percent),
            fit_ceiling=dict(part.fit_ceiling),
        )
        for name, part in zip(fit.responses, fit.identification.experiments, strict=True)
    )


def _records(fit: DriveFit, sources: Sequence[SourceFile]) -> tuple[DriveRecord, ...]:
    parts = [part for part in fit.identification.parts if isinstance(part, RecordFit)]
    files = [source.sha256 for source in sources if source.role == "recording"]
    # each file gives as many records, in the order of the files
    each = max(len(fit.equipped.drive.records), 1)
    of = [file for file in files for _ in range(each)] if len(files) * each == len(parts) else [""] * len(parts)
    return tuple(_record(part, recording) for part, recording in zip(parts, of, strict=True))


def _record(part: RecordFit, recording: str) -> DriveRecord:
    power, times = np.diag(part.noise.power), part.record.time_s
    return DriveRecord(
        name=part.record.name,
        seconds=part.seconds,
        rate_hz=part.record.rate_hz,
        fit_percent=dict(part.fit_percent),
        fit_ceiling=dict(part.fit_ceiling),
        noise_std={name: float(np.sqrt(power[i])) for i, name in enumerate(part.structure.outputs)},
        noise=NoiseOfRecord(coefficients=part.noise.coefficients.tolist(), covariance=part.noise.covariance.tolist()),
        offset={offset.name: offset.value for offset in part.offsets},
        offset_std={offset.name: offset.std for offset in part.offsets},
        recording=recording,
        from_s=float(times[0]),
        to_s=float(times[-1]),
    )


def identified_drive(
    fingerprint: DriveFingerprint,
    one: EquippedDrive,
    *,
    record: str | None = None,
    beside: Mapping[str, float] = MappingProxyType({}),
) -> IdentifiedModel:
    """Return the model that the fingerprint of a drive describes.

    ``fingerprint``: a saved fingerprint. ``one``: the drive, whose structure it names. ``record``: the record whose own
    values it has; where none is named, the drive file states what differs between records. ``beside``: own values of
    the record that the fingerprint does not have; they are held. Raises FingerprintError if the structure has another
    name or other parameters than the fingerprint, or a parameter several values.
    """
    structure = one.structure if record is None else record_structure(one, record)
    kept, bases = fingerprint.values, set(one.structure.names)
    of_others = {name for name in kept if name not in structure.names and base_name(name) in bases}
    stated = {p.name: p.value for p in structure.parameters if p.held and p.name not in kept} if of_others else {}
    several = {base_name(name) for name in of_others} - set(kept) - set(stated)
    if record is None and several:
        name = min(several)
        found = ", ".join(one for one in kept if base_name(one) == name)
        raise FingerprintError(
            f"fingerprint of {fingerprint.drive}: expected one value of {name}, found {found}; state that of the model "
            "with [[known]] in the drive file, in place of [[per_record]]."
        )
    named = {name: value for name, value in kept.items() if name not in of_others} | stated | dict(beside)
    apart = sorted(set(structure.names) ^ set(named))
    if apart or structure.name != fingerprint.structure:
        what = f"a difference in {', '.join(apart)}" if apart else f"structure {structure.name}"
        raise FingerprintError(
            f"fingerprint of {fingerprint.drive}: expected the parameters of structure {fingerprint.structure}, found "
            f"{what}; name the drive file that it was identified with."
        )
    held = {name: value for name, value in fingerprint.held.items() if name in named} | stated | dict(beside)
    free = [name for name in structure.names if name not in held]
    return IdentifiedModel(
        structure=_held_as_then(structure, held, free),
        values=frozen_float([named[name] for name in structure.names]),
        covariance=frozen_float(fingerprint.covariance_of(free)),
    )


def _held_as_then(structure: Structure, held: Mapping[str, float], free: Sequence[str]) -> Structure:
    """Return the structure with what was held then held at its value, and the rest free."""
    bounds = {p.name: (p.lower, p.upper) for p in structure.parameters}
    wide = {name: (min(bounds[name][0], value), max(bounds[name][1], value)) for name, value in held.items()}
    return structure.free_between(**wide, **{name: bounds[name] for name in free}).held_at(**held)
