"""The pitch of a controllable-pitch propeller: from its set point, or a combinator's lever, to piston and blades.

What is asked for acts a delay later. The piston follows in a lag of first order, ``tau dtheta/dt = theta_set - theta``
beyond a deadband, and no faster than its pumps allow; the blades follow the piston within its play. Nothing of it
depends on the shaft, so that it is known ahead of the line::

    M_p = K n_s |n_s| K_Q(theta) / K_Q(theta_0)
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._setpoint import setpoint
from shaftprint.errors import SettingsError
from shaftprint.kernels._compiled import compiled
from shaftprint.tug._pitch_actuation import PitchActuation, pitch_torque
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._demand import demanded_speed, helm_voltage
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel._vessel import Vessel

INPUT = "pitch_set_point"
_ROUNDING = 1e-9


class PitchMotion(NamedTuple):
    """What the pitch does at the nodes and middles of some steps, as deviations of ``P/D``, each (2 steps + 1,)."""

    piston: FloatArray
    """What the actuator has reached, which a feedback shows."""
    blades: FloatArray
    """What the water meets."""


@compiled(inline="always")
def _beyond(error, deadband):  # type: ignore[no-untyped-def]
    """Return what of an error lies beyond a deadband to either side."""
    return error - min(max(error, -deadband), deadband)


@compiled(nogil=True)
def lag(asked: FloatArray, last_asked, value, kept, ramp) -> None:  # type: ignore[no-untyped-def]
    """Write what a first-order lag makes of values that are joined by straight lines, in place."""
    for j in range(asked.size):
        now = asked[j]
        value = kept * value + (1.0 - kept) * last_asked + ramp * (now - last_asked)
        last_asked = now
        asked[j] = value


@compiled(nogil=True)
def _follow(asked, last_asked, piston, blades, kept, ramp, most, deadband, slack, moved):  # type: ignore[no-untyped-def]
    """Write what piston and blades make of values that are joined by straight lines, the piston in place."""
    for j in range(asked.size):
        now = asked[j]
        lacks, will_lack = _beyond(last_asked - piston, deadband), _beyond(now - piston, deadband)
        change = (1.0 - kept) * lacks + ramp * (will_lack - lacks)
        piston += min(max(change, -most), most)
        blades = min(max(blades, piston - slack), piston + slack)
        last_asked = now
        asked[j], moved[j] = piston, blades


class PitchActuator:
    """Stream of the pitch on half steps.

    A vessel whose pitch is not moved keeps it: all values are zero.
    """

    def __init__(self, tug: Tug, vessel: Vessel, campaign: Campaign, *, start_s: float, step_s: float) -> None:
        self._start_s = start_s
        self._half_step_s = 0.5 * step_s
        self._count = 0
        truth = actuation_of(tug)
        asked = asked_pitch(tug, vessel, campaign, start_s)
        if asked is not None and truth is None:
            raise SettingsError(
                f"campaign {campaign.name}: expected a vessel with a table [pitch], or a tug that sails free, where "
                "the pitch is moved, found a tug of fixed pitch; leave out the tests of the pitch."
            )
        self._piston = self._blades = self._before = 0.0
        self._torque = None if tug.pitch is None else pitch_torque(tug.pitch, vessel)
        self._moves = asked is not None
        if asked is None or truth is None:
            return
        self._asked, self._truth = asked, truth
        self._before = float(self._deviation(np.array([start_s]))[0])
        self._piston = self._blades = self._before
        if abs(self._piston) > _ROUNDING:
            rest = vessel.propeller.pitch_ratio if tug.sailing is None else tug.sailing.pitch_ratio
            raise SettingsError(
                f"campaign {campaign.name}: expected a pitch of {rest:g} at {start_s:g} s, that of the working "
                f"point, found {rest + self._piston:.6g}; change further_offsets_v.{INPUT}."
            )
        ratio = self._half_step_s / truth.lag_s
        self._kept = float(np.exp(-ratio))
        self._ramp = 1.0 - (1.0 - self._kept) / ratio

    def next(self, steps: int) -> PitchMotion:
        """Return the motion in the next steps."""
        if not self._moves:
            still = np.zeros(2 * steps + 1)
            return PitchMotion(piston=still, blades=still)
        piston, blades = np.empty((2, 2 * steps + 1))
        piston[0], blades[0] = self._piston, self._blades
        half_steps = np.arange(self._count + 1, self._count + 2 * steps + 1, dtype=np.float64)
        asked = self._deviation(self._start_s + self._half_step_s * half_steps)
        last, truth = float(asked[-1]), self._truth
        most, slack = truth.rate_per_s * self._half_step_s, 0.5 * truth.play
        of_servo = (self._kept, self._ramp, most, truth.deadband, slack)
        _follow(asked, self._before, self._piston, self._blades, *of_servo, blades[1:])
        piston[1:] = asked
        self._count += 2 * steps
        self._piston, self._blades, self._before = float(piston[-1]), float(blades[-1]), last
        return PitchMotion(piston=piston, blades=blades)

    def torque_share(self, blades: FloatArray, other: FloatArray) -> FloatArray:
        """Return the deviation of the propeller's torque that pitch and another cause make together, at nodes.

        Underway the curves of the propeller hold the pitch themselves, and a pitch that stands changes nothing: the
        other cause is returned as it is.

        ``blades``: deviation of ``P/D`` at nodes and middles, shape (2 steps + 1,). ``other``: deviation that
        disturbances make, over the torque, shape (steps + 1,).
        """
        if not self._moves or self._torque is None:
            return other
        return (1.0 + other) * np.polynomial.polynomial.polyval(blades[::2], self._torque) - 1.0

    def _deviation(self, time_s: FloatArray) -> FloatArray:
        """Return what is asked for at the actuator, after its delay."""
        deviation: FloatArray = self._truth.set_point_scale * self._asked(time_s - self._truth.delay_s)
        return deviation


def asked_pitch(
    tug: Tug, vessel: Vessel, campaign: Campaign, start_s: float
) -> Callable[[FloatArray], FloatArray] | None:
    """Return what the pitch is asked for over times [s], as deviation of ``P/D`` from that of the working point.

    By its own set point where the campaign moves it, by the lever of the speed where there is a combinator; None where
    nothing moves the pitch.

    Raises SettingsError if the campaign moves a pitch that the vessel has no set point of.
    """
    combinator = vessel.combinator
    if combinator is not None:
        rest = float(combinator.combined_ratio(_lever_rpm(tug, vessel, campaign, np.array([start_s])))[0])
        return lambda time_s: combinator.combined_ratio(_lever_rpm(tug, vessel, campaign, time_s)) - rest
    if INPUT not in campaign.inputs:
        return None
    sensor = vessel.sensors.pitch_set_point
    if sensor is None:
        raise SettingsError(
            f"campaign {campaign.name}: expected a vessel with [sensors.{INPUT}] where the pitch is moved, found none; "
            "leave out the tests of the pitch."
        )
    from_rest = sensor.pitch_ratio_at_zero_v - (
        vessel.propeller.pitch_ratio if tug.sailing is None else tug.sailing.pitch_ratio
    )
    return lambda time_s: from_rest + sensor.pitch_ratio_per_v * setpoint(campaign, time_s, input=INPUT)


def _lever_rpm(tug: Tug, vessel: Vessel, campaign: Campaign, time_s: FloatArray) -> FloatArray:
    """Return the speed of the engine that the lever asks for [rpm]."""
    return rpm_from_rev_s(demanded_speed(tug, vessel, helm_voltage(tug, campaign, time_s)))


def actuation_of(tug: Tug) -> PitchActuation | None:
    """Return how the pitch of a tug follows: at the quay as its truth says, underway by its lag alone; None: fixed."""
    if tug.sailing is None:
        return tug.pitch
    return PitchActuation(lag_s=tug.sailing.pitch_lag_s, delay_s=0.0, rate_per_s=np.inf)
