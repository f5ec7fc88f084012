"""The clocks of several loggers: a straight line between two of them, found from what both have seen.

===================== ======== ====================================================================
quantity              unit     meaning
===================== ======== ====================================================================
offset                s        what the reference clock reads more than the other
drift                 s/s      by how much the reference clock runs faster
===================== ======== ====================================================================

Raw samples are never moved: a channel on another clock gets another start and rate. What was found stands in the
attributes of the merged recording; ``logger_clocks`` reads it.
"""

from shaftprint.clocks._align import align
from shaftprint.clocks._alignment import Alignment, Stretch
from shaftprint.clocks._clock_map import ClockMap
from shaftprint.clocks._logger_clock import LoggerClock, clock_attributes, logger_clocks
from shaftprint.clocks._merge import joined, merged

__all__ = [
    "Alignment",
    "ClockMap",
    "LoggerClock",
    "Stretch",
    "align",
    "clock_attributes",
    "joined",
    "logger_clocks",
    "merged",
]
