"""From normalised parameters to physical values.

With the working point ``n_s0`` [rev/s] of the propeller shaft and ``M_s0`` [N m] at the gauge::

    I      = tau M_s0 / (2 pi n_s0)                     inertia, thesis eq. 2.23
    K_Q    = (k_q / 2) M_s0 eta_R / (rho n_s0^2 D^5)    thesis eqs 2.9-2.11 at J = 0
    dM/dn  = v K_p M_s0 / n_e0                          proportional governor action on the shaft torque
    zero   = 2 / k_q - 1                                zero offset of the gauge over M_s0 without it

A gauge that shows ``1 + e`` times the torque makes inertias and governor actions as much too large. The same ``e`` is
in the prior of ``tau_up``, which divides an inertia in kg m2 by the torque that the gauge shows: both go into the
budget with their signs. So does the error of the working point: ``M_s0`` divides the responses, the load of their
windows and the prior, and multiplies what is found, so that it cancels here (``_working_point_share.py``). ``K_Q`` is
made of it: there the wander of the load counts.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.catalogue._roles import ROLES, ShipRole
from shaftprint.distributions import NORMAL_95
from shaftprint.fingerprint._working_point_share import (
    GAIN,
    LOAD_WANDER,
    shares_over_torque,
    shifts_of_working_point,
    widened,
)
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.likelihood._known import stated_by_vessel
from shaftprint.identify.uncertainty._budget import Budget, BudgetRow, budget
from shaftprint.identify.uncertainty._profile import Interval
from shaftprint.models._combination import Combination
from shaftprint.models._structure import Structure
from shaftprint.normalisation import Normalisation
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.signals._working_points import WorkingPoint
    from shaftprint.vessel._vessel import Vessel

IDEAL_SLOPE = 2.0
# A number whose deviation is a smaller share of that of its parameter is told by what cancels in it.
_OF_ONE = 0.8
# Sides of an interval that are within this share those of the standard deviation say no more than that.
_AS_USUAL = 0.15
GAUGE_ZERO = "gauge zero share"
"""Name of the zero offset of the torque gauge over the working-point torque."""


@dataclass(frozen=True, kw_only=True, slots=True)
class PhysicalNumber:
    """A physical value as a number that follows from the parameters."""

    number: Combination
    """Its name, unit, formula and role."""
    direct: Mapping[str, float] = field(default_factory=dict)
    """Change, with sign, for one standard deviation of a source that enters the conversion."""
    expected: float | None = None
    """Value of the vessel file."""
    expected_std: float | None = None
    """Standard deviation of that value."""


def physical_numbers(
    identification: Identification, working_point: "WorkingPoint", vessel: "Vessel"
) -> tuple[PhysicalNumber, ...]:
    """Return the physical values that a fit gives, as numbers that follow from its parameters by their roles."""
    structure = identification.structure
    named = structure.named(identification.structure_values())
    slope = next((parameter for parameter in structure.free if parameter.role == ShipRole.LOAD_SLOPE), None)
    return (
        *_physical_forms(structure, named, working_point, vessel),
        *([] if slope is None else [_gauge_zero(slope.name, working_point, vessel)]),
        _torque_coefficient(None if slope is None else (slope.name, float(named[slope.name])), working_point, vessel),
    )


def physical_quantities(
    identification: Identification,
    working_point: "WorkingPoint",
    vessel: "Vessel",
    stated: Budget | None = None,
    intervals: Mapping[str, Interval] | None = None,
) -> tuple[Estimate, ...]:
    """Return physical values with standard deviations, beside the values of the vessel file where it has them.

    Parameters
    ----------
    identification, working_point, vessel
        The fit, where it was made, and what was tested.
    stated
        The uncertainty budget with the physical numbers among its rows; made here when not given.
    intervals
        Profile-likelihood intervals by parameter: what is a multiple of one has its interval.
    """
    numbers = physical_numbers(identification, working_point, vessel)
    if stated is None:
        direct = {item.number.name: item.direct for item in numbers}
        shifts = shifts_of_working_point(identification, working_point)
        stated = budget(identification, [item.number for item in numbers], direct=direct, shifts=shifts)
    quantities = []
    for item in numbers:
        row = stated.row(item.number.name)
        interval, is_open = _interval_of_multiple(identification, item.number, row, intervals or {})
        quantities.append(
            Estimate(
                name=row.name,
                unit=row.unit,
                value=row.value,
                std=row.std,
                interval_95=interval,
                interval_open=is_open,
                expected=item.expected,
                expected_std=item.expected_std,
                meaning=item.number.meaning,
                role=item.number.role,
            )
        )
    return tuple(quantities)


def _interval_of_multiple(
    identification: Identification, number: Combination, row: BudgetRow, intervals: Mapping[str, Interval]
) -> tuple[tuple[float, float] | None, tuple[bool, bool]]:
    """Return the interval of a number that is a multiple of one parameter, and which ends are open.

    It is as wide as the likelihood has that parameter; none where its deviation is another, for errors that cancel.
    """
    role = number.role
    by_role = {one.role: one for one in identification.parameters if one.name in intervals}
    found = by_role.get(role)
    is_product = role is not None and role.rack_power and ShipRole.ENGINE_RACK_SLOPE in by_role
    if found is None or role is None or role.physical is None or is_product or not found.value:
        return None, (False, False)
    factor, interval = row.value / found.value, intervals[found.name]
    if row.std < _OF_ONE * abs(factor) * found.std:
        return None, (False, False)
    further = math.sqrt(max(row.std**2 - (factor * found.std) ** 2, 0.0))
    is_open = (interval.lower_open, interval.upper_open)
    ends = widened((factor * interval.lower, factor * interval.upper), row.value, further, is_open)
    sides = [abs(end - row.value) / (NORMAL_95 * row.std) for end in ends]
    if not all(map(math.isfinite, ends)) or (not any(is_open) and all(abs(side - 1.0) < _AS_USUAL for side in sides)):
        # the standard deviation says as much
        return None, (False, False)
    return ends, is_open


def _physical_forms(
    structure: Structure, named: Mapping[str, FloatArray], working_point: "WorkingPoint", vessel: "Vessel"
) -> Iterator[PhysicalNumber]:
    """Yield inertias and governor actions: what parameters are in the units of the ship."""
    normalisation = Normalisation(
        engine_speed_rev_s=working_point.engine_speed_rev_s,
        gear_ratio=vessel.gearbox.ratio,
        shaft_torque_nm=working_point.shaft_torque_nm,
    )
    scale = vessel.sensors.shaft_torque.scale_std
    rack_slope = structure.named_as(ShipRole.ENGINE_RACK_SLOPE)
    for role in ROLES.values():
        name, form = structure.named_as(role), role.physical
        if name is None or form is None or (role.rack_power and rack_slope is None):
            continue
        factors = (rack_slope, name) if role.rack_power and rack_slope else (name,)
        number = Combination(
            name=form.name,
            unit=form.unit,
            of=_product(form.scale(normalisation), *factors),
            meaning=form.meaning,
            role=role,
        )
        value = float(number.of(named))
        expected, expected_std = stated_by_vessel(role, vessel) or (None, None)
        yield PhysicalNumber(
            number=number,
            direct=({"gauge scale": value * scale} if scale else {})
            | {source: -value * share for source, share in shares_over_torque(working_point).items()}
            | _of_gain(value, working_point),
            expected=expected,
            expected_std=expected_std,
        )


def _of_gain(value: float, working_point: "WorkingPoint") -> dict[str, float]:
    """Return the change of what goes with the torque for the gain that the gauge may have lost unseen."""
    return {GAIN: value * working_point.unseen_gain} if working_point.unseen_gain else {}


def _product(factor: float, *names: str) -> Callable[[Mapping[str, FloatArray]], FloatArray]:
    return lambda named: np.asarray(factor * np.prod([named[name] for name in names], axis=0))


def _gauge_zero(slope: str, working_point: "WorkingPoint", vessel: "Vessel") -> PhysicalNumber:
    """Return the zero offset of the gauge over the torque without it, from the slope of the load."""
    number = Combination(
        name=GAUGE_ZERO,
        unit="%",
        of=lambda named: PERCENT * (IDEAL_SLOPE / named[slope] - 1.0),
        meaning="zero offset of the torque gauge, or constant friction, over the working-point torque",
        role=ShipRole.LOAD_SLOPE,
    )
    stated = PERCENT * vessel.sensors.shaft_torque.zero_std / working_point.shaft_torque_nm
    return PhysicalNumber(number=number, expected=0.0, expected_std=stated)


def _torque_coefficient(
    slope: tuple[str, float] | None, working_point: "WorkingPoint", vessel: "Vessel"
) -> PhysicalNumber:
    """Return the torque coefficient, with name and value of the slope of the load where the fit was free to find it."""
    shown = vessel.coefficient_of(working_point.shaft_torque_nm, working_point.engine_speed_rev_s)
    value = shown if slope is None else shown * slope[1] / IDEAL_SLOPE
    shares = _shares_of_coefficient(working_point, vessel, finds_zero=slope is not None)
    return PhysicalNumber(
        number=Combination(
            name="K_Q",
            unit="-",
            of=_product(shown) if slope is None else _product(shown / IDEAL_SLOPE, slope[0]),
            meaning=f"torque coefficient of the propeller, mean of the test{', underway' * vessel.is_underway}"
            f"{', astern' * vessel.working_point.is_astern}",
            role=ShipRole.TORQUE,
        ),
        direct={source: value * share for source, share in shares.items() if share} | _of_gain(value, working_point),
        # the vessel file states that of zero advance
        expected=None if vessel.is_underway else vessel.torque_coefficient,
        expected_std=vessel.torque_coefficient_std,
    )


def _shares_of_coefficient(working_point: "WorkingPoint", vessel: "Vessel", *, finds_zero: bool) -> dict[str, float]:
    """Return the change of the torque coefficient for one standard deviation of each source, over its size."""
    sensor, torque = vessel.sensors.shaft_torque, working_point.shaft_torque_nm
    shares = {"gauge scale": sensor.scale_std}
    if not finds_zero:
        shares["gauge zero"] = sensor.zero_std / torque
    return shares | {LOAD_WANDER: working_point.load_std}
