"""Rising edges of a pulse channel, between samples: hysteresis and linear interpolation."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import SignalError
from shaftprint.kernels._compiled import compiled
from shaftprint.signals._channels import Counts, spots

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel

# Share of the way from the low to the high level; a pulse must pass all three.
_ARM, _EDGE, _FIRE = 0.3, 0.5, 0.7

# The levels must stand apart by this many times the noise on them.
_LEAST_SEPARATION = 8.0

# What has no levels but swings evenly, as a magnetic pick-up does: of its swings the long ones take at most so many
# times as long as the short ones. Noise of any colour swings less evenly.
_EVEN, _FEWEST_SWINGS = 2.0, 8
# Of the second difference of white noise: its root is this over the standard deviation, its median this over the root.
_SECOND_DIFFERENCE, _MEDIAN = 6.0**0.5, 0.6745


@dataclass(frozen=True, kw_only=True, slots=True)
class PulseLevels:
    """The two levels between which a pulse channel jumps, in counts, and how it does so."""

    low: float
    """Level between pulses [counts]; above ``high`` where the falling edge marks the strip."""
    high: float
    """Level during a pulse [counts]."""
    noise: float
    """Standard deviation of the noise on the levels [counts]."""
    duty: float
    """Share of the time that the channel is nearer to ``high``."""


def pulse_levels(channel: "Channel", *, edge: str = "rising", uneven_share: float = 0.0) -> PulseLevels:
    """Return the levels of a pulse channel, found from stretches all over the recording.

    ``channel``: a channel of pulses. ``edge``: ``"rising"`` or ``"falling"``: which edge marks the angle of the strip.
    ``uneven_share``: share of the intervals between pulses that are longer or shorter than the others: beside a wheel's
    gaps. Raises SignalError if there are neither two levels that stand clear of the noise nor even swings: the channel
    is dead or saturated.
    """
    stretches = spots(channel)
    counts = np.concatenate(stretches).astype(np.float64)
    low, high, noise, above = _two_levels(counts)
    if high - low <= _LEAST_SEPARATION * noise and _swings_evenly(stretches, low, high, uneven_share):
        noise = float(np.median(np.abs(np.diff(counts, 2)))) / (_MEDIAN * _SECOND_DIFFERENCE)
    if high - low <= _LEAST_SEPARATION * noise or high == low:
        raise SignalError(
            f"channel {channel.name}: expected pulses between two levels, found the channel dead "
            f"or saturated near {channel.scale * low + channel.offset:.4g} {channel.unit} "
            f"from {channel.start_s:.1f} s on (noise {abs(channel.scale) * noise:.2g} "
            f"{channel.unit}); check the pick-up and its cable."
        )
    # a negative scale turns the pulses of the counts upside down
    if (edge == "falling") != (channel.scale < 0.0):
        return PulseLevels(low=high, high=low, noise=noise, duty=1.0 - above)
    return PulseLevels(low=low, high=high, noise=noise, duty=above)


def find_edges(samples: Iterable[Counts], levels: PulseLevels) -> FloatArray:
    """Return where the pulses begin, in samples since the first, shape (edges,).

    An edge lies where the straight line between two samples crosses the middle of the levels. It
    counts once the channel has come from below 30 % to above 70 % of the way.

    ``samples``: consecutive blocks of raw counts, nan where there are none; the result is the same for any cut into
    blocks. ``levels``: from ``pulse_levels``.
    """
    sign = 1.0 if levels.high > levels.low else -1.0
    low, high = sign * levels.low, sign * levels.high
    arm, middle, fire = (low + share * (high - low) for share in (_ARM, _EDGE, _FIRE))
    state = np.array([0.0, np.inf, 0.0])
    positions = []
    first = 0
    for block in samples:
        edges = np.empty(block.size // 2 + 1)
        count = scan_edges(block, first, sign, arm, middle, fire, state, edges)
        positions.append(edges[:count].copy())
        first += block.size
    return np.concatenate(positions) if positions else np.empty(0)


@compiled(nogil=True)
def scan_edges(  # type: ignore[no-untyped-def]
    counts, first: int, sign: float, arm: float, middle: float, fire: float, state, edges
) -> int:
    """Write the edges of one block to ``edges`` and return their number.

    ``state`` is carried from block to block: armed or not, the last sample, and the last crossing
    of the middle.
    """
    armed = state[0] != 0.0
    previous = state[1]
    crossing = state[2]
    count = 0
    for k in range(counts.size):
        value = sign * counts[k]
        if armed:
            if previous < middle <= value:
                crossing = first + k - 1 + (middle - previous) / (value - previous)
            if value >= fire:
                edges[count] = crossing
                count += 1
                armed = False
            elif np.isnan(value):
                # a pulse that began before a gap must not be timed behind it
                armed = False
        elif value <= arm:
            armed = True
        previous = value
    state[0] = 1.0 if armed else 0.0
    state[1] = previous
    state[2] = crossing
    return count


def _swings_evenly(stretches: Sequence[Counts], low: float, high: float, uneven_share: float) -> bool:
    """Return whether the channel goes up and down through its middle at a pace that hardly changes in any stretch."""
    levels = PulseLevels(low=low, high=high, noise=0.0, duty=0.5)
    paces = [np.diff(find_edges([stretch], levels)) for stretch in stretches]
    return all(
        pace.size >= _FEWEST_SWINGS
        and np.quantile(pace, 0.95 - uneven_share) <= _EVEN * np.quantile(pace, 0.05 + uneven_share)
        for pace in paces
    )


def _two_levels(counts: FloatArray) -> tuple[float, float, float, float]:
    """Return low level, high level, noise and the share of samples above the middle."""
    middle = 0.5 * (counts.min() + counts.max())
    low = high = middle
    above = np.zeros(counts.size, dtype=np.bool_)
    for _ in range(4):
        above = counts > middle
        if above.all() or not above.any():
            return middle, middle, 0.0, float(above.mean())
        low, high = float(np.median(counts[~above])), float(np.median(counts[above]))
        middle = 0.5 * (low + high)
    larger = above if above.mean() > 0.5 else ~above
    deviation = np.abs(counts[larger] - np.median(counts[larger]))
    # three quarters of the samples: on the level, not on a flank
    noise = float(np.quantile(deviation, 0.75)) / 1.15
    return low, high, noise, float(above.mean())
