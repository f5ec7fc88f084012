"""Which sines a limit reaches: their frequency response is not that of small signals."""

from collections.abc import Mapping, Sequence

import numpy as np

from shaftprint.catalogue import Symbol
from shaftprint.models import Structure
from shaftprint.time_domain._identify_in_time import output_error
from shaftprint.time_domain._record import Record
from shaftprint.time_domain._simulator import ExactDelays, on_record

# Values at which a limit does nothing, whatever is asked for.
IDLE: Mapping[str, float] = {
    Symbol.TORQUE_LIMIT: 6.0,
    Symbol.MOTORING_LIMIT: -2.0,
    Symbol.RACK_RATE: 100.0,
    Symbol.DEADBAND: 0.0,
    Symbol.UNBOOSTED_TORQUE: 1.0,
}
# A sine is touched where limits change more than this share of its motion.
TOUCHED = 2e-3


def limited_sines(structure: Structure, values: Mapping[str, float], records: Sequence[Record]) -> tuple[str, ...]:
    """Return the names of the records whose simulation the limits of a structure change.

    Parameters
    ----------
    values
        Values of its free parameters by name.
    records
        Sines, each with its settled samples in use.
    """
    found = []
    for record in records:
        own = output_error(structure, record).structure
        known = {p.name: values[p.name] for p in own.free if p.name in values}
        idle = {name: value for name, value in IDLE.items() if name in own.names}
        pair = [
            on_record(ExactDelays(), own, own.vector(each), record, ())
            for each in (known, {**known, **{p.name: idle[p.name] for p in own.parameters if p.name in idle}})
        ]
        limited_run, linear_run = pair
        if limited_run is None or linear_run is None:
            found.append(record.name)
            continue
        change = (limited_run - linear_run)[0, record.used]
        motion = linear_run[0, record.used] - linear_run[0, record.used].mean(axis=0)
        if not np.all(np.abs(change).max(axis=0) <= TOUCHED * np.abs(motion).max(axis=0)):
            found.append(record.name)
    return tuple(found)
