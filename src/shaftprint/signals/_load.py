"""The propeller load of a whole test: its mean over all windows, and how far the mean may be from that of another test.

The load is torque over the square of the speed. Recirculating water and wake move it by a per cent from one minute to
the next, as slowly as a window is long, so that neighbouring windows err alike and the scatter between two stretches
says next to nothing. Its wander is taken as a stationary Gaussian process with an exponential autocorrelation (first
order; G. E. Uhlenbeck and L. S. Ornstein, "On the theory of the Brownian motion", Physical Review 36, 1930) of unknown
size and correlation time ``T``, averaged over each window. Mean and size are marginalised at each ``T`` with the usual
prior of no knowledge, which gives the factor ``(n - 1) / (n - 3)`` of a short series (JCGM 101:2008, 6.4.9.4), then
``T`` over a logarithmic grid. A wander slower than half the test cannot be told from its mean: what differs between
days but not within one (draught, current, water under the keel) is not in the number.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.campaign import Campaign, Chirp, Sine
from shaftprint.signals._gaps import EVERYTHING, Coverage
from shaftprint.signals._signals import WorkingPoint
from shaftprint.signals._steady import SteadyStretch

# With fewer windows the variance of a mean has no expectation.
FEWEST_WINDOWS = 4
_GRID = 24
_SHORTEST_SHARE, _LONGEST_SHARE = 0.25, 0.5


def with_load_of_test(
    point: WorkingPoint,
    quiet: tuple[SteadyStretch, ...],
    campaign: Campaign,
    *,
    speed_rev_s: FloatArray,
    torque_nm: FloatArray,
    rate_hz: float,
    start_s: float,
    coverage: Coverage = EVERYTHING,
) -> WorkingPoint:
    """Return the working point with the mean load of the whole test over its own, where there are four windows.

    Parameters
    ----------
    point
        The working point.
    quiet
        The quiet stretches that it is the mean of.
    campaign
        Says where the sines and chirps are; each is one window.
    speed_rev_s, torque_nm
        Signals on the grid, shape (samples,).
    rate_hz, start_s
        The grid.
    coverage
        Says where the gaps are.
    """
    planned = [*((stretch.start_s, stretch.stop_s) for stretch in quiet), *_waves(campaign)]
    # half a sample on either side is what rounding leaves of an end
    first_s, last_s = start_s - 0.5 / rate_hz, start_s + (torque_nm.size + 0.5) / rate_hz
    recorded = [(begin, end) for begin, end in planned if begin >= first_s and end <= last_s]
    windows = _apart([window for window in recorded if not coverage.missing(*window)])
    if len(windows) < FEWEST_WINDOWS:
        return point
    own = point.shaft_torque_nm / point.engine_speed_rev_s**2
    loads = []
    for begin, end in windows:
        inside = slice(round((begin - start_s) * rate_hz), round((end - start_s) * rate_hz))
        loads.append(float(np.mean(torque_nm[inside]) / np.mean(speed_rev_s[inside] ** 2)) / own)
    begins, ends = np.array(windows).T
    mean, std = mean_of_wander(np.array(loads), begins, ends)
    return replace(point, load=mean, load_std=std)


def _waves(campaign: Campaign) -> Iterator[tuple[float, float]]:
    """Yield the windows in which the speed swings about the working point: at their ends it is what it was."""
    for wave in campaign.excitations:
        if isinstance(wave, Sine):
            yield wave.settled_s, wave.window_stop_s
        elif isinstance(wave, Chirp):
            yield wave.start_s, wave.stop_s


def _apart(windows: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the windows in order of time, without those that overlap an earlier one."""
    found: list[tuple[float, float]] = []
    for begin, end in sorted(windows):
        if not found or begin >= found[-1][1]:
            found.append((begin, end))
    return found


def mean_of_wander(values: FloatArray, start_s: FloatArray, stop_s: FloatArray) -> tuple[float, float]:
    """Return the mean of what wanders slowly, and its standard deviation, from means over windows.

    Parameters
    ----------
    values
        Mean over each window, shape (windows,), four or more.
    start_s, stop_s
        When the windows begin and end [s], shape (windows,).
    """
    shortest = _SHORTEST_SHARE * float(np.min(stop_s - start_s))
    longest = _LONGEST_SHARE * float(np.max(stop_s) - np.min(start_s))
    freedom = values.size - 1
    ones, scale = np.ones(values.size), float(np.mean(values))
    logs, means, variances = np.empty((3, _GRID))
    for place, time_s in enumerate(np.geomspace(shortest, longest, _GRID)):
        lower = np.linalg.cholesky(_window_covariance(start_s, stop_s, time_s))
        white, level = np.linalg.solve(lower, np.column_stack([values - scale, ones])).T
        information = float(level @ level)
        means[place] = float(level @ white) / information
        square = max(float(np.sum((white - means[place] * level) ** 2)), np.finfo(float).tiny)
        variances[place] = square / (freedom - 2) / information
        logs[place] = -np.log(np.diag(lower)).sum() - 0.5 * np.log(information) - 0.5 * freedom * np.log(square)
    share = np.exp(logs - logs.max())
    share /= share.sum()
    mean = float(share @ means)
    return scale + mean, float(np.sqrt(share @ (variances + (means - mean) ** 2)))


def _window_covariance(start_s: FloatArray, stop_s: FloatArray, time_s: float) -> FloatArray:
    """Return the covariance of window means of a process of variance 1 and autocorrelation ``exp(-t / T)``.

    The double integral of the autocorrelation over two windows, by its second antiderivative ``T |t| + T^2 exp(-t/T)``.
    """

    def twice(lag_s: FloatArray) -> FloatArray:
        away = np.abs(lag_s)
        return np.asarray(time_s * away + time_s**2 * np.exp(-away / time_s))

    begins, ends = start_s[:, np.newaxis], stop_s[:, np.newaxis]
    both = twice(ends - start_s) - twice(begins - start_s) - twice(ends - stop_s) + twice(begins - stop_s)
    length = stop_s - start_s
    return np.asarray(both / np.outer(length, length))
