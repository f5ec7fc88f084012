"""On which clock the sines of what was moved came, by their phases against the campaign file.

Every sine says when it began, to a thousandth of its period. Where all began when the campaign says, but for one shift
and one drift, the drift is known to a millionth: it is the clock of whoever put them out, or of the channel. So is a
jump of all that come after one instant, where samples were lost or the sines were halted. Sines that were begun by hand
say nothing.
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
# A jump below it moves no number by more than its deviation [s]; one that is believed is so many deviations large.
_LEAST_JUMP_S, _JUMP_DEVIATIONS = 0.005, 5.0
_FEWEST_OF_JUMP = 6


def drift_of_input(
    lines: "Sequence[LineMeasurement]", sines: "Sequence[Sine]", moved: "ExcitationSignal"
) -> float | None:
    """Return the time that the sines lose a second against the campaign file [-]; None where they do not tell.

    ``lines``: one entry a line. ``sines``: the sines of the campaign. ``moved``: the signal that was moved.
    """
    return drift_of_phases(*_phases(sorted(lines, key=lambda line: line.window.frequency_hz), sines, moved))


def jump_of_input(lines: "Sequence[LineMeasurement]", sines: "Sequence[Sine]", moved: "ExcitationSignal") -> FloatArray:
    """Return by how much later each line came than the first, where all after one instant did; empty where none did.

    ``lines``: one entry a line. ``sines``: the sines of the campaign. ``moved``: the signal that was moved.
    """
    order = sorted(range(len(lines)), key=lambda place: lines[place].window.frequency_hz)
    jump_s = jump_of_phases(*_phases([lines[place] for place in order], sines, moved))
    return jump_s[np.argsort(order)] if jump_s.size else jump_s


def _phases(
    order: "Sequence[LineMeasurement]", sines: "Sequence[Sine]", moved: "ExcitationSignal"
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return frequency, turn behind the campaign file, its deviation and the middle of lines, each shape (lines,)."""
    asked = {sine.name: sine for sine in sines}
    omega = np.array([2.0 * np.pi * line.window.frequency_hz for line in order])
    turn = np.array([_turn(line, asked[line.window.line], np.sign(moved.per_volt)) for line in order])
    place = order[0].places(moved.name)[0]
    noise = np.array([line.noise.covariance[place, place].real / line.excited**2 for line in order])
    middle_s = np.array([0.5 * (line.window.start_s + line.window.stop_s) for line in order])
    return omega, turn, np.sqrt(0.5 * noise), middle_s


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
    late_s, weight = _late(omega_rad_s, turn_rad, std_rad)
    table = np.stack([np.ones_like(middle_s), middle_s - middle_s.mean()])
    normal = np.linalg.inv((table * weight) @ table.T)
    shift_s, drift = normal @ (table * weight) @ late_s
    left_s = late_s - shift_s - drift * table[1]
    chi_square = float(weight @ left_s**2) / (omega_rad_s.size - 2)
    std = float(np.sqrt(normal[1, 1] * max(chi_square, 1.0)))
    scatter_s = float(np.sqrt(weight @ left_s**2 / weight.sum()))
    return float(drift) if std < _LARGEST_STD and scatter_s < _LARGEST_SCATTER_S else None


def jump_of_phases(
    omega_rad_s: FloatArray, turn_rad: FloatArray, std_rad: FloatArray, middle_s: FloatArray
) -> FloatArray:
    """Return by how much later each line came than the first [s], shape (lines,); empty where no one jump explains it.

    Before an instant all lines are at one shift, behind it at another, but for the line during which it was; arguments
    as of `drift_of_phases`.
    """
    none = np.empty(0)
    if omega_rad_s.size < _FEWEST_OF_JUMP:
        return none
    late_s, weight = _late(omega_rad_s, turn_rad, std_rad)
    best, found = np.inf, none
    for during in np.argsort(middle_s)[1:-1].tolist():
        after = (middle_s > middle_s[during]).astype(np.float64)
        rest = np.where(np.arange(after.size) == during, 0.0, weight)
        table = np.stack([np.ones_like(after), after])
        normal = np.linalg.inv((table * rest) @ table.T)
        shift_s, jump_s = normal @ (table * rest) @ late_s
        chi_square = float(rest @ (late_s - shift_s - jump_s * after) ** 2) / (after.size - 3)
        large = abs(jump_s) > max(_LEAST_JUMP_S, _JUMP_DEVIATIONS * np.sqrt(normal[1, 1] * max(chi_square, 1.0)))
        if chi_square < best:
            # the line during which it was is late by a part of it
            after[during] = np.clip((late_s[during] - shift_s) / jump_s, 0.0, 1.0) if large else 0.0
            best, found = chi_square, jump_s * after if large else none
    return found


def _late(omega_rad_s: FloatArray, turn_rad: FloatArray, std_rad: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return by how much each line is late [s], and its weight [1/s2]; arguments as of `drift_of_phases`."""
    late_s = np.empty(omega_rad_s.size)
    weight = omega_rad_s**2 / (std_rad**2 + _LEAST_RAD**2)
    for k, (omega, turn) in enumerate(zip(omega_rad_s.tolist(), turn_rad.tolist(), strict=True)):
        # the slow ones say how many turns a faster one is late
        so_far = float(weight[:k] @ late_s[:k] / weight[:k].sum()) if k else 0.0
        late_s[k] = (turn + 2.0 * np.pi * np.round((omega * so_far - turn) / (2.0 * np.pi))) / omega
    return late_s, weight


def _turn(line: "LineMeasurement", sine: "Sine", sign: float) -> float:
    """Return by how much of a turn a line is behind its sine in the campaign file [rad]."""
    asked = 2.0 * np.pi * sine.frequency_hz * (line.window.start_s - sine.start_s) + sine.phase_rad - 0.5 * np.pi
    return asked - float(np.angle(sign * line.of(line.amplitude, line.excitation)))
