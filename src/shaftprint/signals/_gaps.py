"""Where a recording has no values, and which windows that costs.

A gap is a stretch in which a channel holds no number, no pulse or a value that stands still, or a place where its clock
jumps. The signals go on through it as a straight line, so that a filter or a mean over the whole recording does not
break, but nothing may be measured there. Whatever uses a window of the recording asks ``Coverage.missing`` first.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Self

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, runs_of
from shaftprint.signals._channels import time_of

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel

# More gaps than this are listed as one.
_MOST_LISTED = 8


@dataclass(frozen=True, kw_only=True, slots=True)
class Gap:
    """One stretch in which a channel says nothing."""

    channel: str
    """Name of the channel in the recording."""
    start_s: float
    """When it begins, in seconds of the recording."""
    stop_s: float
    """When it ends [s]; the same where the clock jumps and nothing is missing."""
    reason: str
    """What is wrong, as it follows the name of the channel: ``"has no values"``."""
    reach_s: float = 0.0
    """How far beyond both ends it reaches through filter or pulses [s]."""

    @property
    def first_s(self) -> float:
        """Time from which the signal is not to be used [s]."""
        return self.start_s - self.reach_s

    @property
    def last_s(self) -> float:
        """Time until which the signal is not to be used [s]."""
        return self.stop_s + self.reach_s

    @property
    def sentence(self) -> str:
        """What is wrong and when, without a full stop."""
        if self.stop_s - self.start_s < 0.001:
            return f"channel {self.channel} {self.reason} at {self.start_s:.2f} s"
        return f"channel {self.channel} {self.reason} from {self.start_s:.2f} to {self.stop_s:.2f} s"

    def earlier(self, latency_s: float) -> "Gap":
        """Return the gap of what a channel shows that is so late [s]: it lies so much earlier."""
        return replace(self, start_s=self.start_s - latency_s, stop_s=self.stop_s - latency_s)


@dataclass(frozen=True, kw_only=True, slots=True)
class Coverage:
    """What a recording covers: its first and last second, and the gaps between."""

    start_s: float = -math.inf
    """Time of its first sample [s]."""
    stop_s: float = math.inf
    """Time after its last sample [s]."""
    step_s: float = 0.0
    """Time from one sample to the next [s]: a window may begin or end so much outside by rounding."""
    gaps: tuple[Gap, ...] = ()
    """The gaps, in order of time."""

    @classmethod
    def of_grid(cls, *, start_s: float, samples: int, rate_hz: float, gaps: tuple[Gap, ...]) -> Self:
        """Return what a uniform time grid covers."""
        return cls(start_s=start_s, stop_s=start_s + samples / rate_hz, step_s=1.0 / rate_hz, gaps=gaps)

    def missing(self, start_s: float, stop_s: float, *, channel: str | None = None) -> str:
        """Say why a window cannot be used; nothing where it can.

        ``start_s``, ``stop_s``: the window [s]. ``channel``: the only channel whose gaps count; by default those of all
        count. Returns the reason, to follow a colon and without a full stop; empty where the window is whole.
        """
        if start_s < self.start_s - self.step_s or stop_s > self.stop_s + self.step_s:
            return f"the recording lasts from {self.start_s:.1f} to {self.stop_s:.1f} s"
        touching = [gap for gap in self.touching(start_s, stop_s) if channel in (None, gap.channel)]
        if not touching:
            return ""
        others = len({gap.channel for gap in touching}) - 1
        among = f", as {others} more" if others else ""
        return touching[0].sentence + among

    def touching(self, start_s: float, stop_s: float) -> list[Gap]:
        """Return the gaps that reach into a window [s]."""
        return [gap for gap in self.gaps if gap.first_s < stop_s and gap.last_s > start_s]

    def lost(self, time_s: FloatArray, *, channel: str | None = None) -> BoolArray:
        """Return which instants lie in a gap, shape of ``time_s``.

        ``time_s``: instants in seconds of the recording. ``channel``: the only channel whose gaps count; by default
        those of all count.
        """
        is_lost = np.zeros(time_s.shape, dtype=np.bool_)
        for gap in self.gaps:
            if channel in (None, gap.channel):
                is_lost |= (time_s > gap.first_s) & (time_s < gap.last_s)
        return is_lost


EVERYTHING = Coverage()
"""All times, without a gap."""


def clock_gaps(channel: "Channel") -> list[Gap]:
    """Return the places where the clock of a channel jumps: nothing is missing, but no window may hold one."""
    return [
        Gap(
            channel=channel.name,
            start_s=time_of(channel, jump.sample),
            stop_s=time_of(channel, jump.sample),
            reason=f"has a clock that jumps by {jump.jump_s:.4g} s",
        )
        for jump in channel.clock_jumps
    ]


def gaps_of_missing(channel: "Channel", missing: BoolArray, *, longest: float, reach_s: float = 0.0) -> list[Gap]:
    """Return the runs of missing samples over which no line is to be trusted.

    ``channel``: what has no values. ``missing``: which of its samples, shape (samples,). ``longest``: samples of the
    longest run that is no gap. ``reach_s``: how far beyond both ends a gap reaches [s].
    """
    return [
        Gap(
            channel=channel.name,
            start_s=time_of(channel, first),
            stop_s=time_of(channel, stop),
            reason="has no values",
            reach_s=reach_s,
        )
        for first, stop in runs_of(missing)
        if stop - first > longest
    ]


def merged(gaps: Iterable[Gap], begin_s: float, end_s: float) -> list[tuple[float, float]]:
    """Return the stretches that gaps take out of a window, without overlap, in order of time [s]."""
    stretches: list[tuple[float, float]] = []
    for gap in sorted(gaps, key=lambda gap: gap.first_s):
        first, last = max(gap.first_s, begin_s), min(gap.last_s, end_s)
        if first >= last:
            continue
        if stretches and first <= stretches[-1][1]:
            stretches[-1] = (stretches[-1][0], max(stretches[-1][1], last))
        else:
            stretches.append((first, last))
    return stretches


def joined(values: FloatArray) -> FloatArray:
    """Return values with straight lines in place of those that are not numbers, shape of ``values``."""
    indices = np.flatnonzero(np.isfinite(values))
    if indices.size in (0, values.size):
        return values
    return np.interp(np.arange(values.size), indices, values[indices])


def bridge(values: FloatArray, gaps: Iterable[Gap], *, start_s: float, rate_hz: float) -> None:
    """Put straight lines through the gaps of a signal on the grid, in place; at an end its last value goes on.

    ``values``: the signal, shape (samples,). ``gaps``: its gaps. ``start_s``, ``rate_hz``: the grid.
    """
    for first_s, last_s in merged(gaps, start_s - 1.0, start_s + values.size / rate_hz + 1.0):
        first = max(math.ceil((first_s - start_s) * rate_hz), 0)
        stop = min(math.floor((last_s - start_s) * rate_hz) + 1, values.size)
        if first == 0 and stop == values.size:
            values[:] = 0.0
            continue
        before = values[first - 1] if first else values[stop]
        after = values[stop] if stop < values.size else before
        values[first:stop] = np.linspace(before, after, stop - first + 2)[1:-1]


def within(gap: Gap, others: Sequence[Gap]) -> bool:
    """Return whether gaps of other channels take out all that one gap does, but for its reach."""
    return any(other.first_s <= gap.start_s and gap.stop_s <= other.last_s for other in others)


def gap_findings(gaps: Sequence[Gap], windows: Sequence[tuple[str, float, float]]) -> tuple[str, ...]:
    """Return one sentence for each gap with the names of the windows that it costs.

    ``gaps``: in order of time. ``windows``: name, start and stop [s] of everything that is measured.
    """
    groups = list(_side_by_side(gaps))
    if len(groups) > _MOST_LISTED:
        return tuple(_together(channel, gaps, windows) for channel in sorted({gap.channel for gap in gaps}))
    return tuple(f"{_named(group)}; {_cost(group, windows)}" for group in groups)


def _side_by_side(gaps: Sequence[Gap]) -> Iterator[list[Gap]]:
    """Yield gaps of several channels that overlap together."""
    group: list[Gap] = []
    for gap in sorted(gaps, key=lambda gap: gap.first_s):
        if group and gap.first_s > max(other.last_s for other in group):
            yield group
            group = []
        group.append(gap)
    if group:
        yield group


def _named(group: Sequence[Gap]) -> str:
    longest = max(group, key=lambda gap: gap.stop_s - gap.start_s)
    others = sorted({gap.channel for gap in group} - {longest.channel})
    return longest.sentence + (f", likewise {', '.join(others)}" if others else "")


def _together(channel: str, gaps: Sequence[Gap], windows: Sequence[tuple[str, float, float]]) -> str:
    chosen = [gap for gap in gaps if gap.channel == channel]
    seconds = sum(gap.stop_s - gap.start_s for gap in chosen)
    first, last = min(gap.start_s for gap in chosen), max(gap.stop_s for gap in chosen)
    one = replace(chosen[0], start_s=first, stop_s=last).sentence
    return f"{one} in {len(chosen)} places, {seconds:.2f} s together; {_cost(chosen, windows)}"


def _cost(gaps: Sequence[Gap], windows: Sequence[tuple[str, float, float]]) -> str:
    names = [name for name, start, stop in windows if any(gap.first_s < stop and gap.last_s > start for gap in gaps)]
    return f"left out for that: {', '.join(names)}" if names else "no test is touched"
