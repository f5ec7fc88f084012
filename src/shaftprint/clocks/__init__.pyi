from ._align import align
from ._alignment import Alignment, Stretch
from ._clock_map import ClockMap
from ._logger_clock import LoggerClock, clock_attributes, logger_clocks
from ._merge import joined, merged

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
