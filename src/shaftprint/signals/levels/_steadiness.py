"""Whether the torque gauge and the load were the same from the first to the last minute of a test.

In bollard pull the torque is ``M = c n^2 + z`` with the load ``c`` and the zero ``z`` of the gauge. Means over whole
periods and over steady stretches, each over the mean of ``n^2``, tell ``c`` all over the test. It wanders by a per cent
or three over 10 to 100 s. That wander, a stationary process of first order, is held against the same with a straight
drift, and with a jump between two windows: twice the gain in log-likelihood says how much better that is.

A load that really changes and a gain that does look alike in the means; either way the means of different lines do not
belong to one state, and what is compared across the lines is in doubt.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.reasons import Reason
from shaftprint.signals._gaps import EVERYTHING, Coverage
from shaftprint.signals.levels._wander import window_covariance

if TYPE_CHECKING:
    from shaftprint.campaign import Campaign
    from shaftprint.signals.levels._steady import SteadyStretch

# Parts of a long window: shorter ones say no more, for the wander is as slow; longer ones hide a jump.
_SHORTEST_S, _MOST_PARTS = 20.0, 50
# Correlation times of the wander that are tried [s]; what is slower is a drift.
_TIMES_S = np.geomspace(10.0, 100.0, 8)
# Windows on either side of a jump, and in all.
_FEWEST_BESIDE, _FEWEST = 2, 8
# Twice the gain in log-likelihood that the wander alone exceeds once in several hundred tests, and the least change
# that is worth a word: a tenth of it stays in the mean torque.
_DRIFT_GAIN, _JUMP_GAIN = 14.0, 20.0
_LEAST_CHANGE = 0.03
_PERCENT = 100.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Loads:
    """Torque over the square of the speed, window by window in the order of time."""

    start_s: FloatArray
    """When each window begins [s], shape (windows,)."""
    stop_s: FloatArray
    """When it ends [s], shape (windows,)."""
    load: FloatArray
    """Torque over the square of the speed, over its mean [-], shape (windows,)."""
    square: FloatArray
    """Mean of the square of the speed over its mean [-], shape (windows,)."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Change:
    """A change of the load within a test."""

    gain: float
    """Twice the gain in log-likelihood over the wander alone."""
    size: float
    """Relative change from the begin to the end, or across the jump [-]."""
    at_s: float | None
    """When it jumps [s]; None for a drift."""


def expect_steady_gauge(
    stretches: "tuple[SteadyStretch, ...]",
    campaign: "Campaign",
    *,
    speed_rev_s: FloatArray,
    torque_nm: FloatArray,
    rate_hz: float,
    start_s: float,
    channel: str,
    coverage: Coverage = EVERYTHING,
) -> tuple[Reason, ...]:
    """Return a reason where torque over the square of the speed jumps or drifts within the test.

    Parameters
    ----------
    stretches
        Where set point, speed and torque stand still.
    campaign
        Says where the sines are; means over their whole periods are used.
    speed_rev_s, torque_nm
        Signals on the grid, shape (samples,).
    rate_hz, start_s
        The grid.
    channel
        Name of the torque channel.
    coverage
        What the recording covers; windows in a gap are left out.
    """
    planned = [*((s.start_s, s.stop_s) for s in stretches), *_parts(campaign)]
    windows = [window for window in planned if not coverage.missing(*window)]
    loads = loads_of(windows, speed_rev_s=speed_rev_s, torque_nm=torque_nm, rate_hz=rate_hz, start_s=start_s)
    if loads.load.size < _FEWEST:
        return ()
    drift, jump = changes(loads)
    if jump.gain > _JUMP_GAIN and abs(jump.size) > _LEAST_CHANGE and jump.gain >= drift.gain:
        return (_reason(jump, channel),)
    if drift.gain > _DRIFT_GAIN and abs(drift.size) > _LEAST_CHANGE:
        return (_reason(drift, channel),)
    return ()


