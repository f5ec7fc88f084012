"""Is an inertia that stands in a vessel file that of another shaft? It is off by the square of the gear ratio then."""

import math
from collections.abc import Iterator

from shaftprint.card._card import Card
from shaftprint.card._derived import engine_inertia, propeller_inertia, water_inertia
from shaftprint.card._disagreement import Disagreement
from shaftprint.card._series import is_in_nozzle
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
    if vessel.engine is None or 1.0 / _LEAST_SQUARE < square < _LEAST_SQUARE or not 0.0 < square < math.inf:
        return
    card = _card(vessel)
    usual_engine = engine_inertia(card).value
    usual_propeller = propeller_inertia(card).value + water_inertia(card).value
    sides = (
        ("engine", "upstream", "engine", usual_engine),
        ("propeller", "upstream", "engine", square * usual_engine),
        ("propeller", "downstream", "propeller", usual_propeller),
    )
    for shaft, gauge, of, usual in sides:
        rows = [row for row in vessel.inertia if row.gauge == gauge]
        stated = sum(row.inertia_kg_m2 for row in rows if row.shaft == shaft)
        at_shaft = square if shaft == "engine" else 1.0
        if stated < _MOST * sum(row.referred_kg_m2(vessel.gearbox.ratio) for row in rows) / at_shaft:
            continue
        other = "propeller" if shaft == "engine" else "engine"
        for factor, sign in ((square, "·"), (1.0 / square, "/")):
            # written so that what is beyond all numbers is near nothing
            if not abs(stated - usual * factor) <= _NEAR * usual * factor < math.inf or not stated > 0.0:
                continue
            name = f' and shaft = "{other}"' if gauge == "upstream" else ""
            yield Disagreement(
                field="inertia",
                expected=f"about {usual:.4g} kg m2 {gauge} at the {shaft} shaft, as is usual for {_of(of, vessel)}",
                found=f"{stated:.4g}, which is {stated / factor:.4g} {sign} {vessel.gearbox.ratio:g}²",
                advice=f"is it referred to the {other} shaft? Then state {stated / factor:.4g}"
                + (f", or {stated:.4g}{name}" if name else ""),
                is_contradiction=False,
            )


def _of(part: str, vessel: Vessel) -> str:
    if part == "propeller":
        return f"a propeller of {vessel.propeller.diameter_m:g} m"
    return f"{vessel.machine.rated_power_kw:g} kW at {vessel.machine.rated_speed_rpm:g} rpm"


def _card(vessel: Vessel) -> Card:
    """Return what the estimates need of a ship."""
    propeller, machine = vessel.propeller, vessel.machine
    return Card(
        rated_power_kw=machine.rated_power_kw,
        rated_speed_rpm=machine.rated_speed_rpm,
        cylinders=1,
        diameter_m=propeller.diameter_m,
        blades=propeller.blades,
        pitch_ratio=propeller.pitch_ratio,
        area_ratio=propeller.area_ratio,
        in_nozzle=is_in_nozzle(propeller.series),
        water_density_kg_m3=vessel.water_density_kg_m3,
    )
