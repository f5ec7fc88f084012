"""The drive file: what was measured of a line that is no ship's, and what is known of it.

=================== ========= ========================================================================================
quantity            unit      meaning
=================== ========= ========================================================================================
input, output       stated    whole values, not deviations, each in the unit that the file states
time                s         of the recording
parameter           stated    in the unit of the structure's parameter
=================== ========= ========================================================================================
"""

from shaftprint.drive._blocks import Block, BlockKind, FreeParameter
from shaftprint.drive._drive import Drive, FitWay, load_drive
from shaftprint.drive._responses import ResponseColumns
from shaftprint.drive._signals import KnownParameter, PerRecord, SearchedParameter, Signal, StartState, Stretch
from shaftprint.drive._unit_factors import unit_factor, zero_is_anywhere

__all__ = [
    "Block",
    "BlockKind",
    "Drive",
    "FitWay",
    "FreeParameter",
    "KnownParameter",
    "PerRecord",
    "ResponseColumns",
    "SearchedParameter",
    "Signal",
    "StartState",
    "Stretch",
    "load_drive",
    "unit_factor",
    "zero_is_anywhere",
]
