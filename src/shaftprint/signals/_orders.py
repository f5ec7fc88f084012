"""Orders of the shaft line with the pick-up by which their angle is known."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from shaftprint.signals._channel_signals import SpeedSignal
    from shaftprint.vessel._orders import Order
    from shaftprint.vessel._vessel import Vessel


@dataclass(frozen=True, kw_only=True, slots=True)
class TrackedOrder:
    """Something in the shaft torque that comes back with the angle of a shaft."""

    name: str
    """What it is, in words."""
    per_turn: float
    """Periods in one turn of the engine, as the speed below counts them."""
    speed: str
    """Name of the speed whose integral is the angle."""
    through_gears: bool = False
    """Whether the pick-up is on the other shaft, so that the angle is as exact as the gear ratio of the vessel file."""


def tracked_orders(vessel: "Vessel", speeds: Mapping[str, "SpeedSignal"]) -> tuple[TrackedOrder, ...]:
    """Return the orders of a vessel, each with the pick-up of its own shaft that shows most angles in a turn.

    Where its shaft has none, the one that is identified is taken, through the gear ratio of the vessel file.

    ``vessel``: says which orders there are, and which pick-up is on which shaft. ``speeds``: speeds of the recording by
    name, the one that is identified first.
    """
    return tuple(_tracked(order, vessel, speeds) for order in vessel.orders)


def _tracked(order: "Order", vessel: "Vessel", speeds: Mapping[str, "SpeedSignal"]) -> TrackedOrder:
    # the scale of an instrument is no more exact than a gear ratio
    own = [one for one in vessel.sensors.speed if one.shaft == order.shaft and one.name in speeds and one.counts_turns]
    finest = max(own, key=lambda one: math.inf if one.gives_angle else one.pulses_per_revolution, default=None)
    return TrackedOrder(
        name=order.name,
        per_turn=order.per_engine_turn,
        speed=next(iter(speeds)) if finest is None else finest.name,
        through_gears=finest is None,
    )
