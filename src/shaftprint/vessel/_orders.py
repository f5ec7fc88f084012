"""Orders: what comes back with every turn of a shaft, from the numbers of strokes, cylinders and blades.

An order of a shaft is the number of periods in one of its turns. In the torque of the propeller shaft stand order 1 of
that shaft (unbalance, bending of the shaft under the gauge), its blades and their double, and the orders of the engine:
the working cycle of a cylinder, two turns of a four-stroke engine, comes back with order ``2 / strokes``, and all
multiples of it up to the firing of all cylinders (Den Hartog, "Mechanical Vibrations", chapter on multicylinder
engines).
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from shaftprint.vessel._machinery import Gearbox, Machine, Propeller


@dataclass(frozen=True, kw_only=True, slots=True)
class Order:
    """Something that comes back so many times in a turn of a shaft."""

    name: str
    """What it is, in words."""
    shaft: Literal["engine", "propeller"]
    """The shaft that it belongs to."""
    per_engine_turn: float
    """Periods in one turn of the engine, also for orders of the propeller shaft."""


def orders_of(machine: "Machine", gearbox: "Gearbox", propeller: "Propeller") -> tuple[Order, ...]:
    """Return the orders of a shaft line in the torque of its propeller shaft, lowest first.

    ``machine``: says what its own torque repeats, such as the firing of cylinders. ``gearbox``: says by how much the
    propeller shaft is slower. ``propeller``: says the number of blades.
    """
    of_shaft = {1: "shaft order 1", propeller.blades: "blade rate", 2 * propeller.blades: "twice the blade rate"}
    orders = [
        *(
            Order(name=name, shaft="propeller", per_engine_turn=order / gearbox.ratio)
            for order, name in of_shaft.items()
        ),
        *(
            Order(name=f"{machine.word} order {order}", shaft="engine", per_engine_turn=float(order))
            for order in machine.torque_orders
        ),
    ]
    return tuple(sorted(orders, key=lambda order: order.per_engine_turn))
