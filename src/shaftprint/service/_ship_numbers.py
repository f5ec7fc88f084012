"""Numbers that follow from the parameters of a service fit: what they are worth, and where their errors come from."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.catalogue._roles import ROLES, ShipRole
from shaftprint.fingerprint._joint_numbers import JointNumbers
from shaftprint.fingerprint._margin_numbers import margin_numbers
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.likelihood._known import stated_by_vessel
from shaftprint.identify.uncertainty._budget import BudgetRow
from shaftprint.models._combination import Combination
from shaftprint.models._role import Role
from shaftprint.models._structure import Structure
from shaftprint.normalisation import Normalisation
from shaftprint.service._model import ServiceModel

if TYPE_CHECKING:
    from shaftprint.vessel._vessel import Vessel

SERVICE, GAUGE_SCALE, GAUGE_ZERO = "service", "gauge scale", "gauge zero"
"""Sources of errors: the service itself, and what the vessel file states of the gauge."""
# Change by which slopes are taken, over the value.
_STEP = 1e-4


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ShipNumber:
    """A number that follows from the parameters."""

    name: str
    """Its name."""
    unit: str
    """Its unit."""
    value: float
    """Its value."""
    slope: FloatArray
    """Its change for one unit of each free parameter, shape (free,)."""
    meaning: str
    """What it stands for."""
    role: Role | None = None
    """What it is in the line."""
    direct: Mapping[str, float] = field(default_factory=dict)
    """Its change, with sign, for one standard deviation of a source that enters the conversion."""
    expected: tuple[float, float] | None = None
    """Value and standard deviation by the vessel file."""


def parameter_numbers(structure: Structure, theta: FloatArray, free: Sequence[str]) -> list[ShipNumber]:
    """Return the free parameters themselves, whose names are ``free``."""
    about = {parameter.name: parameter for parameter in structure.parameters}
    return [
        ShipNumber(
            name=name,
            unit=about[name].unit,
            value=float(theta[k]),
            slope=np.eye(len(free))[k],
            meaning=about[name].meaning,
            role=about[name].role,
        )
        for k, name in enumerate(free)
    ]


def value_and_slope(of: Callable[[FloatArray], FloatArray], theta: FloatArray) -> tuple[float, FloatArray]:
    """Return what follows from the parameters, and its slopes from differences, shape (free,).

    ``of``: from parameters in rows, shape (rows, free), to a value for each. ``theta``: where, shape (free,).
    """
    steps = _STEP * np.maximum(np.abs(theta), 1e-2)
    table = np.concatenate([theta[None], theta + np.diag(steps), theta - np.diag(steps)])
    values = np.broadcast_to(of(table), len(table))
    return float(values[0]), (values[1 : 1 + theta.size] - values[1 + theta.size :]) / (2.0 * steps)


def _combined(one: Combination, theta: FloatArray, held: Mapping[str, float], free: Sequence[str]) -> ShipNumber:
    """Return a combination of the parameters."""

    def of(table: FloatArray) -> FloatArray:
        sets = {name: table[:, k] for k, name in enumerate(free)}
        return one.of(sets | {name: np.full(len(table), float(value)) for name, value in held.items()})

    value, slope = value_and_slope(of, theta)
    return ShipNumber(
        name=one.name,
        unit=one.unit,
        value=value,
        slope=slope,
        meaning=one.meaning,
        role=one.role,
    )


def combination_numbers(
    structure: Structure, theta: FloatArray, held: Mapping[str, float], free: Sequence[str]
) -> list[ShipNumber]:
    """Return the combinations of the structure."""
    return [_combined(one, theta, held, free) for one in structure.combinations]


def margin_numbers_of(
    structure: Structure, theta: FloatArray, held: Mapping[str, float], free: Sequence[str]
) -> list[ShipNumber]:
    """Return the stability margins."""
    vector = structure.vector(dict(zip(free, theta.tolist(), strict=True)) | dict(held))
    numbers = (_combined(one, theta, held, free) for one in margin_numbers(structure, vector))
    return [one for one in numbers if np.all(np.isfinite(one.slope))]


def physical_numbers_of(
    structure: Structure,
    theta: FloatArray,
    model: ServiceModel,
    vessel: "Vessel",
    *,
    torque_nm: float,
    load_std: float,
    load_slope: FloatArray,
    turn: FloatArray,
) -> list[ShipNumber]:
    """Return inertias, governor actions and the torque coefficient.

    The numbers are normalised with the mean load, which cancels where a torque is what is found.

    ``load_slope``: share by which the load goes with each number at the working point of the vessel file, (free,).
    ``turn``: from changes of the numbers there to those with the load, shape (free, free).
    """
    back = np.linalg.inv(turn)
    point = Normalisation(
        engine_speed_rev_s=model.engine_speed_rev_s, gear_ratio=vessel.gearbox.ratio, shaft_torque_nm=torque_nm
    )
    sensor = vessel.sensors.shaft_torque
    numbers = []
    for role in ROLES.values():
        name, form = structure.named_as(role), role.physical
        if name not in model.free or form is None:
            continue
        k = model.free.index(name)
        value = form.scale(point) * float(theta[k])
        numbers.append(
            ShipNumber(
                name=form.name,
                unit=form.unit,
                value=value,
                slope=form.scale(point) * turn[k, k] * back[k],
                meaning=form.meaning,
                role=role,
                direct={GAUGE_SCALE: value * sensor.scale_std},
                expected=stated_by_vessel(role, vessel),
            )
        )
    coefficient = (
        torque_nm
        * vessel.propeller.relative_rotative_efficiency
        / (vessel.water_density_kg_m3 * point.shaft_speed_rev_s**2 * vessel.propeller.diameter_m**5)
    )
    direct = {
        SERVICE: coefficient * load_std,
        GAUGE_SCALE: coefficient * sensor.scale_std,
        GAUGE_ZERO: coefficient * sensor.zero_std / torque_nm,
    }
    numbers.append(
        ShipNumber(
            name="K_Q",
            unit="-",
            value=coefficient,
            slope=coefficient * load_slope @ back,
            meaning="torque coefficient of the propeller, mean of the service",
            role=ShipRole.TORQUE,
            direct=direct,
            # the vessel file states that of zero advance
            expected=None
            if vessel.torque_coefficient is None or model.sails
            else (vessel.torque_coefficient, vessel.torque_coefficient_std or np.nan),
        )
    )
    return numbers


def budget_row(
    number: ShipNumber, covariance: FloatArray, of_prior: Mapping[str, FloatArray] = MappingProxyType({})
) -> BudgetRow:
    """Return the variance of a number by source."""
    priors = {name: float(number.slope @ change) for name, change in of_prior.items()}
    own = float(number.slope @ covariance @ number.slope) - sum(change**2 for change in priors.values())
    own = max(own, 0.0) + number.direct.get(SERVICE, 0.0) ** 2
    # the scale of the gauge moves a number in two ways, which add up with their signs
    sources = dict.fromkeys((*priors, *(name for name in number.direct if name != SERVICE)))
    further = {name: (priors.get(name, 0.0) + number.direct.get(name, 0.0)) ** 2 for name in sources}
    return BudgetRow(name=number.name, unit=number.unit, value=number.value, variances={SERVICE: own} | further)


def quantity_of(
    number: ShipNumber, covariance: FloatArray, of_prior: Mapping[str, FloatArray] = MappingProxyType({})
) -> Estimate:
    """Return a number as a fingerprint keeps it."""
    expected, expected_std = number.expected or (None, None)
    return Estimate(
        name=number.name,
        unit=number.unit,
        value=number.value,
        std=budget_row(number, covariance, of_prior).std,
        meaning=number.meaning,
        role=number.role,
        expected=expected,
        expected_std=None if expected_std is None or not np.isfinite(expected_std) else expected_std,
    )


def joint_of(
    physical: Sequence[ShipNumber],
    parameters: Sequence[ShipNumber],
    covariance: FloatArray,
    of_prior: Mapping[str, FloatArray],
) -> JointNumbers:
    """Return what the service leaves open of the numbers together, and what was known beforehand apart from it."""
    chosen = [*physical, *(one for one in parameters if one.role is not None and one.role.is_of_line)]
    slopes = np.array([one.slope for one in chosen])
    left = covariance - sum(np.outer(one, one) for one in of_prior.values())
    size = np.sqrt(np.diag(covariance))
    # deviations that were widened leave correlations a little beyond what the rest can have
    squares, turn = np.linalg.eigh(left / np.outer(size, size))
    own = slopes @ ((turn * np.maximum(squares, 0.0)) @ turn.T * np.outer(size, size)) @ slopes.T
    for source in (SERVICE, GAUGE_ZERO):
        change = np.array([one.direct.get(source, 0.0) for one in chosen])
        own = own + np.outer(change, change)
    nothing = np.zeros(covariance.shape[0])
    loadings = {
        name: tuple(
            (slopes @ of_prior.get(name, nothing) + np.array([one.direct.get(name, 0.0) for one in chosen])).tolist()
        )
        for name in dict.fromkeys((*of_prior, GAUGE_SCALE))
    }
    return JointNumbers(
        names=tuple(one.name for one in chosen),
        own_covariance=tuple(tuple(row) for row in (0.5 * (own + own.T)).tolist()),
        loadings=loadings,
    )
