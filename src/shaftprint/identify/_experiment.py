"""One response in the likelihood: its structure, lines, weights, and where its parameters stand among all.

With the weighted residuals ``r = W (y - f(theta))`` over ``[Re, Im]`` of every used line and channel, the cost of an
experiment is ``r^T r / 2``. For maximum likelihood ``W^T W`` is the inverse of the full covariance of each line, and
where that was estimated the residuals of a line are shortened (``Tails``); unweighted (the thesis' way) ``W`` holds
output weights only.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray
from shaftprint.errors import IdentificationError
from shaftprint.identify._tails import Tails, excess_freedom
from shaftprint.identify._weighting import Weighting
from shaftprint.models import Structure
from shaftprint.spectra import FrequencyResponse

# Parameters that are slopes of the propeller torque: they grow with the load.
LOADED = ("k_q", "kappa")


class Term(ABC):
    """One part of the likelihood: residuals whose half square sum is its negative logarithm, up to a constant."""

    __slots__ = ()

    @abstractmethod
    def table(self, theta: FloatArray) -> FloatArray:
        """Return residuals and below them their derivatives, shape (starts, 1 + free, rows).

        Parameters
        ----------
        theta
            Free parameters of this term, shape (starts, free).
        """

    @abstractmethod
    def sensitivity(self, theta: FloatArray, *, expected: bool) -> tuple[FloatArray, FloatArray]:
        """Return rows whose products are the information, and rows whose products are the variance of the slope.

        Parameters
        ----------
        theta
            Free parameters of this term, shape (free,).
        expected
            Whether to average over the noise instead of taking the data as they are.

        Returns
        -------
            ``J`` and ``N``, each of shape (free, rows): ``J J^T`` is the second derivative of the cost, and ``N N^T``
            the covariance of its slope, the same for a likelihood.
        """


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Experiment(Term):
    """A structure and a response to fit it to."""

    structure: Structure
    """The structure with its held and free parameters."""
    response: FrequencyResponse
    """The data, of the structure's outputs."""
    fitted: BoolArray
    """Which lines of the response are fitted, shape (lines of the response,); of the others nothing is used."""
    s: ComplexArray
    """Laplace variable of the fitted lines [rad/s], shape (lines,), complex."""
    factors: Mapping[str, FloatArray]
    """Factor on a parameter at each fitted line: the propeller load of its window acts on ``k_q``."""
    data: FloatArray
    """[Re, Im] of the fitted lines, shape (lines, size)."""
    measured: ComplexArray
    """The same as complex numbers, shape (channels, lines)."""
    covariance: FloatArray
    """Covariance of the data, shape (lines, size, size)."""
    weighting: Weighting
    """How lines and outputs are weighed."""
    weights: FloatArray
    """``W`` of each line, shape (lines, size, size)."""
    tails: Tails
    """How much lines far from the model count."""
    elements: tuple[tuple[int, int, FloatArray], ...]
    """Row, column and elements of ``-W``, shape (lines,), where they are not all zero; those of the diagonal first."""
    held: FloatArray
    """Values of the structure's parameters; the free ones are replaced, shape (structure's parameters,)."""
    free: tuple[int, ...]
    """Places of the free parameters among the structure's."""
    places: tuple[int, ...]
    """Places of the same among all parameters of the objective."""
    columns: tuple[int, ...]
    """Places of the same among the free parameters of the objective."""

    def complete(self, theta: FloatArray) -> FloatArray:
        """Return all parameters of the structure, shape (..., parameters), from its free ones, shape (..., free)."""
        values = np.empty((*theta.shape[:-1], self.held.size))
        values[...] = self.held
        values[..., self.free] = theta
        return values

    def own(self, values: FloatArray) -> FloatArray:
        """Return the parameters of the structure, shape (..., parameters), from those of the objective."""
        return self.complete(values[..., self.places])

    def table(
        self, theta: FloatArray, measured: ComplexArray | None = None, weights: FloatArray | None = None
    ) -> FloatArray:
        """Return residuals, those of one channel's real or imaginary part side by side, and their derivatives.

        Parameters
        ----------
        measured
            Other data of the fitted lines for each start, shape (starts, channels, lines).
        weights
            Other weights ``W`` for each start, shape (starts, lines, size, size).
        """
        elements = self.elements if weights is None else _elements(weights)
        weighted = _weighted(self._stacked(theta, measured), elements)
        shaped = weighted if self.tails.normal else self.tails.shaped(weighted)
        return shaped.reshape(*shaped.shape[:2], -1)

    def sensitivity(self, theta: FloatArray, *, expected: bool) -> tuple[FloatArray, FloatArray]:
        """Return the weighted derivatives, and where they are no likelihood's the same times a root of ``W C W^T``."""
        table = _weighted(self._stacked(theta[None, :], None), self.elements)
        slopes = table[0, 1:]
        if not self.tails.normal:
            shaped = np.sqrt(self.tails.information) * slopes if expected else self.tails.curvature(table)[0]
            rows = shaped.reshape(theta.size, -1)
            return rows, rows
        rows = slopes.reshape(theta.size, -1)
        if self.weighting.is_likelihood:
            return rows, rows
        roots = np.linalg.cholesky(self.weights @ self.noise_covariance @ self.weights.swapaxes(1, 2))
        return rows, np.einsum("kaf,fab->kbf", slopes, roots).reshape(theta.size, -1)

    @property
    def freedom(self) -> FloatArray:
        """Real degrees of freedom behind the covariance of each fitted line, shape (lines,)."""
        return self.response.degrees_of_freedom[self.fitted]

    @property
    def noise_covariance(self) -> FloatArray:
        """Covariance of the data without the factor that makes it right as a weight, shape (lines, size, size)."""
        size = self.data.shape[1]
        known = np.isinf(self.freedom)
        share = np.where(known, 1.0, excess_freedom(self.freedom, size) / np.where(known, 1.0, self.freedom))
        return share[:, None, None] * self.covariance

    @property
    def least_deviation(self) -> float:
        """Smallest standard deviation of a datum, as a share of the value it belongs to."""
        std = np.sqrt(np.diagonal(self.covariance, axis1=1, axis2=2))
        return float(np.min(std / np.maximum(np.tile(np.abs(self.measured).T, 2), np.finfo(np.float64).tiny)))

    def _stacked(self, theta: FloatArray, measured: ComplexArray | None) -> ComplexArray:
        stacked = self.structure.stacked(self.complete(theta), self.s, factors=self.factors)
        stacked[:, 0] -= self.measured if measured is None else measured
        return stacked


