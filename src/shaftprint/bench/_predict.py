"""What records that are only planned would tell of a drive: standard deviations to first order."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._per_record import all_parameters, base_name, free_parameters, own_priors, with_structures
from shaftprint.bench._records import read_records
from shaftprint.bench._time_settings import drive_time_settings
from shaftprint.errors import IdentificationError
from shaftprint.fingerprint._drive_fingerprint import DriveFingerprint, DriveRecord
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.models._parameter import Parameter
from shaftprint.time_domain._identify_in_time import output_error
from shaftprint.time_domain._noise_model import NoiseModel
from shaftprint.time_domain._record import Record
from shaftprint.time_domain._whitening import Whitening

# Rates of a plan and of a record are one but for rounding.
SAME_RATE = 1e-6


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PredictedRecords:
    """What planned records would tell of a drive."""

    parameters: tuple[Parameter, ...]
    """Its free parameters."""
    values: Mapping[str, float]
    """Values at which they are predicted, by parameter."""
    deviations: Mapping[str, float]
    """Standard deviation that each would have; infinite where the records say nothing."""
    noise_source: str
    """Of what colour the noise is taken to be, in words."""


def predict_files(
    one: EquippedDrive,
    inputs: Sequence[Path],
    *,
    kept: DriveFingerprint | None = None,
    noise_std: Mapping[str, float] = MappingProxyType({}),
    values: Mapping[str, float] = MappingProxyType({}),
    priors: Mapping[str, Prior] = MappingProxyType({}),
) -> PredictedRecords:
    """Return what records of planned inputs would tell of a drive.

    Parameters
    ----------
    one
        The drive.
    inputs
        Files with the planned inputs, a column each.
    kept
        A fingerprint, for values and the largest noise that it has seen of each output.
    noise_std, values, priors
        What is stated instead, and known beside the drive file.

    Raises
    ------
    IdentificationError
        If the noise of an output is not known, or the simulation runs away.
    """
    records = read_records(inputs, one, planned=True, hold=kept is not None and kept.inputs_hold)
    names = {parameter.name for parameter in all_parameters(one, records)}
    at = {name: value for name, value in (kept.values if kept else {}).items() if name in names} | dict(values)
    stds = largest_noise(kept) | dict(noise_std)
    return PredictedRecords(
        parameters=tuple(free_parameters(one, records)),
        values=predicted_at(one, records, values=at, priors=priors),
        deviations=predict_drive(one, records, noise_std=stds, kept=kept, values=at, priors=priors),
        noise_source=noise_words(kept, records),
    )


@refusing_none(IdentificationError)
def predict_drive(
    one: EquippedDrive,
    records: Sequence[Record],
    *,
    noise_std: Mapping[str, float],
    kept: DriveFingerprint | None = None,
    values: Mapping[str, float] | None = None,
    priors: Mapping[str, Prior] | None = None,
) -> dict[str, float]:
    """Return the standard deviation that each free parameter would have; infinite where the records say nothing.

    ``one``: the drive. ``records``: planned inputs; what stands as outputs is replaced by those of the model.
    ``noise_std``: standard deviation of the noise of a sample of each output, in its unit. ``kept``: a fingerprint
    whose noise it has the colour of, where records have the rate of those; it is white elsewhere. ``values``: values of
    parameters at which to predict; usual ones where not given. ``priors``: what is known beside the drive file. Raises
    IdentificationError if the noise of an output is not stated, or the simulation runs away.
    """
    structure = one.structure
    missing = [name for name in structure.outputs if not noise_std.get(name, 0.0) > 0.0]
    if missing:
        raise IdentificationError(
            f"prediction: expected the noise of {missing[0]}, a positive standard deviation of one sample, found none."
        )
    at = predicted_at(one, records, values=values or {}, priors=priors or {})
    settings = drive_time_settings(one, records)
    names = [parameter.name for parameter in free_parameters(one, records)]
    information = np.zeros((len(names), len(names)))
    for of_record, record in with_structures(one, records):
        term = output_error(of_record, _as_noise(record, noise_std), settings=settings)
        noise = planned_noise(kept, tuple(structure.outputs), noise_std=noise_std, rate_hz=record.rate_hz)
        term = term.with_noise(Whitening(noise=noise))
        rows = term.rows(np.array([at[name] for name in of_record.names]))
        if rows is None:
            raise IdentificationError(
                f"prediction: the simulation of {structure.name} runs away under {record.name}; state other values."
            )
        places = [names.index(parameter.name) for parameter in of_record.free]
        information[np.ix_(places, places)] += rows[1:] @ rows[1:].T
    for name, prior in own_priors(one, records, {**one.priors, **(priors or {})}).items():
        information[names.index(name), names.index(name)] += 1.0 / prior.std**2
    return dict(zip(names, _deviations(information).tolist(), strict=True))


def predicted_at(
    one: EquippedDrive, records: Sequence[Record], *, values: Mapping[str, float], priors: Mapping[str, Prior]
) -> dict[str, float]:
    """Return every parameter at which records are predicted: as stated, else as known, else as usual.

    ``values``: what is stated; that of a parameter with own values stands for all of them that are not stated
    themselves. ``priors``: what is known beside the drive file. Raises StructureError if no record has one of them.
    """
    known = own_priors(one, records, {**one.priors, **priors})
    means = {name: prior.mean for name, prior in known.items()}
    usual = {parameter.name: parameter.value for parameter in all_parameters(one, records)}
    # refuses what is in no record
    one.structure.vector({name: value for name, value in {**means, **values}.items() if name not in usual})
    return {name: values.get(name, values.get(base_name(name), value)) for name, value in (usual | means).items()}


def largest_noise(kept: DriveFingerprint | None) -> dict[str, float]:
    """Return the largest noise of one sample that a fingerprint has seen of each output."""
    seen = [record.noise_std for record in (kept.records if kept else ())]
    return {name: max(record.get(name, 0.0) for record in seen) for name in {name for one in seen for name in one}}


def coloured_record(kept: DriveFingerprint | None, rate_hz: float) -> DriveRecord | None:
    """Return the record of a fingerprint with the most noise of those at a rate whose colour is kept, if any."""
    alike = [
        record
        for record in (() if kept is None else kept.records)
        if record.noise is not None and abs(record.rate_hz / rate_hz - 1.0) < SAME_RATE
    ]
    return max(alike, key=lambda record: sum(map(math.log, record.noise_std.values())), default=None)


def noise_words(kept: DriveFingerprint | None, records: Sequence[Record]) -> str:
    """Return of what colour the noise of planned records is taken to be."""
    coloured = [record for record in (coloured_record(kept, one.rate_hz) for one in records) if record is not None]
    if len(coloured) < len(records):
        rates = "" if kept is None else ", at a rate whose colour the fingerprint does not keep"
        return f"Noise is taken to be white{rates}; records tell less under noise with a memory."
    return f"Noise has the colour of {', '.join(dict.fromkeys(record.name for record in coloured))}."


def planned_noise(
    kept: DriveFingerprint | None, outputs: Sequence[str], *, noise_std: Mapping[str, float], rate_hz: float
) -> NoiseModel:
    """Return noise of the colour that a fingerprint keeps, white without, with the stated standard deviations.

    ``outputs``: names of the outputs, in the order of the structure.
    """
    sizes, coloured = np.array([noise_std[name] for name in outputs]), coloured_record(kept, rate_hz)
    if kept is None or coloured is None or coloured.noise is None:
        white = np.zeros((0, len(outputs), len(outputs)))
        return NoiseModel(coefficients=frozen_float(white), covariance=frozen_float(np.diag(sizes**2)))
    order = [list(kept.outputs).index(name) for name in outputs]
    scale = sizes / np.array([coloured.noise_std[name] for name in outputs])
    by = scale[:, None] / scale
    past = np.array(coloured.noise.coefficients).reshape(-1, len(kept.outputs), len(kept.outputs))
    anew = np.array(coloured.noise.covariance)[np.ix_(order, order)]
    return NoiseModel(
        coefficients=frozen_float(past[:, order][:, :, order] * by),
        covariance=frozen_float(anew * np.outer(scale, scale)),
    )


def _as_noise(record: Record, noise_std: Mapping[str, float]) -> Record:
    """Return a record whose outputs are as large as their noise: none of them is used, but its size stands for one."""
    turns = 1.0 - 2.0 * (np.arange(record.samples) % 2)
    return replace(record, outputs={name: frozen_float(noise_std[name] * turns) for name in record.outputs})


def _deviations(information: FloatArray) -> FloatArray:
    """Return the root of the diagonal of the inverse; infinite where nothing is known."""
    scale = np.sqrt(np.diag(information))
    safe = np.where(scale > 0.0, scale, 1.0)
    values, vectors = np.linalg.eigh(information / np.outer(safe, safe))
    known = values > 1e-12 * values[-1]
    variance = np.sum(vectors[:, known] ** 2 / values[known], axis=1) / safe**2
    lost = np.any(np.abs(vectors[:, ~known]) > 1e-6, axis=1) | (scale == 0.0)
    return np.where(lost, np.inf, np.sqrt(variance))
