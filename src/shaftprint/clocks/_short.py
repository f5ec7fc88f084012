"""The clocks of short recordings, in which no minutes can be compared: one delay from all that both have seen.

The deviation of a delay from one stretch cannot come from the scatter of many. It follows from the spectrum of what is
left over, which the whole stretch shows, and of the slope that tells the delay, which may be one step:
``variance = sum r(k) s(k) / s(0)^2`` with the autocovariance ``r`` of what is left over and ``s`` of the slope.
"""

from dataclasses import replace

import numpy as np
import scipy

from shaftprint.arrays import FloatArray
from shaftprint.clocks._clock_map import ClockMap
from shaftprint.clocks._coarse import correlation, neighbours
from shaftprint.clocks._shared_band import TINY, shared_band
from shaftprint.clocks._windows import FEWEST, WindowDelay
from shaftprint.errors import ClockError
from shaftprint.signals._content import Content

# There are few averages: lines that chance makes alike are to be none at all.
CHANCE = 8.0
ITERATIONS, LARGEST_STEP_S = 8, 0.1
# Line, gain and delay; with fewer degrees of freedom Student's t has no variance.
FITTED, LEAST_FREEDOM = 4.0, 3.0
# How much more likely, as a logarithm, the best place must be than another, and than the valley before that.
CLEARLY, VALLEY = 8.0, 2.0
# A delay that is known no better than this is none [s].
WORST_STD_S = 0.05


def short_line(
    slow: Content, fast: Content, offset_s: float, drift_std: float, names: str
) -> tuple[ClockMap, list[WindowDelay]]:
    """Return the map from the slower content's clock to the faster one's, and the one delay on which it rests.

    ``slow``, ``fast``: what both loggers have seen. ``offset_s``: what the faster content's clock reads more, roughly
    [s]. ``drift_std``: standard deviation of the drift, which a short recording does not tell [s/s]. ``names``: the
    channels, for messages. Raises ClockError if the delay cannot be told.
    """
    for _ in range(3):
        there_s = slow.time_s + offset_s
        inside = (there_s > fast.start_s) & (there_s < fast.time_s[-1])
        time_s = slow.time_s[inside]
        if time_s.size < FEWEST:
            raise _untold(names, np.inf)
        there = scipy.interpolate.CubicSpline(fast.time_s, fast.values)(there_s[inside])
        values, there = shared_band(slow.values[inside], there, slow.rate_hz, chance=CHANCE)
        spline = scipy.interpolate.CubicSpline(time_s, there)
        delay = _refined(spline, time_s, values, _peak(there, values, slow.rate_hz, names))
        if not delay.std_s < WORST_STD_S:
            raise _untold(names, delay.std_s)
        offset_s += delay.delay_s
    delay = replace(delay, delay_s=offset_s)
    covariance = np.diag([delay.std_s**2, drift_std**2])
    return ClockMap(offset_s=offset_s, drift=0.0, middle_s=delay.time_s, covariance=covariance), [delay]


def _untold(names: str, std_s: float) -> ClockError:
    found = f"a standard deviation of {std_s:.2g} s" if np.isfinite(std_s) else "none that both show"
    return ClockError(
        f"{names}: expected movements that tell the offset of the clocks to {WORST_STD_S:g} s, found {found}; choose "
        "channels that show the same, and a part of the test in which they move."
    )


def _line(time_s: FloatArray) -> FloatArray:
    line, _ = np.linalg.qr(np.stack([np.ones(time_s.size), time_s - time_s[0]], axis=1))
    return line


def _peak(there: FloatArray, values: FloatArray, rate_hz: float, names: str) -> float:
    """Return the likeliest delay on the grid [s]; another that is nearly as likely is an error."""
    size = values.size
    moved, still = scipy.signal.detrend(there), scipy.signal.detrend(values)
    shared, count = correlation(moved, still)
    shared = np.where(count >= 0.5 * size, shared, 0.0)
    # as if each place had as many values: one that leaves fewer to compare is no less likely for that
    likely = -0.5 * size / neighbours(moved, still) * np.log1p(-np.minimum(shared**2, 1.0 - 1e-9))
    # without a valley in between it is the same place, of which the standard deviation tells how wide it is
    peaks = scipy.signal.find_peaks(likely, prominence=VALLEY)[0]
    best = int(np.argmax(likely))
    others = peaks[np.abs(peaks - best) > 2]
    rival = others[np.argmax(likely[others])] if others.size else best
    if rival != best and likely[best] - likely[rival] < CLEARLY:
        raise ClockError(
            f"{names}: expected movements that occur once, found that a shift by {abs(rival - best) / rate_hz:.2g} s "
            "fits nearly as well; take in a step or a chirp besides the sines."
        )
    return (best - (size - 1)) / rate_hz


def _refined(
    spline: "scipy.interpolate.CubicSpline", time_s: FloatArray, values: FloatArray, delay_s: float
) -> WindowDelay:
    """Return the delay with its standard deviation, at the time at which the content tells it."""
    first_s, last_s = time_s[0], time_s[-1]
    both = (time_s + delay_s >= first_s) & (time_s + delay_s <= last_s)
    time_s, values = time_s[both], values[both]
    nothing = WindowDelay(time_s=float(first_s), delay_s=delay_s, std_s=np.inf, energy=0.0, likeness=0.0)
    if time_s.size < FEWEST:
        return nothing
    line = _line(time_s)
    for _ in range(ITERATIONS):
        x, slope = spline(time_s + delay_s), spline(time_s + delay_s, 1)
        basis, _ = np.linalg.qr(np.column_stack([line, x]))
        turned = slope - basis @ (basis.T @ slope)
        size = float(basis[:, 2] @ x)
        gain = float(basis[:, 2] @ values) / size if size else 0.0
        information = gain * float(turned @ turned)
        if abs(information) < TINY:
            return nothing
        residual = values - basis @ (basis.T @ values)
        delay_s += float(np.clip(float(turned @ residual) / information, -LARGEST_STEP_S, LARGEST_STEP_S))
    left, told = (np.abs(np.fft.rfft(part, 2 * part.size)) ** 2 for part in (residual, turned))
    variance = float(np.fft.irfft(left * told)[0]) / time_s.size
    # of as many values as the band of the slope holds, line, gain and delay are fitted; the rest tells the noise, and
    # the variance is that of Student's t
    freedom = max(float(told.sum() ** 2 / (told @ told)) - FITTED, LEAST_FREEDOM)
    variance *= (freedom + FITTED) / (freedom - 2.0)
    return WindowDelay(
        time_s=float(turned**2 @ time_s / (turned @ turned)),
        delay_s=delay_s,
        std_s=float(np.sqrt(variance)) / abs(information),
        energy=float(np.var(x)),
        likeness=float(np.corrcoef(values, x)[0, 1]),
    )
