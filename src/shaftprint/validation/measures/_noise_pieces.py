"""The noise of a recording from where no model has anything to explain: while the set point stands still.

Between the tests, and on the levels of staircases once a step has died out, speed and torque move by noise alone. Cut
into pieces as long as an excerpt, each with its own mean taken off, these stretches say how much of the motion in that
excerpt is noise, and how much that differs from piece to piece.

Noise depends on the speed: its size goes with the load of the propeller, and the orders of shaft and blades move with
it, at idle into the band of the model. An excerpt therefore takes the stretches whose load is nearest to its own, one
by one until they give enough pieces, and the rest of the difference is made up by scaling with the load.

A leg never stands still, but repeats itself: what differs from period to period, over the root of two, is noise of its
speed.

What changes more slowly than a piece is long does not show in it. It is the scatter of the means of the quiet stretches
at the working point, and stays out of the test, which takes the mean off as well; for FitPercent, which does not, it
is part of the noise.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitations import Staircase
from shaftprint.errors import ValidationError
from shaftprint.signals._signals import Signals
from shaftprint.signals._working_points import LegState
from shaftprint.transforms import smallest_quick_length

# What the low-pass shows of a step before it happens.
_AHEAD_S = 1.0
_SHORTEST_S = 5.0
LEAST_LOAD = 0.05
# So many pieces at the right speed say more than hundreds at another; a level of a staircase gives them.
_ENOUGH_PIECES = 3
# Stretches whose load differs by less than this share are as good as those before.
_ALIKE = 0.1
# More pieces than this make the noise hardly better known.
_MOST_PIECES = 48
# Products at lags near the length of a piece come from few samples of it.
_LAG_SHARE = 0.5


@dataclass(frozen=True, kw_only=True, eq=False)
class NoisePieces:
    """Pieces of noise like that in one excerpt."""

    pieces: FloatArray
    """Speed and torque, each piece without its mean, shape (pieces, 2, samples)."""
    as_long: bool
    """Whether they are as long as the excerpt; shorter ones lack what is slower."""

    @cached_property
    def autocovariances(self) -> tuple[FloatArray, FloatArray]:
        """Autocovariance of speed and of torque from lag 0 on, each of shape (lags,)."""
        speed, torque = (self._autocovariance(row) for row in range(2))
        return speed, torque

    def _autocovariance(self, row: int) -> FloatArray:
        chosen = self.pieces[:, row]
        samples = chosen.shape[-1]
        lags = max(int(_LAG_SHARE * samples), 1)
        # divided by all samples, not by those of the lag: a covariance that no signal can have is never made
        return np.asarray(autocorrelated(*chosen)[:lags] / (samples * len(chosen)))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class QuietNoise:
    """Noise of speed and torque in stretches without excitation."""

    rate_hz: float
    """Sample rate [Hz]."""
    stretches: tuple[FloatArray, ...]
    """Speed and torque without their mean, each of shape (2, samples)."""
    loads: FloatArray
    """Load of the propeller over that at the working point, shape (stretches,)."""
    offset_variance: FloatArray
    """Variance of the means of the stretches at the working point, shape (2,)."""

    @property
    def longest_s(self) -> float:
        """Length of the longest stretch [s]."""
        return float(max(stretch.shape[1] for stretch in self.stretches)) / self.rate_hz

    def like(self, samples: int, load: float) -> NoisePieces:
        """Return pieces of noise as in an excerpt.

        ``samples``: length of the excerpt; where no stretch is that long, pieces of the length of the longest are
        returned. ``load``: load of the propeller during most of the excerpt over that at the working point.
        """
        longest = max(stretch.shape[1] for stretch in self.stretches)
        length = min(samples, longest)
        wanted = max(load, LEAST_LOAD)
        apart = np.abs(np.log(self.loads / wanted))
        pieces: list[tuple[int, int]] = []
        last = 0.0
        for index in np.argsort(apart, kind="stable"):
            if len(pieces) >= _ENOUGH_PIECES and apart[index] > last + _ALIKE:
                break
            count = self.stretches[index].shape[1] // length
            if count == 0:
                continue
            last = last if len(pieces) >= _ENOUGH_PIECES else float(apart[index])
            pieces += [(int(index), k * length) for k in range(count)]
        kept = np.linspace(0, len(pieces) - 1, min(len(pieces), _MOST_PIECES)).round().astype(np.intp)
        cut = np.empty((kept.size, 2, length))
        for piece, (index, first) in zip(cut, (pieces[k] for k in kept), strict=True):
            piece[:] = self.stretches[index][:, first : first + length] * (wanted / self.loads[index])
        cut -= cut.mean(axis=-1, keepdims=True)
        return NoisePieces(pieces=cut, as_long=length == samples)


def autocorrelated(*pieces: FloatArray) -> FloatArray:
    """Return the sums of products of the values of each piece with themselves at lags from 0 on, over all pieces."""
    samples = pieces[0].size
    size = smallest_quick_length(2 * samples)
    # spectra are added, and transformed back once
    power = np.zeros(size // 2 + 1)
    for piece in pieces:
        spectrum = np.fft.rfft(piece, size)
        power += spectrum.real**2 + spectrum.imag**2
    return np.asarray(np.fft.irfft(power, size)[:samples])


def quadratic_form(values: FloatArray, autocovariance: FloatArray) -> float:
    """Return ``w^T R w`` for the covariance matrix that an autocovariance makes, zero beyond its lags."""
    products = autocorrelated(values)
    lags = min(autocovariance.size, products.size)
    return float(products[0] * autocovariance[0] + 2.0 * (products[1:lags] @ autocovariance[1:lags]))


def quiet_noise(
    outputs: Callable[[slice], FloatArray], campaign: Campaign, signals: Signals, *, rest_s: float
) -> QuietNoise:
    """Return the noise in the quiet stretches of a recording.

    ``outputs``: gives the deviations of speed and torque from the working point in some samples, shape (2, samples).
    ``campaign``: says where the set point stands still. ``signals``: the recording, with its grid and where its gaps
    are. ``rest_s``: time after a change of the set point from which on a stretch is quiet [s]. Raises ValidationError
    if nothing stands still for 5 s.
    """
    cut, loads, means = [], [], []
    rate_hz, start_s, samples = signals.rate_hz, signals.start_s, signals.shaft_torque_nm.size
    end_s = start_s + samples / rate_hz
    for begin, end, between in _still(campaign, end_s):
        first = max(round((begin + rest_s - start_s) * rate_hz), 0)
        last = min(round((end - _AHEAD_S - start_s) * rate_hz), samples)
        if last - first < _SHORTEST_S * rate_hz or signals.coverage.touching(begin, end):
            continue
        stretch = outputs(slice(first, last))
        mean = stretch.mean(axis=1, keepdims=True)
        cut.append(stretch - mean)
        loads.append(max(1.0 + float(mean[1, 0]), LEAST_LOAD))
        if between:
            means.append(mean[:, 0])
    for state in signals.legs:
        stretch, load = _between_periods(outputs, state, rate_hz=rate_hz, start_s=start_s)
        if stretch.shape[1] >= _SHORTEST_S * rate_hz and np.isfinite(stretch).all():
            cut.append(stretch - stretch.mean(axis=1, keepdims=True))
            loads.append(max(1.0 + load, LEAST_LOAD))
    if not cut:
        raise ValidationError(
            f"campaign {campaign.name}: expected a stretch of {rest_s + _AHEAD_S + _SHORTEST_S:g} s in which the set "
            "point stands still, to tell noise from what a model misses, found none; leave one between the tests."
        )
    scatter = np.var(means, axis=0, ddof=1) if len(means) > 1 else np.zeros(2)
    return QuietNoise(
        rate_hz=rate_hz, stretches=tuple(cut), loads=frozen_float(loads), offset_variance=frozen_float(scatter)
    )


def _between_periods(
    outputs: Callable[[slice], FloatArray], state: LegState, *, rate_hz: float, start_s: float
) -> tuple[FloatArray, float]:
    """Return what differs from period to period of a leg, over the root of two, and the mean deviation of its torque.

    Independent noise of two periods has twice the variance of one; what repeats itself is gone.
    """
    first, last = (round((time - start_s) * rate_hz) for time in (state.start_s, state.stop_s))
    values = outputs(slice(max(first, 0), last))
    places = np.arange(values.shape[1], dtype=np.float64)
    later = places[places + state.period_s * rate_hz <= places[-1]]
    shifted = np.stack([np.interp(later + state.period_s * rate_hz, places, row) for row in values])
    return (shifted - values[:, : later.size]) / math.sqrt(2.0), float(values[1].mean())


def _still(campaign: Campaign, end_s: float) -> Iterator[tuple[float, float, bool]]:
    """Yield where the set point stands still [s], and whether that is between the tests."""
    last = 0.0
    ramps = [move.free_s for move in campaign.moves]
    for test in campaign.excitations:
        if test.start_s > last and (last, test.start_s) not in ramps:
            yield last, test.start_s, True
        if isinstance(test, Staircase):
            edges = [test.start_s + step * test.dwell_s for step in range(len(test.levels_v) + 1)]
            yield from ((begin, stop, False) for begin, stop in pairwise(edges))
        last = test.stop_s
    if end_s > last and not any(begin == last for begin, _ in ramps):
        yield last, end_s, True
