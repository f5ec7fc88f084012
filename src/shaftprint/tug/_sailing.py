"""The truth of a tug that sails free: its propellers, the water around them, and the ship that they push."""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import SettingsError
from shaftprint.vessel._hull import Hull
from shaftprint.vessel._vessel import Vessel

# Ka4-70 in nozzle 19A at P/D 1.11 (M.W.C. Oosterveld, Wake adapted ducted propellers, 1970): its polynomials in powers
# of P/D and J, gathered by hand to powers of J at this one pitch. The tests hold them against the room of propellers.
THRUST_POWERS = (0.6172142, -0.6612127, 0.3512421, -0.3911370)
TORQUE_POWERS = (0.0560555, -0.0006303, -0.0349506, 0.0, -0.0072440)

# Change of those powers for a change of P/D about 1.11: first and second order of the Taylor series.
THRUST_PITCH_POWERS = ((0.8444796, -0.6073492, 0.6328687, 0.0), (0.0931354, -0.3935522, 0.285076, 0.0))
TORQUE_PITCH_POWERS = (
    (0.1144793, -0.0034072, -0.0037785, 0.0, 0.0),
    (0.0613468, -0.0076738, 0.0247989, 0.0, 0.0),
)
CURVES_PITCH_RATIO = 1.11
CURVES_SERIES = "Ka4-70 in nozzle 19A"

# Wageningen B4-70 at P/D 0.9 (M.W.C. Oosterveld and P. van Oossanen, Further computer-analyzed data of the Wageningen
# B-screw series, 1975), gathered alike.
OPEN_THRUST_POWERS = (0.4053922, -0.2741408, -0.2332849, 0.0816130)
OPEN_TORQUE_POWERS = (0.0548038, -0.0314026, -0.0287601, 0.0076989)
OPEN_PITCH_RATIO = 0.90
OPEN_SERIES = "Wageningen B4-70"

_BISECTIONS = 200


@dataclass(frozen=True, kw_only=True, slots=True)
class Sailing:
    """Truth of a ship that sails free; both shafts follow the same set point, and one of them is logged.

    Mass, number of shafts and resistance are those of the vessel file unless they are given here.
    """

    wake_fraction: float = 0.20
    """``w``: the propellers see ``v (1 - w)``."""
    thrust_deduction: float = 0.15
    """``t``: of the thrust ``T (1 - t)`` pulls the ship."""
    thrust_powers: tuple[float, ...] = THRUST_POWERS
    """``K_T`` of propeller and nozzle: coefficients of ``J^0, J^1, ...``."""
    torque_powers: tuple[float, ...] = TORQUE_POWERS
    """``K_Q``: coefficients of ``J^0, J^1, ...``; scaled so that the vessel's effective ``K_Q`` holds at ``J = 0``."""
    thrust_pitch_powers: tuple[tuple[float, ...], ...] = THRUST_PITCH_POWERS
    """First and second order of ``K_T`` in the deviation of ``P/D``: coefficients of ``J^0, J^1, ...`` of each."""
    torque_pitch_powers: tuple[tuple[float, ...], ...] = TORQUE_PITCH_POWERS
    """The same of ``K_Q``."""
    pitch_ratio: float = CURVES_PITCH_RATIO
    """``P/D`` to which the curves belong."""
    pitch_lag_s: float = 1.0
    """Lag of the pitch actuator [s], where the vessel has a controllable pitch."""
    surging_mass_kg: float | None = None
    """Mass of the ship with the water that surges along [kg]; ``None``: the vessel's."""
    resistance_factor: float = 1.0
    """True resistance over that of the vessel file."""
    resistance_exponent: float | None = None
    """``e`` of ``R = c v^e``; ``None``: the vessel's."""
    log_rms_m_s: float = 0.02
    """Noise of a value of the log, where the vessel has one: rms [m/s]."""
    log_scale: float = 1.0
    """What the log shows over the speed through the water."""


