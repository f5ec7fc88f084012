"""The lines of a campaign in messages, from their own times: a spline through few or uneven values bends fast lines.

Through even values a spline shows every line too small by a factor that is known (``spline_gain``). Messages early,
late and lost leave more: 3 % at a third of their rate where they tremble by 15 % of a period. So the lines are fitted
by least squares to the messages at their times, and only what is left of them is joined by the spline; on the grid each
line stands as a spline through even values would show it. That the values of a sender keep its cycle while its messages
wait is told by the same lines.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import scipy

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray
from shaftprint.campaign import Campaign
from shaftprint.sender_cycle import behind_cycle, is_late_by
from shaftprint.signals._channel_signals import HIGHEST_SHARE_OF_RATE, spline_gain
from shaftprint.signals.conditioning import SentValues

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


def joined_about_lines(sent: SentValues, campaign: Campaign, clock: "Clock") -> "tuple[SentValues, FloatArray] | None":
    """Return messages at the times of their values, and joined on the grid with the lines of a campaign as they are.

    Parameters
    ----------
    sent
        The messages.
    campaign
        Its sines and legs are the lines.
    clock
        The grid.

    Returns
    -------
    None where the spline through the messages is as good.
    """
    every = ((window, _inside(window, sent)) for window in _windows(campaign, sent.rate_hz))
    windows = [(window, inside) for window, inside in every if inside.any()]
    if not windows:
        return None
    time_s = _times_of_values(sent, windows)
    fastest_hz = max(float(window.omega_rad_s.max()) for window, _ in windows) / (2.0 * np.pi)
    if time_s is sent.time_s and fastest_hz < _SLOW * sent.rate_hz:
        return None
    grid_s = clock.start_s + np.arange(clock.count) / clock.rate_hz
    left, lines = sent.values.copy(), np.zeros(grid_s.size)
    reach_s = _REACH / sent.rate_hz
    for window, inside in windows:
        amplitude, _ = _fitted(window, time_s[inside], sent.values[inside])
        shown = np.array([spline_gain(float(one) / (2.0 * np.pi), sent.rate_hz) for one in window.omega_rad_s])
        for times, course, factor in ((time_s, left, -1.0), (grid_s, lines, shown)):
            part = slice(*np.searchsorted(times, [window.start_s - reach_s, window.stop_s + reach_s]))
            course[part] += _course(window, factor * amplitude, times[part])
    spline = scipy.interpolate.CubicSpline(time_s, left)
    values: FloatArray = lines + spline(grid_s.clip(time_s[0], time_s[-1]))
    return SentValues(time_s=time_s, values=sent.values, rate_hz=sent.rate_hz), values


def _windows(campaign: Campaign, rate_hz: float) -> Iterator[_Window]:
    """Yield what is measured of a campaign, as far as the messages are fast enough for it."""
    stretches = [(sine.settled_s, sine.window_stop_s, {sine.frequency_hz}) for sine in campaign.sines]
    for leg in campaign.legs:
        harmonics = {harmonic for one in (leg, *campaign.beside(leg)) for harmonic in one.lines}
        stretches.append((leg.settled_s, leg.window_stop_s, {k / leg.length_of_period_s for k in harmonics}))
    for start_s, stop_s, every_hz in stretches:
        shown_hz = sorted(one for one in every_hz if one < HIGHEST_SHARE_OF_RATE * rate_hz)
        if shown_hz:
            yield _Window(start_s=start_s, stop_s=stop_s, omega_rad_s=2.0 * np.pi * np.array(shown_hz))


def _inside(window: _Window, sent: SentValues) -> BoolArray:
    """Return which messages lie in a window; none where they are too few for its lines."""
    inside: BoolArray = (sent.time_s >= window.start_s) & (sent.time_s < window.stop_s)
    enough = np.count_nonzero(inside) >= _FEWEST_A_NUMBER * (2 + 2 * window.omega_rad_s.size)
    return inside if enough else np.zeros_like(inside)


def _times_of_values(sent: SentValues, windows: list[tuple[_Window, BoolArray]]) -> FloatArray:
    """Return when the values were taken: at the times of their messages, unless the lines say that these were late."""
    late_s = behind_cycle(sent.time_s, sent.rate_hz)
    if late_s is None:
        return sent.time_s
    late, residuals, slopes = [], [], []
    for window, inside in windows:
        amplitude, residual = _fitted(window, sent.time_s[inside], sent.values[inside])
        late.append(late_s[inside])
        residuals.append(residual)
        slopes.append(_course(window, 1j * window.omega_rad_s * amplitude, sent.time_s[inside]))
    is_late = is_late_by(np.concatenate(late), np.concatenate(residuals), np.concatenate(slopes))
    return sent.time_s - late_s if is_late else sent.time_s


def _fitted(window: _Window, time_s: FloatArray, values: FloatArray) -> tuple[ComplexArray, FloatArray]:
    """Return the complex amplitudes of the lines, shape (lines,), and what is left of the values."""
    turned = np.outer(time_s - window.start_s, window.omega_rad_s)
    middle_s = 0.5 * (window.start_s + window.stop_s)
    design = np.column_stack([np.ones(time_s.size), time_s - middle_s, np.cos(turned), np.sin(turned)])
    # the lines are nearly orthogonal: normal equations lose nothing
    found = scipy.linalg.solve(design.T @ design, design.T @ values, assume_a="pos")
    cosine, sinus = found[2:].reshape(2, -1)
    return cosine - 1j * sinus, values - design @ found


def _course(window: _Window, amplitude: ComplexArray, time_s: FloatArray) -> FloatArray:
    """Return what the lines are at some times, shape of ``time_s``."""
    course = np.zeros(time_s.size)
    for one, omega_rad_s in zip(amplitude, window.omega_rad_s, strict=True):
        course += (one * np.exp(1j * omega_rad_s * (time_s - window.start_s))).real
    return course
