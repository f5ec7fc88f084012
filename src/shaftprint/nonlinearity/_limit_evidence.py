"""Clipped stretches: torque against speed while a limit holds it."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.nonlinearity._fit import Fit, foretold
from shaftprint.nonlinearity._record import Record
from shaftprint.nonlinearity._replay import NONE

if TYPE_CHECKING:
    from shaftprint.signals import Signals

_SHORTEST_S = 0.05
_TOUCHES = 1e-9


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LimitEvidence:
    """Stretches in which the replay rests on a limit of the torque."""

    start_s: FloatArray
    """When each begins [s], shape (stretches,)."""
    duration_s: FloatArray
    """How long it lasts [s], shape (stretches,)."""
    speed: FloatArray
    """Mean speed [-], shape (stretches,)."""
    torque: FloatArray
    """Mean measured torque of the engine over ``M_b0`` [-], shape (stretches,)."""
    torque_std: FloatArray
    """Its standard deviation, from means of equally long stretches elsewhere [-], shape (stretches,)."""
    limit: FloatArray
    """Limit of the fit at that speed over ``M_b0`` [-], shape (stretches,)."""
    rack: FloatArray
    """Mean of the logged rack over ``X_0`` in the stretch [-], shape (stretches,); not numbers where it was not."""
    curve_speed: FloatArray
    """Speeds of the whole limit curve [-], shape (points,); empty without a torque limit."""
    curve_torque: FloatArray
    """The curve over ``M_b0`` [-], shape (points,)."""
    curve_std: FloatArray
    """Its standard deviation [-], shape (points,)."""
    cloud_speed: FloatArray
    """Speed at all times, thinned, for a picture [-], shape (values,)."""
    cloud_torque: FloatArray
    """Torque of the engine at those times over ``M_b0`` [-], shape (values,)."""

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for name in self.__slots__:
            object.__setattr__(self, name, frozen_float(getattr(self, name)))


def limit_evidence(record: Record, found: Fit, signals: "Signals") -> LimitEvidence:
    """Return the stretches on a limit, with what was measured in them."""
    engine, _ = foretold(record, found.values)
    full = np.interp(record.speed, record.curve_speed, record.curve_torque)
    high, low = found.values["limit"] * full, np.full(full.size, -found.values["m_min"])
    if found.values["air"] < 1.0:
        high = np.full(full.size, NONE)
    rows = []
    for limit in (high, low):
        for first, last in _runs(np.abs(engine - limit) < _TOUCHES * (1.0 + np.abs(limit))):
            span = float(record.time_s[first]), float(record.time_s[last - 1])
            if (last - first) * record.step_s >= _SHORTEST_S and not signals.coverage.missing(*span):
                rows.append(_stretch(record, engine, limit, first, last, signals))
    table = np.array(sorted(rows)).reshape(-1, 7)
    # a curve that was taken from the vessel file is not one that was found
    curved = "limit" in found.free
    relative = found.std("limit") / found.values["limit"] if curved else 0.0
    curve = found.values["limit"] * record.curve_torque if curved else np.empty(0)
    return LimitEvidence(
        start_s=table[:, 0],
        duration_s=table[:, 1],
        speed=table[:, 2],
        torque=table[:, 3],
        torque_std=table[:, 4],
        limit=table[:, 5],
        rack=table[:, 6],
        curve_speed=record.curve_speed if curved else np.empty(0),
        curve_torque=curve,
        curve_std=relative * curve,
        cloud_speed=record.values_of(record.speed),
        cloud_torque=record.values_of(record.engine_torque),
    )


def _runs(on: "np.ndarray[tuple[int], np.dtype[np.bool_]]") -> list[tuple[int, int]]:
    edges = np.flatnonzero(np.diff(np.concatenate([[0], on.astype(np.int8), [0]])))
    return [(int(first), int(last)) for first, last in edges.reshape(-1, 2)]


def _stretch(
    record: Record, engine: FloatArray, limit: FloatArray, first: int, last: int, signals: "Signals"
) -> tuple[float, ...]:
    here = slice(first, last)
    load = (1.0 + record.speed) ** 2
    noise = (record.engine_torque - engine) / load
    means = noise[: noise.size // (last - first) * (last - first)].reshape(-1, last - first).mean(axis=1)
    # half the width between the 16th and 84th of a hundred: clipped stretches themselves do not count
    std = 0.5 * float(np.diff(np.quantile(means, [0.16, 0.84]))[0]) * float(load[here].mean())
    start_s, stop_s = float(record.time_s[first]), float(record.time_s[last - 1])
    return (
        start_s,
        (last - first) * record.step_s,
        float(record.speed[here].mean()),
        float(record.engine_torque[here].mean()),
        std,
        float(limit[here].mean()),
        _rack(signals, start_s, stop_s),
    )


def _rack(signals: "Signals", start_s: float, stop_s: float) -> float:
    if signals.rack is None:
        return float("nan")
    time = signals.rack.start_s + np.arange(signals.rack.fraction.size) / signals.rack.rate_hz
    inside = (time >= start_s) & (time <= stop_s)
    return float(signals.rack.fraction[inside].mean() / signals.rack.working_point) if inside.any() else float("nan")
