"""The set point of a planned test as samples for a generator that holds each of them until the next."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.campaign._setpoint import setpoint
from shaftprint.choices import SET_POINT_RATE_HZ
from shaftprint.design.inputs._lever import Lever
from shaftprint.errors import DesignError

if TYPE_CHECKING:
    from shaftprint.design.planned_test._planned_test import PlannedTest

# So many samples a period of the fastest line: the steps then take 1.6 % of it, which the recorded voltage shows.
_FEWEST_A_PERIOD = 10.0
_MOST_SAMPLES = 50_000_000


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SetPointSamples:
    """Samples of the set point."""

    rate_hz: float
    """Samples a second [Hz]."""
    time_s: FloatArray
    """When each sample is put out [s], shape (samples,)."""
    volts: FloatArray
    """Its voltage [V], shape (samples,)."""
    speed_rpm: FloatArray
    """The engine speed that it asks for [rpm], shape (samples,)."""
    lever: Lever | None
    """What the lever shows for volts; None where it shows them."""


def set_point_samples(test: "PlannedTest", *, rate_hz: float = SET_POINT_RATE_HZ) -> SetPointSamples:
    """Return the set point for a generator with a zero-order hold.

    A held sample is late by half of its length on average (Franklin, Powell, Workman, Digital Control of Dynamic
    Systems, section 5.1); each is therefore the set point in the middle of the time for which it stands.

    ``test``: what is sailed. ``rate_hz``: samples a second [Hz]. Raises DesignError if the rate is too low for the
    fastest line, or gives more samples than a file holds.
    """
    fastest = max(float(leg.frequency_hz[-1]) for leg in test.plan.legs)
    campaign = test.campaign
    count = math.ceil(campaign.duration_s * rate_hz) if math.isfinite(rate_hz) else 0
    if rate_hz < _FEWEST_A_PERIOD * fastest or not 0 < count <= _MOST_SAMPLES:
        raise DesignError(
            f"set point at {rate_hz:g} Hz: expected at least {_FEWEST_A_PERIOD * fastest:.3g} Hz, ten samples a period "
            f"of the fastest line, and at most {_MOST_SAMPLES / campaign.duration_s:.3g} Hz; choose another rate."
        )
    time_s = np.arange(count) / rate_hz
    volts = setpoint(campaign, time_s + 0.5 / rate_hz)
    speed_rpm = test.line.speed_rpm(volts, working_point_rpm=test.plan.limits.engine_speed_rpm)
    return SetPointSamples(rate_hz=rate_hz, time_s=time_s, volts=volts, speed_rpm=speed_rpm, lever=test.line.lever)
