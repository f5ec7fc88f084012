"""A set point that may be logged late: its latency, which no line has below nothing, is let go there.

A channel behind a gateway shows the set point after the governor has it. What a latency of at least nothing tells of
the delay of the loop, and of gains and margins with it, then misleads, though the data do not contradict it.
"""

from collections.abc import Sequence
from dataclasses import replace

from shaftprint.catalogue._roles import ShipRole
from shaftprint.identify.fit._identification import Identification
from shaftprint.models._parameter import Parameter


def bounds_of_late(free: Sequence[Parameter]) -> dict[str, tuple[float, float]]:
    """Return the bounds of each latency of a set point that may be logged late, by name; ``free``: free parameters."""
    return {
        one.name: (-one.upper, one.upper) for one in free if one.role == ShipRole.SET_POINT_LATENCY and one.lower == 0.0
    }


def let_go(identification: Identification) -> Identification:
    """Return a fit whose intervals reach to where a set point that is logged late would have them, its values as is."""
    objective = identification.objective
    late = bounds_of_late(objective.free_parameters)
    parameters = tuple(one.free_between(*late[one.name]) if one.name in late else one for one in objective.parameters)
    return replace(identification, objective=replace(objective, parameters=parameters))
