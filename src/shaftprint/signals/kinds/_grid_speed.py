"""Speed of numbered pulses on the common grid, also where they come faster than its instants."""

import math

from shaftprint.arrays import FloatArray
from shaftprint.signals.conditioning._decimate import SampleGrid, decimated
from shaftprint.signals.pulses._speed import spline_speed, spline_speeds

# Pulses that come faster than this share of the rate of the grid are taken through a filter, as samples are; the spline
# is then read at so many instants a pulse.
_FAST_SHARE, _INSTANTS_A_PULSE = 0.5, 2
_BLOCK_INSTANTS = 262_144


def speed_on_grid(
    time_s: FloatArray, angle_rev: FloatArray, *, start_s: float, rate_hz: float, count: int, channel: str
) -> FloatArray:
    """Return the speed on the grid [rev/s]: by the spline itself, or through a filter where pulses come faster.

    Read at single instants, the spline of many teeth would show the errors of few edges, and fold what is faster than
    the grid.

    ``time_s``, ``angle_rev``: when pulses begin [s] and the angle of the shaft then [rev], shape (pulses,).
    ``start_s``, ``rate_hz``, ``count``: the grid. ``channel``: name of the channel, for messages.
    """
    pulse_rate_hz = (time_s.size - 1) / float(time_s[-1] - time_s[0])
    if pulse_rate_hz <= _FAST_SHARE * rate_hz:
        return spline_speed(time_s, angle_rev, start_s=start_s, step_s=1.0 / rate_hz, count=count)
    finer = math.ceil(_INSTANTS_A_PULSE * pulse_rate_hz / rate_hz)
    parts = spline_speeds(
        time_s,
        angle_rev,
        start_s=start_s,
        step_s=1.0 / (finer * rate_hz),
        count=finer * count,
        block=_BLOCK_INSTANTS,
    )
    return decimated(parts, SampleGrid(first=0.0, step=float(finer), count=count), channel=channel)
