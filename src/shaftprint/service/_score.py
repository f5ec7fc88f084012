"""What segments tell of the parameters: slope ``g`` and curvature ``H`` of the likelihood, one pair a segment.

Each segment is short, begins in steady running and has for itself what no model knows: its load, an offset and a drift
of either output, and the limits where it meets them; underway the speed of the ship where it begins. These are
projected out. The torque is compared without what the propeller takes at the speed of the same moment, at the quay
``M - l (1 + n)^2``: the disturbances of the line move speed and torque together, the more the faster it turns, and what
is left has one colour at all speeds. Its size goes with the load, ``(1 + n)^2``, and is a segment's own beyond that.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.catalogue._sailing import B
from shaftprint.catalogue._sailing_at_large import taken, taken_slope
from shaftprint.errors import ServiceError
from shaftprint.service._model import LIMITS, ServiceModel
from shaftprint.time_domain._noise_model import NoiseModel, estimate_noise
from shaftprint.time_domain._nuisance import drift_columns, orthonormal, without
from shaftprint.time_domain._record import Record
from shaftprint.time_domain._simulator import ExactDelays, on_record
from shaftprint.time_domain._whitening import Whitening

COMPARED = ("n", "M_s")
"""Outputs that are compared."""
MEMORY_S = 2.0
"""Longest memory of the noise [s]."""
# What a limit changes in a segment, over its noise, from which on it counts as met.
_MET = 1e-9


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Simulated:
    """A segment beside its simulation, as they are compared."""

    record: Record
    """The data."""
    weight: FloatArray
    """One over the square of the speed, by which noise is made alike, shape (samples,)."""
    residuals: FloatArray
    """Weighted data less model, shape (samples, outputs)."""
    slopes: FloatArray
    """Weighted derivatives of the model to the free parameters, shape (free, samples, outputs)."""
    beside: FloatArray
    """Weighted columns of what is the segment's own, shape (columns, samples, outputs)."""
    meets_limit: bool
    """Whether a limit of the torque acted in the model."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Score:
    """What one segment tells."""

    slope: FloatArray
    """Slope ``g`` of the log likelihood at the parameters, shape (free,)."""
    information: FloatArray
    """Curvature ``H`` there, shape (free, free)."""
    level: float
    """Size of its noise over that of all segments."""
    count: int
    """Samples of both outputs less what is projected out."""
    meets_limit: bool
    """Whether a limit of the torque acted in the model."""


def simulated(records: Sequence[Record], model: ServiceModel, theta: FloatArray) -> list[Simulated]:
    """Return segments beside their simulation at some parameters.

    ``records``: the segments. ``theta``: its free parameters, shape (free,). Raises
    ServiceError if a simulation runs away.
    """
    runs = []
    for record in records:
        run = _simulated(record, model, theta)
        if run is None:
            raise ServiceError(
                f"{record.name}: the simulation of {model.structure.name} runs away at "
                + ", ".join(f"{name} = {value:.4g}" for name, value in zip(model.free, theta, strict=True))
                + "; begin from a fingerprint of this line (--fingerprint)."
            )
        runs.append(run)
    return runs


def _simulated(record: Record, model: ServiceModel, theta: FloatArray) -> Simulated | None:
    structure = model.structure
    run = on_record(ExactDelays(), structure, model.vector(theta, record.load), record, (*model.free, *model.beside))
    if run is None:
        return None
    # the speed of the ship is simulated and not measured
    at = dict(zip(structure.outputs, run[0].T, strict=True))
    own = run[1:][:, :, [tuple(structure.outputs).index(name) for name in COMPARED]].copy()
    measured = np.stack([record.outputs[name] for name in COMPARED], axis=1)
    more, rise = _taken_more(model, theta, measured[:, 0], at)
    own[:, :, 1] -= record.load * rise * own[:, :, 0]
    residuals = measured - np.stack([at[name] for name in COMPARED], axis=1)
    residuals[:, 1] -= record.load * more
    weight = 1.0 / (1.0 + _smooth(measured[:, 0], record.rate_hz)) ** 2
    free = len(model.free)
    acts = np.abs(own[free:]).max(axis=(1, 2)) > _MET
    drifts = drift_columns(record, len(COMPARED), 1, anew_after_s=np.inf)
    return Simulated(
        record=record,
        weight=weight,
        residuals=residuals * weight[:, None],
        slopes=own[:free] * weight[:, None],
        beside=np.concatenate([drifts, own[free:][acts]]) * weight[:, None],
        meets_limit=any(acts[model.beside.index(name)] for name in LIMITS),
    )


def _taken_more(
    model: ServiceModel, theta: FloatArray, measured: FloatArray, at: Mapping[str, FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Return what the propeller takes more at the measured shaft speed than at the simulated, and its slope there.

    ``measured``: shape (samples,). ``at``: simulated outputs. Both over the torque of the working point.
    """
    speed = at["n"]
    if not model.sails:
        return (1.0 + measured) ** 2 - (1.0 + speed) ** 2, 2.0 * (1.0 + speed)
    ship, slope = at["v"], float(theta[model.free.index(B.name)])
    return taken(measured, ship, slope) - taken(speed, ship, slope), taken_slope(speed, ship, slope)


def _smooth(values: FloatArray, rate_hz: float) -> FloatArray:
    """Return means over half a second, shape (samples,)."""
    half = max(round(0.25 * rate_hz), 1)
    padded = np.pad(values, half, mode="edge")
    sums = np.cumsum(np.concatenate([[0.0], padded]))
    return np.asarray((sums[2 * half + 1 :] - sums[: -2 * half - 1]) / (2 * half + 1))


def noise_of(runs: Sequence[Simulated]) -> Whitening:
    """Return the filter that makes the noise of segments white, which have one colour and sizes of their own.

    Raises IdentificationError if an output has no noise at all.
    """
    kept, stretches, first = [], [], 0
    for run in runs:
        left = _left(run.residuals[None], run.beside)[0]
        kept.append(left / np.sqrt(np.mean(left[:, 0] ** 2)))
        stretches.append(slice(first, first + len(left)))
        first += len(left)
    rate_hz = runs[0].record.rate_hz
    noise: NoiseModel = estimate_noise(np.concatenate(kept), stretches, max_order=round(MEMORY_S * rate_hz))
    return Whitening(noise=noise)


def _left(rows: FloatArray, columns: FloatArray) -> FloatArray:
    """Return rows without what lies in columns, both of shape (..., samples, outputs)."""
    basis = orthonormal(columns.reshape(len(columns), -1))
    return without(rows.reshape(len(rows), -1), basis).reshape(rows.shape)


def scores(runs: Sequence[Simulated], whitening: Whitening) -> list[Score]:
    """Return what each segment tells at the parameters of the runs."""
    return [_score(run, whitening) for run in runs]


def _score(run: Simulated, whitening: Whitening) -> Score:
    rows = np.concatenate([run.residuals[None], run.slopes, run.beside])
    white = whitening.whitened(rows, [slice(0, run.record.samples)])
    free = len(run.slopes)
    left = _left(white[: 1 + free], white[1 + free :]).reshape(1 + free, -1)
    count = left.shape[1] - len(run.beside)
    power = float(left[0] @ left[0]) / count
    return Score(
        slope=left[1:] @ left[0] / power,
        information=left[1:] @ left[1:].T / power,
        level=float(np.sqrt(power)),
        count=count,
        meets_limit=run.meets_limit,
    )
