"""What is put out: a rendered waveform with the time at which it begins."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Play:
    """One part of a test as the counterpart plays it: straight between its values, the last one held."""

    name: str
    """What of the campaign it is, such as ``M1`` or ``ramp to M1``."""
    start_s: float
    """When its first value is put out, by the counterpart's clock [s]."""
    rate_hz: float
    """Values a second [Hz]."""
    volts: FloatArray
    """Set points [V of the campaign], shape (values,)."""

    @property
    def stop_s(self) -> float:
        """When its last value is put out, by the counterpart's clock [s]."""
        return self.start_s + (self.volts.size - 1) / self.rate_hz

    def value_at(self, time_s: FloatArray) -> FloatArray:
        """Return what is put out at times of the counterpart's clock [V], shape of the times."""
        last = self.volts.size - 1
        position = np.clip((np.asarray(time_s, dtype=np.float64) - self.start_s) * self.rate_hz, 0.0, last)
        # a block asks for few of many values: their places are known without a search through a table of them
        before = position.astype(np.intp)
        below, above = self.volts[before], self.volts[np.minimum(before + 1, last)]
        return np.asarray((above - below) * (position - before) + below)