class Way(NamedTuple):
    """Constants of the free-sailing ship; a named tuple because compiled code takes it as it is."""

    torque_nm_s2: FloatArray
    """``M_p / n_s^2`` of one shaft over ``J``: coefficients of its powers [N m s2]."""
    pull_n_s2: FloatArray
    """``k_p (1 - t) T / n_s^2`` over ``J``: coefficients of its powers [N s2]."""
    torque_pitch_nm_s2: FloatArray
    """Change of ``M_p / n_s^2`` with ``P/D``, first and second order, shape (2, powers) [N m s2]."""
    pull_pitch_n_s2: FloatArray
    """Change of the pull over ``n_s^2`` with ``P/D``, first and second order, shape (2, powers) [N s2]."""
    advance_per_m: float
    """``(1 - w) / D`` [1/m]: ``J = v (1 - w) / (n_s D)``."""
    mass_kg: float
    """Ship with the water that surges along [kg]."""
    resistance_at_1_m_s: float
    """``c`` of ``R = c v^e`` [N]."""
    resistance_exponent: float


AT_THE_QUAY = Way(
    torque_nm_s2=np.zeros(1),
    pull_n_s2=np.zeros(1),
    torque_pitch_nm_s2=np.zeros((2, 1)),
    pull_pitch_n_s2=np.zeros((2, 1)),
    advance_per_m=0.0,
    mass_kg=1.0,
    resistance_at_1_m_s=0.0,
    resistance_exponent=1.0,
)
"""No way on the ship: nothing of it is used."""


def way_of(sailing: Sailing, vessel: Vessel) -> Way:
    """Convert the truth of a free-sailing ship to physical constants.

    Raises SettingsError if the vessel file has no hull or the truth is not physical.
    """
    hull = _hull(vessel)
    _check(sailing)
    exponent = hull.resistance_exponent if sailing.resistance_exponent is None else sailing.resistance_exponent
    resistance = sailing.resistance_factor * hull.resistance_n / hull.resistance_speed_m_s**exponent
    diameter = vessel.propeller.diameter_m
    force = vessel.water_density_kg_m3 * diameter**4
    factor = vessel.propeller.torque_coefficient / (
        vessel.propeller.relative_rotative_efficiency * sailing.torque_powers[0]
    )
    pull = hull.shafts * (1.0 - sailing.thrust_deduction) * force
    return Way(
        torque_nm_s2=factor * force * diameter * np.array(sailing.torque_powers),
        pull_n_s2=pull * np.array(sailing.thrust_powers),
        torque_pitch_nm_s2=factor * force * diameter * np.array(sailing.torque_pitch_powers),
        pull_pitch_n_s2=pull * np.array(sailing.thrust_pitch_powers),
        advance_per_m=(1.0 - sailing.wake_fraction) / diameter,
        mass_kg=hull.surging_mass_kg if sailing.surging_mass_kg is None else sailing.surging_mass_kg,
        resistance_at_1_m_s=resistance,
        resistance_exponent=exponent,
    )


def with_propeller_of(sailing: Sailing, vessel: Vessel) -> Sailing:
    """Return a free-sailing ship with the curves of the vessel's propeller.

    Raises SettingsError if it is none of those whose curves are known here.
    """
    propeller = vessel.propeller
    known = {CURVES_SERIES: CURVES_PITCH_RATIO, OPEN_SERIES: OPEN_PITCH_RATIO}
    series = propeller.series or "no series"
    if not math.isclose(propeller.pitch_ratio, known.get(series, math.nan)):
        names = " or ".join(f"{name} with a pitch ratio of {pitch:g}" for name, pitch in known.items())
        raise SettingsError(
            f"vessel {vessel.name}: expected a propeller {names}, of which the simulated ship has curves, found "
            f"{series} with {propeller.pitch_ratio:g}; leave out working_point.ship_speed_m_s to sail at the quay."
        )
    if series == CURVES_SERIES:
        return sailing
    if vessel.pitch is not None or vessel.sensors.pitch_set_point is not None:
        raise SettingsError(
            f"vessel {vessel.name}: expected a fixed pitch underway, found one that is moved; the simulated ship has "
            f"the curves of {series} at one pitch."
        )
    still = ((0.0,) * len(OPEN_THRUST_POWERS),) * 2
    return replace(
        sailing,
        thrust_powers=OPEN_THRUST_POWERS,
        torque_powers=OPEN_TORQUE_POWERS,
        thrust_pitch_powers=still,
        torque_pitch_powers=still,
        pitch_ratio=OPEN_PITCH_RATIO,
    )


