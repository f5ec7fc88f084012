"""A segment of service: one move of the lever with what speed and torque did around it."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, frozen_bool, frozen_float
from shaftprint.time_domain._decimator import Decimator
from shaftprint.time_domain._record import Record


@dataclass(frozen=True, kw_only=True, slots=True)
class LeverLine:
    """The speed that the lever asks for, found where it stands still: a line that may bend."""

    slope_rev_s_per_v: float
    """Speed for one volt [rev/s per V]."""
    middle_v: float
    """Set point about which it is counted [V]."""
    middle_rev_s: float
    """Speed there [rev/s]."""
    spread_rpm: float
    """Scatter of the still stretches about the line [rpm]."""
    stretches: int
    """How many there were."""
    bend_per_v: float = 0.0
    """Share by which the slope grows for one volt, from the middle on [1/V]."""

    def speed_rev_s(self, volts: FloatArray) -> FloatArray:
        """Return the speed [rev/s] that set points [V] ask for, of any shape."""
        moved = volts - self.middle_v
        return np.asarray(self.middle_rev_s + self.slope_rev_s_per_v * moved * (1.0 + 0.5 * self.bend_per_v * moved))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Segment:
    """One move of the lever and what followed."""

    log: str
    """File in which it ends."""
    start_s: float
    """Time of its first sample, in seconds of the file."""
    move_s: float
    """When the lever began to move [s]."""
    move_end_s: float
    """When it had stopped [s]."""
    rate_hz: float
    """Samples a second of the lever [Hz]."""
    every: int
    """Samples of the lever for one of speed and torque."""
    lever_v: FloatArray
    """Set point [V], with the margin of the filter at both ends, shape (fine samples,)."""
    speed_rev_s: FloatArray
    """Engine speed [rev/s], shape (samples,)."""
    torque_nm: FloatArray
    """Shaft torque without its orders [N m], shape (samples,)."""
    state: str
    """What the ship was doing."""
    reason: str = ""
    """Why it is not used; empty where it is."""

    @property
    def name(self) -> str:
        """How tables and messages call it."""
        return f"{self.log} at {self.move_s:.1f} s"

    @property
    def seconds(self) -> float:
        """Length of what is compared [s]."""
        return self.speed_rev_s.size * self.every / self.rate_hz

    def load(
        self,
        *,
        speed_rev_s: float,
        torque_nm: float,
        inertia_time_s: float,
        taken: Callable[[FloatArray], FloatArray],
    ) -> float:
        """Return the torque of the propeller over what it takes at this speed, as ``record`` states it."""
        n, torque = self.speed_rev_s / speed_rev_s - 1.0, self.torque_nm / torque_nm - 1.0
        gained = inertia_time_s * (n[-1] - n[0]) / self.seconds
        return (1.0 + float(np.mean(torque)) - float(gained)) / float(np.mean(taken(n)))

    def record(
        self,
        line: LeverLine,
        *,
        speed_rev_s: float,
        torque_nm: float,
        inertia_time_s: float,
        taken: Callable[[FloatArray], FloatArray],
    ) -> Record:
        """Return it as a record of deviations, its load without the torque that accelerates the propeller.

        ``line``: what the lever asks for. ``speed_rev_s``, ``torque_nm``: engine speed [rev/s] and shaft torque [N m]
        of the working point. ``inertia_time_s``: that behind the gauge [s]. ``taken``: from shaft speeds to what the
        propeller takes in steady running, deviations and torques over those of the working point.
        """
        decimator = Decimator(every=self.every)
        drive = line.speed_rev_s(self.lever_v) / speed_rev_s - 1.0
        n, torque = self.speed_rev_s / speed_rev_s - 1.0, self.torque_nm / torque_nm - 1.0
        load = self.load(speed_rev_s=speed_rev_s, torque_nm=torque_nm, inertia_time_s=inertia_time_s, taken=taken)
        return Record(
            name=self.name,
            rate_hz=self.rate_hz / self.every,
            start_s=self.start_s,
            inputs={"n_set": frozen_float(decimator.filtered(drive))},
            outputs={"n": frozen_float(n), "M_s": frozen_float(torque)},
            used=frozen_bool(np.ones(n.size, dtype=np.bool_)),
            drive={"n_set": frozen_float(drive)},
            every=self.every,
            load=load,
            engine_speed_rev_s=speed_rev_s,
            shaft_torque_nm=torque_nm,
        )
