"""The last simulations of a governor, which the next step of a fit often asks for again.

A descent ends where it simulated last; the unit of the innovations, covariance, scatter and scan are wanted there too.
"""

from collections import deque
from collections.abc import Sequence

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.limits.prediction._set_point import GovernorRecord
from shaftprint.time_domain._record import Record

# Beyond the best parameters a descent has tried a few others before it ends; few records take turns.
KEPT, KEPT_RECORDS = 12, 4


class RecentSimulations:
    """Simulations by record, parameter values and wanted derivatives; only the last few are kept."""

    def __init__(self) -> None:
        """Begin with none."""
        self._kept: deque[tuple[Record, bytes, tuple[str, ...], FloatArray]] = deque(maxlen=KEPT)
        self._coarser: deque[tuple[GovernorRecord, GovernorRecord]] = deque(maxlen=KEPT_RECORDS)

    def coarser(self, record: GovernorRecord) -> GovernorRecord:
        """Return a record with half the drive, one and the same each time: by it simulations are found."""
        for fine, coarse in self._coarser:
            if fine is record:
                return coarse
        self._coarser.append((record, record.coarser()))
        return self._coarser[-1][1]

    def found(self, record: Record, values: FloatArray, wanted: Sequence[str]) -> FloatArray | None:
        """Return a prediction with derivatives, shape (1 + wanted, samples); None where it was not simulated lately."""
        own = values.tobytes()
        for other, at_values, names, simulated in reversed(self._kept):
            if other is record and at_values == own and set(wanted) <= set(names):
                places = [0, *(1 + names.index(name) for name in wanted)]
                return simulated if tuple(wanted) == names else simulated[places]
        return None

    def keep(self, record: Record, values: FloatArray, wanted: Sequence[str], simulated: FloatArray) -> None:
        """Keep a simulation, shape (1 + wanted, samples), in the place of the oldest one."""
        self._kept.append((record, values.tobytes(), tuple(wanted), frozen_float(np.asarray(simulated))))