def steady_ship_speed_m_s(way: Way, shaft_speed_rev_s: float) -> float:
    """Return the speed of the ship [m/s] at which the resistance takes all the pull of a shaft speed [rev/s]."""
    lowest, highest = 0.0, 2.0 * shaft_speed_rev_s / way.advance_per_m
    for _ in range(_BISECTIONS):
        middle = 0.5 * (lowest + highest)
        pull = shaft_speed_rev_s**2 * _power_sum(way.pull_n_s2, way.advance_per_m * middle / shaft_speed_rev_s)
        if pull > way.resistance_at_1_m_s * middle**way.resistance_exponent:
            lowest = middle
        else:
            highest = middle
    return 0.5 * (lowest + highest)


def steady_torque_nm(way: Way, shaft_speed_rev_s: float) -> float:
    """Return the torque of one propeller [N m] in steady running at a shaft speed [rev/s]."""
    advance = way.advance_per_m * steady_ship_speed_m_s(way, shaft_speed_rev_s) / shaft_speed_rev_s
    return shaft_speed_rev_s**2 * _power_sum(way.torque_nm_s2, advance)


def sailing_truth(sailing: Sailing, way: Way, shaft_speed_rev_s: float) -> dict[str, float]:
    """Return what a test underway is to find, by the names of the symbols, at a shaft speed [rev/s]."""
    speed = steady_ship_speed_m_s(way, shaft_speed_rev_s)
    advance = way.advance_per_m * speed / shaft_speed_rev_s
    resistance = way.resistance_at_1_m_s * speed**way.resistance_exponent
    return {
        "w": sailing.wake_fraction,
        "t": sailing.thrust_deduction,
        "J": advance,
        "v_0": speed,
        "R": resistance,
        "a": _log_slope(way.pull_n_s2, advance),
        "b": _log_slope(way.torque_nm_s2, advance),
        "e": way.resistance_exponent,
        "tau_u": way.mass_kg * speed / resistance,
        "p": sailing.pitch_ratio * _power_sum(way.pull_pitch_n_s2[0], advance) / _power_sum(way.pull_n_s2, advance),
        "q": sailing.pitch_ratio
        * _power_sum(way.torque_pitch_nm_s2[0], advance)
        / _power_sum(way.torque_nm_s2, advance),
        "tau_th": sailing.pitch_lag_s,
    }


def _log_slope(powers: FloatArray, at: float) -> float:
    """Return ``d ln P / d ln x`` of a sum of powers."""
    return _power_sum(np.arange(powers.size) * powers, at) / _power_sum(powers, at)


def _power_sum(powers: FloatArray, at: float) -> float:
    return math.fsum(c * at**k for k, c in enumerate(powers.tolist()))


def _hull(vessel: Vessel) -> Hull:
    if vessel.hull is None:
        raise SettingsError(
            f"vessel {vessel.name}: expected a table [hull] for a tug that sails free, found none; add mass and "
            "resistance."
        )
    return vessel.hull


def _check(sailing: Sailing) -> None:
    for name in ("wake_fraction", "thrust_deduction"):
        value = getattr(sailing, name)
        if not -0.5 < value < 1.0:
            raise SettingsError(f"tug: expected {name} between -0.5 and 1, found {value:g}; give a fraction.")
    for name in ("surging_mass_kg", "resistance_factor", "resistance_exponent", "pitch_lag_s"):
        value = getattr(sailing, name)
        if value is not None and not value > 0.0:
            raise SettingsError(f"tug: expected {name} above 0, found {value:g}; give a positive value.")
    for name in ("thrust_powers", "torque_powers"):
        powers = getattr(sailing, name)
        if not powers or not powers[0] > 0.0:
            raise SettingsError(f"tug: expected {name} to begin with a value above 0 for J = 0, found {powers}.")
