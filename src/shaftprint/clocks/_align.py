"""The verb of the room: the map between two loggers' clocks from what both have seen."""

from collections.abc import Sequence

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.clocks._alignment import Alignment, Stretch
from shaftprint.clocks._clock_map import ClockMap
from shaftprint.clocks._coarse import RATE_HZ, coarse_offset, is_short
from shaftprint.clocks._short import short_line
from shaftprint.clocks._windows import WindowDelay, delays_of
from shaftprint.errors import ClockError
from shaftprint.signals._content import Content

DRIFT_STD = 1e-4
"""Standard deviation of a logger's drift before the data are seen: quartz is good for 100 ppm."""

# How far from the coarse offset, then from the line, a stretch may lie [s].
FIRST_S, NEXT_S = 3.0, 0.2
# A stretch further from the line than this counts less in proportion (Huber, Robust estimation of a location parameter,
# 1964).
HUBER = 1.345
ITERATIONS = 50
# A stretch is strange where the contents are less alike than this share of the best; so many must not be.
STRANGE, ALIKE = 0.3, 0.8
# With fewer degrees of freedom Student's t has no variance.
_LEAST_FREEDOM = 3
# Share of the stretches that must lie on one line, and how near [s].
AGREEING, NEAR_S = 0.5, 0.05


def align(
    other: Content,
    reference: Content,
    *,
    drift_std: float = DRIFT_STD,
    latency_s: float = 0.0,
    latency_std_s: float = 0.0,
) -> Alignment:
    """Return how another logger's clock reads on the reference clock.

    Parameters
    ----------
    other, reference
        What both loggers have seen, such as the speed from two pick-ups; units and scales may differ.
    drift_std
        Standard deviation of the drift before the data are seen [s/s].
    latency_s, latency_std_s
        By how much the other logger shows the content later than the reference logger does [s]: the data cannot tell
        that from a clock that is behind.

    Raises
    ------
    ClockError
        If too little is shared, or several maps fit, or no straight line does.
    """
    if min(other.rate_hz, reference.rate_hz) < RATE_HZ:
        raise ClockError(
            f"channels {reference.name} and {other.name}: expected at least {RATE_HZ:g} values a second, found "
            f"{min(other.rate_hz, reference.rate_hz):g}; choose channels that were logged faster."
        )
    offset_s = coarse_offset(other, reference)
    is_slower = other.rate_hz <= reference.rate_hz
    slow, fast = (other, reference) if is_slower else (reference, other)
    names = f"channels {reference.name} and {other.name}"
    if not is_slower:
        offset_s = -offset_s
    if is_short(other, reference):
        line, stretches, scatter = *short_line(slow, fast, offset_s, drift_std, names), None
    else:
        line, stretches, scatter = _long_line(slow, fast, offset_s, drift_std, names)
    clock_map = line if is_slower else line.inverse()
    covariance = clock_map.covariance + np.array([[latency_std_s**2, 0.0], [0.0, 0.0]])
    clock_map = ClockMap(
        offset_s=clock_map.offset_s + latency_s,
        drift=clock_map.drift,
        middle_s=clock_map.middle_s,
        covariance=covariance,
    )
    return Alignment(
        map=clock_map,
        span_s=(other.start_s, float(other.time_s[-1])),
        stretches=tuple(_stretch(delay, latency_s, is_slower=is_slower) for delay in stretches),
        scatter=scatter,
    )


def _long_line(
    slow: Content, fast: Content, offset_s: float, drift_std: float, names: str
) -> tuple[ClockMap, list[WindowDelay], float]:
    """Return the map from the slower content's clock to the faster one's, its minutes, and how far they scatter."""
    expected = np.full(slow.values.size, offset_s)
    for within_s in (FIRST_S, NEXT_S):
        every = delays_of(slow, fast, expected, within_s)
        delays = [delay for delay in every if delay.tells]
        line = _line(delays, drift_std, names)
        expected = line.reference_s(slow.time_s) - slow.time_s
    _expect_alike(every, names)
    _expect_line(delays, line, names)
    scatter = _scatter(delays, line)
    return _widened(line, scatter, len(delays)), delays, scatter


def _stretch(delay: WindowDelay, latency_s: float, *, is_slower: bool) -> Stretch:
    """Return what a delay says on the other clock, which has the slower content or the faster one."""
    if is_slower:
        return Stretch(time_s=delay.time_s, offset_s=delay.delay_s + latency_s, std_s=delay.std_s)
    return Stretch(time_s=delay.time_s + delay.delay_s, offset_s=latency_s - delay.delay_s, std_s=delay.std_s)


