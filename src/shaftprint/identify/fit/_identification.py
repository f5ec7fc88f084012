"""What a fit found."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray, correlation_of
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._covariance import variance_along
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._fit_test import FitTest
from shaftprint.identify.likelihood._fitted_response import FittedResponse
from shaftprint.identify.likelihood._line_test import LineTest
from shaftprint.identify.likelihood._objective import Objective
from shaftprint.identify.likelihood._term import FittedTerm
from shaftprint.identify.search._settings import Settings
from shaftprint.models._margins import Margins, margins
from shaftprint.models._role import Role
from shaftprint.models._structure import Structure
from shaftprint.notebook._labelled import Labelled, LabelledData
from shaftprint.notebook._labelled_rows import labelled_rows
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened
from shaftprint.spectra._frequency_response import FrequencyResponse


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
    which: tuple[int, ...] = ()
    """Which starts of the draw these are."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Identification(Shown, Labelled):
    """What a fit found: parameters with covariance, how well the model explains the data, how unique the optimum is."""

    parts: tuple[FittedTerm, ...]
    """The responses and records that were fitted, each with its structure; one, but for joint fits."""
    objective: Objective
    """The problem that was solved."""
    settings: Settings
    """How it was searched."""
    values: FloatArray
    """All independent parameters, in the objective's order, shape (parameters,); with one response the structure's."""
    covariance: FloatArray
    """Covariance of the free parameters, shape (free, free)."""
    cost: float
    """Half the sum of squared weighted residuals and prior rows."""
    fit_test: FitTest
    """Whether the structure explains the data."""
    clusters: tuple[Cluster, ...]
    """Optima of the search, lowest cost first; those that won or would have won are checked for stability."""

    def summary(self) -> Summary:
        """Return what was fitted to what, and how well."""
        p_value = self.p_value
        facts = {
            "fitted to": shortened(part.name for part in self.parts),
            "parameters": shortened(f"{one.name} {one.value:.4g}" for one in self.parameters),
            "at a bound": shortened(one.name for one in self.parameters if one.at_bound),
            "FitPercent": shortened(f"{name} {value:.1f}" for name, value in self.fit_percent.items()),
            "chi-square": f"{self.chi_square:.1f} at {self.degrees_of_freedom} degrees of freedom"
            + ("" if p_value is None else f", p = {p_value:.2g}"),
            "search": f"{self.reached} of {self.settings.starts} starts reached it",
        }
        return Summary(title=f"Identification of {self.objective.name}", facts=facts)

    def labelled(self) -> LabelledData:
        """Return the free parameters with their standard deviations and covariance."""
        estimates = self.parameters
        texts = {
            "parameter": [one.name for one in estimates],
            "unit": [one.unit for one in estimates],
            "meaning": [one.meaning for one in estimates],
        }
        columns: dict[str, tuple[Sequence[Any], str]] = {
            "value": ([one.value for one in estimates], "estimate"),
            "std": ([one.std for one in estimates], "standard deviation"),
            "at_bound": ([one.at_bound for one in estimates], "whether the search stopped at a bound"),
        }
        facts = {"structure": self.objective.name}
        return labelled_rows(
            "parameter", texts, columns, uncertain=texts["parameter"], covariance=self.covariance, facts=facts
        )

    @property
    def experiments(self) -> tuple[FittedResponse, ...]:
        """The parts that are frequency responses."""
        return tuple(part for part in self.parts if isinstance(part, FittedResponse))

    @property
    def structure(self) -> Structure:
        """The structure, with its held and free parameters; the first of a joint fit."""
        return self.parts[0].structure

    @property
    def response(self) -> FrequencyResponse:
        """The data; the first frequency response of a joint fit.

        Raises
        ------
        IdentificationError
            If no frequency response was fitted.
        """
        return self._first_response.response

    @property
    def fitted(self) -> BoolArray:
        """Which lines of the response were fitted, shape (lines,)."""
        return self._first_response.fitted

    @property
    def fit_percent(self) -> Mapping[str, float]:
        """FitPercent of each output (thesis eq. 2.41), of the first part of a joint fit."""
        return self.parts[0].fit_percent

    @property
    def fit_ceiling(self) -> Mapping[str, float]:
        """FitPercent that the noise allows, of each output."""
        return self.parts[0].fit_ceiling

    @property
    def data_count(self) -> int:
        """Number of data: two a complex value."""
        return self.objective.data_count

    @property
    def whitened(self) -> FloatArray:
        """Residuals of the fitted lines over their covariance, shape (lines, 2 channels), see ``FittedResponse``."""
        return self._first_response.whitened

    @property
    def chi_square(self) -> float:
        """Sum of the squared distances of all lines and of the squared rows of priors."""
        return self.fit_test.chi_square

    @property
    def degrees_of_freedom(self) -> int:
        """Number of data and prior rows minus the number of free parameters that no bound stopped."""
        return self.fit_test.degrees_of_freedom

    @property
    def p_value(self) -> float | None:
        """Probability of a chi-square that large or larger if the structure holds.

        None where nothing is left to test, or where the fit was not weighted by the covariance.
        """
        return self.fit_test.p_value if self.is_likelihood else None

    @property
    def line_tests(self) -> tuple[LineTest, ...]:
        """How far each fitted line lies from the model, experiment by experiment."""
        return self.fit_test.lines

    @property
    def parameters(self) -> tuple[Estimate, ...]:
        """Every free parameter with its standard deviation."""
        estimates = []
        for i, (column, parameter) in enumerate(zip(self.objective.free, self.objective.free_parameters, strict=True)):
            value = float(self.values[column])
            estimates.append(
                Estimate(
                    name=parameter.name,
                    unit=parameter.unit,
                    value=value,
                    std=float(np.sqrt(self.covariance[i, i])),
                    at_bound=value in (parameter.lower, parameter.upper),
                    meaning=parameter.meaning,
                    role=parameter.role,
                )
            )
        return tuple(estimates)

    @property
    def by_role(self) -> dict[Role, float]:
        """Every parameter of the first structure that has a role, free or not."""
        named = self.structure.named(self.structure_values())
        return {role: float(named[name]) for name, role in self.structure.roles.items() if name in named}

    def of_role(self, role: Role) -> Estimate:
        """Return the free parameter of a role.

        Raises
        ------
        IdentificationError
            If there is none.
        """
        for estimate in self.parameters:
            if estimate.role == role:
                return estimate
        raise IdentificationError(f"structure {self.structure.name} has no free parameter of the role {role.name}.")

    @property
    def combinations(self) -> tuple[Estimate, ...]:
        """Every combination of parameters that a structure names, with its standard deviation to first order."""
        return tuple(
            replace(self.derived(c.name, c.unit, lambda named, of=c.of: of(named)), role=c.role, meaning=c.meaning)  # type: ignore[misc]
            for c in self.objective.combinations
        )

    @property
    def correlation(self) -> FloatArray:
        """Correlation of the free parameters, shape (free, free); nan where a variance is infinite."""
        return correlation_of(self.covariance)

    @property
    def margins(self) -> Margins | None:
        """Stability margins, found anew at each call; None for a structure without feedback."""
        return None if self.structure.loop is None else margins(self.structure, self.structure_values())

    @property
    def is_likelihood(self) -> bool:
        """Whether the cost is a negative log-likelihood: the fit was weighted by the covariance."""
        return self.settings.weighting.is_likelihood

    @property
    def reached(self) -> int:
        """How many starts reached the optimum that won."""
        return next(c.starts for c in self.clusters if np.array_equal(c.values, self.values))

    def value(self, name: str) -> float:
        """Return the value of a parameter, free, held or tied.

        Raises
        ------
        IdentificationError
            If the structure has no parameter of that name.
        """
        named = self._named(self.values)
        if name not in named:
            raise IdentificationError(
                f"structure {self.objective.name} has no parameter {name}; it has {', '.join(named)}."
            )
        return named[name]

    def derived(self, name: str, unit: str, of: Callable[[Mapping[str, float]], float]) -> Estimate:
        """Return a function of the parameters with its standard deviation to first order.

        Parameters
        ----------
        of
            Takes the parameter values by name, gives the number; a quotient by a parameter that is 0 is infinite.
        """
        places = list(self.objective.free)
        slopes = np.zeros(len(places))
        with np.errstate(divide="ignore", invalid="ignore"):
            value = float(of(self._named(self.values)))
            for i, column in enumerate(places):
                width = 1e-6 * max(abs(self.values[column]), 1e-3)
                ahead, behind = self.values.copy(), self.values.copy()
                ahead[column] += width
                behind[column] -= width
                slopes[i] = (of(self._named(ahead)) - of(self._named(behind))) / (2.0 * width)
        finite = np.isfinite(value) and bool(np.all(np.isfinite(slopes)))
        variance = variance_along(self.objective, self.values[places], slopes) if finite else np.inf
        return Estimate(name=name, unit=unit, value=value, std=float(np.sqrt(variance)))

    def model(self, frequency_hz: FloatArray) -> ComplexArray:
        """Return the fitted response, shape (channels, frequencies); of a joint fit's first structure."""
        return self.structure.response(self.structure_values(), 2j * np.pi * frequency_hz)

    def structure_values(self, experiment: int = 0) -> FloatArray:
        """Return all parameters of one part's structure, in that structure's order, shape (parameters,)."""
        return self.objective.terms[experiment].structure_values(self.values)

    @property
    def _first_response(self) -> FittedResponse:
        if not self.experiments:
            names = ", ".join(part.name for part in self.parts)
            raise IdentificationError(f"structure {self.objective.name}: fitted to {names}, to no frequency response.")
        return self.experiments[0]

    def _named(self, values: FloatArray) -> dict[str, float]:
        return {name: np.float64(value) for name, value in self.objective.named(values).items()}
