"""The truth behind a simulated recording, in a file of its own that no reader opens."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np

from shaftprint.campaign._campaign import Campaign
from shaftprint.errors import RecordingError
from shaftprint.notebook._shown import Shown
from shaftprint.records import noun_of
from shaftprint.tug._pitch_actuation import pitch_truth
from shaftprint.tug._sailing import sailing_truth, way_of
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._demand import demand_limits
from shaftprint.tug.plant._physics import build_plant, shaft_time_constant_s, working_point, working_point_rack
from shaftprint.tug.sensors._faults import Fault
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel._sensors import RackSensor
from shaftprint.vessel._vessel import Vessel

_PITCH = ("rate_per_s", "deadband", "play", "sensor_rms", "sensor_wander_rms")

SCHEMA = 1
"""Version of the truth file."""


@dataclass(frozen=True, kw_only=True, slots=True)
class StripTruth:
    """True strips of one pick-up."""

    channel: str
    """Name of the channel."""
    angle_deg: tuple[float, ...]
    """Angle from each strip to the next [degree], from strip 1 on; they sum to 360."""
    start_deg: float
    """Angle of the shaft at the start, from the marked edge of strip 1 [degree]."""


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class Truth(Shown):
    """Everything that was put into a simulated recording."""

    vessel: str
    """Name of the vessel."""
    campaign: str
    """Name of the campaign."""
    seed: int
    """Seed of all randomness."""
    duration_s: float
    """Length of the recording [s]."""
    rate_hz: float
    """Sample rate of every channel [Hz]."""
    normalised: Mapping[str, float]
    """Parameters normalised at the working point: ``tau_up``, ``tau_dn``, ``tau_t`` [s]; ``tau_w`` [s], the part of
    ``tau_dn`` that is water beyond the vessel's; with an electric machine on the gearbox its ``s_m`` and ``c_m``;
    with an elastic coupling ``k_c`` [1/s], ``d_c`` and ``tau_m`` [s]; ``k_q``; with a controllable pitch ``q``,
    ``tau_th`` [s], ``t_th`` [s], ``c_th`` and ``c_pitch``; ``kappa``, ``tau_i`` [s] of the dynamic inflow; ``g``,
    ``v``, ``X_0``; ``K_p``, ``K_i`` [1/s], ``t_d`` [s], ``omega_n`` [rad/s], ``zeta``, of a motor ``T_m`` [s] in their
    place, ``t_sp`` [s]; and where percent torque
    was logged ``t_rack`` [s], its latency beyond the vessel's. Underway, in place of ``k_q``: ``w``, ``t``, ``J``,
    ``a``, ``b``, ``e``, ``tau_u`` [s], the speed of the ship ``v_0`` [m/s] and its resistance ``R`` [N]."""
    physical: Mapping[str, float]
    """The same in physical units, which the names carry; rack as a fraction, speeds of the engine in rev/s. With it the
    offset of the torque gauge, which acts on the recording alone."""
    engine_speed_rpm: float
    """Engine speed of the working point [rpm]."""
    shaft_torque_nm: float
    """Driving shaft torque of the working point [N m], above 0 astern too."""
    set_point_slope_rpm_per_v: float
    """Slope of the true set-point line [rpm/V]."""
    set_point_intercept_rpm: float
    """Intercept of the true set-point line [rpm]."""
    set_point_offset_v: float
    """What the potentiometer adds to the voltage of the campaign [V]."""
    strips: tuple[StripTruth, ...]
    """Strips of every pick-up."""
    faults: tuple[Fault, ...]
    """Faults of the recording in the order of time."""
    limited: Mapping[str, float]
    """Share of the time for which a limit of torque or rack acted, by excitation."""
    noise: Mapping[str, float]
    """Sizes of the noise."""


def normalised_truth(tug: Tug, vessel: Vessel) -> dict[str, float]:
    """Return the parameters normalised at the working point, by the names of the thesis' symbols."""
    plant = build_plant(tug, vessel)
    upstream = shaft_time_constant_s(plant.inertia_upstream_kg_m2, tug, vessel)
    downstream = shaft_time_constant_s(plant.inertia_downstream_kg_m2, tug, vessel)
    sensor = vessel.sensors.rack
    late = {} if sensor is None else {"t_rack": rack_latency_s(tug, sensor) - sensor.latency_s}
    return {
        "tau_up": upstream,
        "tau_dn": downstream,
        "tau_t": upstream + downstream,
        "tau_w": shaft_time_constant_s(tug.entrained_water_kg_m2, tug, vessel),
        **_coupling_truth(tug, vessel),
        **_machine_truth(tug),
        **_load_truth(tug, vessel),
        "kappa": tug.inflow_gain,
        "tau_i": tug.inflow_time_s,
        "g": tug.g,
        "v": tug.v,
        "X_0": working_point_rack(tug, vessel),
        "K_p": tug.proportional_gain,
        "K_i": tug.integral_gain_per_s,
        "t_d": tug.governor_delay_s,
        **_actuation_truth(tug, vessel),
        "t_sp": tug.set_point_latency_s,
    } | late


