"""How the values of a channel came that has times of its own: what they tell of who sent them."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.recording._channel import Channel
from shaftprint.recording._levels import BLOCK_SAMPLES

# A step longer than this many periods is one in which messages were lost, longer than that many a hole.
_LOST, _HOLE = 1.5, 5.0
# Fewer changes of the value do not tell how long one is held; so many of the shortest distances may be chance.
_FEWEST_CHANGES, _BY_CHANCE = 50, 0.05
# A change of more than so many steps is no single one.
_MORE = 1.5
# Values of which more differ than this share have no steps.
_MOST_DIFFERENT = 0.5
# So many messages tell what their sender is like; more would fill the memory.
_MOST_JUDGED = 1 << 22
# Differences of two values below this share of their range are rounding.
_ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True, slots=True)
class Hole:
    """A stretch in which no message came."""

    start_s: float
    """Time of the last message before it [s]."""
    stop_s: float
    """Time of the first message after it [s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Messages:
    """What the times and values of messages tell of their sender."""

    count: int
    """Number of messages."""
    period_s: float
    """Time from one message to the next [s]."""
    jitter_s: float
    """Standard deviation of that time, holes aside [s]."""
    lost: int
    """Messages that are missing: those that would fill the steps longer than one and a half periods."""
    holes: tuple[Hole, ...]
    """Steps longer than five periods, in order of time."""
    repeated_share: float
    """Share of the values that are those of the message before."""
    value_period_s: float
    """Time for which a sender keeps a value [s]: a period, or more where new values come less often than messages."""
    step: float
    """Smallest difference of two values [unit of the channel]; 0 where the values have no steps."""

    @property
    def sentence(self) -> str:
        """What they are like, without name and full stop."""
        milli = 1000.0
        parts = [f"a message every {milli * self.period_s:.4g} ms +/- {milli * self.jitter_s:.2g} ms"]
        parts.append(f"{100.0 * self.lost / (self.count + self.lost):.2g} % lost" if self.lost else "none lost")
        if self.holes:
            longest = max(hole.stop_s - hole.start_s for hole in self.holes)
            parts.append(f"{len(self.holes)} hole{'s' if len(self.holes) > 1 else ''} of up to {longest:.3g} s")
        if self.value_period_s > _LOST * self.period_s:
            parts.append(f"each value sent again for {milli * self.value_period_s:.3g} ms")
        return ", ".join(parts)


def judge_messages(channel: Channel) -> Messages:
    """Return what the times and values of a channel tell of their sender; samples that are no numbers do not count.

    ``channel``: a channel with ``stamps``; of more than four million messages the first four are judged. Raises
    RecordingError if the file cannot be read.
    """
    time_s, values = stamped_values(channel, count=min(channel.count, _MOST_JUDGED))
    return messages_of(time_s, values, period_s=1.0 / channel.rate_hz)


def stamped_values(channel: Channel, *, count: int) -> tuple[FloatArray, FloatArray]:
    """Return so many samples of a channel with ``stamps`` from the first on: their times [s] and values, (count,) each.

    Raises RecordingError if the file cannot be read.
    """
    blocks = [(start, min(start + BLOCK_SAMPLES, count)) for start in range(0, count, BLOCK_SAMPLES)]
    time_s = np.concatenate([channel.stamps_s(*block) for block in blocks] or [np.empty(0)])
    values = np.concatenate([channel.values(*block) for block in blocks] or [np.empty(0)])
    return time_s, values


def messages_of(time_s: FloatArray, values: FloatArray, *, period_s: float) -> Messages:
    """Return what messages tell of their sender.

    ``time_s``: when they came [s], ascending, shape (messages,). ``values``: what they hold, shape (messages,); those
    that are no numbers do not count. ``period_s``: time from one to the next, as nearly as it is known [s].
    """
    is_number = np.isfinite(values)
    time_s, values = time_s[is_number], values[is_number]
    steps = np.diff(time_s)
    usual = steps <= _LOST * period_s
    # a message that comes late is no lost one: what is missing is counted in whole periods
    missing = np.rint(steps[~usual] / period_s).astype(np.int64) - 1
    holes = np.flatnonzero(steps > _HOLE * period_s)
    step = _step(values)
    return Messages(
        count=values.size,
        period_s=period_s,
        jitter_s=float(steps[usual].std()) if usual.any() else 0.0,
        lost=int(missing.clip(0).sum()),
        holes=tuple(Hole(start_s=float(time_s[one]), stop_s=float(time_s[one + 1])) for one in holes),
        repeated_share=float(np.mean(np.diff(values) == 0.0)) if steps.size else 0.0,
        value_period_s=_value_period_s(values, step, period_s),
        step=step,
    )


def _value_period_s(values: FloatArray, step: float, period_s: float) -> float:
    """Return for how long a value is kept: the shortest distances between changes, but for what chance makes of them.

    Values in steps stand still for long by themselves, and then change by one step. What changes by more has moved on
    for as long as it was kept.
    """
    changes = np.diff(values)
    places = np.flatnonzero(changes)
    is_more = np.abs(changes[places[1:]]) > _MORE * step
    distances = np.diff(places)[is_more]
    if distances.size < _FEWEST_CHANGES:
        return period_s
    shortest = float(np.quantile(distances, _BY_CHANCE, method="lower"))
    near = distances[(distances >= shortest) & (distances <= shortest + 1.0)]
    return period_s * (float(near.mean()) if shortest > 1.0 else 1.0)


def _step(values: FloatArray) -> float:
    levels = np.unique(values)
    if levels.size < 2 or levels.size > _MOST_DIFFERENT * values.size:
        return 0.0
    apart = np.diff(levels)
    return float(apart[apart > _ROUNDING * (levels[-1] - levels[0])].min())
