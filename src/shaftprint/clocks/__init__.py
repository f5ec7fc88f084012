"""The clocks of several loggers: a straight line between two of them, found from what both have seen.

===================== ======== ====================================================================
quantity              unit     meaning
===================== ======== ====================================================================
offset                s        what the reference clock reads more than the other
drift                 s/s      by how much the reference clock runs faster
===================== ======== ====================================================================

Raw samples are never moved: a channel on another clock gets another start and rate.
"""

from shaftprint.clocks._align import Alignment, align
from shaftprint.clocks._clock_map import ClockMap
from shaftprint.clocks._merge import joined, merged
from shaftprint.clocks._windows import Delay

__all__ = ["Alignment", "ClockMap", "Delay", "align", "joined", "merged"]
