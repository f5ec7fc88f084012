"""Is an inertia that stands in a vessel file that of another shaft? It is off by the square of the gear ratio then."""

import math
from collections.abc import Iterator

from shaftprint.card._disagreement import Disagreement
from shaftprint.card._series import usual_area_ratio
from shaftprint.card._usual_inertia import engine_inertia_kg_m2, propeller_inertia_kg_m2, water_inertia_kg_m2
from shaftprint.vessel._vessel import Vessel

# By this share the estimate may be off once the square is taken out; a square below four may be its deviation.
_NEAR, _LEAST_SQUARE = 0.3, 4.0
# What is held against an estimate is most of what lies on its side of the gauge.
_MOST = 0.5


def referred_inertia(vessel: Vessel) -> Iterator[Disagreement]:
    """Hold the inertias of engine and propeller against those that are usual for their power and diameter.

    One is told only where the square of the ratio explains it and nothing less does.
    """
    square = vessel.gearbox.ratio**2
    if vessel.motor is not None or 1.0 / _LEAST_SQUARE < square < _LEAST_SQUARE or not 0.0 < square < math.inf:
        return
    machine, propeller = vessel.machine, vessel.propeller
    usual_engine = engine_inertia_kg_m2(rated_power_kw=machine.rated_power_kw, rated_speed_rpm=machine.rated_speed_rpm)
    area_ratio = usual_area_ratio(propeller.area_ratio, propeller.series)
    usual_propeller = propeller_inertia_kg_m2(diameter_m=propeller.diameter_m, area_ratio=area_ratio)
    usual_propeller += water_inertia_kg_m2(
        diameter_m=propeller.diameter_m,
        area_ratio=area_ratio,
        pitch_ratio=propeller.pitch_ratio,
        blades=propeller.blades,
        water_density_kg_m3=vessel.water_density_kg_m3,
    )
    # what a value of the other shaft is over that of its own
    sides = (
        ("engine", "upstream", "engine", usual_engine, square),
        ("propeller", "upstream", "engine", square * usual_engine, 1.0 / square),
        ("propeller", "downstream", "propeller", usual_propeller, 1.0 / square),
    )
    for shaft, gauge, of, usual, factor in sides:
        rows = [row for row in vessel.inertia if row.gauge == gauge]
        stated = sum(row.inertia_kg_m2 for row in rows if row.shaft == shaft)
        at_shaft = square if shaft == "engine" else 1.0
        if stated < _MOST * sum(row.referred_kg_m2(vessel.gearbox.ratio) for row in rows) / at_shaft:
            continue
        # written so that what is beyond all numbers is near nothing
        if not abs(stated - usual * factor) <= _NEAR * usual * factor < math.inf or not stated > 0.0:
            continue
        other, sign = ("propeller", "·") if shaft == "engine" else ("engine", "/")
        yield Disagreement(
            field="inertia",
            expected=f"about {usual:.4g} kg m2 {gauge} at the {shaft} shaft, as is usual for {_of(of, vessel)}",
            found=f"{stated:.4g}, which is {stated / factor:.4g} {sign} {vessel.gearbox.ratio:g}²",
            advice=f"is it referred to the {other} shaft? Then state {stated / factor:.4g}"
            + (f', or {stated:.4g} and shaft = "{other}"' if gauge == "upstream" else ""),
            is_contradiction=False,
        )


def _of(part: str, vessel: Vessel) -> str:
    if part == "propeller":
        return f"a propeller of {vessel.propeller.diameter_m:g} m"
    return f"{vessel.machine.rated_power_kw:g} kW at {vessel.machine.rated_speed_rpm:g} rpm"
