"""When and how the recording goes wrong: the schedule of faults, drawn before the voyage."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.tug._noise import Noise

# Nothing fails while the logger is still being watched.
_FIRST_S = 5.0


@dataclass(frozen=True, kw_only=True, slots=True)
class Fault:
    """One fault that was put into a recording."""

    channel: str
    """Name of the channel."""
    kind: str
    """``"missing pulse"``, ``"doubled pulse"``, ``"spike"``, ``"hold"`` or ``"rail"``."""
    time_s: float
    """When it begins; for pulses when the edge passes or would have passed [s]."""
    duration_s: float = 0.0
    """How long it lasts [s]; 0 for a pulse."""


class Faultless:
    """A sensor whose recording nothing spoils: an instrument of its own, or a CAN bus, which sends a message again."""

    def faults(self) -> list[Fault]:
        """Return no fault."""
        return []


class Spikes(NamedTuple):
    """Single samples that are replaced by nonsense."""

    sample: IntArray
    """Sample numbers, ascending, shape (spikes,)."""
    size: FloatArray
    """Value between -1 and 1, as a fraction of the range, shape (spikes,)."""


class Dropouts(NamedTuple):
    """Stretches in which the telemetry passes nothing on."""

    start: IntArray
    """First sample of each stretch, ascending, shape (dropouts,)."""
    stop: IntArray
    """First sample after it, shape (dropouts,)."""
    holds: IntArray
    """1 where the last value is repeated, 0 where the channel goes to its negative rail, shape (dropouts,)."""


def draw_times(interval_s: float, duration_s: float, rng: np.random.Generator) -> FloatArray:
    """Return random times with a mean interval [s], ascending, shape (times,); none for an interval of 0."""
    if interval_s == 0.0:
        return np.empty(0)
    times = []
    time = _FIRST_S + rng.exponential(interval_s)
    while time < duration_s:
        times.append(time)
        time += rng.exponential(interval_s)
    return np.array(times)


def draw_spikes(interval_s: float, duration_s: float, rate_hz: float, rng: np.random.Generator) -> Spikes:
    """Draw spikes of at least six tenths of the range."""
    times = draw_times(interval_s, duration_s, rng)
    size = rng.choice([-1.0, 1.0], times.size) * rng.uniform(0.6, 1.0, times.size)
    return Spikes(sample=np.floor(times * rate_hz).astype(np.int64), size=size)


def draw_dropouts(noise: Noise, duration_s: float, rate_hz: float, rng: np.random.Generator) -> Dropouts:
    """Draw dropouts of the torque telemetry, half of them held and half at the rail."""
    times = draw_times(noise.torque_dropout_interval_s, duration_s, rng)
    longest = noise.torque_dropout_longest_s
    length_s = rng.uniform(longest / 40.0, longest, times.size)
    start = np.floor(times * rate_hz).astype(np.int64)
    stop = start + np.maximum(1, np.round(length_s * rate_hz)).astype(np.int64)
    # one that begins before another has ended cannot be told from it
    ended = np.maximum.accumulate(np.concatenate(([0], stop)))[:-1]
    apart = start >= ended
    holds = rng.integers(0, 2, times.size)
    return Dropouts(start=start[apart], stop=stop[apart], holds=holds[apart])
