"""Simulated repeats of a record."""

from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.identify.likelihood._term import Repeats


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RecordRepeats(Repeats):
    """Simulated repeats of a record: the noise of each is made anew whenever it is needed."""

    model: FloatArray
    """Whitened outputs without noise, shape (used samples * outputs,)."""
    seeds: IntArray
    """Seed of the noise of each repeat, shape (repeats,)."""

    def chosen(self, repeats: IntArray | slice) -> "RecordRepeats":
        """Return some of the repeats."""
        return replace(self, seeds=self.seeds[repeats])

    def data(self, repeat: int) -> FloatArray:
        """Return the whitened outputs of a repeat, shape (used samples * outputs,)."""
        return self.model + np.random.default_rng(int(self.seeds[repeat])).standard_normal(self.model.size)
