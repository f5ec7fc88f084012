"""A clutch in the line: what it holds, and how stiff it is while it holds."""

from typing import Any

from shaftprint.models._parameter import Parameter
from shaftprint.models.equations._clutch import slipping_clutch
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula

M_C = Parameter("m_c", "-", 0.0, 20.0, 3.0, "torque at which a clutch slips, at the shaft and over the working point's")
CLUTCH_STIFFNESS = Parameter("k_c", "1/s", 10.0, 1e5, 1000.0, "stiffness of a closed clutch", held=True)
CLUTCH_DAMPING = Parameter("c_c", "-", 0.1, 1e4, 10.0, "damping of a closed clutch", held=True)
CLUTCH = (M_C, CLUTCH_STIFFNESS, CLUTCH_DAMPING)


def clutch_torque(flow: Flow, slip: Formula, capacity: Formula, p: Any) -> Formula:
    """Return the torque of a clutch over that of the shaft at the working point, for what its plates hold."""
    return slipping_clutch(flow, slip, capacity, stiffness=p.k_c, damping=p.c_c)
