"""The clock on which the channels are brought together."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from threading import Lock
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.signals._channels import DEFAULT_BLOCK_SAMPLES, Advance
from shaftprint.signals.conditioning._decimate import SampleGrid

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel

Mode: TypeAlias = Literal["shaftprint", "thesis"]
"""Whether each step is done shaftprint's way or the thesis' way."""

_FEWEST_BLOCK_SAMPLES = 64


@dataclass(frozen=True, kw_only=True, slots=True)
class Clock:
    """The common grid, and how the channels are read on it."""

    start_s: float
    """Time of the first sample [s]."""
    rate_hz: float
    """Samples a second [Hz]."""
    count: int
    """Number of samples."""
    mode: Mode
    """How each step is done."""
    chunk_s: float | None
    """How much of a channel is read at a time [s]."""
    advance: Advance
    """Is told how many samples have been read."""

    @property
    def time_s(self) -> FloatArray:
        """Time of each sample [s], shape (count,)."""
        return self.start_s + np.arange(self.count) / self.rate_hz

    def latency_s(self, stated_s: float) -> float:
        """Return how much of a stated latency is taken off [s]: the thesis' way leaves it in."""
        return 0.0 if self.mode == "thesis" else stated_s

    def grid(self, channel: "Channel", latency_s: float = 0.0) -> SampleGrid:
        """Return the grid in samples of a channel that shows everything late by a latency [s]."""
        return SampleGrid(
            first=(self.start_s + latency_s - channel.start_s) * channel.rate_hz,
            step=channel.rate_hz / self.rate_hz,
            count=self.count,
        )

    def block_samples(self, channel: "Channel") -> int:
        """Return how many samples of a channel are read at a time."""
        if self.chunk_s is None:
            return DEFAULT_BLOCK_SAMPLES
        return max(round(self.chunk_s * channel.rate_hz), _FEWEST_BLOCK_SAMPLES)


def common_clock(
    channels: "Sequence[Channel]",
    *,
    mode: Mode,
    rate_hz: float,
    chunk_s: float | None,
    progress: Callable[[float], None] | None,
) -> Clock:
    """Return the grid that all channels of the logger cover, from the latest start to the earliest end."""
    start_s = max(channel.start_s for channel in channels)
    stop_s = min(channel.start_s + channel.duration_s for channel in channels)
    return Clock(
        start_s=start_s,
        rate_hz=rate_hz,
        count=max(int((stop_s - start_s) * rate_hz + 1e-6), 0),
        mode=mode,
        chunk_s=chunk_s,
        advance=_meter(sum(channel.count for channel in channels), progress),
    )


def clock_of(channel: "Channel", rate_hz: float | None = None) -> Clock:
    """Return the grid of one channel alone, at its own rate where no other is given."""
    rate = channel.rate_hz if rate_hz is None else rate_hz
    return Clock(
        start_s=channel.start_s,
        rate_hz=rate,
        count=int(channel.duration_s * rate),
        mode="shaftprint",
        chunk_s=None,
        advance=lambda samples: None,
    )


def _meter(total: int, progress: Callable[[float], None] | None) -> Advance:
    """Return a counter of samples that any thread may use."""
    done = 0
    lock = Lock()

    def advance(samples: int) -> None:
        nonlocal done
        with lock:
            done += samples
            if progress is not None:
                progress(done / total)

    return advance
