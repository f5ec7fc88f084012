"""How well a test would find the parameters, before it is made: Cramer-Rao standard deviations in words.

The inverse of the Fisher information ``J^T C^-1 J``, priors included, at assumed parameter values: no unbiased estimate
from such lines is better on average (Cramer, Mathematical Methods of Statistics, section 32.3), and a fit weighted by
the covariance attains it where the standard deviations are small against the curvature of the response. Where a
covariance was estimated, what its degrees of freedom cost is in it, averaged over the noise.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, correlation_of, frozen_float
from shaftprint.digits import stated
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._covariance import known_covariance, known_variance
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._pseudo_inverse import PseudoInverse
from shaftprint.identify.likelihood._objective import Objective
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.prediction._inseparable_groups import Group, inseparable_groups
from shaftprint.identify.prediction._planned_objective import assumed_values, planned_objective, value_and_slopes
from shaftprint.models._combination import Combination
from shaftprint.models._structure import Structure
from shaftprint.notebook._shown import Shown
from shaftprint.spectra._frequency_response import FrequencyResponse

# Standard deviations over the value that the words tell apart.
LEVELS = (0.01, 0.05, 0.2)
# A parameter is no better known than before where the test leaves more than this share of the prior's deviation.
NOTHING_NEW = 0.8


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Accuracy(Shown):
    """Standard deviations and correlations that a test would give."""

    objective: Objective
    """The lines with their covariance, the structures and the priors."""
    values: FloatArray
    """Assumed values of all parameters, in the objective's order, shape (parameters,)."""
    covariance: FloatArray
    """Covariance of the free parameters, shape (free, free); infinite variances where nothing is known."""
    parameters: tuple[Estimate, ...]
    """Every free parameter at its assumed value, with its standard deviation."""
    combinations: tuple[Estimate, ...]
    """Combinations of parameters, with their standard deviations to first order."""
    groups: tuple[Group, ...]
    """Parameters that the test cannot separate, the worst first."""
    priors: Mapping[str, Prior]
    """Priors, by name of the parameter."""

    @property
    def correlation(self) -> FloatArray:
        """Correlation of the free parameters, shape (free, free); nan where a variance is infinite."""
        return correlation_of(self.covariance)

    @property
    def numbers(self) -> tuple[Estimate, ...]:
        """Parameters and combinations."""
        return (*self.parameters, *self.combinations)

    def estimate(self, name: str) -> Estimate:
        """Return one parameter or combination.

        Raises IdentificationError if there is none of that name.
        """
        estimates = {estimate.name: estimate for estimate in self.numbers}
        if name not in estimates:
            raise IdentificationError(f"accuracy of {self.objective.name}: {name} is not among {', '.join(estimates)}.")
        return estimates[name]

    @property
    def sentences(self) -> tuple[str, ...]:
        """What the test would find and how well, what it cannot separate, and where first order is too little."""
        return (*self._levels(), *(group.sentence for group in self.groups), *self._nothing_new(), *self._at_bounds())

    @property
    def text(self) -> str:
        """The sentences, one a line."""
        return "\n".join(self.sentences)

    def _levels(self) -> list[str]:
        every = [e for e in self.numbers if e.value != 0.0]
        share = {e.name: e.std / abs(e.value) for e in every}
        sentences = []
        below = 0.0
        for level in LEVELS:
            names = [name for name, part in share.items() if below < part <= level]
            if names:
                sentences.append(f"Known to {100 * level:g} % or better: {', '.join(names)}.")
            below = level
        poor = [name for name, part in share.items() if LEVELS[-1] < part < 1.0]
        lost = [name for name, part in share.items() if part >= 1.0]
        if poor:
            sentences.append(f"Hardly known, worse than {100 * LEVELS[-1]:g} %: {', '.join(poor)}.")
        if lost:
            sentences.append(f"Not known: {', '.join(lost)}.")
        return sentences

    def _nothing_new(self) -> list[str]:
        std = {e.name: e.std for e in self.parameters}
        units = {e.name: e.unit for e in self.parameters}
        return [
            f"{name} stays at its prior, {stated(prior.mean, prior.std, units[name])}: the test says little about it."
            for name, prior in self.priors.items()
            if std[name] > NOTHING_NEW * prior.std
        ]

    def _at_bounds(self) -> list[str]:
        sentences = []
        for parameter, estimate in zip(self.objective.free_parameters, self.parameters, strict=True):
            reached = [
                bound
                for bound, distance in (
                    (parameter.lower, estimate.value - parameter.lower),
                    (parameter.upper, parameter.upper - estimate.value),
                )
                if distance < estimate.std < np.inf
            ]
            if reached:
                sentences.append(
                    f"{estimate.name}: one standard deviation, {estimate.std:.2g}, reaches past the bound "
                    f"{' and '.join(f'{bound:g}' for bound in reached)}; its interval will end there, and these first-"
                    "order numbers are only a rough guide to it."
                )
        return sentences


