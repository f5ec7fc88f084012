"""What the replay is fed with: the signals of a recording on its own, coarser grid, normalised at the working point."""

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, frozen_bool, frozen_float
from shaftprint.errors import SignalError
from shaftprint.units import rev_s_from_rpm

if TYPE_CHECKING:
    from shaftprint.campaign import Campaign
    from shaftprint.signals import Signals
    from shaftprint.vessel import Vessel

STEP_RATE_HZ = 100.0
"""Rate of the replay [Hz]: delays and actuations of tenths of a second need no finer steps."""

RESIDUAL_RATE_HZ = 25.0
"""Rate at which torques are compared [Hz]: above half of it no governor acts, and only the engine's orders are seen."""

_MARGIN_S = 5.0
# The replay forgets with a time constant of 10 s; the steps of the set point inside a gap are not known to it.
_SETTLED_S = 30.0
_LEAST_SPEED = 0.1


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Record:
    """Signals of the replay; deviations are relative to the working point."""

    time_s: FloatArray
    """Time of the recording [s], shape (steps,)."""
    step_s: float
    """Step of the replay [s]."""
    thinning: int
    """Steps in one value of the residual."""
    set_point: FloatArray
    """``n_set*`` [-], shape (steps,)."""
    speed: FloatArray
    """``n*`` [-], shape (steps,)."""
    shaft_torque: FloatArray
    """``M_s / M_s0`` [-], shape (steps,)."""
    engine_torque: FloatArray
    """``M_s / M_s0 + tau_up dn*/dt``: brake torque over that of the working point [-], shape (steps,)."""
    load: FloatArray
    """Load of the propeller over that of the working point, ``(1 + n*)^2`` [-], infinite where a gap of the recording
    is felt: the residual is then 0; shape (values,)."""
    smooth: BoolArray
    """Where the set point is a sine or a chirp and does not jump, shape (values,)."""
    upstream_s: float
    """``tau_up`` [s]."""
    downstream_s: float
    """``tau_dn`` [s] of the vessel file."""
    speed_slope: float
    """``g`` of the vessel file [-]; 0 where it has no map."""
    rack_slope: float
    """``v`` of the vessel file [-]; 1 where it has no map."""
    curve_speed: FloatArray
    """Speeds of the full-load curve as deviations [-], shape (points,)."""
    curve_torque: FloatArray
    """Full-load torque over ``M_b0`` [-], shape (points,)."""
    engine_speed_rev_s: float
    """``n_0`` [rev/s]."""
    brake_torque_nm: float
    """``M_b0 = M_s0 / (i eta)`` [N m]."""
    rated_torque_nm: float
    """Rated torque of the engine [N m]."""

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for name in ("time_s", "set_point", "speed", "shaft_torque", "engine_torque", "load"):
            object.__setattr__(self, name, frozen_float(getattr(self, name)))

    def values_of(self, steps: FloatArray) -> FloatArray:
        """Return the means over the steps of each value of the residual, shape (values,)."""
        return block_means(steps, self.thinning)

    def only_smooth(self) -> "Record":
        """Return the record with an infinite load outside of sines and chirps, where the residual is then 0."""
        return replace(self, load=np.where(self.smooth, self.load, np.inf))

    @property
    def value_time_s(self) -> FloatArray:
        """Time of each value of the residual [s], shape (values,)."""
        return self.values_of(self.time_s)


def block_means(values: FloatArray, length: int) -> FloatArray:
    """Return the means of whole blocks, shape (blocks,)."""
    whole = values.size // length * length
    means: FloatArray = values[:whole].reshape(-1, length).mean(axis=1)
    return means


