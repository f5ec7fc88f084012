"""What is known of a line before any test: the priors that a vessel file gives to parameters, by their roles.

A test of set point, speed and shaft torque finds ``v K_p / tau``, ``v K_i / tau`` and ``(k_q - g) / tau`` with
``tau = tau_up + tau_dn``, but neither ``tau_up`` nor ``g`` alone. The torsional vibration calculation (TVC) knows the
inertia upstream of the gauge to a few percent, and brake torque over speed at constant rack is nearly flat in the
middle of the range.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.catalogue._roles import ShipRole
from shaftprint.catalogue._shipped import expect_roles
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.models._role import Role
from shaftprint.models._structure import Structure
from shaftprint.normalisation import Normalisation
from shaftprint.torsion._coupling import LineCoupling, line_coupling
from shaftprint.units import rev_s_from_rpm

if TYPE_CHECKING:
    from shaftprint.signals._clock import Mode
    from shaftprint.signals._working_points import WorkingPoint
    from shaftprint.vessel._vessel import Vessel

PRIOR_OF_G = Prior(mean=0.0, std=0.1)
"""Slope of the engine torque with speed, before any test: flat to a tenth."""

SHAFT_TORQUE = "M_s"

SHARE_ROUNDING = 0.002
"""Standard deviation of the share that an electric machine shows: how far it cannot be told is in its scale."""


def priors_from_vessel(
    structure: Structure, vessel: "Vessel", working_point: "WorkingPoint", *, mode: "Mode" = "shaftprint"
) -> dict[str, Prior]:
    """Return what a fit may know beforehand of a structure's free parameters, by their roles.

    It is the inertia upstream of the gauge and with it the slope of the engine torque; stiffness and damping of the
    coupling that the links state, and what it drives ahead of the gauge; the latencies of gauge, set point and rack;
    the scale of what shows a pitch; and the inertia downstream, and the slope of the torque over a pitch, where the
    structure has no shaft torque to show them. Where it shows, the test is to check what the vessel file says of these,
    so that the fit does not know it.

    Parameters
    ----------
    structure
        Its free parameters are asked for.
    vessel, working_point
        What was tested, and where.
    mode
        How the signals were prepared: in thesis mode the whole latency of the torque is still in them.

    Raises
    ------
    StructureError
        If a parameter has the name and unit of one of the catalogue, but no role.
    """
    left_out = set()
    if SHAFT_TORQUE in (*structure.inputs, *structure.outputs):
        left_out |= {ShipRole.INERTIA_DOWNSTREAM, ShipRole.PITCH_SLOPE}
    if ShipRole.INERTIA_UPSTREAM not in _free_names(structure):
        left_out.add(ShipRole.ENGINE_SPEED_SLOPE)
    expected = expected_from_vessel(structure, vessel, working_point, mode=mode)
    return {name: prior for name, prior in expected.items() if structure.roles[name] not in left_out}


def expected_from_vessel(
    structure: Structure, vessel: "Vessel", working_point: "WorkingPoint", *, mode: "Mode" = "shaftprint"
) -> dict[str, Prior]:
    """Return all that a vessel file states of a structure's free parameters, for those who plan or predict a test.

    It is what a fit may know (``priors_from_vessel``, which has the parameters and errors) and what the test is to
    check: the inertia downstream of the gauge, and the slope of the torque over a controllable pitch.
    """
    expect_roles(structure)
    names = _free_names(structure)
    test = _Test(vessel=vessel, point=working_point, is_late=mode == "thesis")
    stated = {names[role]: prior_of(test) for role, prior_of in PRIORS.items() if role in names}
    return {name: prior for name, prior in stated.items() if prior is not None}


def _free_names(structure: Structure) -> dict[Role, str]:
    """Return the free parameters by their roles."""
    return {structure.roles[p.name]: p.name for p in structure.free if p.name in structure.roles}


def stated_by_vessel(role: Role | None, vessel: "Vessel") -> tuple[float, float] | None:
    """Return the physical value of a role and its standard deviation by the vessel file; None where it states none.

    It is an inertia [kg m2] on one side of the gauge, or what the links say of the coupling [N m/rad, N m s/rad], all
    at the propeller shaft. The thesis compares the inertia of its shaft loop with that upstream.
    """
    if role in (ShipRole.INERTIA, ShipRole.INERTIA_UPSTREAM):
        return vessel.inertia_upstream_kg_m2, vessel.inertia_upstream_std_kg_m2
    if role == ShipRole.INERTIA_DOWNSTREAM:
        return vessel.inertia_downstream_kg_m2, vessel.inertia_downstream_std_kg_m2
    coupling = line_coupling(vessel) if role in _OF_COUPLING else None
    if role is None or coupling is None:
        return None
    value, std = _OF_COUPLING[role](coupling)
    return (value, std) if value > 0.0 else None


_OF_COUPLING: Mapping[Role, Callable[[LineCoupling], tuple[float, float]]] = {
    ShipRole.INERTIA_DRIVEN: lambda one: (one.driven_kg_m2, one.driven_std_kg_m2),
    ShipRole.COUPLING_STIFFNESS: lambda one: (one.stiffness_nm_rad, one.stiffness_std_nm_rad),
    ShipRole.COUPLING_DAMPING: lambda one: (one.damping_nm_s_rad, one.damping_std_nm_s_rad),
}


@dataclass(frozen=True, kw_only=True, slots=True)
class _Test:
    """What was tested, where, and how its signals were prepared."""

    vessel: "Vessel"
    point: "WorkingPoint"
    is_late: bool
    """Whether the latencies of torque and rack are still in the signals."""

    def over_torque(self, role: Role, source: str) -> Prior | None:
        """Return what the vessel file knows of an inertia time, ``2 pi I n_s0 / M_s0``; None where it knows nothing.

        Stiffness and damping of a coupling are normalised alike. The standard deviation holds that of the vessel file
        and of the gauge's scale: a gauge that shows too much makes the number too small. The error of the working point
        is not in it, because ``M_s0`` is the number by which the responses are divided, whatever the load was; it comes
        to all that is found over that number alike, after the fit.
        """
        stated = stated_by_vessel(role, self.vessel)
        if stated is None or not stated[1] > 0.0:
            return None
        value, std = stated
        normalisation = Normalisation(
            engine_speed_rev_s=self.point.engine_speed_rev_s,
            gear_ratio=self.vessel.gearbox.ratio,
            shaft_torque_nm=self.point.shaft_torque_nm,
        )
        mean = normalisation.inertia_time_s(value)
        parts = {source: mean * std / value, "gauge scale": -mean * self.vessel.sensors.shaft_torque.scale_std}
        sources = {name: float(part) for name, part in parts.items() if part}
        return Prior(mean=float(mean), std=float(np.linalg.norm(list(sources.values()))), sources=sources)

    def torque_latency(self) -> Prior | None:
        """Return what is known of the torque gauge's latency, over what was taken off already."""
        gauge = self.vessel.sensors.shaft_torque
        return self._latency("telemetry latency", gauge.latency_s if self.is_late else 0.0, gauge.latency_std)

    def set_point_latency(self) -> Prior | None:
        """Return what is known of the set point's latency; None where the vessel file does not state it."""
        set_point = self.vessel.sensors.set_point
        return self._latency("set-point latency", set_point.latency_s, set_point.latency_std_s)

    def set_point_bend(self) -> Prior:
        """Return how far the line of the set point may bend, over the speed of the measured working point."""
        stated_rpm = self.vessel.working_point.engine_speed_rpm
        share = self.point.engine_speed_rev_s / rev_s_from_rpm(stated_rpm)
        std = share * self.vessel.sensors.set_point.line_bend_std
        return Prior(mean=0.0, std=std, sources={"set-point bend": std})

    def rack_latency(self) -> Prior | None:
        """Return what is known of the rack's latency, over what was taken off already; None without a rack."""
        rack = self.vessel.sensors.rack
        if rack is None:
            return None
        return self._latency("rack latency", rack.latency_s if self.is_late else 0.0, rack.latency_std_s)

    def log_latency(self) -> Prior | None:
        """Return what is known of the log's latency, over what was taken off already; None without a log."""
        log = self.vessel.sensors.ship_speed
        if log is None:
            return None
        return self._latency("log latency", log.latency_s if self.is_late else 0.0, log.latency_std)

    def load_slope(self) -> Prior | None:
        """Return what the zero of the torque gauge lets be known of the slope of the load; None at the quay.

        There the test shows it. Underway the ship's speed changes the torque too, and nothing tells the two apart.
        """
        if not self.vessel.is_underway:
            return None
        mean, share = (
            ShipRole.LOAD_SLOPE.law or 0.0,
            self.vessel.sensors.shaft_torque.zero_std / self.point.shaft_torque_nm,
        )
        return Prior(mean=mean, std=mean * share, sources={"gauge zero": -mean * share}) if share else None

    def pitch_slope(self) -> Prior | None:
        """Return the stated slope of the torque over a controllable pitch at the quay; None where none is stated."""
        pitch = self.vessel.pitch
        if pitch is None or pitch.torque_slope is None or self.vessel.is_underway:
            return None
        std = pitch.torque_slope_std or pitch.usual_slope_std(pitch.torque_slope)
        return Prior(mean=pitch.torque_slope, std=std, sources={"pitch slope": std})

    def pitch_sensor_scale(self) -> Prior | None:
        """Return what is known of the scale by which a pitch is shown; None where it is not logged."""
        sensor = self.vessel.sensors.pitch
        if sensor is None:
            return None
        return Prior(mean=1.0, std=sensor.scale_std, sources={"pitch sensor scale": sensor.scale_std})

    def machine_scale(self) -> Prior | None:
        """Return how far converter and gauge may be apart; None where no electric machine is on the gearbox.

        Where no channel shows its torque, the share of the vessel file stands for it.
        """
        machine, sensor = self.vessel.shaft_machine, self.vessel.sensors.machine_torque
        if machine is None:
            return None
        shown = machine.share_std / abs(machine.share) if sensor is None and machine.share else 0.0
        parts = {
            "machine torque": -shown if sensor is None else -sensor.scale_std,
            "gauge scale": self.vessel.sensors.shaft_torque.scale_std,
        }
        sources = {name: part for name, part in parts.items() if part}
        return Prior(mean=1.0, std=float(np.linalg.norm(list(sources.values()))), sources=sources) if sources else None

    def machine_share(self) -> Prior | None:
        """Return the share of the vessel file; None where no electric machine is on the gearbox."""
        machine = self.vessel.shaft_machine
        if machine is None:
            return None
        return Prior(mean=machine.share, std=SHARE_ROUNDING, sources={"machine share": SHARE_ROUNDING})

    def _latency(self, source: str, mean_s: float | None, std_s: float | None) -> Prior | None:
        return Prior(mean=mean_s, std=std_s, sources={source: std_s}) if mean_s is not None and std_s else None


