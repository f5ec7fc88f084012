"""The whole periods of a leg in every channel, over the working point of the leg.

The generator that puts out the set point has a clock of its own. A period that is off by 50 ppm turns a line of 2.5 Hz
by 0.2 rad within five minutes, and what turns leaks between the lines, where the noise is looked for. The period is
therefore measured in the set point itself, and where it is not a whole number of samples the channels are put on a grid
on which it is.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray, frozen_float

if TYPE_CHECKING:
    from shaftprint.signals._working_points import LegState

# Periods together may miss whole samples by this: the fastest lines then turn by less than 1e-3 rad.
_SAME_SAMPLES = 1e-3
# Points of the polynomial through neighbouring samples: it shows a sine of a tenth of the rate to 1e-4.
_POINTS = 8


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LegWindow:
    """Whole periods of a leg, each of a whole number of samples."""

    state: "LegState"
    """Name, begin, length and number of the periods, as they are in the recording, and the working point."""
    clock_ratio: float
    """Length of a period over that of the campaign, minus 1."""
    channels: tuple[str, ...]
    """Names of the channels."""
    values: FloatArray
    """Values over the working point of the leg, shape (channels, periods, samples a period)."""

    def of(self, channel: str) -> FloatArray:
        """Return the values of one channel, shape (periods, samples a period)."""
        values: FloatArray = self.values[self.channels.index(channel)]
        return values

    def spectrum(self) -> ComplexArray:
        """Return complex amplitudes ``2 / N sum x exp(-j w t)`` of all periods together, shape (channels, bins).

        Bin ``k P`` is harmonic ``k``; the bins between hold what differs between the ``P`` periods.
        """
        flat = self.values.reshape(len(self.channels), -1)
        spectrum: ComplexArray = np.fft.rfft(flat, axis=1) * (2.0 / flat.shape[1])
        return spectrum

    def by_period(self) -> ComplexArray:
        """Return complex amplitudes of each harmonic in each period, shape (channels, periods, harmonics)."""
        spectrum: ComplexArray = np.fft.rfft(self.values, axis=2) * (2.0 / self.values.shape[2])
        return spectrum


def cut_leg(
    channels: Mapping[str, FloatArray],
    references: Mapping[str, float],
    state: "LegState",
    harmonics: Sequence[int],
    *,
    excitation: str,
    rate_hz: float,
    start_s: float,
) -> LegWindow:
    """Cut a leg out of whole channels, with the period that the set point really has.

    ``channels``: channels on one grid by name, each of shape (samples,). ``references``: value of each at the working
    point of the leg. ``state``: which part of the recording, with the period of the campaign. ``harmonics``: lines of
    the leg. ``excitation``: name of the channel that is moved. ``rate_hz``, ``start_s``: the grid.
    """
    moved = _cut({excitation: channels[excitation]}, references, state, rate_hz=rate_hz, start_s=start_s)
    ratio = _clock_ratio(moved.by_period()[0][:, list(harmonics)], harmonics)
    measured = replace(state, period_s=state.period_s * (1.0 + ratio))
    # the last period must still be inside
    longest = (start_s + channels[excitation].size / rate_hz - measured.start_s) / measured.period_s
    measured = replace(measured, periods=min(measured.periods, int(np.floor(longest + _SAME_SAMPLES))))
    window = _cut(channels, references, measured, rate_hz=rate_hz, start_s=start_s)
    return replace(window, clock_ratio=ratio)


def _clock_ratio(amplitude: ComplexArray, harmonics: Sequence[int]) -> float:
    """Return by how much a period is longer than was cut, as a share, from the turning of the lines.

    A line of harmonic ``k`` turns by ``-2 pi k`` of that share from one period to the next. Weighted by the power of
    the lines, which is what their phases are known by.

    ``amplitude``: complex amplitudes of the set point, shape (periods, lines). ``harmonics``: the lines.
    """
    turn = np.unwrap(np.angle(amplitude * amplitude.mean(axis=0).conj()), axis=0)
    centred = np.arange(len(turn)) - 0.5 * (len(turn) - 1)
    slope = centred @ turn / (centred @ centred)
    order = np.asarray(harmonics, dtype=np.float64)
    weight = np.mean(np.abs(amplitude) ** 2, axis=0)
    power = float(weight @ order**2)
    return -float((weight * order) @ slope) / (2.0 * np.pi * power) if power else 0.0


def _cut(
    channels: Mapping[str, FloatArray],
    references: Mapping[str, float],
    state: "LegState",
    *,
    rate_hz: float,
    start_s: float,
) -> LegWindow:
    """Return the channels in whole periods of so many samples each, over their values at the working point."""
    exact = state.period_s * rate_hz
    length = round(exact)
    count = length * state.periods
    first = max(round((state.start_s - start_s) * rate_hz), 0)
    is_whole = abs(exact - length) * state.periods < _SAME_SAMPLES and first + count <= _size(channels)
    places = first + (exact / length) * np.arange(count, dtype=np.float64)
    rows = [
        (values[first : first + count] if is_whole else _at(values, places)) / references[name]
        for name, values in channels.items()
    ]
    return LegWindow(
        state=replace(state, start_s=start_s + first / rate_hz),
        clock_ratio=0.0,
        channels=tuple(channels),
        values=frozen_float(np.stack(rows).reshape(len(rows), state.periods, length)),
    )


def _size(channels: Mapping[str, FloatArray]) -> int:
    return min(values.size for values in channels.values())


def _at(values: FloatArray, places: FloatArray) -> FloatArray:
    """Return the values between samples, by the polynomial of Lagrange through the eight around each place."""
    base = np.clip(np.floor(places).astype(np.int64) - (_POINTS // 2 - 1), 0, values.size - _POINTS)
    offset = places - base
    between = np.zeros(places.size)
    for point in range(_POINTS):
        others = [other for other in range(_POINTS) if other != point]
        weight = np.prod([(offset - other) / (point - other) for other in others], axis=0)
        between += weight * values[base + point]
    return between
