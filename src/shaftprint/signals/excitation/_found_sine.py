"""A sine in the recorded set point: its frequency, amplitude and phase, and when it begins and ends.

A sine fitted to the middle of a window gives frequency, amplitude and phase. Begin and end lie where the sum of squares
changes over from the constant to the sine: two change points, found exactly by cumulative sums.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.campaign._excitations import Sine
from shaftprint.signals.excitation._found_test import FoundTest

# Samples of a sine a period that are enough for its phase; how many times its frequency is looked at.
_SAMPLES_A_PERIOD, _HIGHEST = 40.0, 8.0
# Nearer than this part of a period over the whole window a frequency is that of the campaign.
_SAME_BINS = 0.1
# Share of the variance that a sine has to explain.
LEAST_EXPLAINED = 0.5
# The ends of a window of which the begin is not known are left out of the fit.
_TRIMMED_SHARE, _TRIMMED_S = 0.1, 3.0
# Steps of the search for a frequency: how many at most, the longest in periods over the window, and which ends it.
_STEPS, _LONGEST_STEP, _SMALLEST_STEP = 12, 0.1, 1e-7


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SetPointGrid:
    """The recorded set point on its grid."""

    set_point_v: FloatArray
    rate_hz: float
    start_s: float

    def cut(self, first_s: float, last_s: float, *, highest_hz: float = np.inf) -> tuple[FloatArray, FloatArray]:
        """Return times [s] and set point [V] between two times, as means of blocks that show a frequency well."""
        length = max(int(self.rate_hz / (_SAMPLES_A_PERIOD * highest_hz)), 1)
        first = max(round((first_s - self.start_s) * self.rate_hz), 0)
        stop = min(round((last_s - self.start_s) * self.rate_hz), self.set_point_v.size)
        blocks = max(stop - first, 0) // length
        values = self.set_point_v[first : first + blocks * length].reshape(blocks, length).mean(axis=1)
        middle = first + length * np.arange(blocks) + 0.5 * (length - 1)
        return np.asarray(self.start_s + middle / self.rate_hz), np.asarray(values)


def found_sine(grid: SetPointGrid, sine: Sine, shift_s: float, first_s: float, last_s: float) -> FoundTest:
    """Return a sine as the set point shows it between two times."""
    length_s = sine.stop_s - sine.start_s
    trim_s = min(max(_TRIMMED_SHARE * length_s, _TRIMMED_S), 0.25 * length_s)
    inner = sine.start_s + shift_s + trim_s, sine.stop_s + shift_s - trim_s
    time, values = grid.cut(*inner, highest_hz=_HIGHEST * sine.frequency_hz / 4.0)
    if time.size < _SAMPLES_A_PERIOD or time[-1] - time[0] < 1.0 / sine.frequency_hz or np.ptp(values) == 0.0:
        return _not_found(sine)
    frequency = _frequency_hz(time, values, sine.frequency_hz)
    if abs(frequency - sine.frequency_hz) * (time[-1] - time[0]) < _SAME_BINS:
        frequency = sine.frequency_hz
    (cosine, sinus, mean), explained = _fitted(values, _design(time, frequency))
    if explained < LEAST_EXPLAINED:
        return _not_found(sine)
    amplitude = float(np.hypot(cosine, sinus))
    rising = time[0] - float(np.arctan2(cosine, sinus)) / (2.0 * np.pi * frequency)
    time, values = grid.cut(first_s, last_s)
    predicted = amplitude * np.sin(2.0 * np.pi * frequency * (time - rising))
    begin_s, end_s = _begin_and_end(time, values - mean, predicted, middle_s=0.5 * (inner[0] + inner[1]))
    rising += round((begin_s - rising) * frequency) / frequency
    return FoundTest(
        planned=sine,
        is_found=True,
        begin_s=begin_s,
        end_s=end_s,
        rising_s=rising,
        frequency_hz=frequency,
        amplitude_v=amplitude,
        is_inverted=False,
    )


def _not_found(sine: Sine) -> FoundTest:
    return FoundTest(
        planned=sine,
        is_found=False,
        begin_s=np.nan,
        end_s=np.nan,
        rising_s=np.nan,
        frequency_hz=np.nan,
        amplitude_v=np.nan,
        is_inverted=False,
    )


def _begin_and_end(
    time_s: FloatArray, values: FloatArray, predicted: FloatArray, *, middle_s: float
) -> tuple[float, float]:
    """Return the times [s] between which a sine explains values better than zero does, one on each side of a middle."""
    summed = np.concatenate([[0.0], np.cumsum(values**2 - (values - predicted) ** 2)])
    middle = int(np.searchsorted(time_s, middle_s))
    begin = int(np.argmin(summed[: middle + 1]))
    end = middle + int(np.argmax(summed[middle:]))
    return float(time_s[begin]), float(time_s[min(end, time_s.size - 1)])


def _frequency_hz(time_s: FloatArray, values: FloatArray, near_hz: float) -> float:
    """Return the frequency of the strongest sine in a window [Hz], refined by least squares.

    Gauss-Newton steps on cosine, sine, mean and frequency together (IEEE Std 1057-2017, annex B: four-parameter sine
    fit), none longer than a tenth of a period over the window.
    """
    length_s = time_s[-1] - time_s[0]
    rate_hz = (time_s.size - 1) / length_s
    size = 1 << (8 * values.size - 1).bit_length()
    power = np.abs(np.fft.rfft((values - values.mean()) * np.hanning(values.size), size))
    frequencies = np.arange(power.size) * rate_hz / size
    # slower than a period in the window is drift; the campaign's own frequency always counts
    slowest = min(1.0 / length_s, 0.5 * near_hz)
    allowed = (frequencies >= slowest) & (frequencies <= _HIGHEST * near_hz)
    frequency_hz = float(frequencies[allowed][np.argmax(power[allowed])])
    longest_hz = _LONGEST_STEP / length_s
    for _ in range(_STEPS):
        design = _design(time_s, frequency_hz)
        (cosine, sinus, _), _ = _fitted(values, design)
        slope = 2.0 * np.pi * (time_s - time_s[0]) * (sinus * design[:, 0] - cosine * design[:, 1])
        coefficients, _ = _fitted(values, np.column_stack([design, slope]))
        move = float(np.clip(coefficients[3], -longest_hz, longest_hz))
        frequency_hz += move
        if abs(move) < _SMALLEST_STEP * longest_hz:
            break
    return frequency_hz


def _design(time_s: FloatArray, frequency_hz: float) -> FloatArray:
    """Return cosine, sine and one as columns, from the first time on, shape (samples, 3)."""
    phase = 2.0 * np.pi * frequency_hz * (time_s - time_s[0])
    return np.column_stack([np.cos(phase), np.sin(phase), np.ones(phase.size)])


def _fitted(values: FloatArray, design: FloatArray) -> tuple[FloatArray, float]:
    """Return the coefficients of the columns, and the share of the variance that they explain."""
    coefficients = np.asarray(np.linalg.solve(design.T @ design, design.T @ values), dtype=np.float64)
    return coefficients, 1.0 - float(np.var(values - design @ coefficients) / np.var(values))
