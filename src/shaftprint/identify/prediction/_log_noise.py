"""The noise of another log than the one whose noise is known: slower, or of another ship."""

from dataclasses import replace

import numpy as np

from shaftprint.errors import IdentificationError
from shaftprint.identify.prediction._noise_levels import NoiseLevels
from shaftprint.spectra import NOT_MEASURED_STD

SHIP_SPEED = "v_s"
"""Speed of the ship as its log shows it."""
LOG_RMS_M_S, LOG_CYCLE_S = 0.02, 0.2
"""Noise of one value of the log of the Stan Tug 1205 [m/s], and the time from one value to the next [s]."""
# So near to each other are the frequencies at which a log still shows something and no longer does.
_EDGE = 1e-3


def with_log(levels: NoiseLevels, *, cycle_s: float, highest_hz: float, ship_speed_m_s: float) -> NoiseLevels:
    """Return noise levels of the Stan Tug 1205 as a ship with a log of another cycle has them.

    White noise of single values spreads over fewer frequencies where values are fewer.

    Parameters
    ----------
    levels
        Levels with the log among the outputs.
    cycle_s
        Time from one value of the log to the next [s].
    highest_hz
        Frequency above which the log shows no line [Hz].
    ship_speed_m_s
        Mean speed of the ship [m/s].

    Raises
    ------
    IdentificationError
        If the levels have no log, or a number is not positive.
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
    density[:, place, place] += 2.0 * LOG_RMS_M_S**2 * max(cycle_s - LOG_CYCLE_S, 0.0) / ship_speed_m_s**2
    lost = frequency > (1.0 + 0.5 * _EDGE) * highest_hz
    density[lost, place, :] = density[lost, :, place] = 0.0
    density[lost, place, place] = NOT_MEASURED_STD**2
    return replace(levels, frequency_hz=frequency, density=density)
