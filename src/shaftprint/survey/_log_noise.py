"""The noise of another log than the one whose noise is known: slower, or of another ship."""

from dataclasses import replace

import numpy as np

from shaftprint.errors import IdentificationError
from shaftprint.identify.prediction._noise_levels import NoiseLevels
from shaftprint.spectra._line_responses import NOT_MEASURED_STD

SHIP_SPEED, TORQUE = "v_s", "M_s"
"""Speed of the ship as its log shows it, and torque at the gauge."""
LOG_CYCLE_S, LOG_SPEED_M_S = 0.2, 4.75
"""Time between values of the log of the Stan Tug 1205 [s], and the speed that it shows [m/s]."""
# Faster than this no ship moves.
_SHIP_STANDS_HZ = 0.5
# So near to each other are the frequencies at which a log still shows something and no longer does.
_EDGE = 1e-3


def with_log(levels: NoiseLevels, *, cycle_s: float, highest_hz: float, ship_speed_m_s: float) -> NoiseLevels:
    """Return noise levels of the Stan Tug 1205 as a ship of another speed with a log of another cycle has them.

    White noise of single values spreads over fewer frequencies where values are fewer, and is less of a higher speed.

    ``levels``: levels with the log among the outputs. ``cycle_s``: time from one value of the log to the next [s].
    ``highest_hz``: frequency above which the log shows no line [Hz]. ``ship_speed_m_s``: mean speed of the ship [m/s].
    Raises IdentificationError if the levels have no log, or a number is not positive.
    """
    if SHIP_SPEED not in levels.outputs or not min(cycle_s, highest_hz, ship_speed_m_s) > 0.0:
        raise IdentificationError(
            f"noise of a log: expected {SHIP_SPEED} among the outputs and positive numbers, found "
            f"{', '.join(levels.outputs)}, {cycle_s:g} s, {highest_hz:g} Hz and {ship_speed_m_s:g} m/s."
        )
    place, stated = levels.outputs.index(SHIP_SPEED), levels.frequency_hz
    edges = [one for one in (highest_hz, (1.0 + _EDGE) * highest_hz) if stated[0] < one < stated[-1]]
    frequency = np.union1d(stated, edges)
    density = levels.at(frequency)
    # a log of values closer together than the tug's has, as far as is known, no less noise
    times = max(cycle_s, LOG_CYCLE_S) / LOG_CYCLE_S * (LOG_SPEED_M_S / ship_speed_m_s) ** 2
    # what the torque has no part in is noise of single values, but slowly, where it is the ship that moves
    torque = levels.outputs.index(TORQUE)
    moved = np.abs(density[:, place, torque]) ** 2 / density[:, torque, torque].real
    alone = density[:, place, place].real - moved
    density[:, place, place] += (times - 1.0) * np.minimum(alone, alone[frequency > _SHIP_STANDS_HZ].max())
    lost = frequency > (1.0 + 0.5 * _EDGE) * highest_hz
    density[lost, place, :] = density[lost, :, place] = 0.0
    density[lost, place, place] = NOT_MEASURED_STD**2
    return replace(levels, frequency_hz=frequency, density=density)
