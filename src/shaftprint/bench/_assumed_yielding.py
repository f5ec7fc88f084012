"""By how much dry friction yields: a number that is assumed, and what it leaves uncertain.

An ideal law has no such number, and the real contact another than the file says. Where the motion turns, friction
follows after a way of about ``q``, under a steady torque after a time that goes with its root: twice the slope at ``q``
is as far as nothing at all lies from it. With few and weak turns that is nothing; with many, and little noise, it is
more than what noise leaves uncertain.
"""

from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._held_yielding import YIELDING, yielding_of
from shaftprint.catalogue._drives import DRIVES

# Of the assumed number, one standard deviation.
ASSUMED = 2.0
# By how much what rubs yields in the structures that are shipped.
SHIPPED_YIELDING = "theta_y"


def assumed_yielding(one: EquippedDrive) -> dict[str, float]:
    """Return the standard deviation of each yielding that is held at a number which nobody stated to be known."""
    stated = {known.name for known in one.drive.known}
    names = {yielding_of(block) for block in one.drive.blocks if YIELDING in block.parameters}
    names |= {SHIPPED_YIELDING} if one.structure.name in DRIVES else set()
    return {
        p.name: ASSUMED * p.value
        for p in one.structure.parameters
        if p.held and p.name in names and p.name not in stated
    }
