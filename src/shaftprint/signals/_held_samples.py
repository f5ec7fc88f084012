"""Channels that keep their last value: how often, how long, and how late that makes them.

What equal neighbours a channel has by nature is known from its other changes. Noise wider than a step of the channel
leaves a value with a chance that is no larger than that of a change by one step, so that runs end as a geometric
series does. What is slower than its steps stands still for long, and then moves on by one step. A channel that keeps
its value while the quantity goes on comes back with a jump of many steps, and keeps another value each time: crests
that are cut off are all of one.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, IntArray
from shaftprint.reasons import Reason
from shaftprint.signals.conditioning._runs import Runs
from shaftprint.units import MILLI, PERCENT

# A change by more steps than this is none to the next step.
_ONE_STEP = 1.5
# Noise makes so many runs of the length from which they count, in the whole recording.
_BY_CHANCE = 0.01
# Where nearly all changes are by one step the series would never end: of slow channels the jumps tell.
_HIGHEST_SHARE = 0.9
# What stands still for longer is a gap, or a set point that was left where it is.
_LONGEST_S = 2.0
# Of the long runs so many must end in a jump: those of a slow channel hardly ever do.
_JUMPING = 0.3
_FEWEST_RUNS = 10
# A mean lateness below is within what a gauge's latency is known to.
_LEAST_LATE_S = 0.0005
# Held steadily: so many runs are as long as the middle one to this share of it, and a few samples to a sample.
_STEADY, _ALIKE, _FEW_SAMPLES, _FEW_STEADY = 0.7, 0.25, 4, 0.9
# A hold that the vessel file states, to this share.
_AS_STATED = 0.3
_LONG_S = 0.1


@dataclass(frozen=True, kw_only=True, slots=True)
class HeldSamples:
    """What was found of a channel that keeps its last value."""

    channel: str
    """Name of the channel in the recording."""
    is_steady: bool
    """Whether it does so all the time, each value as long as the next."""
    hold_s: float
    """For how long, in the middle [s]."""
    runs: int
    """How often."""
    share: float
    """Share of its samples that only repeat the one before."""
    late_s: float
    """By how much its samples are late on average [s]."""
    samples: float
    """For how many samples, in the middle."""

    @property
    def sentence(self) -> str:
        """What was found, what it does and what to do."""
        late = f"its samples come {_duration(self.late_s)} late on average"
        if self.is_steady:
            return (
                f"Channel {self.channel} holds each value for {self.samples:.4g} samples ({_duration(self.hold_s)}), "
                f"so that {late}: log it where it is made, or at the rate at which it is sent."
            )
        return (
            f"Channel {self.channel} stands still for {PERCENT * self.share:.2g} % of the time, in {self.runs} runs "
            f"of about {_duration(self.hold_s)}: it keeps its last value now and then, as radio telemetry does, and "
            f"{late}; look for the lost samples in the link, and test again."
        )


def held_samples(runs: Runs, *, stated_s: float) -> HeldSamples | None:
    """Return how a channel keeps its last value; None where equal neighbours are what its steps and noise give.

    ``runs``: its runs of equal samples. ``stated_s``: for how long the vessel file says that each value is held [s]; 0
    where none is.
    """
    if runs.changes.size == 0 or runs.samples == 0:
        return None
    rate_hz = runs.channel.rate_hz
    short = runs.lengths <= _LONGEST_S * rate_hz
    lengths, jumping = runs.lengths[short], runs.jumps[short] > _ONE_STEP * float(runs.changes.min())
    steady = _steady_length(runs, lengths)
    if steady and jumping.mean() > _JUMPING:
        if abs(steady / rate_hz - stated_s) < _AS_STATED * stated_s:
            return None
        return _judged(runs, lengths, is_steady=True)
    longer = lengths >= max(_shortest_of_no_chance(runs), (1.0 + _AS_STATED) * stated_s * rate_hz)
    longer &= _within_ends(runs.values[short])
    if np.count_nonzero(longer) < _FEWEST_RUNS or jumping[longer].mean() <= _JUMPING:
        return None
    return _judged(runs, lengths[longer], is_steady=False)


def held_reasons(held: Mapping[str, HeldSamples]) -> Iterator[Reason]:
    """Yield what channels that keep their last value speak against, by the symbol of their quantity."""
    for name, one in held.items():
        yield Reason(kind="held samples", where=name, sentence=one.sentence)


def _judged(runs: Runs, lengths: IntArray, *, is_steady: bool) -> HeldSamples | None:
    """Return what runs that are no chance do; None where they make nothing late that a fit would see."""
    rate_hz = runs.channel.rate_hz
    # the samples of a run are 0, 1, 2, ... late
    late_s = float((0.5 * lengths * (lengths - 1.0)).sum()) / (runs.samples * rate_hz)
    if late_s < _LEAST_LATE_S:
        return None
    middle = float(np.median(lengths))
    return HeldSamples(
        channel=runs.channel.name,
        is_steady=is_steady,
        hold_s=middle / rate_hz,
        runs=lengths.size,
        share=float((lengths - 1.0).sum()) / runs.samples,
        late_s=late_s,
        samples=middle,
    )


def _steady_length(runs: Runs, lengths: IntArray) -> float:
    """Return how many samples nearly every value is held; 0 where they differ."""
    if lengths.size < _FEWEST_RUNS:
        return 0.0
    middle = float(np.median(lengths))
    few = middle < _FEW_SAMPLES
    alike = np.abs(lengths - middle) <= (0.0 if few else max(1.0, _ALIKE * middle))
    # runs of one sample are among all of them, and no long ones
    share = float(np.count_nonzero(alike)) / max(runs.count, 1)
    return middle if share >= (_FEW_STEADY if few else _STEADY) else 0.0


def _within_ends(values: FloatArray) -> BoolArray:
    """Return which values are neither the lowest nor the highest."""
    return np.asarray((values > values.min(initial=np.inf)) & (values < values.max(initial=-np.inf)))


def _shortest_of_no_chance(runs: Runs) -> float:
    """Return from which length a run is none of noise and steps [samples]."""
    one_step = runs.changes <= _ONE_STEP * runs.changes.min()
    stays = float(np.clip(one_step.mean(), 1.0 / max(runs.count, 2), _HIGHEST_SHARE))
    return 1.0 + math.log(_BY_CHANCE / max(runs.count, 1)) / math.log(stays)


def _duration(seconds: float) -> str:
    return f"{seconds:.2g} s" if seconds >= _LONG_S else f"{MILLI * seconds:.2g} ms"
