"""Whether the channel of what was moved shows fast sines smaller than slow ones, held against the campaign file.

A low-pass, a moving average and a hold between what is asked for and what is logged make a sine smaller the faster it
is, by ``1 / sqrt(1 + (w T)^2)`` or ``sinc(f T)``. To second order both are ``1 - k w^2``, and late they are by
``sqrt(2 k)`` and ``sqrt(6 k)``. The scale of the channel is free: only how the sines differ tells of it.

A share ``a`` of another channel ``y`` on it, as where two cables lie together, makes a sine ``1 + a Re(y / u)`` times
as large, which follows the response of that channel and no filter.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import f_tail
from shaftprint.reasons import Reason
from shaftprint.units import MILLI, PERCENT

if TYPE_CHECKING:
    from shaftprint.signals._channel_signals import ExcitationSignal
    from shaftprint.spectra.lines._line_measurement import LineMeasurement

_FEWEST_LINES = 4
# What is late by less is told beside the delays, and no reason against them: generators step every 10 ms.
_LEAST_LATE_S = 0.008
# Sines of one size whose sizes differ by chance look filtered once in 10,000 tests; a filter explains nearly all of it.
_BY_CHANCE, _LEAST_EXPLAINED = 1e-4, 0.9
# From what changes nothing to what leaves no sine to be measured.
_LATE_S = np.geomspace(1e-4, 3.0, 400)
# A sine that is smaller is no sine of this campaign.
_UNEXCITED_SHARE = 0.1
_DEVIATIONS = 2.0
# A share of another channel that changes no sine by more is none that a fit would see.
_LEAST_SHARE = 0.003
# Generators and loggers keep a size to so much of it.
_LEAST_STD = 2e-4


@dataclass(frozen=True, kw_only=True, slots=True)
class InputBand:
    """What the sizes of the sines say of a filter or hold in the channel of what was moved."""

    late_s: float
    """By how much the filter that explains them best makes the channel late [s]; 0 where none is seen."""
    widest_s: float
    """By how much a hold or filter may make it late that the sines do not contradict [s]."""
    beside: str = ""
    """Symbol of another channel of which it shows a share; empty where it does not."""
    beside_share: float = 0.0
    """By how much that changes the sine that it changes most [-]."""


def band_of_lines(
    lines: "Sequence[LineMeasurement]", expected: FloatArray, moved: "ExcitationSignal"
) -> InputBand | None:
    """Return what the sizes of the lines of what was moved say; None of what the campaign does not tell the sizes of.

    The governor obeys messages as they came, and a machine reaches fast sines less.

    ``lines``: one entry a line. ``expected``: amplitude that the campaign asks for at each line, over the working
    point, shape (lines,). ``moved``: the signal that was moved.
    """
    if moved.is_obeyed or moved.is_reached:
        return None
    hertz = np.array([line.window.frequency_hz for line in lines])
    amplitude = np.array([line.excited for line in lines])
    noise = np.array(
        [float(line.noise.covariance[place, place].real) for line in lines for place in line.places(moved.name)]
    )
    gain = np.abs([moved.gain(frequency) for frequency in hertz.tolist()])
    tiny = np.finfo(np.float64).tiny
    answers = {
        name: np.array(
            [float((line.of(line.amplitude, name) / line.of(line.amplitude, moved.name)).real) for line in lines]
        )
        for name in (lines[0].channels if lines else ())
        if name != moved.name
    }
    share_std = np.sqrt(0.5 * noise) / np.maximum(amplitude, tiny)
    return input_band(hertz, amplitude / (gain * expected), share_std, answers=answers)


def input_band(
    frequency_hz: FloatArray,
    share: FloatArray,
    share_std: FloatArray,
    *,
    answers: Mapping[str, FloatArray] = MappingProxyType({}),
) -> InputBand | None:
    """Return what amplitudes say of a filter or hold; None where there are too few lines.

    ``frequency_hz``: frequency of each line [Hz], shape (lines,). ``share``, ``share_std``: amplitude over that of the
    campaign file, and its relative standard deviation by noise, shape (lines,). ``answers``: what other channels show
    in phase with it, over it, by their symbols, each of shape (lines,).
    """
    kept = share > _UNEXCITED_SHARE
    if np.count_nonzero(kept) < _FEWEST_LINES:
        return None
    omega, seen = 2.0 * np.pi * frequency_hz[kept], np.log(share[kept])
    weight = 1.0 / (share_std[kept] ** 2 + _LEAST_STD**2)
    weight /= weight.sum()
    late_of_shapes_s, shapes = _shapes(omega)
    left = _square(seen - shapes, weight)
    without, least, spare = float(_square(seen, weight)), float(left.min()), seen.size - 2
    late_s = float(late_of_shapes_s[int(np.argmin(left))])
    beside, sizes, of_beside = _beside(seen, weight, {name: values[kept] for name, values in answers.items()})
    if of_beside < least and _is_seen(without, of_beside, spare) and sizes > _LEAST_SHARE:
        return InputBand(late_s=0.0, widest_s=_widest_s(omega, seen, weight), beside=beside, beside_share=sizes)
    is_seen = late_s > _LEAST_LATE_S and _is_seen(without, least, spare)
    return InputBand(late_s=late_s if is_seen else 0.0, widest_s=_widest_s(omega, seen, weight))


def _is_seen(without: float, left: float, spare: int) -> bool:
    """Return whether a cause explains nearly all, and more than one does by chance."""
    fall = without - left
    return fall > _LEAST_EXPLAINED * without and bool(
        f_tail(fall / max(left, np.finfo(np.float64).tiny) * spare, 1.0, spare) < _BY_CHANCE
    )


def _beside(seen: FloatArray, weight: FloatArray, answers: Mapping[str, FloatArray]) -> tuple[str, float, float]:
    """Return the channel whose share explains the sines best, how much it changes one, and what it leaves."""
    found = ("", 0.0, np.inf)
    for name, values in answers.items():
        about = values - weight @ values
        power = float(weight @ about**2)
        share = float(weight @ (about * seen)) / power if power else 0.0
        left = _square(seen - share * values, weight)
        if left < found[2]:
            found = (name, float(np.max(np.abs(share * values))), float(left))
    return found


def band_reasons(band: InputBand | None, *, channel: str, symbol: str) -> tuple[Reason, ...]:
    """Return a reason where the channel of what was moved is behind a filter or hold, or shows another one too.

    ``band``: what the sizes of its sines say. ``channel``, ``symbol``: name of the channel, and what it shows.
    """
    if band is not None and band.beside:
        return (
            Reason(
                kind="set-point shape",
                where=symbol,
                sentence=(
                    f"Channel {channel} shows a share of another channel, {band.beside}: its sines differ from those "
                    f"of the campaign, by up to {PERCENT * band.beside_share:.2g} %, as that one answers them; look "
                    "for cross-talk between their cables or inputs, and log them apart."
                ),
            ),
        )
    if band is None or not band.late_s:
        return ()
    corner_hz = 1.0 / (2.0 * np.pi * band.late_s)
    return (
        Reason(
            kind="set-point band",
            where=symbol,
            sentence=(
                f"Channel {channel} shows sines the smaller the faster they are, as behind a low-pass of "
                f"{corner_hz:.2g} Hz or a mean or hold of {2.0 * band.late_s:.2g} s, which would make it "
                f"{MILLI * band.late_s:.0f} ms late: switch the filter of the logger off, log the set point where the "
                "governor takes it, or correct "
                "amplitude_v of the campaign file."
            ),
        ),
    )


def _shapes(omega: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return by how much low-passes and holds are late [s], and what they make of the logarithm of the sines."""
    # of a hold of a whole period nothing is left
    within = _LATE_S[omega.max() * _LATE_S < 0.9 * np.pi]
    low_passes = -0.5 * np.log1p((omega * _LATE_S[:, np.newaxis]) ** 2)
    holds = np.log(np.sinc(omega * within[:, np.newaxis] / np.pi))
    return np.concatenate([_LATE_S, within]), np.concatenate([low_passes, holds])


def _square(values: FloatArray, weight: FloatArray) -> FloatArray:
    """Return the weighted mean square about the weighted mean, along the last axis."""
    about = values - (values @ weight)[..., np.newaxis]
    return np.asarray(about**2 @ weight)


def _widest_s(omega: FloatArray, seen: FloatArray, weight: FloatArray) -> float:
    """Return by how much a hold may be late that the sines do not contradict, to second order [s]."""
    square = omega**2 - weight @ omega**2
    spread = float(weight @ square**2)
    fall = -float(weight @ (square * seen)) / spread
    left = seen - weight @ seen + fall * square
    # the lines scatter as they do, or as their noise says, whichever is more
    variance = float(weight @ left**2) / max(seen.size - 2, 1)
    std = (max(variance, _LEAST_STD**2 / seen.size) / spread) ** 0.5
    return float((6.0 * (max(fall, 0.0) + _DEVIATIONS * std)) ** 0.5)
