"""A sine in the recorded set point: its frequency, amplitude and phase, and when it begins and ends.

A sine fitted to the middle of a window gives frequency, amplitude and phase. Begin and end lie where the sum of squares
changes over from the constant to the sine: two change points, found exactly by cumulative sums.
"""

from dataclasses import dataclass

import numpy as np
from scipy.fft import next_fast_len, rfft

from shaftprint.arrays import FloatArray
from shaftprint.campaign import Sine
from shaftprint.signals.excitation._found_test import FoundTest

# Samples of a sine a period that are enough for its phase; how many times its frequency is looked at.
_SAMPLES_A_PERIOD, _HIGHEST = 40.0, 8.0
# Nearer than this part of a period over the whole window a frequency is that of the campaign.
_SAME_BINS = 0.1
# Share of the variance that a sine has to explain.
LEAST_EXPLAINED = 0.5
# The ends of a window of which the begin is not known are left out of the fit.
_TRIMMED_SHARE, _TRIMMED_S = 0.1, 3.0


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
    (cosine, sinus, mean), explained = _fitted(time, values, frequency)
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
    """Return the frequency of the strongest sine in a window [Hz], refined by least squares."""
    rate_hz = (time_s.size - 1) / (time_s[-1] - time_s[0])
    size = next_fast_len(8 * values.size, real=True)
    taper = np.hanning(values.size)
    power = np.abs(rfft((values - values.mean()) * taper, size))
    frequencies = np.arange(power.size) * rate_hz / size
    # slower than a period in the window is drift; the campaign's own frequency always counts
    slowest = min(1.0 / (time_s[-1] - time_s[0]), 0.5 * near_hz)
    allowed = (frequencies >= slowest) & (frequencies <= _HIGHEST * near_hz)
    frequency_hz = float(frequencies[allowed][np.argmax(power[allowed])])
    step = 0.1 / (time_s[-1] - time_s[0])
    for _ in range(12):
        shares = [_fitted(time_s, values, frequency_hz + side * step)[1] for side in (-1.0, 0.0, 1.0)]
        bend = shares[0] - 2.0 * shares[1] + shares[2]
        move = 0.5 * (shares[0] - shares[2]) / bend if bend < 0.0 else float(np.argmax(shares) - 1)
        frequency_hz += float(np.clip(move, -1.0, 1.0)) * step
        step *= 0.5
    return frequency_hz


def _fitted(time_s: FloatArray, values: FloatArray, frequency_hz: float) -> tuple[FloatArray, float]:
    """Return cosine, sine and mean from the first time on, and the share of the variance that they explain."""
    phase = 2.0 * np.pi * frequency_hz * (time_s - time_s[0])
    design = np.column_stack([np.cos(phase), np.sin(phase), np.ones(phase.size)])
    coefficients = np.linalg.solve(design.T @ design, design.T @ values)
    return coefficients, 1.0 - float(np.var(values - design @ coefficients) / np.var(values))
