"""What must not be passed while the program plays: limits of ship and engine, each with the time that it may last."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from shaftprint.errors import LiveError
from shaftprint.vessel._envelope import StatedEnvelope

if TYPE_CHECKING:
    from shaftprint.vessel._vessel import Vessel

SPEED, TORQUE, SET_POINT = "engine speed", "shaft torque", "set point"
"""Quantities of a vessel file that are bounded; others are channels by their names."""

# Where a rehearsal has no [envelope]: what the engine gives at its rated point and for so long [s].
_REHEARSED_S = 4.0 * 3600.0


@dataclass(frozen=True, kw_only=True, slots=True)
class Bound:
    """Lowest and highest value of one quantity, and how long it may be beyond them."""

    quantity: str
    """What is bounded: ``engine speed``, ``shaft torque``, ``set point``, or the name of a channel."""
    unit: str
    """Its unit."""
    lowest: float
    """Lowest value [unit]; minus infinity without one."""
    highest: float
    """Highest value [unit]; infinity without one."""
    persistence_s: float
    """How long it may be beyond before the test is aborted [s]."""

    def holds(self, value: float) -> bool:
        """Return whether a value is within; what is not a number is not."""
        return self.lowest <= value <= self.highest

    def nearest(self, value: float) -> float:
        """Return the end that a value beyond it has passed."""
        return self.lowest if value < self.lowest else self.highest


@dataclass(frozen=True, kw_only=True, slots=True)
class Envelope:
    """All bounds of a test on one shaft line."""

    bounds: tuple[Bound, ...]
    """Bounds of quantities that are measured, on every block."""
    highest_slew_v_per_s: float
    """Fastest change of the set point [V/s]; infinite without a limit."""
    longest_s: float
    """Longest time for which the program may rule the set point [s]."""
    barred_rpm: tuple[tuple[float, float], ...] = ()
    """Ranges of engine speed in which the line must not stay, with their margin [rpm]."""
    barred_passage_s: float = 5.0
    """How long passing one may take [s]."""
    highest_torque_amplitude_nm: float = math.inf
    """Largest amplitude of the shaft torque that a line may be predicted to make [N m]."""
    is_stated: bool = True
    """Whether the vessel file states it; else it is that of the engine's rated point, for rehearsals alone."""

    def bound_of(self, quantity: str) -> Bound | None:
        """Return the bound of a quantity; None without one."""
        return next((bound for bound in self.bounds if bound.quantity == quantity), None)


def envelope_of(vessel: "Vessel", *, is_rehearsed: bool = False) -> Envelope:
    """Return the envelope that a vessel file states.

    Parameters
    ----------
    vessel
        The vessel file.
    is_rehearsed
        Whether idle and rated point do where it states none.

    Raises
    ------
    LiveError
        If it states none, and the test is not rehearsed.
    """
    stated = vessel.envelope
    if stated is None:
        if not is_rehearsed:
            raise LiveError(
                f"vessel {vessel.name}: expected [envelope] with highest_shaft_torque_nm and longest_s, what the owner "
                "allows a program that plays a test, found none."
            )
        rated_nm = vessel.machine.rated_torque_nm * vessel.gearbox.shaft_over_brake
        stated = StatedEnvelope(
            lowest_shaft_torque_nm=-rated_nm, highest_shaft_torque_nm=rated_nm, longest_s=_REHEARSED_S
        )
    limits, machine = vessel.limits, vessel.machine
    lowest_rpm = stated.lowest_speed_rpm or limits.lowest_speed_rpm or getattr(machine, "idle_speed_rpm", None) or 0.0
    highest_rpm = stated.highest_speed_rpm or limits.highest_speed_rpm or machine.rated_speed_rpm
    lasting_s, margin = stated.persistence_s, stated.barred_margin_rpm
    bounds = [
        Bound(quantity=SPEED, unit="rpm", lowest=lowest_rpm, highest=highest_rpm, persistence_s=lasting_s),
        Bound(
            quantity=TORQUE,
            unit="N m",
            lowest=stated.lowest_shaft_torque_nm,
            highest=stated.highest_shaft_torque_nm,
            persistence_s=lasting_s,
        ),
        Bound(
            quantity=SET_POINT,
            unit="V",
            lowest=_or(stated.lowest_set_point_v, -math.inf),
            highest=_or(stated.highest_set_point_v, math.inf),
            persistence_s=lasting_s,
        ),
    ]
    bounds += [
        Bound(
            quantity=one.channel,
            unit="",
            lowest=_or(one.lowest, -math.inf),
            highest=_or(one.highest, math.inf),
            persistence_s=one.persistence_s,
        )
        for one in stated.channels
    ]
    return Envelope(
        bounds=tuple(bounds),
        barred_rpm=tuple((low - margin, high + margin) for low, high in limits.barred_speeds_rpm),
        highest_slew_v_per_s=_or(stated.highest_slew_v_per_s, math.inf),
        longest_s=stated.longest_s,
        highest_torque_amplitude_nm=_or(stated.highest_torque_amplitude_nm, math.inf),
        is_stated=vessel.envelope is not None,
    )


def _or(stated: float | None, other: float) -> float:
    return other if stated is None else stated