def _line(delays: Sequence[WindowDelay], drift_std: float, names: str) -> ClockMap:
    """Return the straight line through the delays that a few wild ones do not move."""
    if not delays:
        raise ClockError(
            f"{names}: expected at least one minute in which the speed moves in both, found none; "
            "choose channels that show the same, or a longer part of the test."
        )
    time_s, delay_s, std_s = _columns(delays)
    middle_s = float(np.sum(time_s / std_s**2) / np.sum(1.0 / std_s**2))
    rows = np.stack([np.ones(time_s.size), time_s - middle_s], axis=1)
    # a few stretches can be very certain of a wrong period of a sine: at first all count the same
    theta, sizes = np.array([np.median(delay_s), 0.0]), np.maximum(std_s, 0.02)
    for iteration in range(ITERATIONS):
        if iteration == ITERATIONS // 2:
            sizes = std_s
        away = np.abs(delay_s - rows @ theta) / sizes
        spread = max(1.0, float(np.median(away)) / 0.6745)
        weights = np.minimum(1.0, HUBER * spread / np.maximum(away, 1e-12)) / sizes**2
        information = rows.T @ (weights[:, None] * rows) + np.diag([0.0, drift_std**-2])
        theta = np.linalg.solve(information, rows.T @ (weights * delay_s))
    return ClockMap(
        offset_s=float(theta[0]), drift=float(theta[1]), middle_s=middle_s, covariance=np.linalg.inv(information)
    )


def _scatter(delays: Sequence[WindowDelay], line: ClockMap) -> float:
    """Return the root mean square distance from the line in standard deviations, without the wildest tenth."""
    time_s, delay_s, std_s = _columns(delays)
    away = np.sort(np.abs(delay_s - (line.reference_s(time_s) - time_s)) / std_s)
    kept = away[: max(int(np.ceil(0.9 * away.size)), 1)]
    # the mean square of a normal number within its middle nine tenths is 0.62
    trimmed = 0.6229 if away.size > kept.size else 1.0
    return float(np.sqrt(np.sum(kept**2) / max(kept.size - 2, 1) / trimmed))


def _widened(line: ClockMap, scatter: float, stretches: int) -> ClockMap:
    """Return the line with a covariance as large as the scatter around it says, and few stretches allow.

    The stretches are weighted by deviations that each finds from its own minute: of a line through ``n`` of them the
    variance is that of Student's t with ``n - 2`` degrees of freedom.
    """
    freedom = max(stretches - 2, _LEAST_FREEDOM)
    return ClockMap(
        offset_s=line.offset_s,
        drift=line.drift,
        middle_s=line.middle_s,
        covariance=line.covariance * max(scatter, 1.0) ** 2 * freedom / (freedom - 2),
    )


def _expect_line(delays: Sequence[WindowDelay], line: ClockMap, names: str) -> None:
    time_s, delay_s, std_s = _columns(delays)
    away = np.abs(delay_s - (line.reference_s(time_s) - time_s))
    near = away <= np.maximum(NEAR_S, 3.0 * std_s)
    if np.mean(near) >= AGREEING:
        return
    first, last = time_s[0], time_s[-1]
    raise ClockError(
        f"{names}: expected delays on one straight line, found {np.mean(near):.0%} of {time_s.size} minutes within "
        f"{NEAR_S:g} s of it, from {first:.0f} to {last:.0f} s; a logger may have stopped in between: align the parts "
        "one by one."
    )


def _expect_alike(delays: Sequence[WindowDelay], names: str) -> None:
    """Raise if what moves most is not alike in many stretches: a logger that stopped shows another time there."""
    usual = float(np.median([delay.energy for delay in delays]))
    moving = [delay for delay in delays if delay.energy >= usual]
    best = float(np.quantile([delay.likeness for delay in moving], 0.9))
    strange = [delay for delay in moving if delay.likeness < STRANGE * best]
    if len(strange) > (1.0 - ALIKE) * len(moving):
        raise ClockError(
            f"{names}: expected the same movements throughout, found others in {len(strange)} of {len(moving)} "
            f"minutes, the first at {strange[0].time_s:.0f} s; a logger may have stopped in between: align the parts "
            "one by one."
        )


def _columns(delays: Sequence[WindowDelay]) -> tuple[FloatArray, FloatArray, FloatArray]:
    table = np.array([(delay.time_s, delay.delay_s, delay.std_s) for delay in delays])
    return table[:, 0], table[:, 1], table[:, 2]
