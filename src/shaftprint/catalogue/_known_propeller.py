"""A free-sailing structure whose propeller is known: wake and resistance instead of slopes and time of the ship."""

from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._combination import Combination
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure
from shaftprint.propeller._open_water import OpenWaterCurve

OF_THE_SHIP = ("a", "b", "e", "tau_u")
"""Slopes of thrust, torque and resistance and the time of the ship, by their names in free-sailing structures."""
HIGHEST_WAKE = 0.6
"""Upper bound of the wake fraction; full single-screw ships reach 0.45."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class KnownPropeller:
    """Propellers of a ship and the steady running around which it was tested."""

    curve: OpenWaterCurve
    """Open-water curves."""
    pitch_ratio: float
    """Pitch over diameter."""
    diameter_m: float
    """Diameter [m]."""
    propellers: int
    """Number of equal propellers."""
    water_density_kg_m3: float
    """Density of the water [kg/m3]."""
    shaft_speed_rev_s: float
    """Mean speed of the propeller shafts [rev/s]."""
    ship_speed_m_s: float
    """Mean speed through the water [m/s]."""

    def advance(self, w: FloatArray) -> FloatArray:
        """Return the advance ratio for a wake fraction."""
        return self.ship_speed_m_s * (1.0 - w) / (self.shaft_speed_rev_s * self.diameter_m)

    def thrust_n(self, w: FloatArray) -> FloatArray:
        """Return the thrust of all propellers for a wake fraction [N]."""
        force = self.water_density_kg_m3 * self.shaft_speed_rev_s**2 * self.diameter_m**4
        return self.propellers * force * self.curve.thrust.value(self.advance(w), np.asarray(self.pitch_ratio))

    def slopes(self, w: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return ``a`` and ``b`` for a wake fraction."""
        j, theta = self.advance(w), np.asarray(self.pitch_ratio)
        thrust, torque = self.curve.thrust, self.curve.torque
        return (
            j * thrust.advance_slope(j, theta) / thrust.value(j, theta),
            j * torque.advance_slope(j, theta) / torque.value(j, theta),
        )

    def pitch_slopes(self, w: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return ``p`` and ``q`` for a wake fraction."""
        j, theta = self.advance(w), np.asarray(self.pitch_ratio)
        thrust, torque = self.curve.thrust, self.curve.torque
        return (
            theta * thrust.pitch_slope(j, theta) / thrust.value(j, theta),
            theta * torque.pitch_slope(j, theta) / torque.value(j, theta),
        )

    def lowest_wake(self) -> float:
        """Return the wake fraction below which thrust or its slope would leave the curve, at least -0.2.

        Raises
        ------
        PropellerError
            If the curve does not hold the pitch.
        StructureError
            If it does not hold the working point at any wake fraction up to 0.6.
        """
        # the slope of the thrust has no bound where the thrust ends
        last = 0.97 * self.curve.zero_thrust_advance(self.pitch_ratio)
        lowest = 1.0 - last * self.shaft_speed_rev_s * self.diameter_m / self.ship_speed_m_s
        if lowest >= HIGHEST_WAKE:
            raise StructureError(
                f"known propeller {self.curve.name}: expected shaft and ship speed at which it pulls, found no "
                f"thrust at {self.shaft_speed_rev_s:g} rev/s and {self.ship_speed_m_s:g} m/s up to a wake fraction of "
                f"{HIGHEST_WAKE:g}; check both speeds, and that the first is that of the propeller shaft."
            )
        return max(lowest, -0.2)


def sails_free(structure: Structure) -> bool:
    """Return whether a structure has slopes of the propeller and times of the ship, which a known propeller gives."""
    return set(OF_THE_SHIP) <= set(structure.names)


def sailing_values(
    structure: Structure, *, exponent: float, time_s: float, slopes: tuple[float, float] | None = None
) -> dict[str, float]:
    """Return the values of a free-sailing structure by its names, within its bounds; nothing of one that does not.

    ``structure``: FREE-CORE, FREE-SHIP, FREE-CLOSED, FREE-LOG or FREE-PITCH. ``exponent``: slope of the resistance, ``d
    ln R / d ln v``. ``time_s``: time of the ship, ``m v / R`` [s]. ``slopes``: of thrust and torque coefficient,
    ``KnownPropeller.slopes``, where they are known.
    """
    if not sails_free(structure):
        return {}
    a, b, e, tau_u = OF_THE_SHIP
    values = {e: exponent, tau_u: time_s} | ({} if slopes is None else {a: slopes[0], b: slopes[1]})
    bounds = {p.name: (p.lower, p.upper) for p in structure.parameters}
    return {name: float(np.clip(value, *bounds[name])) for name, value in values.items()}


def with_known_propeller(
    structure: Structure, propeller: KnownPropeller, *, mass_kg: float, resistance_n: float | None = None
) -> Structure:
    """Return a free-sailing structure in wake fraction, resistance and mass instead of ``a``, ``b`` and ``tau_u``.

    ``a``, ``b`` (``p`` and ``q``) follow from the curves at ``J = v (1 - w) / (n D)``, and ``tau_u = m v / R``; the
    thrust deduction ``t = 1 - R / (k_p T)`` is a combination.

    Parameters
    ----------
    structure
        FREE-CORE, FREE-SHIP, FREE-CLOSED, FREE-LOG or FREE-PITCH.
    propeller
        Curves and working point.
    mass_kg
        Mass of the ship with the water that surges with it [kg]: ``m`` is held there, and may be freed.
    resistance_n
        Resistance at the working point [N] where ``R`` shall be held; free when not given.

    Raises
    ------
    StructureError
        If the structure does not sail free, or the propeller does not pull at its working point.
    PropellerError
        If the curves do not hold the pitch.
    """
    missing = [name for name in OF_THE_SHIP if name not in structure.names]
    if missing:
        raise StructureError(
            f"structure {structure.name}: expected a free-sailing structure, found no {', '.join(missing)}; use "
            "FREE-CORE, FREE-SHIP, FREE-CLOSED, FREE-LOG or FREE-PITCH."
        )
    speed, lowest = propeller.ship_speed_m_s, propeller.lowest_wake()
    thrust = float(propeller.thrust_n(np.asarray(max(lowest, 0.0))))
    wake = Parameter("w", "-", lowest, HIGHEST_WAKE, max(0.5 * (lowest + HIGHEST_WAKE), lowest), "wake fraction")
    mass = Parameter("m", "kg", 0.1 * mass_kg, 10.0 * mass_kg, mass_kg, "ship with entrained water", held=True)
    resistance = Parameter("R", "N", 0.02 * thrust, 3.0 * thrust, 0.8 * thrust, "resistance at the working point")
    if resistance_n is not None:
        resistance = resistance.held_at(resistance_n)
    sailing = structure.tied("a", lambda w: propeller.slopes(w)[0], wake)
    sailing = sailing.tied("b", lambda w: propeller.slopes(w)[1])
    if "p" in structure.names:
        sailing = sailing.tied("p", lambda w: propeller.pitch_slopes(w)[0]).tied(
            "q", lambda w: propeller.pitch_slopes(w)[1]
        )
    sailing = sailing.tied("tau_u", lambda m, R: m * speed / R, mass, resistance)
    return _with_thrust_deduction(sailing, propeller)


def _with_thrust_deduction(structure: Structure, propeller: KnownPropeller) -> Structure:
    deduction = Combination(
        name="t",
        unit="-",
        of=lambda p: 1.0 - p["R"] / propeller.thrust_n(p["w"]),
        meaning="thrust deduction, 1 - R / (k_p T)",
    )
    return replace(structure, combinations=(deduction, *structure.combinations))
