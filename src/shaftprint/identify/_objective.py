"""What a fit minimises: weighted residuals of all experiments, and rows for what is known beforehand.

The cost is half the sum of squares of all residuals. For maximum likelihood it is the negative log-likelihood, up to a
constant, of all experiments together: they are independent of each other, and parameters of one name are one parameter.
A prior ``mean +/- std`` of a parameter is one more row, ``(theta - mean) / std``.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray, IntArray
from shaftprint.errors import IdentificationError
from shaftprint.identify._experiment import Experiment, build_experiment
from shaftprint.identify._prior import Prior
from shaftprint.identify._united_parameters import united_parameters
from shaftprint.identify._weighting import Weighting
from shaftprint.models import Combination, Parameter, Structure
from shaftprint.spectra import FrequencyResponse


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Redrawn:
    """Other data for the same problem, one row a repeat."""

    measured: tuple[ComplexArray, ...]
    """Of each experiment, fitted lines only, shape (repeats, channels, lines)."""
    weights: tuple[FloatArray | None, ...]
    """``W`` of each experiment's lines, shape (repeats, lines, size, size); None where they are the experiment's."""
    prior_means: FloatArray
    """Means of the prior rows, shape (repeats, prior rows)."""

    def chosen(self, repeats: IntArray | slice) -> "Redrawn":
        """Return some of the repeats."""
        return Redrawn(
            measured=tuple(m[repeats] for m in self.measured),
            weights=tuple(None if w is None else w[repeats] for w in self.weights),
            prior_means=self.prior_means[repeats],
        )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Objective:
    """A fit problem: experiments and prior rows, ready to be evaluated for many parameter sets at once."""

    parameters: tuple[Parameter, ...]
    """Independent parameters of all structures, each once, those of the first structure first."""
    experiments: tuple[Experiment, ...]
    """The responses with their structures."""
    prior_rows: FloatArray
    """Rows ``(index of free parameter, mean, 1 / std)`` of priors and regularisation, shape (rows, 3)."""
    prior_counts: FloatArray
    """1 for a row that is knowledge, 0 for one that only regularises, shape (rows,)."""
    held: FloatArray
    """Values of all parameters; the free ones are replaced in each evaluation, shape (parameters,)."""
    free: tuple[int, ...]
    """Places of the free parameters."""

    @property
    def structure(self) -> Structure:
        """The structure of the first experiment."""
        return self.experiments[0].structure

    @property
    def name(self) -> str:
        """Names of the structures, each once."""
        return " + ".join(dict.fromkeys(e.structure.name for e in self.experiments))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all parameters."""
        return tuple(p.name for p in self.parameters)

    @property
    def free_parameters(self) -> tuple[Parameter, ...]:
        """The parameters that the fit may change."""
        return tuple(self.parameters[i] for i in self.free)

    @property
    def lower(self) -> FloatArray:
        """Lower bounds of the free parameters."""
        return np.array([p.lower for p in self.free_parameters])

    @property
    def upper(self) -> FloatArray:
        """Upper bounds of the free parameters."""
        return np.array([p.upper for p in self.free_parameters])

    @property
    def combinations(self) -> tuple[Combination, ...]:
        """The combinations that the structures name, each once."""
        found: dict[str, Combination] = {}
        for combination in (c for e in self.experiments for c in e.structure.combinations):
            found.setdefault(combination.name, combination)
        return tuple(found.values())

    @property
    def data_count(self) -> int:
        """Number of real data: two a complex value."""
        return sum(e.data.size for e in self.experiments)

    def complete(self, theta: FloatArray) -> FloatArray:
        """Return all parameters, shape (..., parameters), from the free ones, shape (..., free)."""
        values = np.empty((*theta.shape[:-1], self.held.size))
        values[...] = self.held
        values[..., self.free] = theta
        return values

    def named(self, values: FloatArray) -> dict[str, FloatArray]:
        """Return every parameter of every structure by name, tied ones included, from values (..., parameters)."""
        found: dict[str, FloatArray] = {}
        for experiment in self.experiments[::-1]:
            found |= experiment.structure.named(experiment.own(values))
        return found

    def of_starts(self, theta: FloatArray, starts: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return the same as ``residuals``: every start has the same problem."""
        return self.residuals(theta)

    def residuals(self, theta: FloatArray, redrawn: Redrawn | None = None) -> tuple[FloatArray, FloatArray]:
        """Return weighted residuals and their derivatives for many parameter sets.

        Parameters
        ----------
        theta
            Free parameters, shape (starts, free).
        redrawn
            Other data for each start.

        Returns
        -------
            Residuals, shape (starts, rows), and Jacobian, shape (starts, free, rows); rows experiment by experiment,
            those of the priors last.
        """
        parts = [self._part(i, theta, redrawn) for i in range(len(self.experiments))]
        if self.prior_rows.size:
            parts.append(self._prior_part(theta, self.prior_rows[:, 1] if redrawn is None else redrawn.prior_means))
        table = parts[0] if len(parts) == 1 else np.concatenate(parts, axis=2)
        return table[:, 0], table[:, 1:]

    def sensitivity(self, theta: FloatArray, *, expected: bool) -> tuple[FloatArray, FloatArray]:
        """Return rows whose products are the information, and rows whose products are the variance of the slope.

        Parameters
        ----------
        theta
            Free parameters, shape (free,).
        expected
            Whether to average over the noise instead of taking the data as they are.

        Returns
        -------
            See ``Term.sensitivity``, each of shape (free, rows); rows that only regularise have no noise.
        """
        knowledge = self._prior_part(theta[None, :], self.prior_rows[:, 1])[0, 1:]
        parts = [self._spread(e, theta, expected=expected) for e in self.experiments]
        parts.append((knowledge, knowledge * self.prior_counts))
        rows, noise = zip(*parts, strict=True)
        return np.concatenate(rows, axis=1), np.concatenate(noise, axis=1)

    def _spread(self, experiment: Experiment, theta: FloatArray, *, expected: bool) -> tuple[FloatArray, FloatArray]:
        """Return the sensitivity of one experiment with a row for every free parameter."""
        found = []
        for own in experiment.sensitivity(theta[list(experiment.columns)], expected=expected):
            spread = np.zeros((theta.size, own.shape[1]))
            spread[list(experiment.columns)] = own
            found.append(spread)
        return found[0], found[1]

    def _part(self, number: int, theta: FloatArray, redrawn: Redrawn | None) -> FloatArray:
        """Return residuals of one experiment and below them their derivatives to all free parameters."""
        experiment = self.experiments[number]
        data = () if redrawn is None else (redrawn.measured[number], redrawn.weights[number])
        if experiment.columns == tuple(range(theta.shape[1])):
            return experiment.table(theta, *data)
        own = experiment.table(theta[:, experiment.columns], *data)
        table = np.zeros((theta.shape[0], 1 + theta.shape[1], own.shape[2]))
        table[:, [0, *(1 + column for column in experiment.columns)]] = own
        return table

    def _prior_part(self, theta: FloatArray, means: FloatArray) -> FloatArray:
        index = self.prior_rows[:, 0].astype(int)
        table = np.zeros((theta.shape[0], 1 + theta.shape[1], index.size))
        table[:, 0] = (theta[:, index] - means) * self.prior_rows[:, 2]
        table[:, 1 + index, np.arange(index.size)] = self.prior_rows[:, 2]
        return table


def build_objective(
    structure: Structure,
    response: FrequencyResponse,
    *,
    weighting: Weighting,
    priors: Mapping[str, Prior],
    regularisation: Mapping[str, Prior],
    lines: Sequence[str] | None = None,
) -> Objective:
    """Return the fit problem of one structure and one response, see ``build_joint_objective``."""
    return build_joint_objective(
        [(structure, response)], weighting=weighting, priors=priors, regularisation=regularisation, lines=lines
    )


def build_joint_objective(
    pairs: Sequence[tuple[Structure, FrequencyResponse]],
    *,
    weighting: Weighting,
    priors: Mapping[str, Prior],
    regularisation: Mapping[str, Prior],
    lines: Sequence[str] | None = None,
) -> Objective:
    """Return the fit problem of several structures, each with a response; parameters of one name are one.

    Parameters
    ----------
    lines
        Names of the lines to fit in every response; those that it marks as used by default.

    Raises
    ------
    IdentificationError
        If input or outputs differ, two structures describe a parameter differently, a prior names no free parameter,
        no parameter is free, or there are fewer data than free parameters.
    """
    if not pairs:
        raise IdentificationError("joint fit: expected at least one pair of structure and response, found none.")
    weighting.expect_outputs(list(dict.fromkeys(name for structure, _ in pairs for name in structure.outputs)))
    parameters = united_parameters([structure for structure, _ in pairs])
    names = [p.name for p in parameters]
    free = [p.name for p in parameters if not p.held]
    experiments = tuple(
        build_experiment(structure, response, weighting=weighting, lines=lines, names=names, free=free)
        for structure, response in pairs
    )
    known = [*priors.items(), *regularisation.items()]
    objective = Objective(
        parameters=parameters,
        experiments=experiments,
        prior_rows=np.empty((0, 3)),
        prior_counts=np.array([1.0] * len(priors) + [0.0] * len(regularisation)),
        held=np.array([p.value for p in parameters]),
        free=tuple(i for i, p in enumerate(parameters) if not p.held),
    )
    _expect_solvable(objective, [name for name, _ in known])
    rows = [[free.index(name), prior.mean, 1.0 / prior.std] for name, prior in known]
    return replace(objective, prior_rows=np.array(rows).reshape(-1, 3))


def _expect_solvable(objective: Objective, known: Sequence[str]) -> None:
    names = [p.name for p in objective.free_parameters]
    unknown = [name for name in known if name not in names]
    if unknown:
        raise IdentificationError(
            f"prior of {', '.join(unknown)}: structure {objective.name} has the free parameters {', '.join(names)}."
        )
    for p in objective.free_parameters:
        if not (np.isfinite(p.lower) and np.isfinite(p.upper)):
            raise IdentificationError(
                f"parameter {p.name} of structure {objective.name}: expected finite bounds of a free parameter, found "
                f"{p.lower} to {p.upper}; starts are drawn between them."
            )
    if not names:
        raise IdentificationError(
            f"structure {objective.name} has no free parameter: free one with free_between(), or compare its response."
        )
    if objective.data_count + len(known) < len(names):
        lines = sum(e.s.size for e in objective.experiments)
        raise IdentificationError(
            f"structure {objective.name} has {len(names)} free parameters, the response {objective.data_count} usable "
            f"numbers ({lines} lines): measure more lines or hold parameters."
        )