def make_record(signals: "Signals", campaign: "Campaign", vessel: "Vessel") -> Record:
    """Cut the tests out of the signals and normalise them for the replay.

    Parameters
    ----------
    signals, campaign, vessel
        The prepared recording, what was asked, and the installation.

    Raises
    ------
    SignalError
        If the grid is no multiple of the rate of the replay, or holds no test.
    """
    every = signals.rate_hz / STEP_RATE_HZ
    if every < 1.0 or abs(every - round(every)) > 1e-9:
        raise SignalError(
            f"{signals.recording_name}: expected signals at a multiple of {STEP_RATE_HZ:g} Hz to look for "
            f"nonlinearities, found {signals.rate_hz:g} Hz; prepare them with rate_hz = 200."
        )
    inside = _span(signals, campaign)
    point = signals.working_point
    speed_0, torque_0 = point.engine_speed_rev_s, point.shaft_torque_nm
    length = round(every)
    time = signals.start_s + np.arange(signals.samples)[inside] / signals.rate_hz
    speed = block_means(signals.engine_speed.speed_rev_s[inside], length) / speed_0 - 1.0
    torque = block_means(signals.shaft_torque_nm[inside], length) / torque_0
    step_s = 1.0 / STEP_RATE_HZ
    per_inertia = 2.0 * math.pi * speed_0 / (vessel.gearbox.ratio * torque_0)
    upstream = per_inertia * vessel.inertia_upstream_kg_m2
    brake = torque_0 / (vessel.gearbox.ratio * vessel.gearbox.efficiency)
    thinning = round(STEP_RATE_HZ / RESIDUAL_RATE_HZ)
    slopes = _map_slopes(vessel, speed_0, brake)
    lost = _lost(block_means(block_means(time, length), thinning), signals)
    return Record(
        time_s=block_means(time, length),
        step_s=step_s,
        thinning=thinning,
        set_point=block_means(signals.set_point_rev_s[inside], length) / speed_0 - 1.0,
        speed=speed,
        shaft_torque=torque,
        engine_torque=torque + upstream * np.gradient(speed, step_s),
        load=np.where(lost, np.inf, np.maximum(1.0 + block_means(speed, thinning), _LEAST_SPEED) ** 2),
        smooth=_smooth(block_means(block_means(time, length), thinning), campaign),
        upstream_s=upstream,
        downstream_s=per_inertia * vessel.inertia_downstream_kg_m2,
        speed_slope=slopes[0],
        rack_slope=slopes[1],
        curve_speed=frozen_float(rev_s_from_rpm(np.array(vessel.engine.full_load_speed_rpm)) / speed_0 - 1.0),
        curve_torque=frozen_float(np.array(vessel.engine.full_load_torque_nm) / brake),
        engine_speed_rev_s=speed_0,
        brake_torque_nm=brake,
        rated_torque_nm=vessel.engine.rated_torque_nm,
    )


def _smooth(time_s: FloatArray, campaign: "Campaign") -> BoolArray:
    """Return which values lie inside sines and chirps of the campaign, shape (values,)."""
    inside = np.zeros(time_s.size, dtype=np.bool_)
    spans = [(sine.start_s, sine.stop_s) for sine in campaign.sines]
    spans += [(chirp.start_s, chirp.stop_s) for chirp in campaign.chirps]
    for start_s, stop_s in spans:
        inside |= (time_s >= start_s) & (time_s < stop_s)
    return frozen_bool(inside)


def _lost(time_s: FloatArray, signals: "Signals") -> BoolArray:
    """Return which values lie in a gap or so shortly behind it that the replay has not come back, shape (values,)."""
    lost = signals.coverage.lost(time_s)
    for gap in signals.gaps:
        lost |= (time_s >= gap.last_s) & (time_s < gap.last_s + _SETTLED_S)
    return lost


def _span(signals: "Signals", campaign: "Campaign") -> slice:
    """Return the samples from a little before the first test to a little after the last."""
    tests = campaign.excitations
    first_s, last_s = tests[0].start_s - _MARGIN_S, max(test.stop_s for test in tests) + _MARGIN_S
    first = max(round((first_s - signals.start_s) * signals.rate_hz), 0)
    last = min(round((last_s - signals.start_s) * signals.rate_hz), signals.samples)
    if last - first < _MARGIN_S * signals.rate_hz:
        raise SignalError(
            f"{signals.recording_name}: expected tests of campaign {campaign.name} between {first_s:g} and {last_s:g} "
            f"s, found signals from {signals.start_s:g} s on without them; check that both belong together."
        )
    return slice(first, last)


def _map_slopes(vessel: "Vessel", speed_rev_s: float, brake_nm: float) -> tuple[float, float]:
    """Return ``g`` and ``v`` of the map of the vessel file at the working point (thesis eq. 2.6)."""
    rack_map = vessel.engine.rack_map
    if rack_map is None:
        return 0.0, 1.0
    slope = rack_map.speed_slope_nm_per_rev_s * speed_rev_s
    return slope / brake_nm, (brake_nm - slope - rack_map.intercept_nm) / brake_nm
