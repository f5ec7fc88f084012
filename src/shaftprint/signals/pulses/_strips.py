"""Angles between the reflection strips of a shaft, found from the pulses themselves.

At constant speed the interval from one strip to the next is to the time of one revolution as the angle
is to a full turn (thesis "Fingerprinting II", eqs 3.3-3.5). Here every steady revolution counts, and the
revolution is centred on the interval, so that a constant acceleration cancels.
"""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, IntArray, frozen_float
from shaftprint.distributions import chi_square_quantile
from shaftprint.errors import SignalError
from shaftprint.signals._signals import StripAngles

if TYPE_CHECKING:
    from shaftprint.signals.pulses._pulses import PulseTrain

# A revolution is steady when its neighbours differ by less than this share.
_STEADY = 0.01
_FEWEST_REVOLUTIONS = 20
_CLIP = 4.0

# A strip is told from its neighbours when its angle fits this many times better.
_CLEARLY_BETTER = 4.0
# The count of a stretch is doubted where its pattern has a smaller probability than this.
_UNLIKELY = 1e-6
_ROUNDING = 1e-9


def find_strips(train: "PulseTrain", strips: int, *, channel: str) -> StripAngles:
    """Return the angles from strip to strip, beginning at the strip of pulse number 0.

    Parameters
    ----------
    train
        Numbered pulses.
    strips
        Pulses a revolution, at least 2.
    channel
        Name of the channel, for the result and for messages.

    Raises
    ------
    SignalError
        If there are fewer than 20 steady revolutions.
    """
    share, steady = _interval_shares(train, strips)
    strip = train.number[:-1] % strips
    angle, deviation = np.empty(strips), np.empty(strips)
    for k in range(strips):
        shares = share[steady & (strip == k)]
        if shares.size < _FEWEST_REVOLUTIONS:
            raise SignalError(
                f"channel {channel}: expected at least {_FEWEST_REVOLUTIONS} steady revolutions "
                f"to find the angles of its {strips} strips, found {shares.size}."
            )
        angle[k], deviation[k] = _clipped_mean(shares)
    # the angles of one turn: what is left over is shared in proportion
    total = angle.sum()
    return StripAngles(channel=channel, angle_rev=frozen_float(angle / total), std_rev=frozen_float(deviation / total))


def steady_turns(train: "PulseTrain", strips: int) -> bool:
    """Return whether enough of the turns are steady for the angles to be found."""
    _, steady = _interval_shares(train, strips)
    turns = np.bincount(train.number[:-1][steady] % strips, minlength=strips)
    return int(turns.min()) >= _FEWEST_REVOLUTIONS


def revolutions(train: "PulseTrain", angles: FloatArray) -> FloatArray:
    """Return the angle of the shaft at each pulse since pulse number 0 [rev], shape (pulses,).

    ``train``: numbered pulses. ``angles``: angle from each strip or tooth of the turn to the next [rev], shape
    (strips,); they sum to 1.
    """
    strips = angles.size
    places = np.concatenate([[0.0], np.cumsum(angles[:-1])])
    turned: FloatArray = train.number // strips + places[train.number % strips]
    return turned


def renumbered(train: "PulseTrain", strips: int) -> tuple[IntArray, tuple[float, ...]]:
    """Return the pulse numbers, mended where the pattern of the strips shows a miscount.

    Over a gap the number of missing pulses is a rounded guess. The pattern of uneven strips behind it
    tells the number exactly, up to whole revolutions. Strips that are even within what jitter leaves open of a stretch
    tell nothing, and the guess stays.

    ``number``: shape (pulses,). ``position``: where a gap was recounted [samples].
    """
    number = train.number.copy()
    share, steady = _interval_shares(train, strips)
    gaps = np.flatnonzero(np.diff(number) > 1)
    ends = np.concatenate([gaps, [number.size - 1]])
    starts = np.concatenate([[0], gaps + 1])
    longest = int(np.argmax(ends - starts))
    whole = slice(starts[longest], ends[longest])
    reference = _pattern(share, steady, number, whole, strips)
    noise = _noise(share, steady, number, whole, reference)
    mended = []
    # outwards from the longest stretch: each gap against the stretch nearer to it
    for stretch in (*range(longest + 1, starts.size), *range(longest - 1, -1, -1)):
        inside = slice(starts[stretch], ends[stretch])
        shift = _shift(reference, _pattern(share, steady, number, inside, strips), noise)
        if shift == 0:
            continue
        if stretch > longest:
            number[starts[stretch] :] += shift
            mended.append(float(train.position[gaps[stretch - 1]]))
        else:
            number[: ends[stretch] + 1] += shift
            mended.append(float(train.position[gaps[stretch]]))
    return number - number[0], tuple(sorted(mended))


