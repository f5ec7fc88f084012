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

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.fingerprint._fingerprint import Quantity
from shaftprint.fingerprint._working_point_share import LOAD_WANDER, shares_over_torque, shifts_of_working_point
from shaftprint.identify import Budget, Identification, budget
from shaftprint.models import Combination, Structure
from shaftprint.units import SECONDS_PER_MINUTE

if TYPE_CHECKING:
    from shaftprint.signals import WorkingPoint
    from shaftprint.vessel import Vessel

PERCENT = 100.0
IDEAL_SLOPE = 2.0
GAUGE_ZERO = "gauge zero share"
"""Name of the zero offset of the torque gauge over the working-point torque."""


@dataclass(frozen=True, kw_only=True, slots=True)
class PhysicalNumber:
    """A physical value as a number that follows from the parameters."""

    number: Combination
    """Its name, unit and formula."""
    direct: Mapping[str, float] = field(default_factory=dict)
    """Change, with sign, for one standard deviation of a source that enters the conversion."""
    expected: float | None = None
    """Value of the vessel file."""
    expected_std: float | None = None
    """Standard deviation of that value."""


def physical_numbers(
    identification: Identification, working_point: "WorkingPoint", vessel: "Vessel"
) -> tuple[PhysicalNumber, ...]:
    """Return the physical values that a fit gives, as numbers that follow from its parameters."""
    structure = identification.structure
    named = structure.named(identification.own_values())
    scale = vessel.sensors.shaft_torque.scale_std
    plans = (*_inertias(working_point, vessel), *_governor_actions(working_point))
    found = []
    for needs, plan in plans:
        if set(needs) <= set(named):
            value = float(plan.number.of(named))
            found.append(
                PhysicalNumber(
                    number=plan.number,
                    direct=({"gauge scale": value * scale} if scale else {})
                    | {source: -value * share for source, share in shares_over_torque(working_point).items()},
                    expected=plan.expected,
                    expected_std=plan.expected_std,
                )
            )
    return (
        *found,
        *_gauge_zero(structure, working_point, vessel),
        _torque_coefficient(float(named["k_q"]) if _finds_zero(structure) else None, working_point, vessel),
    )


def physical_quantities(
    identification: Identification, working_point: "WorkingPoint", vessel: "Vessel", stated: Budget | None = None
) -> tuple[Quantity, ...]:
    """Return physical values with standard deviations, beside the values of the vessel file where it has them.

    Parameters
    ----------
    identification, working_point, vessel
        The fit, where it was made, and what was tested.
    stated
        The uncertainty budget with the physical numbers among its rows; made here when not given.
    """
    numbers = physical_numbers(identification, working_point, vessel)
    if stated is None:
        direct = {item.number.name: item.direct for item in numbers}
        shifts = shifts_of_working_point(identification, working_point)
        stated = budget(identification, [item.number for item in numbers], direct=direct, shifts=shifts)
    found = []
    for item in numbers:
        row = stated.row(item.number.name)
        found.append(
            Quantity(
                name=row.name,
                unit=row.unit,
                value=row.value,
                std=row.std,
                expected=item.expected,
                expected_std=item.expected_std,
                meaning=item.number.meaning,
            )
        )
    return tuple(found)


def _inertias(working_point: "WorkingPoint", vessel: "Vessel") -> Iterator[tuple[tuple[str, ...], PhysicalNumber]]:
    shaft_rev_s = working_point.engine_speed_rev_s / vessel.gearbox.ratio
    factor = working_point.shaft_torque_nm / (2.0 * np.pi * shaft_rev_s)
    upstream = (vessel.inertia_upstream_kg_m2, vessel.inertia_upstream_std_kg_m2)
    downstream = (vessel.inertia_downstream_kg_m2, vessel.inertia_downstream_std_kg_m2)
    for name, tau, (expected, expected_std), meaning in (
        ("I_dn", "tau_dn", downstream, "inertia downstream of the torque gauge, at the propeller shaft"),
        ("I_up", "tau_up", upstream, "inertia upstream of the torque gauge, at the propeller shaft"),
        ("I", "tau_n", upstream, "inertia that the thesis' shaft loop implies, at the propeller shaft"),
    ):
        number = Combination(name=name, unit="kg m2", of=_product(factor, tau), meaning=meaning)
        yield (tau,), PhysicalNumber(number=number, expected=expected, expected_std=expected_std)


