"""Rules of motion: the set point is put out and followed, and nothing swings up that was not asked for."""

import math
from collections import deque

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.live._envelope import SET_POINT, SPEED
from shaftprint.live._sight import Sight
from shaftprint.live._watch import AbortRule, Breach, Expected, Lasting, Rest

# The logged set point may differ from what was put out by so much, and by so many deviations of it at rest.
_LEAST_V, _SIGMAS = 0.05, 5.0
_PUT_OUT_S, _FOLLOWED_S = 0.5, 2.0
# What the speed may lag behind [s], and by how much of what was asked in that time it may overshoot.
_BEHIND_S, _OVERSHOOT = 3.0, 1.0
# Growth from period to period that is no longer noise, over three windows of this length [s].
_GROWTH, _WINDOW_S, _EVERY_S = 1.05, 2.0, 0.5
_ABOVE_NOISE = 5.0
# A swing that has grown to this share of the speed, and stays there, has met a limit that keeps it from growing on.
_LARGE = 0.03
# What was asked is taken out of the speed by its values of the last seconds: so far apart, as a lightly damped line
# answers for so long [s].
_LAG_S, _LONGEST_LAG_S = 0.1, 3.0
_FIT_S = 12.0
# Of a window with holes so much has to be there.
_LEAST_SHARE = 0.5
# A response to a step looks like growth for as long as it moves from one window to the next.
_IN_A_ROW = 6


class PutOutWatch:
    """What is logged as set point is what the program has put out."""

    def __init__(self, rest: Rest) -> None:
        self._rest, self._lasting = rest, Lasting(_PUT_OUT_S)
        self._limit_v = max(_LEAST_V, _SIGMAS * rest.set_point_std_v)

    def look(self, sight: Sight, expected: Expected) -> Breach | None:
        """Return what is broken with this block."""
        off_v = sight.set_point_v - self._rest.set_point_offset_v - expected.set_point_v
        if not self._lasting.too_long(expected.is_ruling and abs(off_v) > self._limit_v, sight):
            return None
        return Breach(
            rule=AbortRule.SET_POINT,
            channel=SET_POINT,
            value=off_v,
            limit=self._limit_v,
            unit="V",
            persistence_s=_PUT_OUT_S,
            time_s=sight.time_s,
            why="the logged set point is not what is played",
        )


class FollowedWatch:
    """The speed follows the set point, as far as it had time to."""

    def __init__(self, rest: Rest, slope_rpm_per_v: float, span_s: float) -> None:
        self._rest, self._slope = rest, slope_rpm_per_v
        self._asked: deque[float] = deque(maxlen=max(1, round(_BEHIND_S / span_s)))
        self._lasting = Lasting(_FOLLOWED_S)

    def look(self, sight: Sight, expected: Expected) -> Breach | None:
        """Return what is broken with this block."""
        rest = self._rest
        self._asked.append(rest.speed_rpm + self._slope * (expected.set_point_v - rest.volts))
        low, high = min(self._asked), max(self._asked)
        beside = _SIGMAS * rest.speed_std_rpm + _OVERSHOOT * (high - low)
        low, high = low - beside, high + beside
        is_beside = not math.isnan(sight.speed_rpm) and not low <= sight.speed_rpm <= high
        if not self._lasting.too_long(expected.is_ruling and is_beside, sight):
            return None
        return Breach(
            rule=AbortRule.SET_POINT,
            channel=SPEED,
            value=sight.speed_rpm,
            limit=low if sight.speed_rpm < low else high,
            unit="rpm",
            persistence_s=_FOLLOWED_S,
            time_s=sight.time_s,
            why="the speed does not follow the set point",
        )


class OscillationWatch:
    """No swing of the speed grows, or has grown, that was not asked for."""

    def __init__(self, rest: Rest, span_s: float) -> None:
        self._noise_rpm, self._span_s = rest.speed_std_rpm, span_s
        steps = round(_LONGEST_LAG_S / _LAG_S) + 1
        self._lags = sorted({round(_LAG_S * step / span_s) for step in range(steps)})
        count = round(_FIT_S / span_s) + self._lags[-1]
        self._speed: deque[float] = deque(maxlen=count)
        self._asked: deque[float] = deque(maxlen=count)
        self._every = max(1, round(_EVERY_S / span_s))
        self._blocks = self._growing = 0
        self._counter: int | None = None

    def look(self, sight: Sight, expected: Expected) -> Breach | None:
        """Return what is broken with this block."""
        if self._counter is not None:
            # lost blocks and what has no speed are holes, over which nothing is followed
            lost = min(sight.block.counter - self._counter - 1, self._speed.maxlen or 0)
            self._speed.extend([math.nan] * lost)
            self._asked.extend([math.nan] * lost)
        self._counter = sight.block.counter
        self._speed.append(sight.speed_rpm)
        self._asked.append(expected.set_point_v)
        self._blocks += 1
        if not expected.is_ruling or self._blocks % self._every or len(self._speed) < (self._speed.maxlen or 0):
            return None
        growth, size_rpm, hertz = self._unasked()
        is_large = size_rpm > _LARGE * sight.speed_rpm
        is_growing = (growth > _GROWTH or is_large) and size_rpm > _ABOVE_NOISE * self._noise_rpm
        self._growing = self._growing + 1 if is_growing else 0
        if self._growing < _IN_A_ROW:
            return None
        return Breach(
            rule=AbortRule.OSCILLATION,
            channel=SPEED,
            value=size_rpm,
            limit=_ABOVE_NOISE * self._noise_rpm,
            unit="rpm",
            persistence_s=_EVERY_S * _IN_A_ROW,
            time_s=sight.time_s,
            why=f"a swing near {hertz:.2g} Hz that was not asked for has grown, by {growth:.3g} a period",
        )

    def _unasked(self) -> tuple[float, float, float]:
        """Return growth a period, size [rpm] and frequency [Hz] of what the set point does not explain."""
        asked, speed = np.array(self._asked), np.array(self._speed)
        first = self._lags[-1]
        columns = [asked[first - lag : asked.size - lag] for lag in self._lags]
        columns += [np.ones(speed.size - first), np.linspace(-1.0, 1.0, speed.size - first)]
        basis = np.stack(columns, axis=1)
        rest: FloatArray = speed[first:].copy()
        there = np.isfinite(rest) & np.isfinite(basis).all(axis=1)
        window = round(_WINDOW_S / self._span_s)
        parts = [slice(rest.size - (k + 1) * window, rest.size - k * window) for k in (2, 1, 0)]
        if min(float(there[part].mean()) for part in parts) < _LEAST_SHARE:
            return 0.0, 0.0, 0.0
        followed, *_ = np.linalg.lstsq(basis[there], rest[there], rcond=1e-6)
        rest[there] -= basis[there] @ followed
        sizes = [float(np.std(rest[part][there[part]])) for part in parts]
        last = np.where(there, rest, 0.0)[-window * 2 :]
        last = last - last.mean()
        spectrum = np.abs(np.fft.rfft(last * np.hanning(last.size)))
        hertz = max(1, int(np.argmax(spectrum))) / (last.size * self._span_s)
        if min(sizes) <= 0.0:
            return 0.0, sizes[-1], hertz
        growth = min(sizes[1] / sizes[0], sizes[2] / sizes[1]) ** (1.0 / (hertz * _WINDOW_S))
        return growth, math.sqrt(2.0) * sizes[-1], hertz
