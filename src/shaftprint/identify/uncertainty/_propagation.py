"""From the sources of uncertainty to the parameters: how each source moves the estimates, to first order.

The estimate follows its data by ``d theta = -A^-1 J dr`` with the change ``dr`` of the residuals, their derivatives
``J`` and ``A = J J^T``. Noise of the lines with the covariance ``V`` of the residuals gives ``A^-1 J V J^T A^-1``; the
mean of a prior, known to ``s``, that moves by ``dm`` gives ``A^-1 e dm / s^2`` with the unit vector ``e`` of its
parameter. Both together are the covariance of the estimates, exactly.

What moves all outputs of a line together, such as an error of the set-point scale, is taken out of the noise by name.
The noise of speed and of torque is correlated all the same. Each output has its own rows and columns of the covariance,
and half of what it shares with others: their parts add up, and one may be negative where errors of two outputs make up
for each other (as in the allocation of risk by its gradient, Tasche, Capital allocation to business units and
sub-portfolios: the Euler principle, 2008).
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._pseudo_inverse import PseudoInverse
from shaftprint.identify.likelihood._experiment import Experiment
from shaftprint.identify.likelihood._term import Term

NO_DIRECT: Mapping[str, float] = {}
NO_SHIFTS: Mapping[str, Mapping[str, float]] = {}


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Propagation:
    """How each source of uncertainty moves the free parameters."""

    noise: Mapping[str, FloatArray]
    """Part of the parameters' covariance by source of noise, shape (free, free)."""
    effects: Mapping[str, FloatArray]
    """Change of the parameters, with sign, for one standard deviation of each other source, shape (free,)."""
    information: PseudoInverse = field(repr=False)
    """Which directions are known at all."""

    def variances(self, slopes: FloatArray, direct: Mapping[str, float] = NO_DIRECT) -> dict[str, float]:
        """Return the variance of a number by source; empty where the data do not fix the number.

        ``slopes``: derivatives of the number to the free parameters, shape (free,). ``direct``: change of the number
        for one standard deviation of a source, with sign, beside that through the parameters.
        """
        if not np.all(np.isfinite(slopes)) or not self.information.knows(slopes):
            return {}
        parts = {name: float(slopes @ part @ slopes) for name, part in self.noise.items()}
        for name in dict.fromkeys([*self.effects, *direct]):
            through = float(slopes @ self.effects[name]) if name in self.effects else 0.0
            parts[name] = (through + direct.get(name, 0.0)) ** 2
        return parts


def propagation(identification: Identification, shifts: Mapping[str, Mapping[str, float]] = NO_SHIFTS) -> Propagation:
    """Return how noise, priors and further sources move the estimates of an identification.

    ``shifts``: by the name of a further source and of a parameter: change of the parameter, with sign, for one standard
    deviation.
    """
    objective = identification.objective
    theta = identification.values[list(objective.free)]
    rows, _ = objective.sensitivity(theta, expected=False)
    information = PseudoInverse.of(rows)
    noise: dict[str, FloatArray] = {}
    first = 0
    for term in objective.terms:
        pull = information.inverse @ rows[:, first : first + term.row_count]
        first += term.row_count
        for name, part in _noise_parts(term, pull).items():
            noise[name] = noise[name] + part if name in noise else part
    names = [parameter.name for parameter in objective.free_parameters]
    further = {source: np.array([moves.get(name, 0.0) for name in names]) for source, moves in shifts.items()}
    return Propagation(
        noise=noise, effects=_prior_effects(identification, information) | further, information=information
    )


def _noise_parts(term: Term, rows: FloatArray) -> dict[str, FloatArray]:
    """Return the part of the covariance that the noise of a term gives, by output where that can be told.

    ``rows``: ``A^-1 J`` of the term, shape (free, rows).
    """
    if isinstance(term, Experiment):
        return _of_outputs(term, rows)
    # residuals of independent unit variance, of all outputs together
    return {f"noise of {term.name}": rows @ rows.T}


def _of_outputs(experiment: Experiment, rows: FloatArray) -> dict[str, FloatArray]:
    """Return the part of the covariance that the noise of each output gives, and each cause that moves all of them.

    ``rows``: ``A^-1 J`` of the experiment, shape (free, size * lines): components of [Re, Im] slowest.
    """
    lines, size = experiment.data.shape
    by_line = rows.reshape(-1, size, lines).transpose(2, 0, 1) @ experiment.weights
    likelihood = experiment.weighting.is_likelihood
    covariance = experiment.covariance if likelihood else experiment.noise_covariance
    outputs = np.array([output for output, _ in experiment.structure.channels] * 2)
    common = {}
    for name, change in experiment.response.common.items():
        channels = change.reshape(size // 2, -1)[:, experiment.fitted]
        direction = np.concatenate([channels.real, channels.imag]).T
        moved = np.einsum("lia,la->li", by_line, direction)
        common[name] = moved.T @ moved
        covariance = covariance - direction[:, :, None] * direction[:, None, :]
    noise = {}
    for name in dict.fromkeys(outputs.tolist()):
        part = np.einsum("lia,lab,ljb->ij", by_line * (outputs == name), covariance, by_line)
        noise[f"noise of {name}"] = 0.5 * (part + part.T)
    return noise | common


def _prior_effects(identification: Identification, information: PseudoInverse) -> dict[str, FloatArray]:
    """Return the change of the parameters for one standard deviation of each source of the priors."""
    names = [parameter.name for parameter in identification.objective.free_parameters]
    effects: dict[str, FloatArray] = {}
    for name, prior in identification.settings.priors.items():
        along = information.inverse[:, names.index(name)] / prior.std**2
        for source, part in prior.by_source(name).items():
            effects[source] = effects.get(source, np.zeros(along.size)) + part * along
    return effects
