"""The noun ``AssumedShip``: what is taken for granted of a propulsion line while its test is planned, and how well.

The information of a test depends on the ship that it is sailed on. Accuracy hardly moves with the assumed numbers, but
the peaks of speed and torque do, most of all near the resonance of the loop: so a plan holds its limits for nearly all
ships that are possible.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.catalogue._roles import ShipRole
from shaftprint.errors import DesignError
from shaftprint.models._nyquist import stable_rows
from shaftprint.models._role import Role
from shaftprint.models._structure import Structure
from shaftprint.notebook._shown import Shown
from shaftprint.spelling import meant

if TYPE_CHECKING:
    from shaftprint.identify.fit._identification import Identification

# Of so many draws for one that is wanted nearly all lines would have to be unstable for too few to be left.
_DRAWN_FOR_ONE = 4
GAINS = (ShipRole.PROPORTIONAL_GAIN, ShipRole.INTEGRAL_GAIN, ShipRole.DERIVATIVE_GAIN)

RELATIVE_SPREAD: Mapping[Role, float] = {
    ShipRole.PROPORTIONAL_GAIN: 0.3,
    ShipRole.INTEGRAL_GAIN: 0.3,
    ShipRole.DERIVATIVE_GAIN: 0.3,
    ShipRole.LOOP_DELAY: 0.3,
    ShipRole.ACTUATOR_FREQUENCY: 0.2,
    ShipRole.ACTUATOR_DAMPING: 0.3,
    ShipRole.INERTIA_DOWNSTREAM: 0.2,
    ShipRole.INERTIA_UPSTREAM: 0.2,
    ShipRole.INERTIA: 0.2,
}
"""Standard deviation over the value, before any test, by role: governors differ more than masses do."""
SPREAD: Mapping[Role, float] = {
    ShipRole.ENGINE_SPEED_SLOPE: 0.1,
    ShipRole.LOAD_SLOPE: 0.05,
    ShipRole.SET_POINT_BEND: 0.015,
}
"""Standard deviation in the parameter's unit, before any test, by role."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class AssumedShip(Shown):
    """A structure with the values that are assumed for a plan, and their uncertainty as a normal distribution."""

    structure: Structure
    """The structure that the test is to find."""
    values: FloatArray
    """Assumed values of all parameters, shape (parameters,)."""
    covariance: FloatArray
    """Their covariance; zero for what is taken as exact, shape (parameters, parameters)."""
    log_normal: tuple[str, ...] = ()
    """Parameters whose logarithm is normally distributed: the values are medians, the covariance is that of the
    logarithms times the values."""

    @property
    def by_name(self) -> dict[str, float]:
        """The assumed values by name."""
        return dict(zip(self.structure.names, self.values.tolist(), strict=True))

    @property
    def is_exact(self) -> bool:
        """Whether nothing is uncertain."""
        return not self.covariance.any()

    def extended(self, structure: Structure) -> "AssumedShip":
        """Return the ship with a structure that has further parameters behind these, with their usual spread."""
        usual, known = assumed_ship(structure, self.by_name), slice(self.values.size)
        covariance = usual.covariance.copy()
        covariance[known, known] = self.covariance
        return replace(usual, covariance=frozen_float(covariance), log_normal=self.log_normal)

    def draws(self, count: int, rng: np.random.Generator, *, gain_margin: float = 1.0) -> FloatArray:
        """Return possible ships, with a stable loop and within the bounds, the assumed one first.

        A ship whose loop is unstable is not tested.

        ``count``: number of ships. ``rng``: draws them. ``gain_margin``: how many times as large the gains of the
        governor may be, at least, before the line hunts. Returns parameter values, shape (rows, parameters); one row
        where nothing is uncertain. Raises DesignError if hardly any loop is stable, or the assumed one is not.
        """
        if not stable_rows(self.structure, self.values[None, :]).all():
            raise DesignError(
                f"assumed ship {self.structure.name}: expected a stable loop, found an unstable one; give other values."
            )
        if self.is_exact:
            return self.values[None, :]
        rows, drawn = self.values[None, :], 0
        while rows.shape[0] < count and drawn < _DRAWN_FOR_ONE * count:
            more = count - rows.shape[0]
            inside = self.within_bounds(self._drawn(more, rng))
            quiet = stable_rows(self.structure, self.with_gains(inside, gain_margin))
            rows, drawn = np.concatenate([rows, inside[quiet]]), drawn + more
        if rows.shape[0] < count:
            raise DesignError(
                f"assumed ship {self.structure.name}: expected mostly stable loops within the stated uncertainty, "
                f"found {rows.shape[0] - 1} of {drawn}; state it more narrowly, or sail a short test first."
            )
        return rows

    def _drawn(self, count: int, rng: np.random.Generator) -> FloatArray:
        """Return values from the distribution, within no bounds, shape (count, parameters)."""
        rows = rng.multivariate_normal(self.values, self.covariance, size=count, method="eigh")
        places = [self.structure.names.index(name) for name in self.log_normal]
        middle = self.values[places]
        rows[:, places] = middle * np.exp(rows[:, places] / middle - 1.0)
        return rows

    def within_bounds(self, rows: FloatArray) -> FloatArray:
        """Return parameter values, each moved to the next bound where it is beyond, shape (..., parameters)."""
        lower, upper = np.array([(p.lower, p.upper) for p in self.structure.parameters]).T
        return np.clip(rows, lower, upper)

    def with_gains(self, rows: FloatArray, factor: float) -> FloatArray:
        """Return parameter values with so many times the gains of the governor, shape (rows, parameters)."""
        changed = rows.copy()
        changed[:, [place for place, p in enumerate(self.structure.parameters) if p.role in GAINS]] *= factor
        return changed


