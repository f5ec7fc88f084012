"""The set-point voltage over time."""

import math
from typing import assert_never

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray
from shaftprint.campaign._binary_sequence import BinarySequence
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitation import Excitation
from shaftprint.campaign._excitations import SPEED_SET_POINT, Chirp, Sine, Staircase
from shaftprint.campaign._lever_course import LeverCourse
from shaftprint.campaign._multisine import Multisine
from shaftprint.errors import SettingsError


@refusing_none(SettingsError)
def setpoint(campaign: Campaign, time_s: ArrayLike, *, input: str = SPEED_SET_POINT) -> FloatArray:
    """Return the set point of a campaign at given times.

    A value depends on its own time only, so a long recording may be rendered in chunks of any size.

    Parameters
    ----------
    campaign
        What is asked of the ship.
    time_s
        Times since the start of the recording [s], any shape, in any order.
    input
        What is moved: a table of the vessel file's sensors.

    Returns
    -------
    voltage
        Set point [V], shape of ``time_s``; outside of every excitation the offset, or the ramp to a leg and back.
    """
    time = np.asarray(time_s, dtype=np.float64)
    offset_v = campaign.middle_v(input)
    voltage = np.full(time.shape, offset_v)
    if time.size == 0:
        return voltage
    if isinstance(campaign, LeverCourse) and input == SPEED_SET_POINT:
        return campaign.voltage(time)
    first, last = float(time.min()), float(time.max())
    for move in campaign.moves if input == SPEED_SET_POINT else ():
        inside = (time >= move.free_s[0]) & (time < move.free_s[1])
        voltage[inside] = move.value_at(time[inside])
    for excitation in campaign.of_input(input).excitations:
        if excitation.start_s <= last and first < excitation.stop_s:
            inside = (time >= excitation.start_s) & (time < excitation.stop_s)
            voltage[inside] = _voltage(excitation, time[inside], offset_v)
    return voltage


def _voltage(excitation: Excitation, time_s: FloatArray, offset_v: float) -> FloatArray:
    elapsed_s = time_s - excitation.start_s
    match excitation:
        case Sine():
            turns = excitation.frequency_hz * elapsed_s
            return offset_v + excitation.amplitude_v * np.sin(2.0 * math.pi * turns + excitation.phase_rad)
        case Multisine() | BinarySequence():
            return excitation.value_at(time_s)
        case Chirp():
            phase = _linear_phase if excitation.sweep == "linear" else _chirp_phase
            return offset_v + excitation.amplitude_v * np.sin(phase(excitation, elapsed_s) + excitation.phase_rad)
        case Staircase():
            step = np.floor(elapsed_s / excitation.dwell_s).astype(np.intp)
            # the quotient may round up to the number of levels just before the end
            step = np.minimum(step, len(excitation.levels_v) - 1)
            return np.asarray(excitation.levels_v)[step]
        case _:
            assert_never(excitation)


def _chirp_phase(chirp: Chirp, elapsed_s: FloatArray) -> FloatArray:
    """Return the phase since the start [rad] of a logarithmic sweep: the integral of ``2 pi f_0 k^(t/T)``.

    ``2 pi f_0 T / ln(k) (k^(t/T) - 1)`` with ``k = f_1 / f_0``, as in the logarithmic method of
    ``scipy.signal.chirp``.
    """
    duration = chirp.stop_s - chirp.start_s
    log_ratio = math.log(chirp.stop_frequency_hz / chirp.start_frequency_hz)
    scale = 2.0 * math.pi * chirp.start_frequency_hz * duration / log_ratio
    return scale * np.expm1(log_ratio * elapsed_s / duration)


def _linear_phase(chirp: Chirp, elapsed_s: FloatArray) -> FloatArray:
    """Return the phase since the start [rad] of a linear sweep: the integral of ``2 pi (f_0 + (f_1 - f_0) t / T)``."""
    rate_hz_per_s = (chirp.stop_frequency_hz - chirp.start_frequency_hz) / (chirp.stop_s - chirp.start_s)
    return 2.0 * math.pi * (chirp.start_frequency_hz + 0.5 * rate_hz_per_s * elapsed_s) * elapsed_s