def predict_accuracy(
    structure: Structure,
    response: FrequencyResponse,
    *,
    values: Mapping[str, float] | None = None,
    priors: Mapping[str, Prior] | None = None,
    combinations: Sequence[Combination] = (),
    lines: Sequence[str] | None = None,
) -> Accuracy:
    """Return how well given lines would find the parameters of a structure.

    Parameters
    ----------
    structure
        The structure.
    response
        Lines with their covariance, of a recording or of ``planned_response``; its values do not matter.
    values
        Assumed parameter values by name; the structure's own where not given.
    priors
        Priors of free parameters by name.
    combinations
        Combinations to report besides those of the structure.
    lines
        Names of the lines to fit; those that the response marks as used by default.

    Raises
    ------
    StructureError
        If a value names no parameter of the structure.
    IdentificationError
        If structure and response do not fit together, a prior names no free parameter, no parameter is free or a value
        is outside its bounds.
    """
    return _predicted([(structure, response)], values or {}, priors or {}, combinations, lines)


def predict_joint_accuracy(
    pairs: Sequence[tuple[Structure, FrequencyResponse]],
    *,
    values: Mapping[str, float] | None = None,
    priors: Mapping[str, Prior] | None = None,
    combinations: Sequence[Combination] = (),
) -> Accuracy:
    """Return how well several tests together would find the parameters; parameters of one name are one parameter.

    ``pairs``: each structure with its lines; for another working point it is ``Structure.scaled``. ``values``,
    ``priors``, ``combinations``: see ``predict_accuracy``. Raises IdentificationError as ``predict_accuracy``, or if
    two structures describe a parameter differently.
    """
    return _predicted(pairs, values or {}, priors or {}, combinations, None)


def predict_joint_deviations(
    pairs: Sequence[tuple[Structure, FrequencyResponse]],
    *,
    values: Mapping[str, float],
    priors: Mapping[str, Prior],
) -> tuple[dict[str, float], FloatArray]:
    """Return the deviations of ``predict_joint_accuracy`` and the covariance, without groups that it cannot separate.

    ``pairs``, ``values``, ``priors``: see ``predict_joint_accuracy``. Returns standard deviations of parameters and
    combinations by name, and the covariance of the free parameters; infinite where nothing is known.
    """
    objective = planned_objective(pairs, priors)
    theta = assumed_values(objective, values)[list(objective.free)]
    covariance, information = known_covariance(objective, theta, expected=True)
    deviations = {
        combination.name: _derived(objective, theta, combination, covariance, information).std
        for combination in objective.combinations
    }
    covariance[information.lost, information.lost] = np.inf
    of_parameters = np.sqrt(np.diag(covariance)).tolist()
    names = [parameter.name for parameter in objective.free_parameters]
    return dict(zip(names, of_parameters, strict=True)) | deviations, covariance


def _predicted(
    pairs: Sequence[tuple[Structure, FrequencyResponse]],
    values: Mapping[str, float],
    priors: Mapping[str, Prior],
    combinations: Sequence[Combination],
    lines: Sequence[str] | None,
) -> Accuracy:
    objective = planned_objective(pairs, priors, lines)
    assumed = assumed_values(objective, values)
    theta = assumed[list(objective.free)]
    within, information = known_covariance(objective, theta, expected=True)
    covariance = within.copy()
    covariance[information.lost, information.lost] = np.inf
    parameters = tuple(
        Estimate(name=p.name, unit=p.unit, value=float(value), std=float(np.sqrt(variance)))
        for p, value, variance in zip(objective.free_parameters, theta, np.diag(covariance), strict=True)
    )
    named = {c.name: c for c in (*objective.combinations, *combinations)}

    def estimate(combination: Combination) -> Estimate:
        return _derived(objective, theta, combination, within, information)

    return Accuracy(
        objective=objective,
        values=frozen_float(assumed),
        covariance=frozen_float(covariance),
        parameters=parameters,
        combinations=tuple(estimate(combination) for combination in named.values()),
        groups=inseparable_groups(objective, parameters, covariance, tuple(named.values()), estimate),
        priors=dict(priors),
    )


def _derived(
    objective: Objective,
    theta: FloatArray,
    combination: Combination,
    covariance: FloatArray,
    information: PseudoInverse,
) -> Estimate:
    """Return a combination with its standard deviation to first order; infinite where it cannot be formed."""
    value, slopes = value_and_slopes(objective, theta, combination)
    finite = np.isfinite(value) and bool(np.all(np.isfinite(slopes)))
    variance = known_variance(slopes, covariance, information) if finite else np.inf
    return Estimate(name=combination.name, unit=combination.unit, value=value, std=float(np.sqrt(variance)))
