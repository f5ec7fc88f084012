"""One part of the likelihood, whatever its data are: what an objective asks of it, and what it tells of itself.

Terms are independent of each other. Each has a structure, whose free parameters are some of those of the objective;
parameters of one name are one parameter. A frequency response is a term (``Experiment``), and so are records in time
and whatever another room makes.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, IntArray
from shaftprint.identify.likelihood._line_test import LineTest
from shaftprint.identify.likelihood._term_check import TermCheck
from shaftprint.models._nyquist import stable_rows
from shaftprint.models._structure import Structure


class Repeats(ABC):
    """Other data for one term, one row a repeat of the test."""

    __slots__ = ()

    @abstractmethod
    def chosen(self, repeats: IntArray | slice) -> Self:
        """Return some of the repeats."""


class FittedTerm(ABC):
    """How well one term is explained by the parameters that were found."""

    __slots__ = ()

    structure: Structure
    """The structure, with its held and free parameters."""
    fit_percent: Mapping[str, float]
    """FitPercent of each output (thesis eq. 2.41)."""

    @property
    @abstractmethod
    def fit_ceiling(self) -> Mapping[str, float]:
        """FitPercent that the noise allows, of each output."""

    @property
    @abstractmethod
    def name(self) -> str:
        """What messages call the data."""

    @property
    @abstractmethod
    def seconds(self) -> float:
        """Length of a record, gaps apart [s]; 0 of a frequency response."""

    @property
    @abstractmethod
    def checks(self) -> tuple[TermCheck, ...]:
        """Whether the data contradict themselves or the other data; empty where that is not asked."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class TermTest:
    """What a term adds to the test of fit."""

    chi_square: float
    """Sum of squared distances."""
    count: int
    """Number of independent data in it."""
    mean: float
    """What the sum is on average for the true model; ``count`` where all noise is known."""
    variance: float
    """Variance of the sum; twice ``count`` where all noise is known."""
    lines: tuple[LineTest, ...]
    """Its parts."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Term(ABC):
    """One part of the likelihood: residuals whose half square sum is its negative logarithm, up to a constant."""

    structure: Structure
    """The structure with its held and free parameters."""
    held: FloatArray
    """Values of the structure's parameters; the free ones are replaced, shape (structure's parameters,)."""
    free: tuple[int, ...]
    """Places of the free parameters among the structure's."""
    places: tuple[int, ...]
    """Places of the free parameters among all parameters of the objective; see ``placed``."""
    columns: tuple[int, ...]
    """Places of the same among the free parameters of the objective."""

    @property
    @abstractmethod
    def name(self) -> str:
        """What messages call the data."""

    @property
    @abstractmethod
    def data_count(self) -> int:
        """Number of independent real data."""

    @property
    @abstractmethod
    def row_count(self) -> int:
        """Number of rows of ``sensitivity``."""

    @property
    @abstractmethod
    def is_likelihood(self) -> bool:
        """Whether the residuals are weighted by their noise."""

    @property
    @abstractmethod
    def least_deviation(self) -> float:
        """Smallest standard deviation of a datum, as a share of the value it belongs to; infinite where none is."""

    @property
    @abstractmethod
    def null_cost(self) -> float:
        """Half the square sum of the residuals of a model that gives zero."""

    @abstractmethod
    def with_floor(self, floor: float) -> Self:
        """Return the term as if no value were known better than to a share of itself."""

    @abstractmethod
    def table(self, theta: FloatArray, repeats: Repeats | None = None) -> FloatArray:
        """Return residuals and below them their derivatives, shape (starts, 1 + free, rows).

        Rows may be any rotation of the residuals. A model that cannot be evaluated has a large finite residual.

        ``theta``: free parameters of this term, shape (starts, free). ``repeats``: other data for each start, from
        ``redrawn``.
        """

    def following(self, starts: int) -> Callable[[FloatArray, IntArray], FloatArray]:
        """Return ``table`` for one descent of so many starts, from their parameters and numbers.

        What a term finds beside the parameters it may look for near where it was before.
        """
        return lambda theta, rows: self.table(theta)

    @abstractmethod
    def evaluable(self, theta: FloatArray) -> BoolArray:
        """Return whether the model can be evaluated at free parameters of this term, shape (starts,)."""

    @abstractmethod
    def sensitivity(self, theta: FloatArray, *, expected: bool) -> tuple[FloatArray, FloatArray]:
        """Return rows whose products are the information, and rows whose products are the variance of the slope.

        ``theta``: free parameters of this term, shape (free,). ``expected``: whether to average over the noise instead
        of taking the data as they are. Returns ``J`` and ``N``, each of shape (free, rows): ``J J^T`` is the second
        derivative of the cost, and ``N N^T`` the covariance of its slope, the same for a likelihood.
        """

    @abstractmethod
    def assessed(self, values: FloatArray, number: int) -> tuple[FittedTerm, TermTest]:
        """Return how well the data are explained.

        ``values``: all parameters of the objective, shape (parameters,). ``number``: number of the term in the
        objective.
        """

    @abstractmethod
    def redrawn(self, values: FloatArray, count: int, rng: np.random.Generator) -> Repeats:
        """Return what repeats of the test would give, were the parameters true.

        ``values``: all parameters of the objective, shape (parameters,). ``count``: number of repeats. Raises
        IdentificationError if the data cannot be drawn anew.
        """

    def placed(self, names: Sequence[str], free: Sequence[str]) -> Self:
        """Return the term as part of an objective.

        ``names``, ``free``: names of all parameters and of the free parameters of the objective.
        """
        return replace(
            self,
            places=tuple(names.index(p.name) for p in self.structure.free),
            columns=tuple(free.index(p.name) for p in self.structure.free),
        )

    def complete(self, theta: FloatArray) -> FloatArray:
        """Return all parameters of the structure, shape (..., parameters), from its free ones, shape (..., free)."""
        values = np.empty((*theta.shape[:-1], self.held.size))
        values[...] = self.held
        values[..., self.free] = theta
        return values

    def structure_values(self, values: FloatArray) -> FloatArray:
        """Return the parameters of the structure, shape (..., parameters), from those of the objective."""
        return self.complete(values[..., self.places])

    def stable(self, values: FloatArray) -> BoolArray:
        """Return whether the model is stable, shape (rows,), for parameters of the objective (rows, parameters)."""
        return stable_rows(self.structure, self.structure_values(values))


class WhitenedTerm(Term):
    """Samples in time, divided by noise of a known colour; their rows are as few as they can be, ``1 + free``."""

    __slots__ = ()

    @property
    def row_count(self) -> int:
        """Number of rows of ``sensitivity``."""
        return 1 + len(self.free)

    @property
    def is_likelihood(self) -> bool:
        """Whether residuals are weighted by their noise: always."""
        return True

    @property
    def least_deviation(self) -> float:
        """Infinite: the noise of samples in time is never small in every one."""
        return np.inf

    def with_floor(self, floor: float) -> Self:
        """Return the term itself."""
        return self

    def sensitivity(self, theta: FloatArray, *, expected: bool) -> tuple[FloatArray, FloatArray]:
        """Return the derivatives; noise and curvature of the model are independent, so both are the same."""
        rows = self.table(theta[None, :])[0, 1:]
        return rows, rows