def _reason(change: Change, channel: str) -> Reason:
    how = "drifts" if change.at_s is None else f"jumps at about {change.at_s:.0f} s"
    return Reason(
        kind="gauge steadiness",
        where=channel,
        sentence=(
            f"The torque over the square of the speed {how} by {_PERCENT * change.size:+.1f} %, more than a load "
            f"wanders: gain or zero of the torque gauge in channel {channel} changed within the test, or the ship did; "
            "check the telemetry, or use a part of the test."
        ),
    )


def _parts(campaign: "Campaign") -> Iterator[tuple[float, float]]:
    """Yield parts of the sines that hold whole periods."""
    total = sum(sine.window_s for sine in campaign.sines)
    shortest_s = max(_SHORTEST_S, total / _MOST_PARTS)
    for sine in campaign.sines:
        period = 1.0 / sine.frequency_hz
        count = max(sine.periods // max(int(np.ceil(shortest_s / period)), 1), 1)
        borders = sine.settled_s + period * (sine.periods // count) * np.arange(count + 1)
        yield from zip(borders[:-1].tolist(), borders[1:].tolist(), strict=True)


def loads_of(
    windows: Sequence[tuple[float, float]],
    *,
    speed_rev_s: FloatArray,
    torque_nm: FloatArray,
    rate_hz: float,
    start_s: float,
) -> Loads:
    """Return the load in windows; those outside the signals are left out."""
    rows = []
    for begin, end in sorted(windows):
        first, stop = round((begin - start_s) * rate_hz), round((end - start_s) * rate_hz)
        if first < 0 or stop > torque_nm.size or stop <= first:
            continue
        square = float(np.mean(speed_rev_s[first:stop] ** 2))
        rows.append((begin, end, float(np.mean(torque_nm[first:stop])) / square, square))
    table = np.array(rows).reshape(-1, 4)
    return Loads(
        start_s=table[:, 0],
        stop_s=table[:, 1],
        load=table[:, 2] / np.mean(table[:, 2]),
        square=table[:, 3] / np.mean(table[:, 3]),
    )


def changes(loads: Loads) -> tuple[Change, Change]:
    """Return the best drift and the best jump of the load."""
    middle = 0.5 * (loads.start_s + loads.stop_s)
    count = middle.size
    places = range(_FEWEST_BESIDE, count - _FEWEST_BESIDE + 1)
    tried = np.stack(
        [(middle - middle[0]) / (middle[-1] - middle[0]), *(np.arange(count) >= index for index in places)], axis=1
    )
    common = np.stack([np.ones(count), 1.0 / loads.square - 1.0], axis=1)
    plain = -np.inf
    best, sizes = np.full(tried.shape[1], -np.inf), np.zeros(tried.shape[1])
    for time_s in _TIMES_S:
        lower = np.linalg.cholesky(window_covariance(loads.start_s, loads.stop_s, float(time_s)))
        white = np.linalg.solve(lower, np.column_stack([loads.load, common, tried]))
        basis = np.linalg.qr(white[:, 1:3]).Q
        residual = white - basis @ (basis.T @ white)
        load_residual, more = residual[:, 0], residual[:, 3:]
        along = more.T @ load_residual
        power = np.sum(more**2, axis=0)
        square = float(load_residual @ load_residual)
        log = -np.log(np.diag(lower)).sum()
        plain = max(plain, log - 0.5 * count * np.log(square))
        log_likelihood = log - 0.5 * count * np.log(square - along**2 / power)
        better = log_likelihood > best
        best[better], sizes[better] = log_likelihood[better], (along / power)[better]
    gains = 2.0 * (best - plain)
    index = 1 + int(np.argmax(gains[1:]))
    at = places[index - 1]
    return (
        Change(gain=float(gains[0]), size=float(sizes[0]), at_s=None),
        Change(
            gain=float(gains[index]),
            size=float(sizes[index]),
            at_s=0.5 * float(loads.stop_s[at - 1] + loads.start_s[at]),
        ),
    )
