"""The lines of a campaign in messages, from their own times: a spline through few or uneven values bends fast lines.

Through even values a spline shows every line too small by a factor that is known (``spline_gain``). Messages early,
late and lost leave more: 3 % at a third of their rate where they tremble by 15 % of a period. So the lines are fitted
by least squares to the messages at their times, and only what is left of them is joined by the spline; on the grid each
line stands as a spline through even values would show it. That the values of a sender keep its cycle while its messages
wait is told by the same lines.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import scipy

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray
from shaftprint.campaign._campaign import Campaign
from shaftprint.sender_cycle import behind_cycle, is_late_by
from shaftprint.signals._channel_signals import HIGHEST_SHARE_OF_RATE, spline_gain
from shaftprint.signals.conditioning._condition import SentValues

if TYPE_CHECKING:
    from shaftprint.signals._clock import Clock

# A spline through trembling messages bends lines that are slower, over the rate of the messages, by less than 2e-4.
_SLOW = 0.07
# Fewer messages for each number that is fitted leave too little.
_FEWEST_A_NUMBER = 4
# Beyond so many messages the end of a spline is not felt.
_REACH = 10


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Window:
    """Lines that are measured in one stretch."""

    start_s: float
    stop_s: float
    omega_rad_s: FloatArray
    """Their frequencies, shape (lines,)."""
    inside: BoolArray
    """Which messages lie in it, shape (messages,)."""


def joined_about_lines(sent: SentValues, campaign: Campaign, clock: "Clock") -> "tuple[SentValues, FloatArray] | None":
    """Return messages at the times of their values, and joined on the grid with the lines of a campaign as they are.

    ``sent``: the messages. ``campaign``: its sines and legs are the lines. ``clock``: the grid. Returns None where the
    spline through the messages is as good.
    """
    windows = list(_windows(campaign, sent))
    if not windows:
        return None
    fastest_hz = max(float(window.omega_rad_s.max()) for window in windows) / (2.0 * np.pi)
    is_slow = fastest_hz < _SLOW * sent.rate_hz
    late_s = behind_cycle(sent.time_s, sent.rate_hz)
    if is_slow and late_s is None:
        return None
    time_s = sent.time_s
    fits = [_fitted(window, time_s, sent.values) for window in windows]
    if late_s is not None and _is_late(late_s, sent, windows, fits):
        time_s = time_s - late_s
        fits = [_fitted(window, time_s, sent.values) for window in windows]
    elif is_slow:
        return None
    grid_s = clock.time_s
    without_lines, lines = sent.values.copy(), np.zeros(grid_s.size)
    reach_s = _REACH / sent.rate_hz
    for window, (amplitude, _) in zip(windows, fits, strict=True):
        shown = np.array([spline_gain(float(omega) / (2.0 * np.pi), sent.rate_hz) for omega in window.omega_rad_s])
        for times, course, factor in ((time_s, without_lines, -1.0), (grid_s, lines, shown)):
            part = slice(*np.searchsorted(times, [window.start_s - reach_s, window.stop_s + reach_s]))
            course[part] += _course(window, factor * amplitude, times[part])
    spline = scipy.interpolate.CubicSpline(time_s, without_lines)
    values: FloatArray = lines + spline(grid_s.clip(time_s[0], time_s[-1]))
    return replace(sent, time_s=time_s), values


def _windows(campaign: Campaign, sent: SentValues) -> Iterator[_Window]:
    """Yield what is measured of a campaign, as far as the messages are fast enough for it and not too few."""
    stretches = [(sine.settled_s, sine.window_stop_s, {sine.frequency_hz}) for sine in campaign.sines]
    for leg in campaign.legs:
        harmonics = {harmonic for one in (leg, *campaign.beside(leg)) for harmonic in one.lines}
        stretches.append((leg.settled_s, leg.window_stop_s, {k / leg.length_of_period_s for k in harmonics}))
    for start_s, stop_s, every_hz in stretches:
        shown_hz = sorted(line_hz for line_hz in every_hz if line_hz < HIGHEST_SHARE_OF_RATE * sent.rate_hz)
        inside = (sent.time_s >= start_s) & (sent.time_s < stop_s)
        if shown_hz and np.count_nonzero(inside) >= _FEWEST_A_NUMBER * (2 + 2 * len(shown_hz)):
            omega_rad_s = 2.0 * np.pi * np.array(shown_hz)
            yield _Window(start_s=start_s, stop_s=stop_s, omega_rad_s=omega_rad_s, inside=inside)


def _is_late(
    late_s: FloatArray, sent: SentValues, windows: list[_Window], fits: list[tuple[ComplexArray, FloatArray]]
) -> bool:
    """Return whether lines that were fitted at the times of the messages say that these were late."""
    late, residuals, slopes = [], [], []
    for window, (amplitude, residual) in zip(windows, fits, strict=True):
        late.append(late_s[window.inside])
        residuals.append(residual)
        slopes.append(_course(window, 1j * window.omega_rad_s * amplitude, sent.time_s[window.inside]))
    return is_late_by(np.concatenate(late), np.concatenate(residuals), np.concatenate(slopes))


def _fitted(window: _Window, time_s: FloatArray, values: FloatArray) -> tuple[ComplexArray, FloatArray]:
    """Return the complex amplitudes of the lines, shape (lines,), and what is left of the values in the window."""
    time_s, values = time_s[window.inside], values[window.inside]
    turned = np.outer(time_s - window.start_s, window.omega_rad_s)
    middle_s = 0.5 * (window.start_s + window.stop_s)
    design = np.column_stack([np.ones(time_s.size), time_s - middle_s, np.cos(turned), np.sin(turned)])
    # the lines are nearly orthogonal: normal equations lose nothing
    numbers = scipy.linalg.solve(design.T @ design, design.T @ values, assume_a="pos")
    cosine, sinus = numbers[2:].reshape(2, -1)
    return cosine - 1j * sinus, values - design @ numbers


def _course(window: _Window, amplitude: ComplexArray, time_s: FloatArray) -> FloatArray:
    """Return what the lines are at some times, shape of ``time_s``."""
    course = np.zeros(time_s.size)
    for height, omega_rad_s in zip(amplitude, window.omega_rad_s, strict=True):
        course += (height * np.exp(1j * omega_rad_s * (time_s - window.start_s))).real
    return course
