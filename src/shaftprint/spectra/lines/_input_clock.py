"""On which clock the sines of what was moved came, by their phases against the campaign file.

Every sine says when it began, to a thousandth of its period. Where all began when the campaign says, but for one shift
and one drift, the drift is known to a millionth: it is the clock of whoever put them out, or of the channel. Sines that
were begun by hand say nothing.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray

if TYPE_CHECKING:
    from shaftprint.campaign._excitations import Sine
    from shaftprint.signals._channel_signals import ExcitationSignal
    from shaftprint.spectra.lines._line_measurement import LineMeasurement

_FEWEST_LINES = 4
# What is left of a phase whatever the noise is [rad], and the largest error with which a drift is still told [-].
_LEAST_RAD, _LARGEST_STD = 5e-4, 3e-6
# Sines that were begun by hand are not so near to one shift [s].
_LARGEST_SCATTER_S = 0.005


def drift_of_input(
    lines: "Sequence[LineMeasurement]", sines: "Sequence[Sine]", moved: "ExcitationSignal"
) -> float | None:
    """Return the time that the sines lose a second against the campaign file [-]; None where they do not tell.

    ``lines``: one entry a line. ``sines``: the sines of the campaign. ``moved``: the signal that was moved.
    """
    asked = {sine.name: sine for sine in sines}
    order = sorted(lines, key=lambda line: line.window.frequency_hz)
    omega = np.array([2.0 * np.pi * line.window.frequency_hz for line in order])
    turn = np.array([_turn(line, asked[line.window.line], np.sign(moved.per_volt)) for line in order])
    place = order[0].places(moved.name)[0]
    noise = np.array([line.noise.covariance[place, place].real / line.excited**2 for line in order])
    middle_s = np.array([0.5 * (line.window.start_s + line.window.stop_s) for line in order])
    return drift_of_phases(omega, turn, np.sqrt(0.5 * noise), middle_s)


def drift_of_phases(
    omega_rad_s: FloatArray, turn_rad: FloatArray, std_rad: FloatArray, middle_s: FloatArray
) -> float | None:
    """Return the drift [-] of sines that are late by so many radians; None where they do not tell.

    ``omega_rad_s``: angular frequency of each line, ascending [rad/s], shape (lines,). ``turn_rad``, ``std_rad``: phase
    by which it is late, to whole turns, and its standard deviation by noise [rad], shape (lines,). ``middle_s``: middle
    of its window [s], shape (lines,).
    """
    if omega_rad_s.size < _FEWEST_LINES:
        return None
    late_s = np.empty(omega_rad_s.size)
    weight = omega_rad_s**2 / (std_rad**2 + _LEAST_RAD**2)
    for k, (omega, turn) in enumerate(zip(omega_rad_s.tolist(), turn_rad.tolist(), strict=True)):
        # the slow ones say how many turns a faster one is late
        so_far = float(weight[:k] @ late_s[:k] / weight[:k].sum()) if k else 0.0
        late_s[k] = (turn + 2.0 * np.pi * np.round((omega * so_far - turn) / (2.0 * np.pi))) / omega
    table = np.stack([np.ones_like(middle_s), middle_s - middle_s.mean()])
    normal = np.linalg.inv((table * weight) @ table.T)
    shift_s, drift = normal @ (table * weight) @ late_s
    left_s = late_s - shift_s - drift * table[1]
    chi_square = float(weight @ left_s**2) / (omega_rad_s.size - 2)
    std = float(np.sqrt(normal[1, 1] * max(chi_square, 1.0)))
    scatter_s = float(np.sqrt(weight @ left_s**2 / weight.sum()))
    return float(drift) if std < _LARGEST_STD and scatter_s < _LARGEST_SCATTER_S else None


def _turn(line: "LineMeasurement", sine: "Sine", sign: float) -> float:
    """Return by how much of a turn a line is behind its sine in the campaign file [rad]."""
    asked = 2.0 * np.pi * sine.frequency_hz * (line.window.start_s - sine.start_s) + sine.phase_rad - 0.5 * np.pi
    return asked - float(np.angle(sign * line.of(line.amplitude, line.excitation)))
