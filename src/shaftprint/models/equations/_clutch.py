"""A friction clutch that slips, as equations of signals.

What turns on both sides is joined by a spring and a damper that give no more torque than the plates hold (the element
of Prandtl, 1928, with a damper beside its spring)::

    T = clip(k a + c w, -T_C, T_C)        da/dt = (T - k a) / c

Closed, ``da/dt`` is the slip ``w`` and the spring carries the torque; slipping, the spring keeps what the plates hold;
open, ``T_C = 0``, it is let go. Unlike laws of friction over the speed it neither creeps under a steady torque nor
jumps.
"""

from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula, Number, as_formula, clip


def slipping_clutch(flow: Flow, slip: Formula, capacity: Number, *, stiffness: Number, damping: Number) -> Formula:
    """Return the torque that a clutch transmits, positive with the slip.

    ``slip``: speed of what drives less that of what is driven. ``capacity``: torque at which the plates slip; 0 where
    they are apart. ``stiffness``: torque over the angle between both sides while they hold, in units of the capacity
    over those of the slip times seconds. ``damping``: torque over the slip while they hold, above 0.
    """
    wound = flow.state("clutch")
    spring = as_formula(stiffness) * wound
    held, resistance = as_formula(capacity), as_formula(damping)
    torque = clip(spring + resistance * slip, -held, held)
    flow.rate(wound, (torque - spring) / resistance)
    return torque
