"""What a flexible model makes of a record: noise without the structure's misfit in it, and tests of the structure.

Noise that is taken from the residuals of a structure holds its misfit: a drive with dry friction under a linear
structure was "trusted" with a FitPercent of 50 %, and a mode that rings for longer than an impulse response was noise.
So the residuals are explained by all that the structure might lack, and what remains is noise:

- finite impulse responses from the inputs: any linear structure that settles within seconds;
- the same through the poles of the noise, as in an ARX model: what rings for longer (Ljung, System Identification:
  Theory for the User, second edition, section 4.2);
- the simulated outputs ``f`` as ``sign f``, ``f |f|`` and ``|f|`` through lags of several lengths: small motions other
  than large ones, and motions up other than motions down (the Hammerstein form of Billings, Nonlinear System
  Identification, 2013, section 2.3, in the outputs, where friction acts).

Inputs and simulated outputs are free of noise, so that directions and noise are independent where the structure holds,
and every test is an F test. They are weighed with a noise model from the flexible model, found by generalised least
squares in several passes. The likelihood keeps the noise of ``_input_response``: more directions would take slow noise
with them, and standard deviations under noise that remembers for five seconds would come out an eighth too small.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.signal import lfilter
from scipy.special import fdtrc

from shaftprint.arrays import FloatArray
from shaftprint.identify import CheckKind, TermCheck
from shaftprint.time_domain._input_response import delayed_inputs
from shaftprint.time_domain._noise_model import NoiseModel, estimate_noise
from shaftprint.time_domain._nuisance import orthonormal, without
from shaftprint.time_domain._record import Record
from shaftprint.time_domain._span import Span
from shaftprint.time_domain._whitening import Whitening

# Lengths of the lags: so many, from two samples to this share of the record.
LAGS, LONGEST_SHARE = 4, 1.0 / 40.0
# Speed, over its standard deviation, at which the sign of a motion is complete.
SIGN_WIDTH = 0.05
# An output reverses where at least this share of its samples lies on either side of zero.
REVERSES = 0.02
# Lags of the inputs through the poles of the noise: a mode has two poles, straight lines between samples one more.
MODE_LAGS = 6
# How often noise and what is taken from it are found anew.
PASSES = 3
# One lag of the impulse response for so many samples.
SAMPLES_A_LAG = 10


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Rest:
    """What directions leave of the residuals of a structure."""

    directions: FloatArray
    """The directions, shape (directions, samples, outputs)."""
    noise: NoiseModel
    """The colour of what they leave."""
    power: FloatArray
    """Mean square of the noise, shape (outputs,): what they leave and, with the weight of the noise, what they take of
    it on average, ``tr V - tr X (X^T V^-1 X)^-1 X^T + tr X (X^T V^-1 X)^-1 X^T``."""


@dataclass(frozen=True, kw_only=True, eq=False)
class FlexibleModel:
    """What a structure leaves of a record, beside a model that is more flexible than it."""

    record: Record
    """The data."""
    names: tuple[str, ...]
    """Names of the outputs."""
    measured: FloatArray
    """Outputs, shape (samples, outputs)."""
    residuals: FloatArray
    """What the structure leaves of them, shape (samples, outputs)."""
    simulated: FloatArray
    """Outputs of the structure without offset and drift, shape (samples, outputs)."""
    slopes: FloatArray
    """Derivatives of these to the free parameters, shape (free, samples, outputs)."""
    nuisance: FloatArray
    """Offsets, drifts and effects of initial states, which are fitted too, shape (columns, samples, outputs)."""
    longest_memory_s: float
    """Longest memory of the noise that is tried [s]."""

    @cached_property
    def power(self) -> FloatArray:
        """Mean square of the noise of each output, of what the flexible model leaves, shape (outputs,)."""
        return self._passes.power

    @cached_property
    def checks(self) -> tuple[TermCheck, ...]:
        """The structure against the flexible model, and parts of the record against each other."""
        fitted = np.concatenate([self.nuisance, self.slopes])
        half = np.where(np.cumsum(self.record.used) <= 0.5 * self.record.used.sum(), -1.0, 1.0)
        groups: Mapping[CheckKind, FloatArray] = {
            "small and large": self._small_and_large,
            "up and down": self._up_and_down,
            "halves": self.slopes * half[:, None],
            "flexible": self._passes.directions,
        }
        found = [self._check(kind, directions, fitted) for kind, directions in groups.items()]
        return (*found, self._check("other data", self.slopes, self.nuisance))

    @cached_property
    def _passes(self) -> "_Rest":
        """What remains after the last pass."""
        fitted = np.concatenate([self.nuisance, self.slopes])
        count = max(int(self.record.used.sum()) // (SAMPLES_A_LAG * len(self.record.inputs)), 1)
        plain = np.concatenate([
            self._on_each(delayed_inputs(self.record, most=count)), self._small_and_large, self._up_and_down
        ])  # fmt: skip
        found = self._beside(plain, fitted, None)
        for _ in range(PASSES):
            found = self._beside(np.concatenate([plain, self._through_poles(found.noise)]), fitted, found.noise)
        return found

    def _beside(self, directions: FloatArray, fitted: FloatArray, weight: NoiseModel | None) -> "_Rest":
        """Return the residuals without directions, fitted with the weight of a noise, right in size on average."""
        white = self._counted if weight is None else Whitening(noise=weight).whitened
        every = np.concatenate([fitted, directions])
        rows = _flat(white(every, self.record.stretches))
        target = white(self.residuals[None], self.record.stretches).ravel()
        span, used = Span.of(rows), self.record.used
        rest = self.residuals - np.tensordot(span.shares(target), every, axes=1)
        right_in_size = rest * np.sqrt(target.size / max(target.size - span.rank, 1))
        order = round(self.longest_memory_s * self.record.rate_hz)
        noise = estimate_noise(right_in_size, self.record.stretches, max_order=order)
        power = np.mean(rest[used] ** 2, axis=0) + self._energy(every, span.turn) / used.sum()
        return _Rest(directions=directions, noise=noise, power=power)

    def _counted(self, values: FloatArray, stretches: object) -> FloatArray:
        """Return the samples that count, as a filter of white noise would, shape (rows, counted samples, outputs)."""
        return values[:, self.record.used]

    def _check(self, kind: CheckKind, directions: FloatArray, fitted: FloatArray) -> TermCheck:
        """Return how much of the residuals lies along directions, beside what was fitted."""
        noise = self._passes.noise
        white = Whitening(noise=noise).whitened
        target, basis, rows = (
            _flat(white(values, self.record.stretches)) for values in (self.residuals[None], fitted, directions)
        )
        basis = orthonormal(basis)
        rest = without(target[0], basis)
        span = Span.of(without(rows, basis))
        shares, explained = span.shares(rest), span.explained(rest)
        spare = rest.size - len(basis) - span.rank - noise.coefficients.size
        beyond = (rest @ rest - explained) / max(spare, 1)
        size = self._sizes(directions, span.turn, shares, fitted)
        level = np.sqrt(self.power / np.maximum(self._motion_power, np.finfo(np.float64).tiny))
        largest = int(np.argmax(size / level))
        enough = spare > 0 and span.rank > 0 and beyond > 0.0
        return TermCheck(
            kind=kind,
            output=self.names[largest],
            share=float(size[largest]),
            noise=float(level[largest]),
            p_value=float(fdtrc(span.rank, spare, explained / span.rank / beyond)) if enough else 1.0,
        )

    def _sizes(self, directions: FloatArray, turn: FloatArray, shares: FloatArray, fitted: FloatArray) -> FloatArray:
        """Return the size of a difference over that of the motion, without what noise gives on average, (outputs,).

        Parameters
        ----------
        directions, fitted
            What it is made of, and what it is taken beside, shape (rows, samples, outputs).
        turn
            Weights of the directions that independent noise of unit variance has, shape (directions, rank).
        shares
            Weights that the difference has, shape (directions,).
        """
        used = self.record.used
        basis = orthonormal(_flat(fitted[:, used]))
        beside = without(_flat(directions[:, used]), basis).reshape(len(directions), -1, len(self.names))
        square, chance = (
            np.sum(np.tensordot(weights.T, beside, axes=1) ** 2, axis=(0, 1)) for weights in (shares[:, None], turn)
        )
        motion = used.sum() * np.where(self._motion_power > 0.0, self._motion_power, np.inf)
        return np.asarray(np.sqrt(np.maximum(square - chance, 0.0) / motion))

    def _energy(self, directions: FloatArray, turn: FloatArray) -> FloatArray:
        """Return what noise gives along directions on average, summed over the counted samples, shape (outputs,)."""
        return np.asarray(np.sum(np.tensordot(turn.T, directions[:, self.record.used], axes=1) ** 2, axis=(0, 1)))

    @property
    def _motion_power(self) -> FloatArray:
        """Variance of each output, shape (outputs,)."""
        return np.asarray(self.measured[self.record.used].var(axis=0))

    @cached_property
    def _small_and_large(self) -> FloatArray:
        """What large motions may do other than small ones, odd in the motion, shape (directions, samples, outputs)."""
        size = self.simulated.std(axis=0)
        scaled = self._motion / np.where(size > 0.0, size, 1.0)
        rows = np.concatenate([np.clip(scaled / SIGN_WIDTH, -1.0, 1.0), scaled * np.abs(scaled)], axis=1)
        return self._on_each(self._lagged(rows.T))

    @cached_property
    def _up_and_down(self) -> FloatArray:
        """What motions up may do other than motions down, shape (directions, samples, outputs)."""
        return self._on_each(self._lagged(np.abs(self._motion).T))

    @property
    def _motion(self) -> FloatArray:
        """Simulated outputs, about zero where they reverse and about their mean where not, shape (samples, outputs)."""
        up = np.mean(self.simulated > 0.0, axis=0)
        reverses = (up > REVERSES) & (up < 1.0 - REVERSES)
        return np.asarray(self.simulated - np.where(reverses, 0.0, self.simulated.mean(axis=0)))

    def _lagged(self, rows: FloatArray) -> FloatArray:
        """Return rows, shape (rows, samples), as they are and behind first-order lags."""
        rate = self.record.rate_hz
        found = [rows]
        for lag_s in np.geomspace(2.0 / rate, max(LONGEST_SHARE * self.record.samples, 4.0) / rate, LAGS):
            pole = np.exp(-1.0 / (rate * lag_s))
            found.append(lfilter([1.0 - pole], [1.0, -pole], rows, zi=pole * rows[:, :1])[0])
        return np.concatenate(found)

    def _through_poles(self, noise: NoiseModel) -> FloatArray:
        """Return the latest samples of the inputs as if they were innovations of the noise."""
        recent = delayed_inputs(self.record, most=MODE_LAGS, longest_s=(MODE_LAGS - 1) / self.record.rate_hz)
        return noise.driven(self._on_each(recent))

    def _on_each(self, rows: FloatArray) -> FloatArray:
        """Return every row, shape (rows, samples), on every output alone: (rows outputs, samples, outputs)."""
        size = len(self.names)
        found = np.zeros((size, *rows.shape, size))
        for output in range(size):
            found[output, :, :, output] = rows
        return found.reshape(-1, self.record.samples, size)


def _flat(rows: FloatArray) -> FloatArray:
    """Return rows of shape (rows, samples, outputs) as (rows, samples outputs), none where there are none."""
    return rows.reshape(rows.shape[0], rows.shape[1] * rows.shape[2])