def _coupling_truth(tug: Tug, vessel: Vessel) -> dict[str, float]:
    """Return stiffness and damping of an elastic coupling over the torque, and the inertia time behind it."""
    if tug.coupling is None:
        return {}
    # stiffness and damping are normalised as an inertia is: the torque of the working point over its speed
    scale = shaft_time_constant_s(1.0, tug, vessel)
    return {
        "k_c": scale * tug.coupling.stiffness_nm_rad,
        "d_c": scale * tug.coupling.damping_nm_s_rad,
        "tau_m": scale * tug.coupling.driven_kg_m2,
    }


def _machine_truth(tug: Tug) -> dict[str, float]:
    """Return what of the torque an electric machine gives, and its torque over that which its channel shows."""
    machine = tug.shaft_machine
    return {} if machine is None else {"s_m": machine.share, "c_m": 1.0 / machine.shown}


def _actuation_truth(tug: Tug, vessel: Vessel) -> dict[str, float]:
    """Return how the torque follows what is asked for: the fuel of an engine, the current of a motor."""
    if vessel.motor is None:
        return {"omega_n": tug.natural_frequency_rad_s, "zeta": tug.damping_ratio}
    return {"T_m": tug.torque_time_s}


def _load_truth(tug: Tug, vessel: Vessel) -> dict[str, float]:
    """Return what the torque of the propeller follows: the square of the speed, or the ship."""
    if tug.sailing is None:
        return {"k_q": 2.0} | ({} if tug.pitch is None else pitch_truth(tug.pitch, vessel))
    speed, _ = working_point(tug, vessel)
    return sailing_truth(tug.sailing, way_of(tug.sailing, vessel), speed / vessel.gearbox.ratio)


def rack_latency_s(tug: Tug, sensor: RackSensor) -> float:
    """Return the time by which the percent torque is late [s]."""
    return sensor.latency_s if tug.rack_latency_s is None else tug.rack_latency_s


