"""Where in a stretch the error of a model can lie: the rest of the stretch shows noise alone, and is left out.

A model answers the set point. What it misses of a step begins with the step and is over when the line has settled;
before and after that it can only be off by a constant. What it misses of a sweep has the frequencies of the sweep and
their multiples, and a mean that moves slowly where a limit acts one way more than the other. Each of these is a linear
space, and a residual is projected on it: all of the error stays, and the noise outside is gone.

The projections ``T`` are orthogonal and take the mean off, so that for noise of covariance ``R`` the trace of
``(T R T)^2`` is what the variance of its energy and the mixed term of noise and error need.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.validation.measures._step_numbers import STEP_NUMBERS, step_numbers

# A line that settles twice as late as its model is still judged to where it settles.
_SETTLING_TIMES = 2.0
# So many samples for one period of the fastest that the low-pass leaves make the covariance of the noise.
_SAMPLES_A_PERIOD = 4.0
# A sweep is wide open at its ends: what it excites begins below the frequency with which a stretch begins.
_BELOW_LOWEST = 0.8
# Slower than so many periods in a stretch, the mean may move.
_SLOW_PERIODS = 4.0


class Reach(Protocol):
    """Where in a stretch the error of a model can lie."""

    def of(self, values: FloatArray) -> FloatArray:
        """Return the part of signals in it, without mean, shape (..., samples) as given."""
        ...

    def trace_of_square(self, pieces: FloatArray, autocovariance: FloatArray, samples: int) -> float:
        """Return the trace of the square of the covariance that noise has in it, for a stretch of some samples.

        ``pieces``: pieces of the noise, shape (pieces, samples of a piece), projected. ``autocovariance``:
        autocovariance of the noise before that, from lag 0 on, shape (lags,). ``samples``: samples of the stretch.
        """
        ...


@dataclass(frozen=True, slots=True)
class Everywhere:
    """All of the stretch."""

    def of(self, values: FloatArray) -> FloatArray:
        """Return signals without their mean."""
        return np.asarray(values - values.mean(axis=-1, keepdims=True))

    def trace_of_square(self, pieces: FloatArray, autocovariance: FloatArray, samples: int) -> float:
        """Return the trace of the square of the covariance matrix that an autocovariance makes."""
        lags = np.arange(min(autocovariance.size, samples))
        weights = (samples - lags) * np.where(lags > 0, 2.0, 1.0)
        return float(np.sum(weights * autocovariance[: lags.size] ** 2))


EVERYWHERE = Everywhere()
"""All of a stretch, for what no step and no sweep bounds."""


@dataclass(frozen=True, kw_only=True, slots=True)
class WhileSettling:
    """From a step until the line has settled, and two levels beside it."""

    first: int
    """Sample of the step."""
    stop: int
    """First sample at which the line has settled."""
    stride: int
    """Samples of which one is enough to tell the covariance of the noise."""

    def of(self, values: FloatArray) -> FloatArray:
        """Return signals with what is before the step and after settling at its mean, without the mean of all."""
        kept = values.copy()
        for level in (np.s_[: self.first], np.s_[self.stop :]):
            part = kept[..., level]
            if part.shape[-1]:
                part[...] = part.mean(axis=-1, keepdims=True)
        return np.asarray(kept - kept.mean(axis=-1, keepdims=True))

    def trace_of_square(self, pieces: FloatArray, autocovariance: FloatArray, samples: int) -> float:
        """Return the trace of ``(T R T)^2``, from every stride-th row and column of ``R``."""
        lags = autocovariance[: samples : self.stride]
        size = -(-samples // self.stride)
        places = np.arange(size)
        covariance = np.pad(lags, (0, size - lags.size))[np.abs(places[:, None] - places)]
        thin = WhileSettling(first=self.first // self.stride, stop=self.stop // self.stride, stride=1)
        covariance = thin.of(thin.of(covariance).T)
        return float(np.sum(covariance**2)) * self.stride**2


@dataclass(frozen=True, kw_only=True, slots=True)
class Swept:
    """The frequencies that a stretch of a sweep excites, and a mean that moves slowly."""

    rate_hz: float
    """Sample rate [Hz]."""
    lowest_hz: float
    """Frequency with which the stretch begins [Hz]."""

    def of(self, values: FloatArray) -> FloatArray:
        """Return signals without mean and without the frequencies between."""
        samples = values.shape[-1]
        spectrum = np.fft.rfft(values, axis=-1)
        frequency = np.fft.rfftfreq(samples, 1.0 / self.rate_hz)
        slow_hz = _SLOW_PERIODS * self.rate_hz / samples
        between = (frequency > slow_hz) & (frequency < _BELOW_LOWEST * self.lowest_hz)
        spectrum[..., between | (frequency == 0.0)] = 0.0
        return np.asarray(np.fft.irfft(spectrum, samples, axis=-1))

    def trace_of_square(self, pieces: FloatArray, autocovariance: FloatArray, samples: int) -> float:
        """Return the trace for the mean power of the pieces at each frequency, which the projection leaves alone."""
        count, length = pieces.shape
        power = np.mean(np.abs(np.fft.fft(pieces, axis=-1)) ** 2, axis=0) / length
        # the square of a mean of so many exponential variables is that much too large
        square = float(np.sum(power**2)) / (1.0 + 1.0 / count)
        return float(square * samples / length)


def while_settling(model: FloatArray, time_s: FloatArray, *, settled_share: float, highest_hz: float) -> Reach:
    """Return where a model can err in its response to one step.

    ``model``: its response, shape (samples,). ``time_s``: time after the step [s], shape (samples,), negative before
    it. ``settled_share``: share of the height within which a response has settled. ``highest_hz``: cut-off of the
    low-pass that data and model went through [Hz].
    """
    place = list(STEP_NUMBERS).index("settling time")
    settling_s = float(step_numbers(model[None], time_s, settled_share=settled_share)[place, 0])
    if not np.isfinite(settling_s):
        return EVERYWHERE
    step_s = float(time_s[1] - time_s[0])
    first, stop = np.searchsorted(time_s, (0.0, _SETTLING_TIMES * settling_s))
    stride = max(int(1.0 / (_SAMPLES_A_PERIOD * highest_hz * step_s)), 1)
    return WhileSettling(first=int(first), stop=int(stop), stride=stride)
