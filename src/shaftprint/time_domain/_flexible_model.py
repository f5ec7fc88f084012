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
and every test is an F test. They are weighed with the noise that the first and the last of them leave. The likelihood
keeps the noise of ``_input_response``: more directions would take slow noise with them, and standard deviations under
noise that remembers for five seconds would come out an eighth too small.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import f_tail
from shaftprint.identify.likelihood._term_check import CheckKind, TermCheck
from shaftprint.time_domain._flexible_directions import (
    impulse_responses,
    slow_course,
    small_and_large,
    through_poles,
    up_and_down,
)
from shaftprint.time_domain._input_response import filled
from shaftprint.time_domain._noise_model import NoiseModel, estimate_noise
from shaftprint.time_domain._nuisance import left_of, orthonormal, without
from shaftprint.time_domain._record import Record
from shaftprint.time_domain._span import Span
from shaftprint.time_domain._whitening import Whitening

# What a flexible model follows is chance from this p-value on.
CHANCE = 1e-3
# Where it follows this share of what the structure leaves, its own rest is the better noise.
FOLLOWED = 0.5
# Residuals smaller than this share of the motion are rounding: simulated data without noise.
EXACT = 1e-9


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Difference:
    """What directions explain of what a structure leaves."""

    excess: float
    """Its mean square along them over that of the noise: 1 on average if the structure holds."""
    size: FloatArray
    """Root mean square over that of the motion, without what noise gives on average, shape (outputs,)."""
    p_value: float
    """Probability of that much or more if the structure holds."""


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
    parameters: tuple[str, ...]
    """Names of the free parameters."""
    noise: NoiseModel
    """The noise by which the fit was weighed."""
    nuisance: FloatArray
    """Offsets, drifts and effects of initial states, which are fitted too, shape (columns, samples, outputs)."""
    longest_memory_s: float
    """Longest memory of the noise that is tried [s]."""

    @cached_property
    def power(self) -> FloatArray:
        """Mean square of the noise of each output, shape (outputs,).

        It is what the structure leaves, less what the flexible model follows of that unless by chance; where it follows
        half or more, what the flexible model leaves. Always to take the latter would take a share of a tone that no
        input drives, such as a shaft order, for motion.
        """
        plain = self._misfit
        if self._exact:
            return plain
        flexible = self._difference(self._directions, self._fitted, self._noise)
        followed = flexible.size**2 * self._motion
        if flexible.p_value > CHANCE:
            return plain
        most = followed >= FOLLOWED**2 * plain
        unexplained = np.minimum(self._unexplained, plain) if np.any(most) else plain
        return np.asarray(np.where(most, unexplained, plain - followed))

    @cached_property
    def checks(self) -> tuple[TermCheck, ...]:
        """The structure against the flexible model, and parts of the record against each other; none without noise."""
        if self._exact:
            return ()
        groups: Mapping[CheckKind, FloatArray] = {
            "small and large": small_and_large(self.record, self.simulated),
            "up and down": up_and_down(self.record, self.simulated),
            "flexible": self._directions,
        }
        checks = [self.along(kind, directions) for kind, directions in groups.items()]
        return (*checks, *self._constancy, self._check("other data", self.slopes, self.nuisance, self._noise))

    @property
    def _constancy(self) -> Iterator[TermCheck]:
        """Each number early in the record against the same number late, one by one: what wanders is one of them.

        A number that moves slowly moves the outputs by its slope there; that holds for what moves slower than the
        outputs forget. It is asked under the noise that the deviations of the numbers rest on: the one beside a
        flexible model takes colour from its many directions where samples are few, and numbers of sound drives moved.
        """
        course = slow_course(self.record)[:, :, None]
        for name, slope in zip(self.parameters, self.slopes, strict=True):
            check = self._check("constancy", slope * course, self._fitted, self.noise)
            yield replace(check, parameter=name)

    def along(self, kind: CheckKind, directions: FloatArray) -> TermCheck:
        """Return how much of what the structure leaves lies along directions, (directions, samples, outputs)."""
        return self._check(kind, directions, self._fitted, self._noise)

    @cached_property
    def _unexplained(self) -> FloatArray:
        """Mean square of the noise beside all directions, shape (outputs,).

        That is what they leave and, since weights are those of the noise, what they take of it on average:
        ``tr V = tr (V - X (X^T V^-1 X)^-1 X^T) + tr X (X^T V^-1 X)^-1 X^T``. The noise is found anew beside all of
        them: the one that gives the poles still holds the mode that they explain.
        """
        noise = self._noise_beside(self._directions, self._noise)
        span, unexplained = self._beside(self._directions, noise)
        every, used = np.concatenate([self._fitted, self._directions]), self.record.used
        return np.asarray(np.mean(unexplained[used] ** 2, axis=0) + self._energy(every, span.turn) / used.sum())

    @cached_property
    def _noise(self) -> NoiseModel:
        """The noise beside all but what goes through its own poles, by generalised least squares."""
        return self._noise_beside(self._plain, self._noise_beside(self._plain, None))

    def _noise_beside(self, directions: FloatArray, weight: NoiseModel | None) -> NoiseModel:
        """Return the noise of what directions leave under the weight of another noise."""
        _, unexplained = self._beside(directions, weight)
        every, used = np.concatenate([self._fitted, directions]), self.record.used
        noise = np.zeros(unexplained.shape)
        for output in range(len(self.names)):
            basis = orthonormal(every[:, used, output])
            noise[used, output] = filled(self.residuals[used, output], unexplained[used, output], basis)
        order = round(self.longest_memory_s * self.record.rate_hz)
        return estimate_noise(noise, self.record.stretches, max_order=order)

    @cached_property
    def _fitted(self) -> FloatArray:
        """What was fitted, shape (rows, samples, outputs)."""
        return np.concatenate([self.nuisance, self.slopes])

    @cached_property
    def _plain(self) -> FloatArray:
        """Directions that do not depend on the noise, shape (directions, samples, outputs)."""
        return np.concatenate([
            impulse_responses(self.record, len(self.names)),
            small_and_large(self.record, self.simulated),
            up_and_down(self.record, self.simulated),
        ])  # fmt: skip

    @cached_property
    def _directions(self) -> FloatArray:
        """All directions, shape (directions, samples, outputs)."""
        return np.concatenate([self._plain, through_poles(self.record, self._noise)])

    def _beside(self, directions: FloatArray, weight: NoiseModel | None) -> tuple[Span, FloatArray]:
        """Return what was fitted and directions under the weight of a noise, and what they leave of the residuals."""
        white = self._counted if weight is None else Whitening(noise=weight).whitened
        every = np.concatenate([self._fitted, directions])
        span = Span.of(_flat(white(every, self.record.stretches)))
        target = white(self.residuals[None], self.record.stretches).ravel()
        return span, self.residuals - np.tensordot(span.shares(target), every, axes=1)

    def _counted(self, values: FloatArray, stretches: object) -> FloatArray:
        """Return the samples that count, as a filter of white noise would, shape (rows, counted samples, outputs)."""
        return values[:, self.record.used]

    def _check(self, kind: CheckKind, directions: FloatArray, fitted: FloatArray, noise: NoiseModel) -> TermCheck:
        """Return how much of the residuals lies along directions, beside what was fitted, under a noise."""
        difference = self._difference(directions, fitted, noise)
        level = np.sqrt(self.power / np.maximum(self._motion, np.finfo(np.float64).tiny))
        largest = int(np.argmax(difference.size / level))
        return TermCheck(
            kind=kind,
            output=self.names[largest],
            share=float(difference.size[largest]),
            noise=float(level[largest]),
            excess=difference.excess,
            p_value=difference.p_value,
        )

    def _difference(self, directions: FloatArray, fitted: FloatArray, noise: NoiseModel) -> "_Difference":
        """Return what directions explain of the residuals beside what was fitted."""
        white = Whitening(noise=noise).whitened
        target, basis, rows = (
            _flat(white(values, self.record.stretches)) for values in (self.residuals[None], fitted, directions)
        )
        basis = orthonormal(basis)
        unexplained = without(target[0], basis)
        span = Span.of(left_of(rows, basis))
        shares, explained = span.shares(unexplained), span.explained(unexplained)
        spare = unexplained.size - len(basis) - span.rank - noise.coefficients.size
        beyond = max(float(unexplained @ unexplained) - explained, 0.0) / max(spare, 1)
        enough = spare > 0 and span.rank > 0 and beyond > 0.0
        excess = explained / span.rank / beyond if enough else 1.0
        return _Difference(
            excess=excess,
            size=self._sizes(directions, np.sqrt(beyond) * span.turn, shares, fitted),
            p_value=f_tail(excess, span.rank, spare) if enough else 1.0,
        )

    def _sizes(self, directions: FloatArray, turn: FloatArray, shares: FloatArray, fitted: FloatArray) -> FloatArray:
        """Return the size of a difference over that of the motion, without what noise gives on average, (outputs,).

        ``directions``, ``fitted``: what it is made of, and what it is taken beside, shape (rows, samples, outputs).
        ``turn``: weights of the directions that noise gives, as independent vectors, shape (directions, rank).
        ``shares``: weights that the difference has, shape (directions,).
        """
        used = self.record.used
        basis = orthonormal(_flat(fitted[:, used]))
        across = without(_flat(directions[:, used]), basis).reshape(len(directions), -1, len(self.names))
        square, chance = (
            np.asarray(np.sum(np.tensordot(weights.T, across, axes=1) ** 2, axis=(0, 1)))
            for weights in (shares[:, None], turn)
        )
        motion = used.sum() * np.where(self._motion > 0.0, self._motion, np.inf)
        return np.asarray(np.sqrt(np.maximum(square - chance, 0.0) / motion))

    def _energy(self, directions: FloatArray, turn: FloatArray) -> FloatArray:
        """Return what noise gives along directions on average, summed over the counted samples, shape (outputs,)."""
        return np.asarray(np.sum(np.tensordot(turn.T, directions[:, self.record.used], axes=1) ** 2, axis=(0, 1)))

    @property
    def _misfit(self) -> FloatArray:
        """Mean square of what the structure leaves, right in size on average, shape (outputs,)."""
        used = self.record.used
        spare = max(int(used.sum()) - len(self._fitted), 1)
        return np.asarray(np.sum(self.residuals[used] ** 2, axis=0) / spare)

    @property
    def _exact(self) -> bool:
        """Whether the structure follows some output but for rounding."""
        return bool(np.any(np.sqrt(self._misfit) <= EXACT * np.sqrt(self._motion)))

    @property
    def _motion(self) -> FloatArray:
        """Variance of each output, shape (outputs,)."""
        return np.asarray(self.measured[self.record.used].var(axis=0))


def _flat(rows: FloatArray) -> FloatArray:
    """Return rows of shape (rows, samples, outputs) as (rows, samples outputs), none where there are none."""
    return rows.reshape(rows.shape[0], rows.shape[1] * rows.shape[2])
