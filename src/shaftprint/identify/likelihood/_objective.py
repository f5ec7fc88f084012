"""What a fit minimises: weighted residuals of all terms, and rows for priors.

The cost is half the sum of squares of all residuals. For maximum likelihood it is the negative log-likelihood, up to a
constant, of all terms together, frequency responses and records in time: they are independent of each other, and
parameters of one name are one parameter.
A prior ``mean +/- std`` of a parameter is one more row, ``(theta - mean) / std``.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, IntArray
from shaftprint.identify.likelihood._experiment import Experiment
from shaftprint.identify.likelihood._term import Repeats, Term
from shaftprint.models._combination import Combination
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure
from shaftprint.notebook._shown import Shown


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Redrawn:
    """Other data for the same problem, one row a repeat."""

    repeats: tuple[Repeats, ...]
    """Of each term."""
    prior_means: FloatArray
    """Means of the prior rows, shape (repeats, prior rows)."""

    def chosen(self, repeats: IntArray | slice) -> "Redrawn":
        """Return some of the repeats."""
        return Redrawn(
            repeats=tuple(drawn.chosen(repeats) for drawn in self.repeats), prior_means=self.prior_means[repeats]
        )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Objective(Shown):
    """A fit problem: terms and prior rows, ready to be evaluated for many parameter sets at once."""

    parameters: tuple[Parameter, ...]
    """Independent parameters of all structures, each once, those of the first structure first."""
    terms: tuple[Term, ...]
    """The responses and records with their structures."""
    prior_rows: FloatArray
    """Rows ``(index of free parameter, mean, 1 / std)`` of priors and regularisation, shape (rows, 3)."""
    prior_counts: FloatArray
    """1 for a row that is knowledge, 0 for one that only regularises, shape (rows,)."""
    held: FloatArray
    """Values of all parameters; the free ones are replaced in each evaluation, shape (parameters,)."""
    free: tuple[int, ...]
    """Places of the free parameters."""

    @property
    def experiments(self) -> tuple[Experiment, ...]:
        """The terms that are frequency responses."""
        return tuple(term for term in self.terms if isinstance(term, Experiment))

    @property
    def others(self) -> tuple[Term, ...]:
        """The terms that are none."""
        return tuple(term for term in self.terms if not isinstance(term, Experiment))

    @property
    def structure(self) -> Structure:
        """The structure of the first term."""
        return self.terms[0].structure

    @property
    def name(self) -> str:
        """Names of the structures, each once."""
        return " + ".join(dict.fromkeys(term.structure.name for term in self.terms))

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
        combinations: dict[str, Combination] = {}
        for combination in (c for term in self.terms for c in term.structure.combinations):
            combinations.setdefault(combination.name, combination)
        return tuple(combinations.values())

    @property
    def data_count(self) -> int:
        """Number of independent real data: two a complex value of a response."""
        return sum(term.data_count for term in self.terms)

    @property
    def null_cost(self) -> float:
        """Half the square sum of the residuals of a model that gives zero."""
        return sum(term.null_cost for term in self.terms)

    def complete(self, theta: FloatArray) -> FloatArray:
        """Return all parameters, shape (..., parameters), from the free ones, shape (..., free)."""
        values = np.empty((*theta.shape[:-1], self.held.size))
        values[...] = self.held
        values[..., self.free] = theta
        return values

    def named(self, values: FloatArray) -> dict[str, FloatArray]:
        """Return every parameter of every structure by name, tied ones included, from values (..., parameters)."""
        values_by_name: dict[str, FloatArray] = {}
        for term in self.terms[::-1]:
            values_by_name |= term.structure.named(term.structure_values(values))
        return values_by_name

    def stable(self, values: FloatArray) -> BoolArray:
        """Return whether the models of all terms are stable, shape (rows,), for parameters (rows, parameters)."""
        return np.asarray(np.all([term.stable(values) for term in self.terms], axis=0))

    def evaluable(self, theta: FloatArray) -> BoolArray:
        """Return whether all terms can be evaluated, shape (starts,), at free parameters (starts, free)."""
        return np.asarray(np.all([term.evaluable(theta[:, term.columns]) for term in self.terms], axis=0))

    def of_starts(self, theta: FloatArray, starts: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return the same as ``residuals``: every start has the same problem."""
        return self.residuals(theta)

    def following(self, starts: int) -> Callable[[FloatArray, IntArray], tuple[FloatArray, FloatArray]]:
        """Return ``of_starts`` for one descent of so many starts: see ``Term.following``."""
        tables = [term.following(starts) for term in self.terms]

        def residuals(theta: FloatArray, rows: IntArray) -> tuple[FloatArray, FloatArray]:
            parts = [
                self._spread(term, table(theta[:, term.columns], rows), theta)
                for term, table in zip(self.terms, tables, strict=True)
            ]
            return self._with_priors(parts, theta, self.prior_rows[:, 1])

        return residuals

    def residuals(self, theta: FloatArray, redrawn: Redrawn | None = None) -> tuple[FloatArray, FloatArray]:
        """Return weighted residuals and their derivatives for many parameter sets.

        ``theta``: free parameters, shape (starts, free). ``redrawn``: other data for each start. Returns residuals,
        shape (starts, rows), and Jacobian, shape (starts, free, rows); rows term by term, those of the priors last.
        """
        parts = [self._part(i, theta, redrawn) for i in range(len(self.terms))]
        return self._with_priors(parts, theta, self.prior_rows[:, 1] if redrawn is None else redrawn.prior_means)

    def _with_priors(
        self, parts: list[FloatArray], theta: FloatArray, means: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return residuals and Jacobian from those of the terms and the rows of the priors."""
        if self.prior_rows.size:
            parts = [*parts, self._prior_part(theta, means)]
        table = parts[0] if len(parts) == 1 else np.concatenate(parts, axis=2)
        return table[:, 0], table[:, 1:]

    def sensitivity(self, theta: FloatArray, *, expected: bool) -> tuple[FloatArray, FloatArray]:
        """Return rows whose products are the information, and rows whose products are the variance of the slope.

        ``theta``: free parameters, shape (free,). ``expected``: whether to average over the noise instead of taking the
        data as they are. Returns see ``Term.sensitivity``, each of shape (free, rows); rows that only regularise have
        no noise.
        """
        knowledge = self._prior_part(theta[None, :], self.prior_rows[:, 1])[0, 1:]
        parts = [self.sensitivity_to(term, theta, expected=expected) for term in self.terms]
        parts.append((knowledge, knowledge * self.prior_counts))
        rows, noise = zip(*parts, strict=True)
        return np.concatenate(rows, axis=1), np.concatenate(noise, axis=1)

    def sensitivity_to(self, term: Term, theta: FloatArray, *, expected: bool) -> tuple[FloatArray, FloatArray]:
        """Return the sensitivity of one term, with a row for every free parameter."""
        sensitivities = []
        for rows_of_term in term.sensitivity(theta[list(term.columns)], expected=expected):
            spread = np.zeros((theta.size, rows_of_term.shape[1]))
            spread[list(term.columns)] = rows_of_term
            sensitivities.append(spread)
        return sensitivities[0], sensitivities[1]

    def _part(self, number: int, theta: FloatArray, redrawn: Redrawn | None) -> FloatArray:
        """Return residuals of one term and below them their derivatives to all free parameters."""
        term = self.terms[number]
        repeats = None if redrawn is None else redrawn.repeats[number]
        return self._spread(term, term.table(theta[:, term.columns], repeats), theta)

    @staticmethod
    def _spread(term: Term, part: FloatArray, theta: FloatArray) -> FloatArray:
        """Return a term's residuals and derivatives with a row for every free parameter."""
        if term.columns == tuple(range(theta.shape[1])):
            return part
        table = np.zeros((theta.shape[0], 1 + theta.shape[1], part.shape[2]))
        table[:, [0, *(1 + column for column in term.columns)]] = part
        return table

    def _prior_part(self, theta: FloatArray, means: FloatArray) -> FloatArray:
        index = self.prior_rows[:, 0].astype(int)
        table = np.zeros((theta.shape[0], 1 + theta.shape[1], index.size))
        table[:, 0] = (theta[:, index] - means) * self.prior_rows[:, 2]
        table[:, 1 + index, np.arange(index.size)] = self.prior_rows[:, 2]
        return table
