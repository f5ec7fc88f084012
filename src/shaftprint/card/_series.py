"""Torque coefficients by the propeller series, where a card or a vessel file names diameter, pitch and blades."""

from dataclasses import dataclass

from shaftprint.errors import PropellerError
from shaftprint.propeller._four_quadrants import FourQuadrantCurve, four_quadrants
from shaftprint.propeller._ka4_70 import ka4_70_in_19a
from shaftprint.propeller._open_water import OpenWaterCurve
from shaftprint.propeller._wageningen_b import wageningen_b
from shaftprint.vessel._machinery import Propeller

OPEN_AREA_RATIO, NOZZLE_AREA_RATIO = 0.55, 0.70
"""Blade area ratios ``A_E/A_0`` that are usual for open propellers and for those in a nozzle."""
_IN_NOZZLE = ("ka4", "ka 4", "nozzle", "19a", "duct", "kort")


@dataclass(frozen=True, kw_only=True, slots=True)
class SeriesTorque:
    """What a series gives a propeller at zero advance."""

    name: str
    """Series and type, such as ``Ka4-70 in nozzle 19A``."""
    torque_coefficient: float
    """``K_Q`` at zero advance."""


def series_torque(
    *, series: str | None, blades: int, area_ratio: float | None, pitch_ratio: float, astern: bool = False
) -> SeriesTorque | None:
    """Return ``K_Q`` at zero advance by the series that is nearest to a propeller; None where none was tested.

    ``series``: name of the series; with a nozzle in it Ka4-70 in nozzle 19A, whatever the blades, else Wageningen B.
    ``blades``, ``area_ratio``, ``pitch_ratio``: the propeller; an area ratio that is not known is that of usual open
    propellers. ``astern``: whether the shaft turns astern; open propellers alone have a series for that, and one of
    them.
    """
    try:
        if astern:
            return _astern(series, blades, area_ratio, pitch_ratio)
        curve = _curve(series, blades, area_ratio)
        return SeriesTorque(name=curve.name, torque_coefficient=curve.at(0.0, pitch_ratio).torque)
    except PropellerError:
        return None


def _astern(series: str | None, blades: int, area_ratio: float | None, pitch_ratio: float) -> SeriesTorque | None:
    if area_ratio is None or is_in_nozzle(series):
        return None
    curve = four_quadrants(blades=blades, area_ratio=area_ratio)
    return SeriesTorque(name=f"{curve.name} astern", torque_coefficient=curve.bollard(pitch_ratio, astern=True).torque)


def open_water_curve(propeller: Propeller) -> OpenWaterCurve | None:
    """Return the open-water curve of the series of a propeller; None where it has none, or none was tested.

    Unlike ``series_torque`` it does not take a series for one that is not named: slopes rest on it.
    """
    if propeller.series is None:
        return None
    try:
        curve = _curve(propeller.series, propeller.blades, propeller.area_ratio)
        curve.at(0.0, propeller.pitch_ratio)
    except PropellerError:
        return None
    return curve


def four_quadrant_curve(propeller: Propeller) -> FourQuadrantCurve:
    """Return thrust and torque of a propeller with ship and shaft each ahead or astern.

    Raises PropellerError if no such curves are known of the propeller, or of its pitch.
    """
    if propeller.series is None:
        raise PropellerError(
            "four quadrants: expected propeller.series in the vessel file, found none; which curves a propeller has is "
            'not told by its blades. Name it, such as series = "Wageningen B4-70".'
        )
    if is_in_nozzle(propeller.series):
        raise PropellerError(
            f"four quadrants: expected an open propeller, found {propeller.series}; coefficients of no propeller in a "
            "nozzle are known here."
        )
    if propeller.area_ratio is None:
        raise PropellerError("four quadrants: expected propeller.area_ratio in the vessel file, found none; state it.")
    curve = four_quadrants(blades=propeller.blades, area_ratio=propeller.area_ratio)
    if propeller.series.strip().lower() != curve.name.lower():
        raise PropellerError(
            f"four quadrants: expected a propeller {curve.name}, the only one whose coefficients are known here, found "
            f"{propeller.series}."
        )
    curve.of_pitch(propeller.pitch_ratio)
    return curve


def tested_pitch(propeller: Propeller) -> tuple[str, float, float] | None:
    """Return name, lowest and highest pitch ratio of the series of a propeller; None where none is named or tested."""
    if propeller.series is None:
        return None
    try:
        curve = _curve(propeller.series, propeller.blades, propeller.area_ratio)
    except PropellerError:
        return None
    return curve.name, curve.lowest_pitch_ratio, curve.highest_pitch_ratio


def why_untested(propeller: Propeller) -> str:
    """Return why the series that a propeller names was not tested for its blades; empty where it was, or none is named.

    The pitch is not looked at.
    """
    if propeller.series is None:
        return ""
    try:
        _curve(propeller.series, propeller.blades, propeller.area_ratio)
    except PropellerError as error:
        return str(error)
    return ""


def usual_area_ratio(area_ratio: float | None, series: str | None) -> float:
    """Return the blade area ratio as stated, or as usual with or without a nozzle by the name of the series."""
    if area_ratio is not None:
        return area_ratio
    return NOZZLE_AREA_RATIO if is_in_nozzle(series) else OPEN_AREA_RATIO


def is_in_nozzle(series: str | None) -> bool:
    """Return whether the name of a series says that the propeller turns in a nozzle."""
    return series is not None and any(word in series.lower() for word in _IN_NOZZLE)


def _curve(series: str | None, blades: int, area_ratio: float | None) -> OpenWaterCurve:
    if is_in_nozzle(series):
        return ka4_70_in_19a()
    return wageningen_b(blades=blades, area_ratio=OPEN_AREA_RATIO if area_ratio is None else area_ratio)
