"""The noun of the room: how the clock of one logger reads on the clock of another."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Self

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float

if TYPE_CHECKING:
    from shaftprint.recording import Channel


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ClockMap:
    """A straight line from the time of one logger to the time of another.

    ``reference = other + offset_s + drift (other - middle_s)``
    """

    offset_s: float
    """What the reference clock reads more at ``middle_s`` [s]."""
    drift: float
    """By how much the reference clock runs faster [s/s]."""
    middle_s: float
    """Time on the other clock at which offset and drift are independent of each other, nearly [s]."""
    covariance: FloatArray
    """Covariance of ``offset_s`` and ``drift``, shape (2, 2)."""

    def __post_init__(self) -> None:
        """Make the covariance read-only."""
        object.__setattr__(self, "covariance", frozen_float(self.covariance))

    def reference_s(self, other_s: FloatArray) -> FloatArray:
        """Return the reference clock's times of times of the other clock [s], same shape."""
        return np.asarray(other_s + self.offset_s + self.drift * (other_s - self.middle_s))

    def std_s(self, other_s: FloatArray) -> FloatArray:
        """Return the standard deviation of the reference clock's times [s], same shape."""
        away = np.asarray(other_s - self.middle_s)
        (offset, both), (_, drift) = self.covariance
        return np.asarray(np.sqrt(np.maximum(offset + 2.0 * both * away + drift * away**2, 0.0)))

    def applied(self, channel: "Channel") -> "Channel":
        """Return a channel of the other logger on the reference clock: the same samples, another start and rate."""
        start_s = self.reference_s(np.asarray(channel.start_s)).item()
        return replace(channel, start_s=start_s, rate_hz=channel.rate_hz / (1.0 + self.drift))

    def inverse(self) -> Self:
        """Return the map from the reference clock to the other."""
        turned = -1.0 / (1.0 + self.drift)
        slopes = np.array([[-1.0, 0.0], [0.0, -(turned**2)]])
        return replace(
            self,
            offset_s=-self.offset_s,
            drift=-1.0 - turned,
            middle_s=self.middle_s + self.offset_s,
            covariance=slopes @ self.covariance @ slopes.T,
        )
