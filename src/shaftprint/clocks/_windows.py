"""How far two clocks are apart in each stretch of a recording, with the standard deviation of that.

In a stretch the slower content ``y`` is ``g x(t + delay) + c + d t`` with ``x`` the faster one. The derivative of the
content tells the delay (Gauss and Newton); what is left over is coloured, so its autocovariance goes into the standard
deviation (Newey and West, "A simple, positive semi-definite, heteroskedasticity and autocorrelation consistent
covariance matrix", 1987, equation 5).
"""

from dataclasses import dataclass

import numpy as np
import scipy

from shaftprint.arrays import FloatArray
from shaftprint.clocks._shared_band import shared_band
from shaftprint.signals._content import Content

STRETCH_S = 60.0
"""Length of a stretch [s]: long against the movements, short against what temperature does to a clock."""

FEWEST = 20
STEP_S = 0.04
ITERATIONS = 8
# A stretch whose delay is known no better than this is not used.
WORST_STD_S = 0.25
# Longest correlation of what is left over that is looked for [s].
MEMORY_S = 5.0


@dataclass(frozen=True, kw_only=True, slots=True)
class WindowDelay:
    """The delay of one stretch."""

    time_s: float
    """Middle of the stretch on the slower content's clock [s]."""
    delay_s: float
    """What the faster content's clock reads more [s]."""
    std_s: float
    """Its standard deviation [s]; infinite where the stretch does not determine it."""
    energy: float
    """Mean square of what the faster content shows there in the shared band; 1 is what is left over."""
    likeness: float
    """Correlation of both contents there, in the shared band."""

    @property
    def tells(self) -> bool:
        """Whether the stretch determines the delay of the clocks."""
        return self.std_s < WORST_STD_S


def delays_of(slow: Content, fast: Content, expected: FloatArray, within_s: float) -> list[WindowDelay]:
    """Return the delay of every stretch, in order of time.

    ``slow``, ``fast``: what both loggers have seen. ``expected``: delay that is looked around, at each value of
    ``slow`` [s]. ``within_s``: how far from it to look [s].
    """
    inside = (slow.time_s + expected > fast.start_s) & (slow.time_s + expected < fast.time_s[-1])
    time_s, expected = slow.time_s[inside], expected[inside]
    length = max(round(STRETCH_S * slow.rate_hz), FEWEST)
    if time_s.size < length:
        return []
    there = scipy.interpolate.CubicSpline(fast.time_s, fast.values)(time_s + expected)
    slow_band, there = shared_band(slow.values[inside], there, slow.rate_hz)
    spline = scipy.interpolate.CubicSpline(time_s, there)
    delays = []
    for first in range(0, time_s.size - length + 1, length):
        part = slice(first, first + length)
        left_s, std_s = _left(spline, time_s[part], slow_band[part], within_s)
        delays.append(
            WindowDelay(
                time_s=float(time_s[first] + time_s[first + length - 1]) / 2.0,
                delay_s=float(expected[first + length // 2]) + left_s,
                std_s=std_s,
                energy=float(np.var(there[part])),
                likeness=_correlation(slow_band[part], spline(time_s[part] + left_s)),
            )
        )
    return delays


def _left(
    spline: "scipy.interpolate.CubicSpline", time_s: FloatArray, values: FloatArray, within_s: float
) -> tuple[float, float]:
    """Return what is left of the delay of one stretch and its standard deviation, infinite where undetermined."""
    line, _ = np.linalg.qr(np.stack([np.ones(time_s.size), time_s - time_s[0]], axis=1))
    detrended = values - line @ (line.T @ values)
    if not np.any(np.abs(detrended) > 1e-12 * np.max(np.abs(values))):
        return 0.0, np.inf
    delay_s = _searched(spline, time_s, detrended, line, within_s)
    for _ in range(ITERATIONS):
        x, slope = spline(time_s + delay_s), spline(time_s + delay_s, 1)
        basis, _ = np.linalg.qr(np.column_stack([line, x]))
        turned = slope - basis @ (basis.T @ slope)
        size = float(basis[:, 2] @ x)
        gain = float(basis[:, 2] @ values) / size if size else 0.0
        information = gain * float(turned @ turned)
        if information == 0.0:
            return 0.0, np.inf
        residual = values - basis @ (basis.T @ values)
        step = float(turned @ residual) / information
        delay_s += float(np.clip(step, -within_s, within_s))
        if abs(delay_s) > 1.5 * within_s + STEP_S:
            return 0.0, np.inf
    scores = turned * (residual - step * gain * turned)
    return delay_s, float(np.sqrt(_long_run(scores, time_s)) / abs(information))


def _correlation(one: FloatArray, two: FloatArray) -> float:
    one, two = scipy.signal.detrend(one), scipy.signal.detrend(two)
    size = float(np.sqrt((one @ one) * (two @ two)))
    return float(one @ two) / size if size > 0.0 else 0.0


def _searched(
    spline: "scipy.interpolate.CubicSpline",
    time_s: FloatArray,
    detrended: FloatArray,
    line: FloatArray,
    within_s: float,
) -> float:
    """Return the delay on a raster at which the contents are most alike."""
    places = np.arange(-np.ceil(within_s / STEP_S), np.ceil(within_s / STEP_S) + 1) * STEP_S
    shared = np.empty(places.size)
    for i, delay_s in enumerate(places):
        x = spline(time_s + delay_s)
        x = x - line @ (line.T @ x)
        size = float(x @ x)
        shared[i] = abs(float(detrended @ x)) / np.sqrt(size) if size > 0.0 else 0.0
    return float(places[int(np.argmax(shared))])


def _long_run(scores: FloatArray, time_s: FloatArray) -> float:
    """Return the variance of the sum of coloured scores."""
    longest = max(int(MEMORY_S / (time_s[1] - time_s[0])), 1)
    longest = min(longest, scores.size // 4)
    spectrum = np.abs(np.fft.rfft(scores, 2 * scores.size)) ** 2
    covariance = np.fft.irfft(spectrum)[: longest + 1]
    weights = 1.0 - np.arange(longest + 1) / (longest + 1.0)
    return float(max(covariance[0] + 2.0 * np.sum(weights[1:] * covariance[1:]), covariance[0] * 0.1))
