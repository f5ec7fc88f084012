"""The set point of a test as a polyline with jumps, and what a limit of its rate makes of it.

The limit of the rate lies before the governor and outside of its loop, so that what the governor gets follows from the
recorded set point alone. It is worked out on the polyline, exact between two samples: on the grid of a simulation a
ramp begins a share of a step early, which at 100 Hz made rates up to 5 % too low.
"""

from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.kernels._compiled import compiled
from shaftprint.time_domain._decimator import Decimator
from shaftprint.time_domain._record import Record


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class GovernorRecord(Record):
    """A record whose set point may have a limited rate."""

    corner_time_s: FloatArray
    """Corners of the set point [s]; a jump has two of one time, shape (corners,)."""
    corner_value: FloatArray
    """The set point there [-], shape (corners,)."""

    def coarser(self) -> "GovernorRecord":
        """Return the record with every other sample of its drive, or with all where they cannot be halved."""
        half = Decimator(every=self.every // 2)
        ahead = 2 * half.half - self.margin
        if self.every % 2 or ahead < 0:
            return self
        drive = {name: frozen_float(np.pad(values, ahead, mode="edge")[::2]) for name, values in self.drive.items()}
        return replace(self, every=half.every, drive=drive)

    def set_point_at(self, rate_per_s: float) -> FloatArray:
        """Return the set point that changes no faster than a rate [1/s], on the drive's grid, shape (samples,)."""
        limited = rate_limited(self.corner_time_s, self.corner_value, rate_per_s)
        time = self.start_s - self.margin / self.drive_rate_hz + self.drive_time_s
        return frozen_float(np.interp(time, self.corner_time_s, limited))


def rate_limited(time_s: FloatArray, value: FloatArray, rate_per_s: float) -> FloatArray:
    """Return a signal that follows a polyline no faster than a rate, at its corners.

    It moves towards the polyline at the rate until it meets it, and from there with it or, where the polyline is
    faster, again at the rate.

    ``time_s``, ``value``: corners, the times in order [s]; two of one time are a jump, shape (corners,).
    ``rate_per_s``: fastest change, in the unit of the values a second.
    """
    limited = np.empty(value.size)
    _follow(np.diff(time_s), np.asarray(value, dtype=np.float64), float(rate_per_s), limited)
    return limited


@compiled(nogil=True)
def _follow(lasts, value, rate, limited) -> None:  # type: ignore[no-untyped-def]
    at = value[0]
    limited[0] = at
    for k in range(lasts.size):
        reach = rate * lasts[k]
        rise = value[k + 1] - value[k]
        if rise > reach:
            # a polyline from below passes on its way up; until then the signal comes down towards it
            until = min(max((at - value[k]) * lasts[k] / (rise + reach), 0.0), lasts[k])
            at += reach - 2.0 * rate * until
        elif rise < -reach:
            until = min(max((value[k] - at) * lasts[k] / (reach - rise), 0.0), lasts[k])
            at += 2.0 * rate * until - reach
        else:
            at += min(max(value[k + 1] - at, -reach), reach)
        limited[k + 1] = at
