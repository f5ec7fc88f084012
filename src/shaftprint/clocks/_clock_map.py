"""The noun of the room: how the clock of one logger reads on the clock of another."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Self

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import ClockError

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel


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
        """Check the numbers and make the covariance read-only.

        Raises ClockError if a number is not finite, the drift turns time round, or the covariance is none.
        """
        covariance = frozen_float(self.covariance)
        object.__setattr__(self, "covariance", covariance)
        if not np.all(np.isfinite([self.offset_s, self.drift, self.middle_s])) or self.drift <= -1.0:
            raise ClockError(
                "clock map: expected finite numbers and a drift above -1, found offset "
                f"{self.offset_s:g} s, drift {self.drift:g}, middle {self.middle_s:g} s."
            )
        if not _is_covariance(covariance):
            raise ClockError(
                "clock map: expected a covariance of offset and drift, symmetric with variances that are not negative "
                f"and a correlation within -1 and 1, found {covariance.tolist()}."
            )

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
        return channel.on_other_clock(start_s=start_s, rate_hz=channel.rate_hz / (1.0 + self.drift))

    def then(self, following: "ClockMap") -> Self:
        """Return the map to the clock that a following map leads to; errors of the two are independent."""
        there_s = self.middle_s + self.offset_s - following.middle_s
        first = (1.0 + following.drift) * np.eye(2)
        theirs = np.array([[1.0, there_s], [0.0, 1.0 + self.drift]])
        return replace(
            self,
            offset_s=self.offset_s + following.offset_s + following.drift * there_s,
            drift=self.drift + following.drift + self.drift * following.drift,
            covariance=first @ self.covariance @ first.T + theirs @ following.covariance @ theirs.T,
        )

    def inverse(self) -> Self:
        """Return the map from the reference clock to the other."""
        turned = -1.0 / (1.0 + self.drift)
        slopes = np.array([[turned, 0.0], [0.0, -(turned**2)]])
        return replace(
            self,
            offset_s=-self.offset_s,
            drift=-1.0 - turned,
            middle_s=self.middle_s + self.offset_s,
            covariance=slopes @ self.covariance @ slopes.T,
        )


def _is_covariance(matrix: FloatArray) -> bool:
    if matrix.shape != (2, 2) or not np.all(np.isfinite(matrix)):
        return False
    (offset, both), (other, drift) = matrix.tolist()
    size = np.sqrt(max(offset, 0.0)) * np.sqrt(max(drift, 0.0))
    # what rounding leaves of a correlation of 1
    least = (1.0 + 1e-9) * size + np.finfo(np.float64).tiny
    return bool(min(offset, drift) >= 0.0 and abs(both) <= least and abs(both - other) <= 1e-9 * least)
