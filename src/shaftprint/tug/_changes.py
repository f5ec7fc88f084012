"""What changes on a ship, one law each: wear, other settings, other water, another day."""

from dataclasses import replace

import numpy as np

from shaftprint.tug._noise import Noise
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._physics import working_point
from shaftprint.vessel._vessel import Vessel

# From test to test: the torque of the propeller as a share, the zero of the gauge [N m], the set point [V: 5 rpm].
LOAD_REPEATABILITY, ZERO_STD_NM, SET_POINT_STD_V = 0.005, 60.0, 0.02
SEA_WATER_15_KG_M3, DENSITY_PER_C = 1025.9, -2.1e-4
TORQUE_PER_M = 0.02
"""Torque of a propeller at bollard pull by draught [1/m]: two per cent a metre."""


def with_injection(tug: Tug, factor: float) -> Tug:
    """Return a ship whose rack gives so many times the torque: the governor, unchanged, moves the rack as it did."""
    return with_gains(tug, proportional=factor, integral=factor)


def with_gains(tug: Tug, *, proportional: float = 1.0, integral: float = 1.0) -> Tug:
    """Return a ship whose governor has so many times its gains."""
    return replace(
        tug,
        proportional_gain=proportional * tug.proportional_gain,
        integral_gain_per_s=integral * tug.integral_gain_per_s,
    )


def with_delay(tug: Tug, added_s: float) -> Tug:
    """Return a ship whose fuel comes later by a time [s]."""
    return replace(tug, governor_delay_s=tug.governor_delay_s + added_s)


def with_load(tug: Tug, factor: float, vessel: Vessel) -> Tug:
    """Return a ship whose propeller takes so many times the torque at the same speed.

    Gains are normalised with that torque: the governor stays as it is.
    """
    _, torque_nm = working_point(tug, vessel)
    return replace(
        tug,
        shaft_torque_nm=factor * torque_nm,
        proportional_gain=tug.proportional_gain / factor,
        integral_gain_per_s=tug.integral_gain_per_s / factor,
    )


def with_inertia(tug: Tug, factor: float, vessel: Vessel) -> Tug:
    """Return a ship with so many times the inertia behind its gauge, entrained water included."""
    there = vessel.inertia_downstream_kg_m2 if tug.inertia_downstream_kg_m2 is None else tug.inertia_downstream_kg_m2
    added = (factor - 1.0) * (there + tug.entrained_water_kg_m2)
    return replace(tug, inertia_downstream_kg_m2=there + added)


def in_water(tug: Tug, vessel: Vessel, *, density_kg_m3: float, deeper_m: float = 0.0) -> Tug:
    """Return a ship in other water than that of its vessel file, or at another draught."""
    factor = density_kg_m3 / vessel.water_density_kg_m3 * (1.0 + TORQUE_PER_M * deeper_m)
    return with_load(tug, factor, vessel)


def sea_water_kg_m3(temperature_c: float) -> float:
    """Return the density of sea water [kg/m3] between 5 and 25 degrees Celsius, a straight line through EOS-80."""
    return SEA_WATER_15_KG_M3 * (1.0 + DENSITY_PER_C * (temperature_c - 15.0))


def on_another_day(tug: Tug, vessel: Vessel, rng: np.random.Generator) -> Tug:
    """Return a ship on another day: other waves, another zero of the gauge, the helm not quite where it was.

    ``tug``, ``vessel``: the ship. ``rng``: draws the day.
    """
    noise = Noise()
    tug = with_load(tug, 1.0 + rng.normal(0.0, LOAD_REPEATABILITY), vessel)
    return replace(
        tug,
        noise=replace(
            noise,
            inflow_rms=noise.inflow_rms * rng.uniform(0.7, 1.5),
            surge_rms=noise.surge_rms * rng.uniform(0.5, 3.0),
            combustion_rms=noise.combustion_rms * rng.uniform(0.8, 1.2),
            hunting_rms=noise.hunting_rms * rng.uniform(0.7, 1.3),
        ),
        torque_zero_offset_nm=float(rng.normal(0.0, ZERO_STD_NM)),
        set_point_offset_v=tug.set_point_offset_v + float(rng.normal(0.0, SET_POINT_STD_V)),
    )
