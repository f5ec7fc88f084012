"""Whether the set point was recorded with one amplitude from the first to the last minute of a test.

The campaign file says with which amplitude each line was put out, and the recorded one is known to a thousandth. An
amplifier or a range that is changed in the middle makes all lines from then on larger by one factor, and all responses
smaller. Two things are held against such a change, each with the
scatter that it shows itself, so that what was set by hand is none:

- within a line, what its stretches show (in a leg its periods), whatever the line as a whole is;
- from line to line, the recorded over the asked amplitude. A set point that is held or filtered falls smoothly with the
  frequency, and between legs, which hold the same lines, not at all. Values that are sent some time after they were
  taken scatter in proportion to the frequency; how much, the stretches within the lines show. What the steps of
  messages leave in a sine is the same in all of its stretches.

The stretch in which the change lies is left out: it is of neither amplitude.

A staircase ahead of the sines is not looked at: they get their scale from the speed (``_dc_scale.py``).

Generator and channel look alike here. Where the generator put out more, the responses are right.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.reasons import Reason
from shaftprint.signals._gaps import EVERYTHING, Coverage
from shaftprint.signals.levels._leg_periods import leg_periods
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.campaign._excitations import Sine
    from shaftprint.campaign._leg import Leg

# A window is looked at in so many stretches of whole periods.
_STRETCHES = 6
# Legs are compared by their lines below this [Hz]: faster ones are bent by what holds or filters the set point.
_SLOW_HZ = 1.0
# Scatter that is expected before any is seen, and how many values that counts for: of stretches, sines, legs.
_OF_STRETCHES, _OF_SINES, _OF_LEGS, _COUNTS = 1e-3, 1e-3, 2e-4, 4
# Fewest stretches of a line, and lines, that tell how the scatter grows with the frequency; the least scatter; corners
# that are tried; median of the square of a normal number.
_FEWEST_TO_SCATTER, _FEWEST_LINES, _LEAST_SCATTER, _TRIED, _MEDIAN_OF_SQUARE = 4, 4, 1e-5, 30, 0.455
# Highest frequency over the corners of filters of first order whose mixtures resemble what a set point passes.
_CORNERS = (0.8, 3.0)
# Length of the stretches on either side of a change [s]: what is shorter is a disturbance.
_LEAST_BESIDE_S = 20.0
# Stretches of a line in which a change lies, on either side of it.
_FEWEST_BESIDE = 2
# A stretch that ends so near to the end of its sine may hold less than the sine [s].
_EDGE_S = 0.5
# Share of a stretch in which a change may pass unseen.
_UNSEEN = 0.4
# Twice the gain in log-likelihood that a set point without a change does not reach, and what changes are looked for: a
# larger one is no change of gain, and has its remark at each line.
_THRESHOLD, _LEAST, _MOST = 25.0, 0.006, 0.3
# A set point that moves by less than this share of what was asked is another fault.
_SILENT = 0.1
# Within so much of twice the best log-likelihood lies the time of a change in 95 of 100.
_AS_GOOD = 3.84
_ROUNDS = 8

Kind: TypeAlias = Literal["sine", "leg"]
"""What stretches are of."""
_Row: TypeAlias = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Amplitudes:
    """Recorded over asked amplitude of the set point in stretches of its lines, in order of time."""

    start_s: FloatArray
    """When each stretch begins [s], shape (stretches,)."""
    stop_s: FloatArray
    """When it ends [s], shape (stretches,)."""
    log_ratio: FloatArray
    """Logarithm of the recorded over the asked amplitude, shape (stretches,)."""
    test: IntArray
    """Which test it is of, ascending, shape (stretches,)."""
    kinds: tuple[Kind, ...]
    """What each test is."""
    frequency_hz: FloatArray
    """Frequency of each test [Hz]; 0 where it has none of its own, shape (tests,)."""
    rounding: FloatArray
    """Standard deviation of what the steps of messages leave in the logarithm of each test, shape (tests,)."""


@dataclass(frozen=True, kw_only=True, slots=True)
class AmplitudeChange:
    """A change of the amplitude of the set point."""

    likelihood: float
    """Twice the gain in log-likelihood over no change."""
    size: float
    """Relative change [-]."""
    between_s: tuple[float, float]
    """When it was, in 95 of 100 [s]."""


def expect_steady_set_point(
    campaign: "Campaign",
    set_point_v: FloatArray,
    *,
    rate_hz: float,
    start_s: float,
    channel: str,
    coverage: Coverage = EVERYTHING,
    rounding: Callable[["Sine"], float] | None = None,
) -> tuple[Reason, ...]:
    """Return a reason where the amplitude of the set point changes within the tests.

    ``campaign``: what was asked of the ship; its sines and legs are used. ``set_point_v``: the set point on the grid
    [V], shape (samples,). ``rate_hz``, ``start_s``: the grid. ``channel``: name of its channel. ``coverage``: what the
    recording covers; stretches in a gap are left out. ``rounding``: standard deviation of what the steps of messages
    leave in the amplitude of a sine, as a share of it; none where the set point is not sent in steps.
    """
    amplitudes = amplitudes_of(
        campaign, set_point_v, rate_hz=rate_hz, start_s=start_s, coverage=coverage, rounding=rounding
    )
    change = change_of(amplitudes)
    if change is None:
        return ()
    first_s, last_s = change.between_s
    percent = PERCENT * change.size
    return (
        Reason(
            kind="set-point shape",
            where=channel,
            sentence=(
                f"The amplitude of the set point in channel {channel} is {abs(percent):.1f} % "
                f"{'higher' if percent > 0.0 else 'lower'} from {0.5 * (first_s + last_s):.0f} s on (between "
                f"{first_s:.0f} and {last_s:.0f} s) than before, over what the campaign file asks: check its amplifier "
                "and the range of the logger, and whether the generator was set anew; identify the tests before or "
                "after it alone, with a campaign file that names no others."
            ),
        ),
    )


def amplitudes_of(
    campaign: "Campaign",
    set_point_v: FloatArray,
    *,
    rate_hz: float,
    start_s: float,
    coverage: Coverage,
    rounding: Callable[["Sine"], float] | None,
) -> Amplitudes:
    """Return the amplitude of every line of a campaign, stretch by stretch.

    ``campaign``, ``set_point_v``, ``rate_hz``, ``start_s``, ``coverage``, ``rounding``: as of
    ``expect_steady_set_point``.
    """
    cut = _Cut(
        values=set_point_v,
        rate_hz=rate_hz,
        start_s=start_s,
        stop_s=start_s + set_point_v.size / rate_hz,
        coverage=coverage,
    )
    left = (lambda _: 0.0) if rounding is None else rounding
    tests: list[tuple[float, Kind, float, float, list[_Row]]] = [
        *((sine.start_s, "sine", sine.frequency_hz, left(sine), cut.of_sine(sine)) for sine in campaign.sines),
        *((leg.start_s, "leg", 0.0, 0.0, cut.of_leg(leg)) for leg in campaign.legs),
    ]
    heard = [
        (kind, hertz, share, [row for row in rows if row[2] > _SILENT])
        for _, kind, hertz, share, rows in sorted(tests, key=lambda test: test[0])
    ]
    heard = [test for test in heard if test[3]]
    table = np.array([row for *_, rows in heard for row in rows]).reshape(-1, 3)
    return Amplitudes(
        start_s=table[:, 0],
        stop_s=table[:, 1],
        log_ratio=np.log(table[:, 2]),
        test=np.repeat(np.arange(len(heard)), [len(rows) for *_, rows in heard]).astype(np.int64),
        kinds=tuple(kind for kind, *_ in heard),
        frequency_hz=np.array([hertz for _, hertz, *_ in heard]),
        rounding=np.array([share for _, _, share, _ in heard]),
    )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Cut:
    """A set point of which stretches are cut out."""

    values: FloatArray
    rate_hz: float
    start_s: float
    stop_s: float
    coverage: Coverage

    def of(self, begin_s: float, end_s: float) -> FloatArray:
        """Return the samples of a stretch."""
        first, stop = (round((at_s - self.start_s) * self.rate_hz) for at_s in (begin_s, end_s))
        return self.values[first:stop]

    def of_sine(self, sine: "Sine") -> list[_Row]:
        """Return begin, end and recorded over asked amplitude of stretches of a sine."""
        length_s = max(sine.periods // _STRETCHES, 1) / sine.frequency_hz
        rows = []
        for begin_s in sine.settled_s + length_s * np.arange(int(sine.periods / sine.frequency_hz / length_s + 1e-6)):
            end_s = begin_s + length_s
            # a set point that is a little early ends within it
            is_cut = length_s < _LEAST_BESIDE_S and end_s > sine.stop_s - _EDGE_S
            if is_cut or begin_s < self.start_s or end_s > self.stop_s or self.coverage.missing(begin_s, end_s):
                continue
            values = self.of(begin_s, end_s)
            turn = 2.0 * np.pi * sine.frequency_hz / self.rate_hz * np.arange(values.size)
            columns = np.stack([np.sin(turn), np.cos(turn), np.ones(turn.size), turn], axis=1)
            solved, *_ = np.linalg.lstsq(columns, values, rcond=None)
            rows.append((float(begin_s), float(end_s), float(np.hypot(solved[0], solved[1])) / sine.amplitude_v))
        return rows

    def of_leg(self, leg: "Leg") -> list[_Row]:
        """Return begin, end and recorded over asked amplitude of the periods of a leg, its lines by their power.

        The size of each line alone counts: a generator whose clock is another turns them.
        """
        held = leg_periods(leg, self.coverage)
        if held is None or held.start_s < self.start_s or held.stop_s > self.stop_s + 1.0 / self.rate_hz:
            return []
        harmonics = [line for line in leg.lines if line < 0.45 * self.rate_hz * held.period_s]
        asked = np.array([leg.lines[line] for line in harmonics])
        borders_s = held.start_s + held.period_s * np.arange(held.periods + 1)
        sizes = []
        for begin_s, end_s in pairwise(borders_s.tolist()):
            values = self.of(begin_s, end_s)
            sizes.append(2.0 / values.size * np.abs(np.fft.rfft(values - values.mean())[harmonics]))
        mean = np.mean(sizes, axis=0)
        slow = np.array(harmonics) <= max(_SLOW_HZ * held.period_s, harmonics[0])
        common = float(asked[slow] @ mean[slow] / (asked[slow] @ asked[slow]))
        return [
            (float(begin_s), float(end_s), common * float(size @ mean / max(mean @ mean, np.finfo(np.float64).tiny)))
            for begin_s, end_s, size in zip(borders_s[:-1], borders_s[1:], sizes, strict=True)
        ]


def change_of(amplitudes: Amplitudes) -> AmplitudeChange | None:
    """Return the change of the amplitude that explains its stretches best; None where there is none.

    ``amplitudes``: of every stretch.
    """
    begin_s, end_s = amplitudes.start_s, amplitudes.stop_s
    scatter = _scatter(amplitudes)
    length_s = np.append(0.0, np.cumsum(end_s - begin_s))
    tried = []
    for before in range(1, begin_s.size):
        for after in range(before, min(before + 3, begin_s.size)):
            if min(length_s[before], length_s[-1] - length_s[after]) < _LEAST_BESIDE_S:
                continue
            # a stretch of which a small part has changed looks like one that has not
            unseen = _UNSEEN if after == before else 0.0
            first_s = end_s[before - 1] - unseen * (end_s[before - 1] - begin_s[before - 1])
            last_s = begin_s[after] + unseen * (end_s[after] - begin_s[after])
            tried.append((*_compared(amplitudes, scatter, before, after), float(first_s), float(last_s)))
    likelihood, size, _, _ = max(tried, default=(0.0, 0.0, 0.0, 0.0))
    if not (likelihood > _THRESHOLD and _LEAST < abs(size) < _MOST):
        return None
    alike = [one for one in tried if one[0] > likelihood - _AS_GOOD and one[1] * size > 0.0]
    return AmplitudeChange(
        likelihood=likelihood,
        size=float(np.expm1(size)),
        between_s=(min(one[2] for one in alike), max(one[3] for one in alike)),
    )


def _scatter(amplitudes: Amplitudes) -> FloatArray:
    """Return how far the stretches of each sine scatter, as all sines together tell, shape (tests,); 0 where untold.

    The scatter is that of values which are late by a time of their own, ``s^2 (corner^2 + f^2)``. It is told by the
    differences of neighbours, in the middle, so that a change of the amplitude does not pass for scatter.
    """
    tests, variances, counts = [], [], []
    for test, kind in enumerate(amplitudes.kinds):
        values = amplitudes.log_ratio[amplitudes.test == test]
        if kind != "sine" or values.size < _FEWEST_TO_SCATTER:
            continue
        tests.append(test)
        variances.append(float(np.median(np.diff(values) ** 2)) / (2.0 * _MEDIAN_OF_SQUARE) + _LEAST_SCATTER**2)
        counts.append(values.size)
    if len(tests) < _FEWEST_LINES:
        return np.zeros(len(amplitudes.kinds))
    frequency_hz, variance, count = amplitudes.frequency_hz[tests], np.array(variances), np.array(counts)

    def fitted(corner_hz: float) -> tuple[float, float]:
        shape = corner_hz**2 + frequency_hz**2
        size = float(count @ (variance / shape)) / count.sum()
        return float(count @ (np.log(size * shape) + variance / (size * shape))), size

    corners_hz = np.geomspace(0.1 * frequency_hz.min(), 10.0 * frequency_hz.max(), _TRIED)
    corner_hz = min(corners_hz, key=lambda corner_hz: fitted(corner_hz)[0])
    return np.asarray(np.sqrt(fitted(corner_hz)[1] * (corner_hz**2 + amplitudes.frequency_hz**2)))


def _compared(amplitudes: Amplitudes, scatter: FloatArray, before: int, after: int) -> tuple[float, float]:
    """Return twice the gain in log-likelihood, and the size of a change of the logarithm.

    ``amplitudes``: of every stretch. ``scatter``: how far the stretches of each test scatter, shape (tests,).
    ``before``, ``after``: how many stretches are before the change, and the first one after it.
    """
    count = amplitudes.log_ratio.size
    kept = np.r_[0:before, after:count]
    values, tests = amplitudes.log_ratio[kept], amplitudes.test[kept]
    changed = (kept >= after).astype(float)
    parts, means = [], []
    for test, kind in enumerate(amplitudes.kinds):
        inside = tests == test
        if not inside.any():
            continue
        of_values, of_course = values[inside], changed[inside]
        if 0.0 < of_course.mean() < 1.0:
            if min(of_course.sum(), of_course.size - of_course.sum()) < _FEWEST_BESIDE:
                return 0.0, 0.0
            centred = of_values - of_values.mean(), of_course - of_course.mean()
            parts.append((*centred, float(np.hypot(_OF_STRETCHES, scatter[test]))))
        else:
            scattered = float(np.hypot(scatter[test] / np.sqrt(of_values.size), amplitudes.rounding[test]))
            expected = float(np.hypot(_OF_SINES, scattered))
            means.append((kind, expected, amplitudes.frequency_hz[test], of_values.mean(), of_course[0]))
    of_sines = np.array([row[1:] for row in means if row[0] == "sine"]).reshape(-1, 4)
    if len(of_sines):
        smooth = _smooth(of_sines[:, 1] / of_sines[:, 1].max()) / of_sines[:, :1]
        lines = of_sines[:, 2:] / of_sines[:, :1]
        rest = lines - smooth @ np.linalg.lstsq(smooth, lines, rcond=None)[0]
        parts.append((rest[:, 0], rest[:, 1], 1.0))
    of_legs = np.array([row[3:] for row in means if row[0] == "leg"]).reshape(-1, 2)
    if len(of_legs):
        rest = of_legs - of_legs.mean(axis=0)
        parts.append((rest[:, 0], rest[:, 1], _OF_LEGS))
    size = 0.0
    for _ in range(_ROUNDS):
        weights = [_number(part) / _left(part, size) for part in parts]
        along = sum(weight * float(part[1] @ part[0]) for weight, part in zip(weights, parts, strict=True))
        power = sum(weight * float(part[1] @ part[1]) for weight, part in zip(weights, parts, strict=True))
        size = along / power if power > 0.0 else 0.0
    return sum(_number(part) * float(np.log(_left(part, 0.0) / _left(part, size))) for part in parts), size


def _smooth(frequency: FloatArray) -> FloatArray:
    """Return how a held or filtered set point may fall, of frequencies over the highest, shape (lines, columns)."""
    square = frequency**2
    filters = [np.log1p((corner * frequency) ** 2) for corner in _CORNERS]
    return np.stack([np.ones(square.size), square, *filters], axis=1)


_Part: TypeAlias = tuple[FloatArray, FloatArray, float]


def _number(part: _Part) -> float:
    return float(part[0].size + _COUNTS)


def _left(part: _Part, size: float) -> float:
    """Return the sum of squares that a size leaves, that of the expected scatter counted."""
    values, course, expected = part
    return float(np.sum((values - size * course) ** 2)) + _COUNTS * expected**2
