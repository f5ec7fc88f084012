"""A ship that goes from ahead to astern by its clutches, with what its vessel file states."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from shaftprint.card._series import four_quadrant_curve
from shaftprint.catalogue._crash_stop import NOT_OF_THE_LINE, CrashStopSymbol, FourQuadrantPropeller, crash_stop
from shaftprint.errors import SettingsError
from shaftprint.models._structure import Structure
from shaftprint.normalisation import Normalisation
from shaftprint.units import rev_s_from_rpm
from shaftprint.vessel._hull import Hull
from shaftprint.vessel._vessel import Vessel


@dataclass(frozen=True, kw_only=True, slots=True)
class StatedValue:
    """A number and how well the vessel file knows it."""

    value: float
    """The number."""
    std: float = 0.0
    """Standard deviation; 0 where none is stated."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class StoppedShip:
    """Equations of a crash stop and the parameters that the vessel file states."""

    structure: Structure
    """Structure ``CRASH-STOP``."""
    stated: Mapping[str, StatedValue]
    """Line, ship, clutches and torque limits; the governor is not in a vessel file."""
    vessel: Vessel
    """The ship."""

    @property
    def of_the_line(self) -> frozenset[str]:
        """Parameters of governor, engine and shaft, which a test of the same line underway finds."""
        return frozenset(self.structure.names) - NOT_OF_THE_LINE

    @property
    def speed_m_s(self) -> float:
        """Speed from which it stops [m/s]."""
        speed = self.vessel.working_point.ship_speed_m_s
        assert speed is not None  # noqa: S101 - no such ship is stopped
        return speed


def stopped_ship(vessel: Vessel) -> StoppedShip:
    """Return the crash stop of a ship: an engine, a reversing gearbox and a propeller of fixed pitch.

    Raises
    ------
    SettingsError
        If the vessel file does not describe such a ship; the message lists every field.
    PropellerError
        If the propeller is none whose forces are known in four quadrants.
    StructureError
        If it does not pull at the working point.
    """
    _expect_all(vessel)
    point, gearbox = vessel.working_point, vessel.gearbox
    assert vessel.hull is not None and point.ship_speed_m_s is not None  # noqa: S101, PT018 - both were expected
    line = Normalisation(
        engine_speed_rev_s=rev_s_from_rpm(point.engine_speed_rpm),
        gear_ratio=gearbox.ratio,
        shaft_torque_nm=point.shaft_torque_nm,
    )
    propeller = FourQuadrantPropeller(
        curve=four_quadrant_curve(vessel.propeller),
        pitch_ratio=vessel.propeller.pitch_ratio,
        diameter_m=vessel.propeller.diameter_m,
        shaft_speed_rev_s=line.shaft_speed_rev_s,
        ship_speed_m_s=point.ship_speed_m_s,
    )
    return StoppedShip(
        structure=crash_stop(propeller, curve=vessel.machine.full_load_shape(line.engine_speed_rev_s)),
        stated=_line(vessel, line) | _limits(vessel) | _ship(vessel.hull, point.ship_speed_m_s),
        vessel=vessel,
    )


def _expect_all(vessel: Vessel) -> None:
    hull = vessel.hull
    missing = {
        "an [engine] (a motor reverses without clutches)": vessel.engine is None,
        "a fixed pitch (blades that turn stop a ship without clutches)": vessel.pitch is not None,
        "no [shaft_machine]": vessel.shaft_machine is not None,
        "working_point.ship_speed_m_s (the speed from which it stops)": not vessel.is_underway,
        "hull.wake_fraction": hull is None or hull.wake_fraction is None,
        "gearbox.astern_ratio": vessel.gearbox.astern_ratio is None,
        "gearbox.clutch_torque_nm": vessel.gearbox.clutch_torque_nm is None,
        "limits.motoring_torque_nm": vessel.motoring is None,
    }
    lacking = [words for words, lacks in missing.items() if lacks]
    if lacking:
        raise SettingsError(f"vessel {vessel.name}: a crash stop expects {', '.join(lacking)}.")


def _line(vessel: Vessel, line: Normalisation) -> dict[str, StatedValue]:
    """Return inertia times and clutches, over the torque that the vessel file states: no gauge comes in."""
    gearbox = vessel.gearbox
    assert gearbox.astern_ratio is not None and gearbox.clutch_torque_nm is not None  # noqa: S101, PT018 - expected
    inertias = {
        CrashStopSymbol.INERTIA_UPSTREAM: (vessel.inertia_upstream_kg_m2, vessel.inertia_upstream_std_kg_m2),
        CrashStopSymbol.INERTIA_DOWNSTREAM: (vessel.inertia_downstream_kg_m2, vessel.inertia_downstream_std_kg_m2),
    }
    held_nm = gearbox.clutch_torque_nm * gearbox.shaft_over_brake
    return {
        **{
            name: StatedValue(value=float(line.inertia_time_s(value)), std=float(line.inertia_time_s(std)))
            for name, (value, std) in inertias.items()
        },
        CrashStopSymbol.CLUTCH_TORQUE: StatedValue(value=held_nm / line.shaft_torque_nm),
        CrashStopSymbol.RATIO_ASTERN: StatedValue(value=gearbox.astern_ratio / gearbox.ratio),
    }


def _limits(vessel: Vessel) -> dict[str, StatedValue]:
    """Return highest and lowest torque of the engine over that of the working point."""
    point, gearbox = vessel.working_point, vessel.gearbox
    assert vessel.motoring is not None  # noqa: S101 - it was expected
    brake_nm = point.shaft_torque_nm / gearbox.shaft_over_brake
    highest = vessel.machine.full_load_nm(point.engine_speed_rpm)
    drag = float(np.interp(point.engine_speed_rpm, *vessel.motoring))
    return {
        CrashStopSymbol.TORQUE_LIMIT: StatedValue(value=highest / brake_nm),
        CrashStopSymbol.MOTORING_LIMIT: StatedValue(value=-drag / brake_nm),
    }


def _ship(hull: Hull, speed_m_s: float) -> dict[str, StatedValue]:
    """Return wake, exponent of the resistance, and ``tau_u = m v / R``."""
    assert hull.wake_fraction is not None  # noqa: S101 - it was expected
    time_s, time_std_s = hull.surge_time_s(speed_m_s)
    return {
        CrashStopSymbol.WAKE_FRACTION: StatedValue(value=hull.wake_fraction, std=hull.wake_fraction_std or 0.0),
        CrashStopSymbol.RESISTANCE_EXPONENT: StatedValue(value=hull.resistance_exponent),
        CrashStopSymbol.SHIP_TIME: StatedValue(value=time_s, std=time_std_s),
    }
