"""The nouns of the room: how to search, and what a fit found."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray
from shaftprint.errors import IdentificationError
from shaftprint.identify._covariance import variance_along
from shaftprint.identify._objective import MaximumLikelihood, Objective, Weighting
from shaftprint.identify._prior import Prior
from shaftprint.identify._starts import Draw, LatinHypercube
from shaftprint.models import Margins, Structure, margins
from shaftprint.spectra import FrequencyResponse

# Two-sided 95 % of the normal distribution.
NORMAL_95 = 1.959963984540054


@dataclass(frozen=True, kw_only=True, slots=True)
class Settings:
    """How a fit searches and weighs; the defaults follow thesis section 5.1, but weigh by the measured covariance."""

    weighting: Weighting = field(default_factory=MaximumLikelihood)
    """How lines and outputs are weighed."""
    priors: Mapping[str, Prior] = field(default_factory=dict)
    """What is known of parameters beforehand; it counts in the uncertainty."""
    regularisation: Mapping[str, Prior] = field(default_factory=dict)
    """A pull towards values that is not knowledge: it does not count in the uncertainty."""
    starts: int = 50
    """Number of starts."""
    draw: Draw = field(default_factory=LatinHypercube)
    """How the starts are drawn within the bounds."""
    max_iterations: int = 100
    """Limit of iterations of each start."""
    tolerance: float = 1e-5
    """Share of the cost below which a further gain is not worth a step (0.001 %)."""
    require_stable: bool = True
    """Whether an unstable model may not win."""

    def __post_init__(self) -> None:
        """Check the counts.

        Raises
        ------
        IdentificationError
            If starts, iterations or tolerance are not positive.
        """
        if self.starts < 1 or self.max_iterations < 1 or not self.tolerance > 0.0:
            raise IdentificationError(
                f"search settings: expected positive starts, iterations and tolerance, found {self.starts}, "
                f"{self.max_iterations} and {self.tolerance}."
            )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Cluster:
    """An optimum of the search, with the starts that reached it."""

    values: FloatArray
    """All parameters, shape (parameters,)."""
    cost: float
    """Half the sum of squared residuals."""
    starts: int
    """How many starts reached it."""
    stable: bool | None
    """Whether the model is stable there; None where it was not asked."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Estimate:
    """One number that was found, with its uncertainty."""

    name: str
    """Name of the parameter or combination."""
    unit: str
    """Unit, ``-`` where there is none."""
    value: float
    """Estimate."""
    std: float
    """Standard deviation; infinite where the data say nothing."""
    at_bound: bool = False
    """Whether the search stopped at a bound."""

    @property
    def interval_95(self) -> tuple[float, float]:
        """95 % interval from the standard deviation."""
        return self.value - NORMAL_95 * self.std, self.value + NORMAL_95 * self.std


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Identification:
    """What a fit found: parameters with covariance, how well the model explains the data, how unique the optimum is."""

    structure: Structure
    """The structure, with its held and free parameters."""
    response: FrequencyResponse
    """The data."""
    fitted: BoolArray
    """Which lines of the response were fitted, shape (lines,)."""
    objective: Objective
    """The problem that was solved."""
    settings: Settings
    """How it was searched."""
    values: FloatArray
    """All parameters, in the structure's order, shape (parameters,)."""
    covariance: FloatArray
    """Covariance of the free parameters, shape (free, free)."""
    cost: float
    """Half the sum of squared weighted residuals and prior rows."""
    degrees_of_freedom: int
    """Number of data and prior rows minus the number of free parameters."""
    data_count: int
    """Number of data: two a complex value."""
    fit_percent: Mapping[str, float]
    """FitPercent of each output (thesis eq. 2.41)."""
    fit_ceiling: Mapping[str, float]
    """FitPercent that the noise allows, of each output."""
    clusters: tuple[Cluster, ...]
    """Optima of the search, lowest cost first; those that won or would have won are checked for stability."""

    @property
    def parameters(self) -> tuple[Estimate, ...]:
        """Every free parameter with its standard deviation."""
        found = []
        for i, parameter in enumerate(self.structure.free):
            value = float(self.values[self.structure.names.index(parameter.name)])
            found.append(
                Estimate(
                    name=parameter.name,
                    unit=parameter.unit,
                    value=value,
                    std=float(np.sqrt(self.covariance[i, i])),
                    at_bound=value in (parameter.lower, parameter.upper),
                )
            )
        return tuple(found)

    @property
    def combinations(self) -> tuple[Estimate, ...]:
        """Every combination of parameters that the structure names, with its standard deviation to first order."""
        return tuple(
            self.derived(c.name, c.unit, lambda named, of=c.of: of(named))  # type: ignore[misc]
            for c in self.structure.combinations
        )

    @property
    def correlation(self) -> FloatArray:
        """Correlation of the free parameters, shape (free, free); nan where a variance is infinite."""
        std = np.sqrt(np.diag(self.covariance))
        std[np.isinf(std)] = np.nan
        return np.asarray(self.covariance / np.outer(std, std))

    @property
    def margins(self) -> Margins | None:
        """Stability margins, found anew at each call; None for a structure without feedback."""
        return None if self.structure.loop is None else margins(self.structure, self.values)

    @property
    def is_likelihood(self) -> bool:
        """Whether ``2 cost`` is a chi-square: the fit was weighted by the covariance."""
        return isinstance(self.settings.weighting, MaximumLikelihood)

    @property
    def reached(self) -> int:
        """How many starts reached the optimum that won."""
        return next(c.starts for c in self.clusters if np.array_equal(c.values, self.values))

    def value(self, name: str) -> float:
        """Return the value of a parameter, free or held.

        Raises
        ------
        IdentificationError
            If the structure has no parameter of that name.
        """
        if name not in self.structure.names:
            raise IdentificationError(
                f"structure {self.structure.name} has no parameter {name}; it has {', '.join(self.structure.names)}."
            )
        return float(self.values[self.structure.names.index(name)])

    def derived(self, name: str, unit: str, of: Callable[[Mapping[str, float]], float]) -> Estimate:
        """Return a function of the parameters with its standard deviation to first order.

        Parameters
        ----------
        of
            Takes the parameter values by name, gives the number; a quotient by a parameter that is 0 is infinite.
        """
        places = [self.structure.names.index(p.name) for p in self.structure.free]
        slopes = np.zeros(len(places))
        with np.errstate(divide="ignore", invalid="ignore"):
            value = float(of(self._named(self.values)))
            for i, place in enumerate(places):
                width = 1e-6 * max(abs(self.values[place]), 1e-3)
                ahead, behind = self.values.copy(), self.values.copy()
                ahead[place] += width
                behind[place] -= width
                slopes[i] = (of(self._named(ahead)) - of(self._named(behind))) / (2.0 * width)
        known = np.isfinite(value) and bool(np.all(np.isfinite(slopes)))
        variance = variance_along(self.objective, self.values[places], slopes) if known else np.inf
        return Estimate(name=name, unit=unit, value=value, std=float(np.sqrt(variance)))

    def model(self, frequency_hz: FloatArray) -> ComplexArray:
        """Return the fitted response, shape (outputs, frequencies)."""
        return self.structure.response(self.values, 2j * np.pi * frequency_hz)

    def _named(self, values: FloatArray) -> dict[str, float]:
        return dict(zip(self.structure.names, values, strict=True))
