"""What any way of measuring a sine in a window gives, and the contract of such a way."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray

if TYPE_CHECKING:
    from shaftprint.spectra.lines._windows import Window

# Sampling instants that miss a window edge by rounding only belong to the window.
_EDGE_SAMPLES = 1e-6


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class WindowSamples:
    """All channels inside one window."""

    window: "Window"
    """The window."""
    rate_hz: float
    """Sample rate [Hz]."""
    time_s: FloatArray
    """Time of each sample since the start of the window [s], shape (samples,)."""
    channels: tuple[str, ...]
    """Names of the channels."""
    values: FloatArray
    """Values, shape (channels, samples)."""

    def of(self, channel: str) -> FloatArray:
        """Return the values of one channel, shape (samples,)."""
        values: FloatArray = self.values[self.channels.index(channel)]
        return values


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LineFit:
    """The sine found in one window, channel by channel, and what remains when it is taken away.

    A channel is ``mean + Re(amplitude[0] exp(j w t)) + Re(amplitude[1] exp(2 j w t)) + ... + residual``, with ``t``
    counted from the start of the window; drift is in neither the mean nor the residual.
    """

    samples: WindowSamples
    """What was fitted."""
    amplitude: ComplexArray
    """Complex amplitude of the fundamental and of each fitted harmonic, shape (orders, channels)."""
    mean: FloatArray
    """Mean of each channel, shape (channels,)."""
    residual: FloatArray
    """What the fit does not explain, shape (channels, samples)."""


class SineMethod(ABC):
    """A way to measure the sine in a window."""

    @abstractmethod
    def fit(self, samples: WindowSamples) -> LineFit:
        """Measure the sine of the window's frequency in all channels.

        ``samples``: all channels inside one window, in any units. Returns amplitudes in the units of the channels, with
        the residual.
        """


def cut_window(
    window: "Window", values: Mapping[str, FloatArray], *, rate_hz: float, start_s: float
) -> WindowSamples | None:
    """Cut the samples of a window out of whole channels.

    ``values``: channels on one grid by name, each of shape (samples,). ``rate_hz``: sample rate of the grid [Hz].
    ``start_s``: time of the first sample [s]. Returns the samples with ``start <= t < stop``, or None where the
    channels do not cover the window.
    """
    inside = window_slice(window, min(channel.size for channel in values.values()), rate_hz=rate_hz, start_s=start_s)
    if inside is None:
        return None
    time_s = start_s - window.start_s + np.arange(inside.start, inside.stop) / rate_hz
    return WindowSamples(
        window=window,
        rate_hz=rate_hz,
        time_s=time_s,
        channels=tuple(values),
        values=np.stack([channel[inside] for channel in values.values()]),
    )


def cut_window_at(
    window: "Window", name: str, values: FloatArray, *, time_s: FloatArray, rate_hz: float
) -> WindowSamples:
    """Cut the samples of a window out of a channel whose values have times of their own.

    ``window``: the window; the channel covers it. ``name``: name of the channel. ``values``, ``time_s``: its values and
    their times [s], ascending, each of shape (samples,). ``rate_hz``: how many values come in a second, as a rule [Hz].
    """
    first, stop = np.searchsorted(time_s, [window.start_s, window.stop_s])
    return WindowSamples(
        window=window,
        rate_hz=rate_hz,
        time_s=time_s[first:stop] - window.start_s,
        channels=(name,),
        values=values[np.newaxis, first:stop],
    )


def window_slice(window: "Window", count: int, *, rate_hz: float, start_s: float) -> slice | None:
    """Return which of so many samples are in a window, ``start <= t < stop``, or None where some of them are not there.

    ``count``: number of samples. ``rate_hz``, ``start_s``: their rate [Hz] and the time of the first [s].
    """
    first = int(np.ceil((window.start_s - start_s) * rate_hz - _EDGE_SAMPLES))
    last = int(np.ceil((window.stop_s - start_s) * rate_hz - _EDGE_SAMPLES))
    return None if first < 0 or last > count else slice(first, last)
