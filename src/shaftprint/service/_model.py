"""The model that service is compared with: the closed loop at large, with what is known of it beforehand."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.catalogue._gauge import (
    C_SET,
    GAUGE_K_I,
    GAUGE_K_P,
    GAUGE_OMEGA_N,
    GAUGE_ZETA,
    K_Q,
    T_D,
    T_GAUGE,
    T_SP,
    TAU_DN,
    TAU_UP,
    G,
)
from shaftprint.catalogue._known_propeller import OF_THE_SHIP
from shaftprint.catalogue._limited import BOLLARD, M_MAX, M_MIN, T_AW, limited
from shaftprint.catalogue._roles import ShipRole
from shaftprint.catalogue._sailing import TAU_U, A, B, E
from shaftprint.catalogue._sailing_at_large import SAILING, V_0, steady_ship, taken
from shaftprint.errors import ServiceError
from shaftprint.identify.likelihood._known import stated_by_vessel
from shaftprint.models._structure import Structure
from shaftprint.normalisation import Normalisation
from shaftprint.survey._expected_of_ship import expected_of_ship
from shaftprint.units import SECONDS_PER_MINUTE

if TYPE_CHECKING:
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.service._segment import LeverLine, Segment
    from shaftprint.time_domain._record import Record
    from shaftprint.vessel._vessel import Vessel

FREE = tuple(
    one.name for one in (GAUGE_K_P, GAUGE_K_I, GAUGE_OMEGA_N, GAUGE_ZETA, T_D, T_SP, TAU_DN, TAU_UP, G, C_SET, T_GAUGE)
)
"""Parameters that service is asked for."""
FREE_UNDERWAY = (*FREE, *OF_THE_SHIP)
"""The same of a ship that makes way: slopes of thrust, torque and resistance, and the time of the ship."""
LIMITS = (M_MAX.name, M_MIN.name, T_AW.name)
"""Parameters of the limits of the torque."""
BESIDE = (K_Q.name, *LIMITS)
"""Parameters that each segment has for itself: its load, and the limits where it meets one."""
OVER_TORQUE = (GAUGE_K_P.name, GAUGE_K_I.name, TAU_DN.name, TAU_UP.name, G.name)
"""Those that go with the torque over the speed of the point at which they are normalised."""
_SPEED_SLOPE_STD, _SCALE_STD = 0.3, 0.005
# Slopes of thrust and torque by a series at an assumed wake, and the exponent of a resistance nobody has measured.
_SLOPE_SHARE, _EXPONENT_SHARE = 0.3, 0.25


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ServiceModel:
    """A structure at the working point of the vessel file, with where a fit begins and what the file knows."""

    structure: Structure
    """The closed loop, with the limits of the torque."""
    values: Mapping[str, float]
    """Values to begin with, by name; of held parameters too."""
    known: Mapping[str, float]
    """What the vessel file knows, by name."""
    prior_std: Mapping[str, float]
    """Standard deviations of that, by name."""
    free: tuple[str, ...]
    """Parameters that service is asked for, by name."""
    beside: tuple[str, ...]
    """Parameters that each segment has for itself."""
    engine_speed_rev_s: float
    """Engine speed of the working point [rev/s]."""
    shaft_torque_nm: float
    """Shaft torque of the working point [N m]."""
    is_of_fingerprint: bool
    """Whether the values are those of a fingerprint, against which a log can be held."""
    gauge_share: float = 0.0
    """Which share of the deviation of the inertia ahead of the gauge, as it is known beforehand, is that of the gauge's
    scale: kg m2 are known, and the torque by which they are divided is measured."""
    covariance: FloatArray | None = None
    """Covariance of the free parameters by that fingerprint, shape (free, free); None where it has others."""

    @property
    def theta(self) -> FloatArray:
        """Values of the free parameters, shape (free,)."""
        return np.array([self.values[name] for name in self.free])

    @property
    def theta_known(self) -> FloatArray:
        """What is known of the free parameters beforehand, shape (free,); where nothing is, their values."""
        return np.array([self.known.get(name, self.values[name]) for name in self.free])

    def vector(self, theta: FloatArray, load: float) -> FloatArray:
        """Return all parameters under a load over that of the working point, shape (parameters,).

        A propeller that takes ``l (1 + n)^2`` has the slope ``2 l``; what it takes more at the working point moves the
        limits, which are counted from there.
        """
        own = {**self.values, **dict(zip(self.free, theta.tolist(), strict=True))}
        own[K_Q.name] = 2.0 * load
        own[M_MAX.name] = max(self.values[M_MAX.name] - (load - 1.0), 0.1)
        own[M_MIN.name] = self.values[M_MIN.name] - (load - 1.0)
        return np.array([own[name] for name in self.structure.names])

    def records(self, segments: "Sequence[Segment]", line: "LeverLine") -> list["Record"]:
        """Return segments as records of deviations from the working point.

        ``segments``: usable ones. ``line``: what the lever asks for.
        """
        return [one.record(line, **self._point) for one in segments]

    def loads(self, segments: "Sequence[Segment]") -> FloatArray:
        """Return the torque of the propeller over what it takes at that speed, shape (segments,)."""
        return np.array([one.load(**self._point) for one in segments])

    @property
    def _point(self) -> dict[str, Any]:
        return {
            "speed_rev_s": self.engine_speed_rev_s,
            "torque_nm": self.shaft_torque_nm,
            "inertia_time_s": self.values[TAU_DN.name],
            "taken": self.taken,
        }

    def taken(self, speed: FloatArray) -> FloatArray:
        """Return what the propeller takes in steady running over that of the working point, shape (speeds,).

        ``speed``: shaft speeds, deviations from the working point, shape (speeds,).
        """
        if self.sails:
            ship = steady_ship(speed, self.values[A.name], self.values[E.name])
            return np.asarray(taken(speed, ship, self.values[B.name]))
        return np.asarray((1.0 + speed) ** 2)

    def at(self, theta: FloatArray) -> "ServiceModel":
        """Return the model at other values of the free parameters, shape (free,)."""
        return replace(self, values={**self.values, **dict(zip(self.free, theta.tolist(), strict=True))})

    @property
    def sails(self) -> bool:
        """Whether the ship makes way."""
        return B.name in self.free


def service_model(vessel: "Vessel", fingerprint: "Fingerprint | None" = None) -> ServiceModel:
    """Return the model of a line in service.

    ``vessel``: the installation. ``fingerprint``: one of an earlier test or of other days, to begin from; usual values
    where there is none. Raises ServiceError if the line is of a kind whose service cannot be compared with a model yet.
    """
    _expect_line(vessel)
    speed = vessel.working_point.engine_speed_rpm / SECONDS_PER_MINUTE
    torque = vessel.working_point.driving_torque_nm
    structure = limited(
        "torque", curve=vessel.machine.full_load_shape(speed), load=SAILING if vessel.is_underway else BOLLARD
    )
    point = Normalisation(engine_speed_rev_s=speed, gear_ratio=vessel.gearbox.ratio, shaft_torque_nm=torque)
    free = FREE_UNDERWAY if vessel.is_underway else FREE
    values = {parameter.name: parameter.value for parameter in structure.parameters}
    prior_std = {
        G.name: _SPEED_SLOPE_STD,
        C_SET.name: _SCALE_STD,
        T_GAUGE.name: vessel.sensors.shaft_torque.latency_std,
    }
    gauge_share = 0.0
    stated = stated_by_vessel(ShipRole.INERTIA_UPSTREAM, vessel)
    if stated is not None:
        values[TAU_UP.name] = point.inertia_time_s(stated[0])
        share = np.hypot(stated[1] / stated[0], vessel.sensors.shaft_torque.scale_std)
        prior_std[TAU_UP.name] = float(values[TAU_UP.name] * share)
        gauge_share = float(vessel.sensors.shaft_torque.scale_std / share)
    downstream = stated_by_vessel(ShipRole.INERTIA_DOWNSTREAM, vessel)
    if downstream is not None:
        values[TAU_DN.name] = point.inertia_time_s(downstream[0])
    if vessel.is_underway:
        values |= expected_of_ship(structure, vessel)
        prior_std |= _of_ship_std(vessel, values)
    known = {name: values[name] for name in prior_std}
    values |= _limits(vessel, speed, torque)
    if fingerprint is not None:
        values |= _of_fingerprint(fingerprint, point, values, free)
    return ServiceModel(
        structure=structure,
        values=values,
        known=known,
        prior_std={name: max(std, 1e-4) for name, std in prior_std.items()},
        free=free,
        beside=(*BESIDE, V_0.name) if vessel.is_underway else BESIDE,
        engine_speed_rev_s=speed,
        shaft_torque_nm=torque,
        is_of_fingerprint=fingerprint is not None,
        gauge_share=gauge_share,
        covariance=None if fingerprint is None else _covariance(fingerprint, point, free),
    )


def _expect_line(vessel: "Vessel") -> None:
    """Refuse lines that have no model here.

    Raises ServiceError if it is such a one.
    """
    kinds = {
        "a motor drives the line": vessel.motor is not None,
        "an electric machine is on the gearbox": vessel.shaft_machine is not None,
        "the pitch is controllable": vessel.pitch is not None,
        "the shaft turns astern": vessel.working_point.is_astern,
    }
    for kind, is_so in kinds.items():
        if is_so:
            raise ServiceError(
                f"vessel {vessel.name}: expected an engine with a fixed propeller at the quay, whose service can be "
                f"compared with a model, found that {kind}; make a test of it (shaftprint plan)."
            )


def _of_ship_std(vessel: "Vessel", values: Mapping[str, float]) -> dict[str, float]:
    """Return how far what the vessel file lets be expected of ship and propeller may be off, by name."""
    hull, speed_m_s = vessel.hull, vessel.working_point.ship_speed_m_s
    if hull is None or speed_m_s is None:
        return {}
    shares = {A.name: _SLOPE_SHARE, B.name: _SLOPE_SHARE, E.name: _EXPONENT_SHARE}
    return {name: share * abs(values[name]) for name, share in shares.items()} | {
        TAU_U.name: hull.surge_time_s(speed_m_s)[1]
    }


def _limits(vessel: "Vessel", speed_rev_s: float, torque_nm: float) -> dict[str, float]:
    """Return the limits of the torque at the working point, over the brake torque there."""
    brake = torque_nm / vessel.gearbox.shaft_over_brake
    rpm = speed_rev_s * SECONDS_PER_MINUTE
    highest = vessel.machine.full_load_nm(rpm) / brake
    motoring = vessel.motoring
    lowest = {} if motoring is None else {M_MIN.name: -float(np.interp(rpm, *motoring)) / brake}
    return {M_MAX.name: highest, **lowest}


def _of_fingerprint(
    fingerprint: "Fingerprint", point: Normalisation, usual: Mapping[str, float], free: Sequence[str]
) -> dict[str, float]:
    """Return the values of a fingerprint at the working point of the vessel file.

    Raises ServiceError if it is of a structure with other numbers.
    """
    tested = fingerprint.conditions
    own = {quantity.name: quantity.value for quantity in fingerprint.parameters} | fingerprint.held
    missing = [name for name in (GAUGE_K_P.name, GAUGE_K_I.name, T_D.name, TAU_DN.name) if name not in own]
    if missing:
        raise ServiceError(
            f"fingerprint of {tested.vessel}: expected one of a gauge-aware structure such as GAUGE-CLOSED, found "
            f"{fingerprint.structure}, which has no {missing[0]}; leave --fingerprint out or name another."
        )
    scale = _scale(fingerprint, point, free)
    values = {name: own[name] * factor for name, factor in zip(free, scale, strict=True) if name in own}
    return {name: value for name, value in values.items() if name in usual and name not in (C_SET.name,)}


def _scale(fingerprint: "Fingerprint", point: Normalisation, free: Sequence[str]) -> FloatArray:
    """Return by what each free parameter is multiplied from the point of a test to another, shape (free,)."""
    tested = fingerprint.conditions
    torque = tested.shaft_torque.value / point.shaft_torque_nm
    speed = tested.engine_speed.value / SECONDS_PER_MINUTE / point.engine_speed_rev_s
    return np.array([torque / speed if name in OVER_TORQUE else 1.0 for name in free])


def _covariance(fingerprint: "Fingerprint", point: Normalisation, free: Sequence[str]) -> FloatArray | None:
    """Return the covariance of the free parameters at the working point of the vessel file; None where some are not."""
    own = {one.name: k for k, one in enumerate(fingerprint.parameters)}
    if fingerprint.covariance is None or any(name not in own for name in free):
        return None
    places, scale = [own[name] for name in free], _scale(fingerprint, point, free)
    return np.asarray(np.array(fingerprint.covariance)[np.ix_(places, places)] * np.outer(scale, scale))
