"""Which sines a limit reaches: their frequency response is not that of small signals."""

from collections.abc import Mapping, Sequence

import numpy as np

from shaftprint.catalogue._limited_governor import GovernorSymbol
from shaftprint.models._structure import Structure
from shaftprint.time_domain._identify_in_time import output_error
from shaftprint.time_domain._record import Record
from shaftprint.time_domain._simulator import ExactDelays, on_record

# Values at which a limit does nothing, whatever is asked for.
IDLE: Mapping[str, float] = {
    GovernorSymbol.TORQUE_LIMIT: 6.0,
    GovernorSymbol.MOTORING_LIMIT: -2.0,
    GovernorSymbol.RACK_RATE: 100.0,
    GovernorSymbol.SET_POINT_RATE: 50.0,
    GovernorSymbol.DEADBAND: 0.0,
    GovernorSymbol.UNBOOSTED_TORQUE: 1.0,
}
# A sine is touched where limits change more than this share of its motion.
TOUCHED = 2e-3


def limited_sines(structure: Structure, values: Mapping[str, float], records: Sequence[Record]) -> tuple[str, ...]:
    """Return the names of the records whose simulation the limits of a structure change.

    ``values``: values of its free parameters by name. ``records``: sines, each with its settled samples in use.
    """
    names = []
    for record in records:
        equipped = output_error(structure, record).structure
        free_values = {p.name: values[p.name] for p in equipped.free if p.name in values}
        idle = {name: value for name, value in IDLE.items() if name in equipped.names}
        pair = [
            on_record(ExactDelays(), equipped, equipped.vector(each), record, ())
            for each in (
                free_values,
                {**free_values, **{p.name: idle[p.name] for p in equipped.parameters if p.name in idle}},
            )
        ]
        limited_run, linear_run = pair
        if limited_run is None or linear_run is None:
            names.append(record.name)
            continue
        change = (limited_run - linear_run)[0, record.used]
        motion = linear_run[0, record.used] - linear_run[0, record.used].mean(axis=0)
        if not np.all(np.abs(change).max(axis=0) <= TOUCHED * np.abs(motion).max(axis=0)):
            names.append(record.name)
    return tuple(names)
