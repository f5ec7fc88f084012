"""What is done to a channel before it is a signal: outliers, repairs, decimation, and the thesis' own way."""

from shaftprint.signals.conditioning._condition import Reading, SentValues, conditioned
from shaftprint.signals.conditioning._cut_off import CutOff
from shaftprint.signals.conditioning._decimate import SampleGrid, decimated, filter_grid, low_pass_taps
from shaftprint.signals.conditioning._outliers import (
    GOOD,
    HOLD,
    RAIL,
    SPIKE,
    FaultLimits,
    fault_limits,
    flagged,
    mark_holds,
    mark_spikes,
    sample_codes,
)
from shaftprint.signals.conditioning._patch import Patcher
from shaftprint.signals.conditioning._runs import Runs, RunTally
from shaftprint.signals.conditioning._thesis import previous_neighbours, pulse_period_speed

__all__ = [
    "GOOD",
    "HOLD",
    "RAIL",
    "SPIKE",
    "CutOff",
    "FaultLimits",
    "Patcher",
    "Reading",
    "RunTally",
    "Runs",
    "SampleGrid",
    "SentValues",
    "conditioned",
    "decimated",
    "fault_limits",
    "filter_grid",
    "flagged",
    "low_pass_taps",
    "mark_holds",
    "mark_spikes",
    "previous_neighbours",
    "pulse_period_speed",
    "sample_codes",
]