PRIORS: Mapping[Role, Callable[[_Test], Prior | None]] = {
    ShipRole.ENGINE_SPEED_SLOPE: lambda _: PRIOR_OF_G,
    ShipRole.INERTIA_UPSTREAM: lambda test: test.over_torque(ShipRole.INERTIA_UPSTREAM, "TVC"),
    ShipRole.INERTIA_DOWNSTREAM: lambda test: test.over_torque(ShipRole.INERTIA_DOWNSTREAM, "TVC"),
    ShipRole.INERTIA_DRIVEN: lambda test: test.over_torque(ShipRole.INERTIA_DRIVEN, "TVC"),
    ShipRole.COUPLING_STIFFNESS: lambda test: test.over_torque(ShipRole.COUPLING_STIFFNESS, "coupling"),
    ShipRole.COUPLING_DAMPING: lambda test: test.over_torque(ShipRole.COUPLING_DAMPING, "coupling damping"),
    ShipRole.TORQUE_LATENCY: _Test.torque_latency,
    ShipRole.SET_POINT_LATENCY: _Test.set_point_latency,
    ShipRole.SET_POINT_BEND: _Test.set_point_bend,
    ShipRole.RACK_LATENCY: _Test.rack_latency,
    ShipRole.LOG_LATENCY: _Test.log_latency,
    ShipRole.LOAD_SLOPE: _Test.load_slope,
    ShipRole.PITCH_SLOPE: _Test.pitch_slope,
    ShipRole.PITCH_SENSOR_SCALE: _Test.pitch_sensor_scale,
    ShipRole.MACHINE_SCALE: _Test.machine_scale,
    ShipRole.MACHINE_SHARE: _Test.machine_share,
}
"""Priors of a vessel file, by role."""
