"""Numbers that a card does not have, derived from those that it has or taken as usual, each with its origin.

What is usual is that of the Stan Tug 1205, whose shipped file says where it is from, unless it says so here.
"""

import math
from dataclasses import dataclass

from shaftprint.card._card import Card
from shaftprint.card._series import series_torque
from shaftprint.card._usual_inertia import engine_inertia_kg_m2, propeller_inertia_kg_m2, water_inertia_kg_m2
from shaftprint.errors import SettingsError
from shaftprint.units import rev_s_from_rpm

EFFICIENCY = 0.97
# Torque over rated torque at speed over rated speed of a turbocharged high-speed engine (D8 MH data sheet).
_FULL_LOAD = (
    (0.273, 0.515),
    (0.364, 0.659),
    (0.455, 0.885),
    (0.545, 1.089),
    (0.682, 1.130),
    (0.818, 1.130),
    (0.909, 1.099),
    (0.955, 1.047),
    (1.0, 1.0),
)
_IDLE_SHARE, _WORKING_SHARE = 1.0 / 3.0, 2.0 / 3.0
# Torque without fuel over rated torque, at a third of rated speed and at rated speed.
_MOTORING_SHARES = (0.19, 0.32)
# Of the usual inertias of engine, blades and water.
_ENERGY_STD, _BLADE_INERTIA_STD = 0.5, 0.4
_WATER_STD = 0.3
_FULL_SCALE_SHARE = 1.5
# Of a torque by a propeller series at zero advance, and by the propeller law through rated power.
_SERIES_STD, _LAW_STD = 0.15, 0.25


@dataclass(frozen=True, kw_only=True, slots=True)
class Derived:
    """A number with where it is from."""

    value: float
    """The number, in the unit of its key."""
    origin: str
    """Where it is from and how uncertain it is, in words; empty where it stands on the card."""
    std: float | None = None
    """Standard deviation, where the file has a key for it."""


def gear_ratio(card: Card) -> Derived:
    """Return engine speed over propeller speed.

    Raises SettingsError if the card has neither the ratio nor the speed of the propeller.
    """
    if card.gear_ratio is not None:
        return Derived(value=card.gear_ratio, origin="")
    if card.propeller_rated_rpm is None:
        raise SettingsError(
            f"card of {card.name}: expected the gear ratio or the speed of the propeller at rated engine speed, found "
            "neither; state one of them."
        )
    return Derived(
        value=card.rated_speed_rpm / card.propeller_rated_rpm,
        origin=f"{card.rated_speed_rpm:g} over {card.propeller_rated_rpm:g} rpm, +/- 0.5 % of rounding",
    )


def rated_torque_nm(card: Card) -> float:
    """Return the brake torque at rated power [N m], ``P / (2 pi n)``."""
    return 1000.0 * card.rated_power_kw / (2.0 * math.pi * rev_s_from_rpm(card.rated_speed_rpm))


def idle_speed(card: Card) -> Derived:
    """Return the idle speed [rpm]."""
    if card.idle_speed_rpm is not None:
        return Derived(value=card.idle_speed_rpm, origin="")
    return Derived(value=_IDLE_SHARE * card.rated_speed_rpm, origin="usual: a third of rated speed, +/- 20 %")


def working_speed(card: Card) -> Derived:
    """Return the engine speed of the test [rpm]."""
    if card.engine_speed_rpm is not None:
        return Derived(value=card.engine_speed_rpm, origin="")
    return Derived(
        value=_WORKING_SHARE * card.rated_speed_rpm,
        origin="chosen: two thirds of rated speed; state the speed of your test",
    )


