"""The delay of each step of the staircases: set point to speed, at the middle of the step (table 3.3).

It is a difference of level crossings: transport delay, rise of the loop and delay of the sensor
together.
"""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitations import Staircase
from shaftprint.reasons import Note
from shaftprint.signals._gaps import EVERYTHING, Coverage
from shaftprint.signals._signals import StepDelay

# The levels before and after are taken from the last third of their dwell.
_REST_SHARE = 1.0 / 3.0
_LEAST_STEP_V = 1e-6
# Noise crosses the middle of a step that is less than twice so many of its deviations high, before the step as after.
_CLEAR = 4.0


def find_step_delays(
    set_point_rev_s: FloatArray,
    speed_rev_s: FloatArray,
    campaign: Campaign,
    *,
    rate_hz: float,
    start_s: float,
    coverage: Coverage = EVERYTHING,
) -> tuple[tuple[StepDelay, ...], tuple[str, ...]]:
    """Return the delay of each step inside the staircases, and which steps were not found.

    ``set_point_rev_s``, ``speed_rev_s``: set point and speed [rev/s] on the grid, shape (samples,). ``campaign``: says
    where the staircases are. ``rate_hz``, ``start_s``: the grid. ``coverage``: says where the gaps are; steps that they
    touch are passed over. ``delays``: in order of time. ``findings``: one sentence for each step that could not be
    found.
    """
    delays: list[StepDelay] = []
    findings: list[str] = []
    hidden: dict[str, list[float]] = {}
    for staircase in campaign.staircases:
        levels = staircase.levels_v
        for k in range(1, len(levels)):
            if abs(levels[k] - levels[k - 1]) < _LEAST_STEP_V or coverage.missing(*step_window(staircase, k)):
                continue
            crossings = [_crossing(values, staircase, k, rate_hz, start_s) for values in (set_point_rev_s, speed_rev_s)]
            set_point_crossing, speed_crossing = crossings
            if set_point_crossing is None or speed_crossing is None:
                findings.append(
                    f"step {k} of {staircase.name} near {staircase.start_s + k * staircase.dwell_s:.0f}"
                    f" s: expected the {'set point' if set_point_crossing is None else 'speed'} to cross the middle "
                    "between its levels, found no crossing"
                )
                continue
            at_s, rising, _ = set_point_crossing
            speed_s, _, deviations = speed_crossing
            clear = deviations >= _CLEAR
            if not clear:
                hidden.setdefault(staircase.name, []).append(deviations)
            delays.append(
                StepDelay(
                    staircase=staircase.name,
                    set_point_time_s=at_s,
                    speed_time_s=speed_s if clear else None,
                    rising=rising,
                )
            )
    delays.sort(key=lambda delay: delay.set_point_time_s)
    findings += [
        Note(
            f"{name}: noise of the speed hides the delay of {len(heights)} of its steps: half of a step is "
            f"{min(heights):.1f} standard deviations of the noise, {_CLEAR:g} or more are needed"
        )
        for name, heights in hidden.items()
    ]
    return tuple(delays), tuple(findings)


def step_window(staircase: Staircase, step: int) -> tuple[float, float]:
    """Return the stretch that the delay of a step is found from [s]."""
    instant = staircase.start_s + step * staircase.dwell_s
    return instant - _REST_SHARE * staircase.dwell_s, instant + staircase.dwell_s


def _crossing(
    values: FloatArray, staircase: Staircase, step: int, rate_hz: float, start_s: float
) -> tuple[float, bool, float] | None:
    """Return when the values cross the middle between their levels before and after a step.

    Returned besides: whether upwards, and how far the middle is from the levels, in standard deviations about them.
    Nothing is returned where a crossing is not found, or the values do not show both levels.
    """
    dwell = staircase.dwell_s
    instant = staircase.start_s + step * dwell
    places = [
        round((instant + share * dwell - start_s) * rate_hz) for share in (-_REST_SHARE, 0.0, 1.0 - _REST_SHARE, 1.0)
    ]
    first, jump, settled, end = (min(max(index, 0), values.size) for index in places)
    # a little before the next step: the filter makes it visible ahead of time
    ahead = round(0.02 * dwell * rate_hz)
    if jump - ahead <= first or end - ahead <= settled:
        return None
    levels = values[first : jump - ahead], values[settled : end - ahead]
    before, after = (float(np.median(level)) for level in levels)
    rising = after > before
    middle = 0.5 * (before + after)
    part = values[first:settled]
    above = part >= middle if rising else part <= middle
    crossings = np.flatnonzero(above[1:] & ~above[:-1])
    if crossings.size == 0:
        return None
    k = int(crossings[0])
    fraction = (middle - part[k]) / (part[k + 1] - part[k])
    noise = max(float(level.std()) for level in levels)
    return start_s + (first + k + float(fraction)) / rate_hz, rising, abs(after - middle) / max(noise, 1e-12)