def physical_truth(tug: Tug, vessel: Vessel) -> dict[str, float]:
    """Return the physical constants with their units in the names."""
    plant = build_plant(tug, vessel)
    speed, _ = working_point(tug, vessel)
    rate = tug.rack_rate_limit_per_s
    limited = {} if rate is None else {"rack_rate_limit_per_s": rate}
    pitch = {} if tug.pitch is None else {f"pitch_{k}": getattr(tug.pitch, k) for k in _PITCH}
    coupling = {} if tug.coupling is None else {f"coupling_{name}": x for name, x in asdict(tug.coupling).items()}
    return {
        "inertia_upstream_kg_m2": plant.inertia_upstream_kg_m2,
        "inertia_downstream_kg_m2": plant.inertia_downstream_kg_m2,
        "entrained_water_kg_m2": tug.entrained_water_kg_m2,
        "propeller_nm_per_rev_s_squared": plant.propeller_nm_s2,
        "map_speed_slope_nm_per_rev_s": plant.speed_slope_nm_s,
        "map_rack_slope_nm": plant.rack_slope_nm,
        "map_offset_nm": plant.rack_offset_nm,
        "governor_proportional_per_rev_s": plant.proportional_s,
        "governor_integral_per_rev": plant.integral,
        "anti_windup_s": plant.anti_windup_s,
        "motoring_torque_nm": float(np.interp(speed, plant.motoring_speed_rev_s, plant.motoring_torque_nm)),
        "deadband_rev_s": plant.deadband_rev_s,
        "unboosted_torque_share": plant.air_share,
        "turbocharger_lag_s": plant.turbocharger_lag_s,
        "gear_ratio": plant.gear_ratio,
        "transmission_efficiency": plant.efficiency,
        "torque_zero_offset_nm": tug.torque_zero_offset_nm,
        **limited,
        **coupling,
        **pitch,
        **_of_speed_and_generator(tug),
        **demand_limits(tug, vessel).stated,
    }


def _of_speed_and_generator(tug: Tug) -> dict[str, float]:
    """Return how gains and delay go with the speed, what generator and lever make of the voltage, where they do."""
    names = (
        "governor_gain_exponent", "governor_delay_exponent", "generator_step_v", "generator_cycle_s",
        "set_point_bend_per_v", "set_point_hysteresis_v",
    )  # fmt: skip
    return {name: value for name in names if (value := getattr(tug, name))}


def tell_truth(
    tug: Tug,
    vessel: Vessel,
    campaign: Campaign,
    *,
    seed: int,
    rate_hz: float,
    strips: tuple[StripTruth, ...],
    faults: tuple[Fault, ...],
    limited: Mapping[str, float],
) -> Truth:
    """Gather the truth of one voyage."""
    speed, torque = working_point(tug, vessel)
    return Truth(
        vessel=vessel.name,
        campaign=campaign.name,
        seed=seed,
        duration_s=campaign.duration_s,
        rate_hz=rate_hz,
        normalised=normalised_truth(tug, vessel),
        physical=physical_truth(tug, vessel),
        engine_speed_rpm=rpm_from_rev_s(speed),
        shaft_torque_nm=torque,
        set_point_slope_rpm_per_v=tug.set_point_slope_rpm_per_v,
        set_point_intercept_rpm=tug.set_point_intercept_rpm,
        set_point_offset_v=tug.set_point_offset_v,
        strips=strips,
        faults=tuple(sorted(faults, key=lambda fault: (fault.time_s, fault.channel))),
        limited=limited,
        noise=asdict(tug.noise),
    )


def truth_path(recording: str | Path) -> Path:
    """Return where the truth of a recording lies: ``NAME.truth.json`` beside it."""
    return Path(recording).with_suffix(".truth.json")


def truth_text(truth: Shown) -> str:
    """Return a truth, of one line or of both, as the text of its file."""
    return json.dumps({"schema": SCHEMA} | asdict(cast("Any", truth)), indent=1, allow_nan=False) + "\n"


def read_truth(path: str | Path) -> Truth:
    """Read a truth file, for comparisons with an estimate; nothing that estimates may do so.

    Parameters
    ----------
    path
        The truth file.

    Raises
    ------
    RecordingError
        If there is no such file or it is not a truth file of this version.
    """
    try:
        content = json.loads(Path(path).read_text(encoding="utf-8"))
        schema = content.pop("schema")
        if schema != SCHEMA:
            raise RecordingError(f"{path}: expected truth of schema {SCHEMA}, found {schema}; simulate it again.")
        return noun_of(Truth, content, named="truth")
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise RecordingError(f"{path}: expected a truth file written beside a recording, found {error!r}.") from None
