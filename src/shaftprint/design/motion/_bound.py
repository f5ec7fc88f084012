"""The noun ``Bound``: a limit as a straight line in the deviations of ``SIGNALS``."""

from dataclasses import dataclass

from shaftprint.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Bound:
    """``weights . signals <= room``."""

    name: str
    """Limit that it stands for."""
    weights: FloatArray
    """What it weighs, in the order of ``SIGNALS``, shape (signals,)."""
    room: float
    """What is left at the working point, the margin for noise taken off, positive."""