def assumed_ship(
    structure: Structure, values: Mapping[str, float] | None = None, *, std: Mapping[str, float] | None = None
) -> AssumedShip:
    """Return a ship of which something is assumed before any test.

    Parameters
    ----------
    structure
        The structure that the test is to find.
    values
        Assumed values by name; the structure's own where not given.
    std
        Standard deviations by name, in the parameters' units, those left out are exact; by their roles where not given
        (``RELATIVE_SPREAD``, ``SPREAD``).

    Raises
    ------
    StructureError
        If a value names no parameter.
    DesignError
        If a standard deviation names none.
    """
    vector = structure.vector(values or {})
    spread = _usual_std(structure, vector) if std is None else dict(std)
    unknown = [name for name in spread if name not in structure.names]
    if unknown:
        raise DesignError(
            f"assumed ship: structure {structure.name} has no parameter {', '.join(unknown)}; it has "
            f"{', '.join(structure.names)}.{meant(unknown[0], structure.names)}"
        )
    deviations = np.array([spread.get(name, 0.0) for name in structure.names])
    return AssumedShip(
        structure=structure, values=frozen_float(vector), covariance=frozen_float(np.diag(deviations**2))
    )


def ship_of_fit(structure: Structure, fit: "Identification") -> AssumedShip:
    """Return what a first test found, with its covariance, for the plan of the next.

    Parameters
    ----------
    structure
        The structure as it is normalised at the first working point, its sensors ideal.
    fit
        A fit of it to one response or to several at their working points; what it held keeps the structure's value.

    Raises
    ------
    DesignError
        If the fit does not have all free parameters of the structure.
    """
    estimates = {estimate.name: estimate.value for estimate in fit.parameters}
    missing = [p.name for p in structure.free if p.name not in estimates]
    if missing:
        raise DesignError(
            f"assumed ship {structure.name}: expected a fit with {', '.join(missing)}, found one of "
            f"{fit.objective.name}."
        )
    names = [p.name for p in structure.free]
    places = [structure.names.index(name) for name in names]
    rows = [list(estimates).index(name) for name in names]
    covariance = np.zeros((len(structure.names),) * 2)
    covariance[np.ix_(places, places)] = fit.covariance[np.ix_(rows, rows)]
    values = structure.vector({name: estimates[name] for name in names})
    return AssumedShip(structure=structure, values=frozen_float(values), covariance=frozen_float(covariance))


def _usual_std(structure: Structure, values: FloatArray) -> dict[str, float]:
    spread = {}
    for parameter, value in zip(structure.parameters, values.tolist(), strict=True):
        if parameter.held or parameter.role is None:
            continue
        if parameter.role in RELATIVE_SPREAD:
            spread[parameter.name] = RELATIVE_SPREAD[parameter.role] * abs(value)
        elif parameter.role in SPREAD:
            spread[parameter.name] = SPREAD[parameter.role]
    return spread