def unplaced_stretches(train: "PulseTrain", strips: int, gaps: IntArray) -> list[tuple[float, float]]:
    """Return the stretches behind gaps that are too short to show at which strip they begin.

    ``train``: numbered pulses. ``strips``: pulses a revolution. ``gaps``: numbers of the intervals over which the count
    is a guess, shape (gaps,), ascending. Returns first and last pulse of each [samples].
    """
    share, steady = _interval_shares(train, strips)
    borders = np.flatnonzero(np.diff(train.number) > 1)
    starts, ends = np.concatenate([[0], borders + 1]), np.concatenate([borders, [train.number.size - 1]])
    longest = int(np.argmax(ends - starts))
    stretches = []
    # across a silence without a jump of the number the count goes on, as of a shaft that starts
    for gap in np.intersect1d(gaps, borders).tolist():
        behind = int(np.searchsorted(starts, gap, side="right"))
        # behind, as seen from the longest stretch, at which the count begins
        stretch = behind if behind > longest else behind - 1
        inside = slice(starts[stretch], ends[stretch])
        if not np.all(np.isfinite(_pattern(share, steady, train.number, inside, strips).share)):
            stretches.append((float(train.position[starts[stretch]]), float(train.position[ends[stretch]])))
    return stretches


def _interval_shares(train: "PulseTrain", strips: int) -> tuple[FloatArray, BoolArray]:
    """Return each interval as a share of the revolution around it, and where that is steady."""
    interval = np.diff(train.position)
    half, odd = strips // 2, strips % 2 == 1
    weights = np.ones(strips if odd else strips + 1)
    if not odd:
        weights[0] = weights[-1] = 0.5
    steady = np.zeros(interval.size, dtype=np.bool_)
    share = np.full(interval.size, np.nan)
    if interval.size < 4 * strips:
        return share, steady
    turn = np.convolve(interval, weights, mode="valid")
    inside = slice(half, half + turn.size)
    share[inside] = interval[inside] / turn
    consecutive = np.diff(train.number) == 1
    changed = np.full(turn.size, np.inf)
    changed[strips:-strips] = np.abs(turn[2 * strips :] / turn[: -2 * strips] - 1.0)
    complete = np.convolve(consecutive, np.ones(4 * half + 1), mode="same") > 4 * half
    steady[inside] = (changed < _STEADY) & complete[inside]
    return share, steady


def _clipped_mean(values: FloatArray) -> tuple[float, float]:
    """Return the mean of the values near the median and the standard deviation of that mean."""
    for _ in range(3):
        median = np.median(values)
        spread = 1.4826 * np.median(np.abs(values - median))
        values = values[np.abs(values - median) <= max(_CLIP * spread, 1e-12)]
    # neighbouring intervals share an edge; seen from one strip a revolution apart they are independent
    return float(values.mean()), float(values.std(ddof=1) / np.sqrt(values.size))


class _Pattern(NamedTuple):
    """The strips of a stretch as its intervals show them."""

    share: FloatArray
    """Mean share of each strip, not a number where there is none; shape (strips,)."""
    turns: IntArray
    """Number of turns that it is the mean of, shape (strips,)."""


def _pattern(share: FloatArray, steady: BoolArray, number: IntArray, inside: slice, strips: int) -> _Pattern:
    """Return the strips of the steady turns within a stretch."""
    kept = steady[inside]
    strip = number[:-1][inside][kept] % strips
    count = np.bincount(strip, minlength=strips)
    total = np.bincount(strip, weights=share[inside][kept], minlength=strips)
    return _Pattern(np.where(count > 0, total / np.maximum(count, 1), np.nan), count)


def _noise(share: FloatArray, steady: BoolArray, number: IntArray, inside: slice, pattern: _Pattern) -> float:
    """Return the standard deviation of one share about the mean of its strip, by the median; rounding at least."""
    kept = steady[inside]
    about = share[inside][kept] - pattern.share[number[:-1][inside][kept] % pattern.share.size]
    return max(1.4826 * float(np.median(np.abs(about))), _ROUNDING) if about.size else _ROUNDING


def _shift(reference: _Pattern, found: _Pattern, noise: float) -> int:
    """Return by how many strips a stretch is miscounted, between -strips/2 and strips/2."""
    strips = reference.share.size
    if not np.all(np.isfinite(reference.share)) or not np.all(np.isfinite(found.share)):
        return 0
    variance = noise**2 * (1.0 / reference.turns + 1.0 / found.turns)
    as_counted = np.sum((found.share - reference.share) ** 2 / variance)
    if as_counted < chi_square_quantile(1.0 - _UNLIKELY, strips):
        return 0
    # a stretch counted one too low shows strip k where the reference has strip k + 1
    errors = np.array([np.sum((np.roll(found.share, k) - reference.share) ** 2) for k in range(strips)])
    best = int(np.argmin(errors))
    if errors[best] * _CLEARLY_BETTER > errors[0]:
        return 0
    return best if best <= strips // 2 else best - strips
