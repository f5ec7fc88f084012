"""The noun ``Band``: how well a test may make the numbers known on the ships and in the noise that are possible."""

from collections.abc import Mapping
from dataclasses import dataclass

from shaftprint.notebook._shown import Shown

HELD = 0.8
"""Share of the possible ships that a band holds: a tenth lies on either side."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Band(Shown):
    """What is left open of a plan's accuracy by the noise and the numbers of a ship that are not known."""

    deviations: Mapping[str, tuple[float, float]]
    """Lower and upper standard deviation of the possible ships over that of their middle, by number."""
    middle: Mapping[str, float]
    """What is promised: the median over the possible ships, over what is predicted at the assumed values, by number."""
    seconds: tuple[float, float] | None = None
    """Shortest and longest test like this one that meets every wish [s]; None without wishes."""
