"""Judging while it runs: each line from its whole periods as they come."""

import math
from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.campaign._excitation import Excitation
from shaftprint.campaign._excitations import Sine
from shaftprint.campaign._leg import Leg
from shaftprint.live._block import Block, LiveChannel
from shaftprint.live._judgement import LineJudgement
from shaftprint.live._timetable import period_s

# A time that is printed and read again may be off a sample by rounding.
_ROUNDING = 1e-6


class LineJudge:
    """Sines of all channels over the whole periods of one test; memory does not grow with its length."""

    def __init__(
        self, test: Excitation | Leg, *, zero_s: float, channels: Sequence[LiveChannel], set_point: str
    ) -> None:
        """Begin to judge a test.

        ``zero_s``: second 0 of the campaign by the counterpart's clock [s]. ``channels``: those that go on evenly with
        the set point. ``set_point``: name of the set point's channel, over which responses are.
        """
        self._hertz = _frequencies(test)
        self._set_point = set_point
        self._outputs = tuple(one.name for one in channels if one.name != set_point)
        self._channels = {one.name: one for one in channels}
        self._begin_s = zero_s + getattr(test, "settled_s", test.start_s)
        self._period_s = period_s(test) or math.inf
        self._rate_hz = next(iter(self._channels.values())).rate_hz
        self._periods: list[ComplexArray] = []
        self._current = 0
        self._open = _Sums(len(self._channels), len(self._hertz))
        self.spoilt = 0
        """Periods that are left out because samples of them were lost or were no numbers."""
        self.most_periods = int(getattr(test, "periods", 0))
        """Whole periods that the test has."""

    @property
    def periods(self) -> int:
        """Whole periods that have come and count."""
        return len(self._periods)

    def take(self, block: Block) -> bool:
        """Add a block; return whether it ended a period."""
        if not self._hertz or self._current >= self.most_periods:
            return False
        samples = np.stack([block.values(one) for one in self._channels.values()])
        time_s: FloatArray = block.source_s - self._begin_s + np.arange(samples.shape[1]) / self._rate_hz
        number = np.floor((time_s + _ROUNDING / self._rate_hz) / self._period_s)
        before = self._current
        for period in np.unique(number[(number >= 0) & (number < self.most_periods)]).tolist():
            inside = number == period
            self._end_before(int(period))
            self._open.add(samples[:, inside], time_s[inside], self._hertz.values())
        if time_s.size:
            after_s = float(time_s[-1]) + (1.0 + _ROUNDING) / self._rate_hz
            self._end_before(min(self.most_periods, math.floor(after_s / self._period_s)))
        return self._current > before

    def _end_before(self, period: int) -> None:
        """Close all periods before one."""
        while self._current < period:
            whole = self._open.count >= math.floor(self._period_s * self._rate_hz)
            lines = self._open.lines()
            if whole and np.isfinite(lines).all():
                self._periods.append(lines)
            else:
                self.spoilt += 1
            self._open = _Sums(len(self._channels), len(self._hertz))
            self._current += 1

    def judgements(self) -> tuple[LineJudgement, ...]:
        """Return what is known of each line so far; none before the first whole period."""
        if not self._periods:
            return ()
        sums = np.stack(self._periods)
        names = list(self._channels)
        reference = names.index(self._set_point)
        others = [names.index(one) for one in self._outputs]
        mean = sums.mean(axis=0)
        found = []
        for place, (name, hertz) in enumerate(self._hertz.items()):
            response = mean[others, place] / mean[reference, place]
            # what differs from period to period beyond what the set point does
            scatter = sums[:, others, place] - response * sums[:, reference, place][:, None]
            count = len(self._periods)
            variance = (np.abs(scatter) ** 2).sum(axis=0) / (2.0 * max(count - 1, 1) * count)
            std = np.sqrt(variance) / abs(mean[reference, place])
            found.append(
                LineJudgement(
                    line=name,
                    frequency_hz=hertz,
                    periods=count,
                    outputs=self._outputs,
                    response=response,
                    std=std if count > 1 else np.full(len(others), math.nan),
                )
            )
        return tuple(found)


class _Sums:
    """What of one period has come: sums of all channels, and with the turning of each line."""

    def __init__(self, channels: int, lines: int) -> None:
        self.count = 0
        self._plain = np.zeros(channels)
        self._turned = np.zeros((channels, lines), dtype=np.complex128)
        self._turns = np.zeros(lines, dtype=np.complex128)

    def add(self, samples: FloatArray, time_s: FloatArray, hertz: Iterable[float]) -> None:
        """Add samples, shape (channels, samples)."""
        turns = np.exp(-2j * math.pi * np.outer(time_s, list(hertz)))
        self.count += time_s.size
        self._plain += samples.sum(axis=1)
        self._turned += samples @ turns
        self._turns += turns.sum(axis=0)

    def lines(self) -> ComplexArray:
        """Return the amplitudes of the lines, shape (channels, lines).

        The mean is taken out: a period is no whole number of samples, so that it would not vanish by itself.
        """
        if not self.count:
            return self._turned * math.nan
        moving: ComplexArray = self._turned - np.outer(self._plain / self.count, self._turns)
        return moving * (2.0 / self.count)


def _frequencies(test: Excitation | Leg) -> Mapping[str, float]:
    """Return the frequency [Hz] of each line by its name."""
    if isinstance(test, Sine):
        return {test.name: test.frequency_hz}
    if isinstance(test, Leg):
        return {f"{test.name}/{harmonic}": harmonic / test.length_of_period_s for harmonic in test.lines}
    return {}
