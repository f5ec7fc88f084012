"""Rising edges of a pulse channel, between samples: hysteresis and linear interpolation."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, IntArray
from shaftprint.errors import SignalError
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
    before = _Before(is_armed=False, sample=np.inf, crossing=0.0)
    positions = []
    first = 0
    for block in samples:
        if block.size:
            upright: Counts = block if sign > 0.0 else -block.astype(np.float64)
            edges, before = _scanned(upright, first, (arm, middle, fire), before)
            positions.append(edges)
        first += block.size
    return np.concatenate(positions) if positions else np.empty(0)


class _Before(NamedTuple):
    """What the samples before a block leave."""

    is_armed: bool
    """Whether the channel has been low, and not high since."""
    sample: float
    """The last one."""
    crossing: float
    """Where the channel last crossed the middle upwards [samples]."""


def _scanned(
    counts: Counts, first: int, levels: tuple[float, float, float], before: _Before
) -> tuple[FloatArray, _Before]:
    """Return the edges that begin in one block, and what it leaves to the next.

    ``first``: number of its first sample. ``levels``: where a pulse is armed, crosses the middle, and fires.
    """
    arm, middle, fire = levels
    is_low, is_above, is_high = _at_most(counts, arm), ~_below(counts, middle), ~_below(counts, fire)
    missing = np.empty(0, dtype=np.int64)
    if counts.dtype != np.int16:
        is_number = ~np.isnan(counts)
        is_above, is_high, missing = is_above & is_number, is_high & is_number, np.flatnonzero(~is_number)
    highs = np.flatnonzero(_begins(is_high))
    # the place of the last low sample before each pulse, and before the end; -1 where it was in an earlier block
    ends = np.append(highs, counts.size)
    low = _last_before(ends, np.flatnonzero(_begins(is_low[::-1])[::-1]), -1 if before.is_armed else -2)
    # a pulse that began before a gap must not be timed behind it
    is_armed = low > np.maximum(np.append(-2, highs), _last_before(ends, missing, -2))
    crossed = np.flatnonzero(_begins(is_above))
    previous = np.where(crossed > 0, counts[crossed - 1], before.sample).astype(np.float64)
    crossed, previous = crossed[previous < middle], previous[previous < middle]
    rise = counts[crossed].astype(np.float64) - previous
    crossing = np.append(before.crossing, first + crossed - 1 + (middle - previous) / rise)
    # a pulse may cross the middle and fire within one sample
    edges = crossing[np.searchsorted(crossed, highs[is_armed[:-1]], side="right")]
    return edges, _Before(is_armed=bool(is_armed[-1]), sample=float(counts[-1]), crossing=float(crossing[-1]))


def _at_most(counts: Counts, level: float) -> BoolArray:
    """Return where counts are at most a level; whole numbers are compared as such, many times faster."""
    return np.asarray(counts <= (np.int16(np.floor(level)) if counts.dtype == np.int16 else level))


def _below(counts: Counts, level: float) -> BoolArray:
    return np.asarray(counts < (np.int16(np.ceil(level)) if counts.dtype == np.int16 else level))


def _begins(mask: BoolArray) -> BoolArray:
    """Return where runs of true values begin."""
    begins = mask.copy()
    begins[1:] &= ~mask[:-1]
    return begins


def _last_before(places: IntArray, of: IntArray, none: int) -> IntArray:
    """Return the last of some places before each of others, all ascending; ``none`` where there is none."""
    return np.append(none, of)[np.searchsorted(of, places)]


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