def build_experiment(
    structure: Structure,
    response: FrequencyResponse,
    *,
    weighting: Weighting,
    lines: Sequence[str] | None,
    names: Sequence[str],
    free: Sequence[str],
) -> Experiment:
    """Return the part of the likelihood that one response gives.

    Parameters
    ----------
    names, free
        Names of all parameters and of the free parameters of the objective.

    Raises
    ------
    IdentificationError
        If input or outputs differ or a line is not in the response.
    """
    taken = _of_structure(structure, response)
    fitted = _fitted_lines(taken, lines)
    measured = channels_of(taken)[:, fitted]
    covariance = taken.covariance[fitted]
    weights = weighting.matrices(taken, covariance)
    return Experiment(
        structure=structure,
        response=taken,
        fitted=fitted,
        s=np.asarray(1j * taken.omega_rad_s[fitted], dtype=np.complex128),
        factors=load_factors(taken, fitted),
        data=np.concatenate([measured.real, measured.imag]).T,
        measured=measured,
        covariance=covariance,
        weighting=weighting,
        weights=weights,
        tails=weighting.tails(taken.degrees_of_freedom[fitted], covariance.shape[1]),
        elements=_elements(weights),
        held=structure.vector({}),
        free=tuple(i for i, p in enumerate(structure.parameters) if not p.held),
        places=tuple(names.index(p.name) for p in structure.free),
        columns=tuple(free.index(p.name) for p in structure.free),
    )


