"""A line of the set point that bends: at another speed a volt asks for another change of the speed.

Levers, their cards and their converters are straight to some tenths of a per cent a volt. A test at one speed does not
see it. One at two would put the difference of the slopes into the gains if one scale of the set point held for both.
"""

from dataclasses import replace

from shaftprint.catalogue._roles import ShipRole
from shaftprint.models._blocks import Gain
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure

_SET_POINT = "n_set"
B_SET = Parameter(
    "b_set",
    "-",
    -0.2,
    0.2,
    0.0,
    "share by which the set-point line is steeper at twice the speed",
    role=ShipRole.SET_POINT_BEND,
)


def with_bend(structure: Structure) -> Structure:
    """Return a structure for tests at several speeds, the slope of whose set-point line goes with the speed.

    At the working point of the parameters it is the structure as it was; ``at_working_point`` says what the bend does
    at another. A structure without the set point, or with its bend already, is returned as it is.
    """
    if _SET_POINT not in structure.inputs or B_SET.name in structure.names:
        return structure
    paths = dict(zip(structure.channels, structure.paths, strict=True))
    bend = 1.0 + Gain(B_SET)
    outputs = {
        output: {
            one: paths[output, one] * bend if one == _SET_POINT else paths[output, one] for one in structure.inputs
        }
        for output in structure.outputs
    }
    bent = replace(structure, outputs=outputs, parameters=(*structure.parameters, B_SET))
    return bent.scaled(**{B_SET.name: 0.0})
