"""What a fit minimises: weighted residuals of all lines and outputs, and rows for what is known beforehand.

With the residual vector ``r = W (y - f(theta))`` over ``[Re, Im]`` of every used line and output, the cost is
``r^T r / 2``. For maximum likelihood ``W^T W`` is the inverse of the full covariance of each line, so ``2 cost`` is a
chi-square; unweighted (the thesis' way) ``W`` holds output weights only. A prior ``mean +/- std`` of a parameter is
one more row, ``(theta - mean) / std``.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from shaftprint.errors import IdentificationError
from shaftprint.identify._prior import Prior
from shaftprint.models import Structure
from shaftprint.spectra import FrequencyResponse


class Weighting(ABC):
    """How the lines and outputs of a response are weighted against each other."""

    __slots__ = ()

    @abstractmethod
    def matrices(self, response: FrequencyResponse, covariance: FloatArray) -> FloatArray:
        """Return ``W`` of each line, shape (lines, size, size), for covariances of that shape."""


@dataclass(frozen=True, slots=True)
class MaximumLikelihood(Weighting):
    """Weights from the full covariance of each line: efficient, and ``2 cost`` is a chi-square."""

    def matrices(self, response: FrequencyResponse, covariance: FloatArray) -> FloatArray:
        """Return the inverse Cholesky factors of the covariances."""
        return np.linalg.inv(np.linalg.cholesky(covariance))


@dataclass(frozen=True, slots=True)
class Unweighted(Weighting):
    """All lines alike, as in the thesis; outputs against each other by the given weights."""

    output_weights: Mapping[str, float] = field(default_factory=dict)
    """Weight of each output's squared residuals by name; 1 where not given."""

    def matrices(self, response: FrequencyResponse, covariance: FloatArray) -> FloatArray:
        """Return diagonal matrices of the square roots of the output weights.

        Raises
        ------
        IdentificationError
            If a weight names an output that the response does not have, or is not positive.
        """
        for name, weight in self.output_weights.items():
            if name not in response.outputs or not weight > 0.0:
                raise IdentificationError(
                    f"output weight {name} = {weight}: expected a positive weight of one of "
                    f"{', '.join(response.outputs)}."
                )
        roots = np.sqrt([self.output_weights.get(name, 1.0) for name in response.outputs])
        return np.broadcast_to(np.diag(np.tile(roots, 2)), covariance.shape).copy()


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Objective:
    """A fit problem: structure, data, weights and prior rows, ready to be evaluated for many parameter sets at once."""

    structure: Structure
    """The structure with its held and free parameters."""
    s: ComplexArray
    """Laplace variable of the used lines [rad/s], shape (lines,), complex."""
    factors: Mapping[str, FloatArray]
    """Factor on a parameter at each used line: the propeller load of its window acts on ``k_q``."""
    data: FloatArray
    """[Re, Im] of the used lines, shape (lines, size)."""
    measured: ComplexArray
    """The same as complex numbers, shape (outputs, lines)."""
    covariance: FloatArray
    """Covariance of the data, shape (lines, size, size)."""
    weights: FloatArray
    """``W`` of each line, shape (lines, size, size)."""
    terms: tuple[tuple[int, int, FloatArray], ...]
    """Row, column and elements of ``-W``, shape (lines,), where they are not all zero; those of the diagonal first."""
    prior_rows: FloatArray
    """Rows ``(index of free parameter, mean, 1 / std)`` of priors and regularisation, shape (rows, 3)."""
    prior_counts: FloatArray
    """1 for a row that is knowledge, 0 for one that only regularises, shape (rows,)."""
    held: FloatArray
    """Values of all parameters; the free ones are replaced in each evaluation, shape (parameters,)."""
    free: tuple[int, ...]
    """Places of the free parameters."""

    @property
    def lower(self) -> FloatArray:
        """Lower bounds of the free parameters."""
        return np.array([p.lower for p in self.structure.free])

    @property
    def upper(self) -> FloatArray:
        """Upper bounds of the free parameters."""
        return np.array([p.upper for p in self.structure.free])

    def complete(self, theta: FloatArray) -> FloatArray:
        """Return all parameters, shape (..., parameters), from the free ones, shape (..., free)."""
        values = np.broadcast_to(self.held, (*theta.shape[:-1], self.held.size)).copy()
        values[..., self.free] = theta
        return values

    def of_starts(self, theta: FloatArray, starts: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return the same as ``residuals``: every start has the same problem."""
        return self.residuals(theta)

    def residuals(self, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return weighted residuals and their derivatives for many parameter sets.

        Parameters
        ----------
        theta
            Free parameters, shape (starts, free).

        Returns
        -------
            Residuals, shape (starts, rows), and Jacobian, shape (starts, free, rows).
        """
        stacked = self.structure.stacked(self.complete(theta), self.s, factors=self.factors)
        starts, count, outputs, lines = stacked.shape
        stacked[:, 0] -= self.measured
        table = self._weighted(stacked).reshape(starts, count, 2 * outputs * lines)
        if not self.prior_rows.size:
            return table[:, 0], table[:, 1:]
        index = self.prior_rows[:, 0].astype(int)
        known = np.zeros((starts, count, index.size))
        known[:, 0] = (theta[:, index] - self.prior_rows[:, 1]) * self.prior_rows[:, 2]
        known[:, 1 + index, np.arange(index.size)] = self.prior_rows[:, 2]
        table = np.concatenate([table, known], axis=2)
        return table[:, 0], table[:, 1:]

    def _weighted(self, stacked: ComplexArray) -> FloatArray:
        """Return ``-W`` times [Re, Im] of stacked responses, shape (starts, stack, 2 outputs, lines), term by term."""
        starts, count, outputs, lines = stacked.shape
        table = np.empty((starts, count, 2 * outputs, lines))
        for row, column, weight in self.terms:
            part = (stacked.real if column < outputs else stacked.imag)[:, :, column % outputs]
            if row == column:
                np.multiply(part, weight, out=table[:, :, row])
            else:
                table[:, :, row] += part * weight
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
    """Return the fit problem of a structure and a response.

    Raises
    ------
    IdentificationError
        If input or outputs differ, a prior names no free parameter, no parameter is free, or there are fewer data than
        free parameters.
    """
    _expect_same_channels(structure, response)
    names = structure.free
    known = [*priors.items(), *regularisation.items()]
    unknown = [name for name, _ in known if name not in {p.name for p in names}]
    if unknown:
        raise IdentificationError(
            f"prior of {', '.join(unknown)}: structure {structure.name} has the free parameters "
            f"{', '.join(p.name for p in names)}."
        )
    chosen = _chosen_lines(response, lines)
    data = np.concatenate([response.response[:, 0].real, response.response[:, 0].imag]).T[chosen]
    if not names:
        raise IdentificationError(
            f"structure {structure.name} has no free parameter: free one with free_between(), or compare its response."
        )
    if data.size + len(known) < len(names):
        raise IdentificationError(
            f"structure {structure.name} has {len(names)} free parameters, the response {data.size} usable numbers "
            f"({int(chosen.sum())} lines): measure more lines or hold parameters."
        )
    covariance = response.covariance[chosen]
    weights = weighting.matrices(response, covariance)
    places = {p.name: i for i, p in enumerate(names)}
    return Objective(
        structure=structure,
        factors=load_factors(response, chosen),
        s=np.asarray(1j * response.omega_rad_s[chosen], dtype=np.complex128),
        data=data,
        measured=response.response[:, 0, chosen],
        covariance=covariance,
        weights=weights,
        terms=_terms(weights),
        prior_rows=np.array([[places[n], p.mean, 1.0 / p.std] for n, p in known]).reshape(-1, 3),
        prior_counts=np.array([1.0] * len(priors) + [0.0] * len(regularisation)),
        held=structure.vector({}),
        free=tuple(i for i, p in enumerate(structure.parameters) if not p.held),
    )


def _terms(weights: FloatArray) -> tuple[tuple[int, int, FloatArray], ...]:
    """Return row, column and elements of ``-W`` where they are not all zero, the diagonal first."""
    size = weights.shape[1]
    rest = [(i, j) for i in range(size) for j in range(size) if i != j and weights[:, i, j].any()]
    return tuple((i, j, -weights[:, i, j]) for i, j in [*((i, i) for i in range(size)), *rest])


def load_factors(response: FrequencyResponse, chosen: BoolArray | None = None) -> dict[str, FloatArray]:
    """Return what the propeller load of each line's window does to the parameters of a structure.

    A propeller whose torque is ``M_s0 (1 + delta) (n / n_0)^2`` has the slope ``k_q (1 + delta)`` in values
    normalised with one working point, and nothing else changes.
    """
    load = response.load if chosen is None else response.load[chosen]
    return {} if np.all(load == 1.0) else {"k_q": load}


def _chosen_lines(response: FrequencyResponse, lines: Sequence[str] | None) -> BoolArray:
    if lines is None:
        return response.used
    unknown = [name for name in lines if name not in response.lines]
    if unknown:
        raise IdentificationError(
            f"lines {', '.join(unknown)} are not in the response; it has {', '.join(response.lines)}."
        )
    return np.array([name in lines for name in response.lines], dtype=np.bool_)


def _expect_same_channels(structure: Structure, response: FrequencyResponse) -> None:
    if (structure.input,) != response.inputs or tuple(structure.outputs) != response.outputs:
        raise IdentificationError(
            f"structure {structure.name} goes from {structure.input} to {', '.join(structure.outputs)}, the "
            f"response from {', '.join(response.inputs)} to {', '.join(response.outputs)}: choose a structure with "
            "these channels, or convert the response with open_loop()."
        )
