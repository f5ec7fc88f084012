"""The uncertainty budget: which source contributes how much to the variance of every number."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.uncertainty._numbers import Numbers
from shaftprint.identify.uncertainty._propagation import propagation
from shaftprint.models._combination import Combination
from shaftprint.notebook._shown import Shown

Direct = Mapping[str, Mapping[str, float]]
NO_DIRECT: Direct = {}


@dataclass(frozen=True, kw_only=True, slots=True)
class BudgetRow:
    """The uncertainty of one number by its sources."""

    name: str
    """Name of the number."""
    unit: str
    """Unit, ``-`` where there is none."""
    value: float
    """Estimate."""
    variances: Mapping[str, float]
    """Variance by source; empty where the data do not fix the number. That of a noise is negative where errors of two
    outputs make up for each other."""

    @property
    def std(self) -> float:
        """Standard deviation of all sources together; infinite where the data do not fix the number."""
        return float(np.sqrt(max(sum(self.variances.values()), 0.0))) if self.variances else np.inf

    @property
    def shares(self) -> dict[str, float]:
        """Share of each source in the variance; they add up to 1. Empty where the number is unknown or certain."""
        total = sum(self.variances.values())
        return {name: part / total for name, part in self.variances.items()} if total > 0.0 else {}


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class Budget(Shown):
    """Which source contributes how much to the uncertainty of every number, to first order."""

    sources: tuple[str, ...]
    """Names of all sources: noise of each output, then those of the priors, then others."""
    rows: tuple[BudgetRow, ...]
    """Every free parameter, every combination of the structures, and what else was asked for."""

    def row(self, name: str) -> BudgetRow:
        """Return the row of one number.

        Raises
        ------
        IdentificationError
            If there is none of that name.
        """
        for row in self.rows:
            if row.name == name:
                return row
        raise IdentificationError(f"budget: there is no {name}; it has {', '.join(row.name for row in self.rows)}.")


def budget(
    identification: Identification,
    numbers: Sequence[Combination] = (),
    *,
    direct: Direct = NO_DIRECT,
    shifts: Direct = NO_DIRECT,
) -> Budget:
    """Return the variance of every free parameter, combination and further number by source.

    Parameters
    ----------
    numbers
        Further numbers that follow from the parameters; their formulas take and give arrays.
    direct
        By the name of a further number and of a source: change of the number, with sign, for one standard deviation of
        the source, beside that through the parameters. A source of a prior that also enters the conversion from
        parameter to number has both; they may cancel.
    shifts
        By the name of a source and of a parameter: change of the parameter, with sign, for one standard deviation of a
        source that the fit does not know of, such as that by which its data were divided.
    """
    objective = identification.objective
    theta = identification.values[list(objective.free)][None, :]
    parameters = objective.free_parameters
    combinations = (*objective.combinations, *numbers)
    count = len(parameters) + len(combinations)
    every = Numbers(objective, combinations, np.arange(count))
    table = np.repeat(theta, count, axis=0)
    rows, _ = objective.sensitivity(theta[0], expected=False)
    curvature = np.broadcast_to(np.sum(rows**2, axis=1), table.shape)
    values, slopes = every.values(table), every.slopes(table, curvature)
    moved = propagation(identification, shifts)
    named = [*((p.name, p.unit) for p in parameters), *((c.name, c.unit) for c in combinations)]
    budget_rows = tuple(
        BudgetRow(
            name=name,
            unit=unit,
            value=float(values[i]),
            variances=moved.variances(slopes[i], direct.get(name, {})),
        )
        for i, (name, unit) in enumerate(named)
    )
    more = (name for changes in direct.values() for name in changes)
    return Budget(sources=tuple(dict.fromkeys([*moved.noise, *moved.effects, *more])), rows=budget_rows)