def with_floor(experiment: Experiment, floor: float) -> Experiment:
    """Return the experiment as if no value were known better than to a share of itself.

    Parameters
    ----------
    floor
        The share, added to the covariance as an independent standard deviation.
    """
    size = experiment.data.shape[1]
    least = (floor * np.tile(np.abs(experiment.measured).T, 2)) ** 2
    covariance = experiment.covariance + least[:, :, None] * np.eye(size)
    weights = experiment.weighting.matrices(experiment.response, covariance)
    return replace(experiment, covariance=covariance, weights=weights, elements=_elements(weights))


def channels_of(response: FrequencyResponse) -> ComplexArray:
    """Return the response of every channel, outputs slowest, shape (channels, lines)."""
    return response.response.reshape(-1, response.frequency_hz.size)


def load_factors(response: FrequencyResponse, chosen: BoolArray | None = None) -> dict[str, FloatArray]:
    """Return what the propeller load of each line's window does to the parameters of a structure.

    A propeller whose torque is ``M_s0 (1 + delta) (n / n_0)^2`` has the slopes ``k_q (1 + delta)`` and
    ``kappa (1 + delta)`` in values normalised with one working point, and nothing else changes.
    """
    load = response.load if chosen is None else response.load[chosen]
    return {} if np.all(load == 1.0) else dict.fromkeys(LOADED, load)


def _elements(weights: FloatArray) -> tuple[tuple[int, int, FloatArray], ...]:
    """Return row, column and elements of ``-W`` where they are not all zero, the diagonal first.

    Parameters
    ----------
    weights
        Shape (lines, size, size), or (starts, lines, size, size).

    Returns
    -------
        The elements of shape (lines,), or (starts, 1, lines).
    """
    size = weights.shape[-1]
    pairs = [(i, i) for i in range(size)]
    pairs += [(i, j) for i in range(size) for j in range(size) if i != j and weights[..., i, j].any()]
    found = ((i, j, -weights[..., i, j]) for i, j in pairs)
    return tuple((i, j, w if w.ndim == 1 else w[:, None]) for i, j, w in found)


def _weighted(stacked: ComplexArray, elements: tuple[tuple[int, int, FloatArray], ...]) -> FloatArray:
    """Return ``-W`` times [Re, Im] of stacked responses, shape (starts, stack, size, lines), element by element."""
    starts, count, channels, lines = stacked.shape
    table = np.empty((starts, count, 2 * channels, lines))
    for row, column, weight in elements:
        part = (stacked.real if column < channels else stacked.imag)[:, :, column % channels]
        if row == column:
            np.multiply(part, weight, out=table[:, :, row])
        else:
            table[:, :, row] += part * weight
    return table


def _fitted_lines(response: FrequencyResponse, lines: Sequence[str] | None) -> BoolArray:
    if lines is None:
        return response.used
    unknown = [name for name in lines if name not in response.lines]
    if unknown:
        raise IdentificationError(
            f"lines {', '.join(unknown)} are not in the response; it has {', '.join(response.lines)}."
        )
    return np.array([name in lines for name in response.lines], dtype=np.bool_)


def _of_structure(structure: Structure, response: FrequencyResponse) -> FrequencyResponse:
    """Return the response of the structure's outputs."""
    outputs = tuple(structure.outputs)
    if structure.inputs != response.inputs or not set(outputs) <= set(response.outputs):
        raise IdentificationError(
            f"structure {structure.name} goes from {', '.join(structure.inputs)} to {', '.join(outputs)}, the "
            f"response from {', '.join(response.inputs)} to {', '.join(response.outputs)}: "
            + (
                "choose a structure with these channels, or convert the response with open_loop()."
                if response.inputs == ("n_set",)
                else "give both the same names."
            )
        )
    return response if outputs == response.outputs else response.of_outputs(*outputs)
