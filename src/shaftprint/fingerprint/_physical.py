"""From normalised parameters to physical values.

With the working point ``n_s0`` [rev/s] of the propeller shaft and ``M_s0`` [N m] at the gauge::

    I      = tau M_s0 / (2 pi n_s0)                     inertia, thesis eq. 2.23
    K_Q    = M_s0 eta_R / (rho n_s0^2 D^5)              thesis eqs 2.9-2.11 at J = 0
    dM/dn  = v K_p M_s0 / n_e0                          proportional governor action on the shaft torque
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from operator import itemgetter
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.fingerprint._fingerprint import Quantity
from shaftprint.identify import Identification
from shaftprint.units import SECONDS_PER_MINUTE

if TYPE_CHECKING:
    from shaftprint.signals import WorkingPoint
    from shaftprint.vessel import Vessel


@dataclass(frozen=True, kw_only=True, slots=True)
class _Physical:
    name: str
    unit: str
    needs: tuple[str, ...]
    factor: float
    torque_power: float
    of: Callable[[Mapping[str, float]], float]
    meaning: str
    expected: float | None = None
    expected_std: float | None = None


def physical_quantities(
    identification: Identification, working_point: "WorkingPoint", vessel: "Vessel"
) -> tuple[Quantity, ...]:
    """Return physical values with standard deviations, beside the values of the vessel file where it has them.

    The uncertainties of the fit, of the working-point torque and of the gauge's scale are added in quadrature, for
    the torque coefficient also that of the gauge's zero and of the working-point speed.
    """
    torque, sensor = working_point.shaft_torque_nm, vessel.sensors.shaft_torque
    gauge = sensor.scale_std_fraction or 0.0
    torque_share = float(np.hypot(working_point.shaft_torque_std_nm / torque, gauge))
    structure = identification.structure
    names = {*structure.names, *(tie.name for tie in structure.ties)}
    found = []
    for item in _catalogue(working_point, vessel):
        if not set(item.needs) <= names:
            continue
        estimate = identification.derived(item.name, item.unit, item.of)
        value = item.factor * estimate.value
        std = float(np.hypot(item.factor * estimate.std, value * item.torque_power * torque_share))
        found.append(
            Quantity(
                name=item.name,
                unit=item.unit,
                value=value,
                std=std,
                expected=item.expected,
                expected_std=item.expected_std,
                meaning=item.meaning,
            )
        )
    # a zero offset shifts the torque itself, but not its changes, of which all other values are made
    zero_share = (sensor.zero_std_nm or 0.0) / torque
    return (*found, _torque_coefficient(working_point, vessel, float(np.hypot(torque_share, zero_share))))


def _catalogue(working_point: "WorkingPoint", vessel: "Vessel") -> tuple[_Physical, ...]:
    return (*_inertias(working_point, vessel), *_governor_actions(working_point))


def _inertias(working_point: "WorkingPoint", vessel: "Vessel") -> Iterator[_Physical]:
    shaft_rev_s = working_point.engine_speed_rev_s / vessel.gearbox.ratio
    upstream = (vessel.inertia_upstream_kg_m2, vessel.inertia_upstream_std_kg_m2)
    downstream = (vessel.inertia_downstream_kg_m2, vessel.inertia_downstream_std_kg_m2)
    for name, tau, (expected, expected_std), meaning in (
        ("I_dn", "tau_dn", downstream, "inertia downstream of the torque gauge, at the propeller shaft"),
        ("I_up", "tau_up", upstream, "inertia upstream of the torque gauge, at the propeller shaft"),
        ("I", "tau_n", upstream, "inertia that the thesis' shaft loop implies, at the propeller shaft"),
    ):
        yield _Physical(
            name=name,
            unit="kg m2",
            needs=(tau,),
            factor=working_point.shaft_torque_nm / (2.0 * np.pi * shaft_rev_s),
            torque_power=1.0,
            of=itemgetter(tau),
            meaning=meaning,
            expected=expected,
            expected_std=expected_std,
        )


def _governor_actions(working_point: "WorkingPoint") -> Iterator[_Physical]:
    for name, unit, gain, meaning in (
        ("governor proportional action", "N m/rpm", "K_p", "change of torque"),
        ("governor integral action", "N m/(rpm s)", "K_i", "rate of change of torque"),
    ):
        yield _Physical(
            name=name,
            unit=unit,
            needs=(gain, "v"),
            factor=working_point.shaft_torque_nm / (working_point.engine_speed_rev_s * SECONDS_PER_MINUTE),
            torque_power=1.0,
            of=lambda p, gain=gain: p["v"] * p[gain],  # type: ignore[misc]
            meaning=f"{meaning}, at the propeller shaft, for one rpm of engine-speed error",
        )


def _torque_coefficient(working_point: "WorkingPoint", vessel: "Vessel", torque_share: float) -> Quantity:
    shaft_rev_s = working_point.engine_speed_rev_s / vessel.gearbox.ratio
    speed_share = working_point.engine_speed_std_rev_s / working_point.engine_speed_rev_s
    value = (
        working_point.shaft_torque_nm
        * vessel.propeller.relative_rotative_efficiency
        / (vessel.water_density_kg_m3 * shaft_rev_s**2 * vessel.propeller.diameter_m**5)
    )
    return Quantity(
        name="K_Q",
        unit="-",
        value=value,
        std=float(value * np.hypot(torque_share, 2.0 * speed_share)),
        expected=vessel.propeller.torque_coefficient,
        meaning="torque coefficient of the propeller at the working point",
    )
