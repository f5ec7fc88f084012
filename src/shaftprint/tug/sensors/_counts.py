"""What a logger keeps of a channel: counts of 16 bits, and what they stand for."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray

VOLT_PER_COUNT = 10.24 / 32768.0
"""Resolution of the voltage channels of the logger [V]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class LoggedChannel:
    """A channel of the log; ``value = count * scale + offset``."""

    name: str
    """Its name."""
    unit: str
    """Unit of its values."""
    scale: float = VOLT_PER_COUNT
    """Value of one count [unit]."""
    offset: float = 0.0
    """Value at count zero [unit]."""
    long_name: str
    """What it is, in words."""


def as_counts(values: FloatArray) -> NDArray[np.int16]:
    """Return values in counts as the logger stores them: whole ones, within its range."""
    counts: FloatArray = np.rint(values)
    return counts.clip(-32768, 32767).astype(np.int16)
