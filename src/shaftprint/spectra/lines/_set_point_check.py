"""Whether the set point of a line is what the campaign says, and a clean sine."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.errors import ResponseError
from shaftprint.reasons import Reason
from shaftprint.spectra.lines._stretches import stretch_periods

if TYPE_CHECKING:
    from shaftprint.signals._channel_signals import ExcitationSignal
    from shaftprint.spectra.lines._line_measurement import LineMeasurement

_UNEXCITED_SHARE = 0.1
_AMPLITUDE_TOLERANCE = 0.1
_FREQUENCY_TOLERANCE_BINS = 0.05
_FREQUENCY_LIMIT_BINS = 0.5
_STRETCH_TOLERANCE = 0.25
_STRETCH_LIMIT = 0.5
_CLEAN_DB = 40.0
_NEIGHBOUR_GAP_DB = 20.0
# Held steps and quantisation of a set point stay far below this.
_HARMONIC_LIMIT = 0.03
_HZ_PER_RAD_S = 1.0 / (2.0 * np.pi)


@dataclass(frozen=True, kw_only=True, slots=True)
class SetPointFinding:
    """What is wrong with the set point of one line."""

    remarks: tuple[str, ...]
    """What was found; empty where all is well."""
    usable: bool
    """Whether a response can still be measured with it."""


def check_frequency_unit(measurements: Sequence["LineMeasurement"]) -> None:
    """Refuse a campaign whose frequencies are not those of the recording.

    ``measurements``: one entry a line. Raises ResponseError if the set point moves at ``1 / (2 pi)`` of the stated
    frequency in more than half of the windows, or at none of the stated frequencies.
    """
    ratio = np.array([line.excitation_frequency_hz / line.window.frequency_hz for line in measurements])
    angular = np.abs(ratio / _HZ_PER_RAD_S - 1.0) < 0.05
    if 2 * np.count_nonzero(angular) > ratio.size:
        worst = measurements[int(np.argmax(angular))]
        raise ResponseError(
            f"{worst.window.line}: expected the set point to move at "
            f"{worst.window.frequency_hz:g} Hz, found {worst.excitation_frequency_hz:.3g} Hz, "
            f"1/(2 pi) of it, likewise in {np.count_nonzero(angular)} of {ratio.size} sines: the "
            "campaign's frequency_hz seems to be in rad/s; divide it by 2 pi."
        )
    if not np.any(ratio == 1.0):
        first = measurements[0]
        motion = (
            "a set point that does not move" if np.all(np.isnan(ratio)) else f"{first.excitation_frequency_hz:.3g} Hz"
        )
        raise ResponseError(
            f"{first.window.line}: expected the set point to move at {first.window.frequency_hz:g} "
            f"Hz between {first.window.start_s:g} and {first.window.stop_s:g} s, found {motion}, and "
            "no other sine of the campaign is in the recording either: check that campaign and "
            "recording belong together and that the set-point channel is the right one."
        )


def check_set_point(
    line: "LineMeasurement", *, expected: float, local_db: FloatArray, place: int, moved: "ExcitationSignal"
) -> SetPointFinding:
    """Compare the set point of one line with the campaign and with its neighbours.

    ``expected``: amplitude that the campaign asks for, over the working point. ``local_db``: local signal-to-noise
    ratio of the set point of all lines [dB], shape (lines,). ``place``: place of this line among them. ``moved``: the
    signal that was moved, for messages. Returns remarks, and whether the line can be used.
    """
    amplitude = line.excited
    if line.excitation_frequency_hz != line.window.frequency_hz:
        return SetPointFinding(remarks=(_wrong_sine(line, amplitude, expected, moved),), usable=False)
    if amplitude < _UNEXCITED_SHARE * expected:
        return SetPointFinding(remarks=(amplitude_remark(amplitude, expected, moved),), usable=False)
    disturbed = line.disturbed_stretches(_STRETCH_TOLERANCE)
    if np.any(disturbed):
        usable = bool(disturbed.mean() < _STRETCH_LIMIT)
        return SetPointFinding(remarks=(_stretch_remark(line, disturbed),), usable=usable)
    remarks = []
    if abs(amplitude - expected) > _AMPLITUDE_TOLERANCE * expected:
        remarks.append(amplitude_remark(amplitude, expected, moved))
    offset_hz = _frequency_offset_hz(line)
    offset_bins = abs(offset_hz) * line.window.duration_s
    typical_db = _typical_db(local_db, place)
    if offset_bins > _FREQUENCY_TOLERANCE_BINS:
        hz = line.window.frequency_hz
        # as many decimals as the difference needs to be seen
        decimals = max(0, 1 + math.floor(-math.log10(abs(offset_hz))))
        remarks.append(f"set point runs at {hz + offset_hz:.{decimals}f} Hz where the campaign says {hz:g} Hz")
    elif local_db[place] < min(_CLEAN_DB, typical_db - _NEIGHBOUR_GAP_DB):
        remarks.append(
            f"set point is not a clean sine: signal-to-noise {local_db[place]:.1f} dB where the "
            f"lines beside it have {typical_db:.1f} dB"
        )
    return SetPointFinding(remarks=tuple(remarks), usable=offset_bins < _FREQUENCY_LIMIT_BINS)


def shape_reasons(lines: Sequence["LineMeasurement"]) -> tuple[Reason, ...]:
    """Return a reason where the recorded set point is no sine: it was cut off, or another one was asked for.

    ``lines``: one entry a line.
    """
    bent = [line for line in lines if _harmonic_share(line) > _HARMONIC_LIMIT]
    if not bent:
        return ()
    worst = max(bent, key=_harmonic_share)
    share = f"{100.0 * _harmonic_share(worst):.1f} % of it at {worst.window.line}"
    return (
        Reason(
            kind="set-point shape",
            where=worst.window.line,
            sentence=(
                f"The set point is no sine as the campaign asks: its harmonics are {share}, and too much at "
                f"{len(bent)} lines; check whether its channel is cut off at a highest or lowest value."
            ),
        ),
    )


def _harmonic_share(line: "LineMeasurement") -> float:
    """Return the size of harmonics 2 and 3 of the set point over its sine; 0 where they were not fitted."""
    size = float(np.sqrt(np.nansum(np.abs(line.of(line.harmonic, line.excitation)) ** 2)))
    return size / max(line.excited, np.finfo(np.float64).tiny)


def _wrong_sine(line: "LineMeasurement", found: float, expected: float, moved: "ExcitationSignal") -> str:
    hz = line.excitation_frequency_hz
    if not _moves(line, expected):
        return amplitude_remark(found, expected, moved)
    if not abs(hz / line.window.frequency_hz - 1.0) * line.window.periods >= 1.0:
        share = line.of(line.variances.signal, line.excitation) / line.of(line.variances.overall, line.excitation)
        return f"set point is not a clean sine: the line is {100.0 * share:.0f} % of its variance"
    return f"set point moves at {hz:.3g} Hz where the campaign says {line.window.frequency_hz:g} Hz"


def _moves(line: "LineMeasurement", expected: float) -> bool:
    """Whether the set point moves at all as much as a sine of the expected amplitude would make it."""
    return bool(line.of(line.variances.overall, line.excitation) > (_UNEXCITED_SHARE * expected) ** 2 / 2.0)


def amplitude_remark(found: float, expected: float, moved: "ExcitationSignal") -> str:
    """Say what amplitude the set point has.

    ``found``, ``expected``: amplitudes over the working point. ``moved``: the signal that was moved.
    """
    unit, size = moved.shown_unit, moved.shown_reference
    return (
        f"{moved.words} has an amplitude of {found * size:.3g} {unit} where the campaign asks for "
        f"{expected * size:.3g} {unit}"
    )


def _stretch_s(line: "LineMeasurement") -> float:
    return stretch_periods(line.window.periods) / line.window.frequency_hz


def _frequency_offset_hz(line: "LineMeasurement") -> float:
    """Difference between true and stated frequency, from the turning of the phase over the window."""
    turn = np.unwrap(np.angle(line.excited_stretches / line.of(line.amplitude, line.excitation)))
    centred = np.arange(turn.size) - 0.5 * (turn.size - 1)
    slope_rad = float((centred @ turn) / (centred @ centred))
    return slope_rad / (2.0 * np.pi * _stretch_s(line))


def _stretch_remark(line: "LineMeasurement", disturbed: BoolArray) -> str:
    length_s = _stretch_s(line)
    indices = np.flatnonzero(disturbed)
    first_s = line.window.start_s + length_s * indices[0]
    last_s = line.window.start_s + length_s * (indices[-1] + 1)
    return (
        f"set-point sine is disturbed in {indices.size} of {disturbed.size} parts of the window, "
        f"between {first_s:.1f} and {last_s:.1f} s"
    )


def _typical_db(local_db: FloatArray, place: int) -> float:
    """Median of up to two lines on each side; the line's own where it has no neighbour."""
    neighbours = np.delete(local_db, place)[max(place - 2, 0) : place + 2]
    return float(np.median(neighbours)) if neighbours.size else float(local_db[place])