def _governor_actions(working_point: "WorkingPoint") -> Iterator[tuple[tuple[str, ...], PhysicalNumber]]:
    factor = working_point.shaft_torque_nm / (working_point.engine_speed_rev_s * SECONDS_PER_MINUTE)
    for name, unit, gain, meaning in (
        ("governor proportional action", "N m/rpm", "K_p", "change of torque"),
        ("governor integral action", "N m/(rpm s)", "K_i", "rate of change of torque"),
    ):
        text = f"{meaning}, at the propeller shaft, for one rpm of engine-speed error"
        yield (
            (gain, "v"),
            PhysicalNumber(number=Combination(name=name, unit=unit, of=_product(factor, "v", gain), meaning=text)),
        )


def _product(factor: float, *names: str) -> Callable[[Mapping[str, FloatArray]], FloatArray]:
    return lambda named: np.asarray(factor * np.prod([named[name] for name in names], axis=0))


def _gauge_zero(structure: Structure, working_point: "WorkingPoint", vessel: "Vessel") -> tuple[PhysicalNumber, ...]:
    """Return the zero offset of the gauge over the torque without it, where the fit is free to find it."""
    if not _finds_zero(structure):
        return ()
    number = Combination(
        name=GAUGE_ZERO,
        unit="%",
        of=lambda named: PERCENT * (IDEAL_SLOPE / named["k_q"] - 1.0),
        meaning="zero offset of the torque gauge, or constant friction, over the working-point torque",
    )
    stated_nm = vessel.sensors.shaft_torque.zero_std
    stated = PERCENT * stated_nm / working_point.shaft_torque_nm
    return (PhysicalNumber(number=number, expected=0.0, expected_std=stated),)


def _finds_zero(structure: Structure) -> bool:
    return "k_q" in [parameter.name for parameter in structure.free]


def _torque_coefficient(slope: float | None, working_point: "WorkingPoint", vessel: "Vessel") -> PhysicalNumber:
    """Return the torque coefficient, with the fitted slope ``k_q`` where the fit was free to find it."""
    shaft_rev_s = working_point.engine_speed_rev_s / vessel.gearbox.ratio
    shown = (
        working_point.shaft_torque_nm
        * vessel.propeller.relative_rotative_efficiency
        / (vessel.water_density_kg_m3 * shaft_rev_s**2 * vessel.propeller.diameter_m**5)
    )
    finds_zero = slope is not None
    value = shown if slope is None else shown * slope / IDEAL_SLOPE
    shares = _shares_of_coefficient(working_point, vessel, finds_zero=finds_zero)
    return PhysicalNumber(
        number=Combination(
            name="K_Q",
            unit="-",
            of=_product(shown / IDEAL_SLOPE, "k_q") if finds_zero else _product(shown),
            meaning="torque coefficient of the propeller, mean of the test",
        ),
        direct={source: value * share for source, share in shares.items() if share},
        expected=vessel.propeller.torque_coefficient,
    )


def _shares_of_coefficient(working_point: "WorkingPoint", vessel: "Vessel", *, finds_zero: bool) -> dict[str, float]:
    """Return the change of the torque coefficient for one standard deviation of each source, over its size."""
    sensor, torque = vessel.sensors.shaft_torque, working_point.shaft_torque_nm
    shares = {"gauge scale": sensor.scale_std}
    if not finds_zero:
        shares["gauge zero"] = sensor.zero_std / torque
    return shares | {LOAD_WANDER: working_point.load_std}