def working_torque(card: Card) -> Derived:
    """Return the shaft torque at the speed of the test [N m].

    At bollard pull it is that of the propeller series at zero advance, ``rho n^2 D^5 K_Q``; underway, and where the
    series was not tested, that of the propeller law through rated power, ``M_rated i eta (n / n_rated)^2``.
    """
    if card.shaft_torque_nm is not None:
        return Derived(value=card.shaft_torque_nm, origin="measured, as stated")
    speed_rpm, ratio = working_speed(card).value, gear_ratio(card).value
    series = series_torque(
        series=card.series, blades=card.blades, area_ratio=card.usual_area_ratio, pitch_ratio=card.pitch_ratio
    )
    if card.is_underway or series is None:
        share = (speed_rpm / card.rated_speed_rpm) ** 2
        return _within(
            rated_torque_nm(card) * ratio * EFFICIENCY * share, _LAW_STD, "propeller law through rated power"
        )
    return _within(
        series.torque_coefficient * _force_m(card, speed_rpm, ratio), _SERIES_STD, f"{series.name} at zero advance"
    )


def _within(value: float, share: float, origin: str) -> Derived:
    return Derived(value=value, origin=f"{origin}, +/- {100.0 * share:.0f} %", std=share * value)


def torque_coefficient(card: Card) -> Derived:
    """Return ``K_Q = M_s / (rho n^2 D^5)`` of the working point."""
    torque, force_m = working_torque(card), _force_m(card, working_speed(card).value, gear_ratio(card).value)
    return Derived(
        value=torque.value / force_m,
        origin="of the working point below, as uncertain as its torque",
        std=None if torque.std is None else torque.std / force_m,
    )


def full_load(card: Card) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return speeds [rpm] and torques [N m] of a usual full-load curve through rated power."""
    torque_nm = rated_torque_nm(card)
    return (
        tuple(speed * card.rated_speed_rpm for speed, _ in _FULL_LOAD),
        tuple(torque * torque_nm for _, torque in _FULL_LOAD),
    )


def motoring(card: Card) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return speeds [rpm] and torques [N m] of a usual engine without fuel."""
    low, high = (share * rated_torque_nm(card) for share in _MOTORING_SHARES)
    return (_IDLE_SHARE * card.rated_speed_rpm, card.rated_speed_rpm), (low, high)


def engine_inertia(card: Card) -> Derived:
    """Return the inertia of engine, flywheel, coupling and gears at the engine shaft [kg m2]."""
    value = engine_inertia_kg_m2(rated_power_kw=card.rated_power_kw, rated_speed_rpm=card.rated_speed_rpm)
    origin = "usual: at rated speed the energy of 0.3 s of rated power, +/- 50 %"
    return Derived(value=value, origin=origin, std=_ENERGY_STD * value)


def propeller_inertia(card: Card) -> Derived:
    """Return the inertia of the dry propeller [kg m2]."""
    value = propeller_inertia_kg_m2(diameter_m=card.diameter_m, area_ratio=card.usual_area_ratio)
    origin = "bronze blades of usual thickness, +/- 40 %"
    return Derived(value=value, origin=origin, std=_BLADE_INERTIA_STD * value)


def water_inertia(card: Card) -> Derived:
    """Return the inertia of the entrained water [kg m2]."""
    value = water_inertia_kg_m2(
        diameter_m=card.diameter_m,
        area_ratio=card.usual_area_ratio,
        pitch_ratio=card.pitch_ratio,
        blades=card.blades,
        water_density_kg_m3=card.water_density_kg_m3,
    )
    return Derived(value=value, origin="Schwanecke (1963), +/- 30 %", std=_WATER_STD * value)


def full_scale(card: Card) -> Derived:
    """Return the largest torque that the gauge passes on [N m]."""
    if card.gauge.full_scale_nm is not None:
        return Derived(value=card.gauge.full_scale_nm, origin="")
    return Derived(
        value=_FULL_SCALE_SHARE * rated_torque_nm(card) * gear_ratio(card).value * EFFICIENCY,
        origin="assumed: 1.5 times the rated torque of the shaft; see the data sheet of the telemetry",
    )


def _force_m(card: Card, speed_rpm: float, ratio: float) -> float:
    """Return ``rho n^2 D^5`` [N m]."""
    return float(card.water_density_kg_m3 * (rev_s_from_rpm(speed_rpm) / ratio) ** 2 * card.diameter_m**5)
