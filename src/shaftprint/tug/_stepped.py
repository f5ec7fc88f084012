"""A simulated ship that is stepped block by block, with a set point that is decided as it goes."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray
from pydantic import PrivateAttr

from shaftprint.arrays import FloatArray
from shaftprint.campaign._lever_course import LeverCourse
from shaftprint.tug._crew import Crew
from shaftprint.tug._truth import Truth
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._disturbance import Disturbance
from shaftprint.tug.plant._voyage import Stretch, acting, ready_line, sailed
from shaftprint.tug.sensors._counts import LoggedChannel
from shaftprint.vessel._vessel import Vessel

VoltsAt: TypeAlias = Callable[[FloatArray], FloatArray]
"""Gives the set point [V] at times since the start [s]."""

# Every latency of a lever and its bus is shorter.
_REMEMBERED_S = 10.0


class _Decided(LeverCourse):
    """A course of which only the past is known: what was put out block by block."""

    _pieces: deque[tuple[float, VoltsAt]] = PrivateAttr(default_factory=deque)

    def go_on(self, start_s: float, volts: VoltsAt) -> None:
        """Say what is put out from a time on [s]."""
        self._pieces.append((start_s, volts))
        while len(self._pieces) > 1 and self._pieces[1][0] < start_s - _REMEMBERED_S:
            self._pieces.popleft()

    def voltage(self, time_s: FloatArray) -> FloatArray:
        """Return what was put out [V], shape of the times [s]; the course's own value before the first piece."""
        volts = super().voltage(time_s)
        place = np.searchsorted([start_s for start_s, _ in self._pieces], time_s, side="right") - 1
        for number in np.unique(place[place >= 0]).tolist():
            inside = place == number
            volts[inside] = self._pieces[number][1](time_s[inside])
        return volts


@dataclass(frozen=True, kw_only=True, slots=True)
class SteppedChannel(LoggedChannel):
    """A channel of the log of a stepped ship, sampled evenly."""

    rate_hz: float
    start_s: float


class SteppedTug:
    """A simulated ship with its sensors, stepped by blocks of samples."""

    def __init__(self, tug: Tug, vessel: Vessel, *, first_v: float, duration_s: float, seed: int) -> None:
        """Let the line run steadily.

        ``tug``, ``vessel``: the truth and the installation. ``first_v``: set point at the start [V]. ``duration_s``:
        longest time that it is sailed [s]. ``seed``: of all randomness. Raises SettingsError if the truth is not
        physical.
        """
        self._course = _Decided(
            name="live", duration_s=duration_s, offset_v=first_v, corner_s=(0.0,), corner_v=(first_v,)
        )
        self._crew = Crew(tug, vessel, self._course, seed=seed)
        self.rate_hz = self._crew.rate_hz
        """Samples a second of the log [Hz]."""
        self._step_s = 1.0 / self.rate_hz
        self._line = ready_line(tug, vessel, self._course, step_s=self._step_s, start_s=0.0)
        self._disturbance = Disturbance(tug.noise, self._step_s, self._crew.process)
        self.gear_ratio = vessel.gearbox.ratio
        """Speed of the engine over that of the propeller shaft."""
        self._done = 0
        self._log = _Log()
        self._crew.declare(cast("Any", self._log))

    @property
    def channels(self) -> tuple[SteppedChannel, ...]:
        """The channels of its log."""
        return tuple(self._log.channels.values())

    @property
    def time_s(self) -> float:
        """Time that it has sailed [s]."""
        return self._done * self._step_s

    @property
    def truth(self) -> Truth:
        """What was put into its log so far."""
        return self._crew.truth()

    def step(self, steps: int, volts: VoltsAt) -> tuple[Stretch, dict[str, NDArray[np.int16]]]:
        """Sail on by a number of samples.

        ``volts``: set point [V] over time since the start [s]. Returns what really happened, and the counts of each
        channel of the log.
        """
        self._course.go_on(self.time_s, volts)
        acts = acting(self._disturbance, self._line, steps)
        stretch = sailed(self._line, acts, steps, first=self._done, start_s=0.0, step_s=self._step_s)
        self._done += steps
        self._crew.write(cast("Any", self._log), stretch)
        return stretch, self._log.taken()


class _Log:
    """What a crew writes into: channels, and the counts since they were last taken."""

    def __init__(self) -> None:
        self.channels: dict[str, SteppedChannel] = {}
        self._counts: dict[str, NDArray[np.int16]] = {}

    def declare(self, name: str, *, times: Literal["by rate", "uneven"], **declared: Any) -> None:
        if times == "by rate":
            self.channels[name] = SteppedChannel(name=name, **declared)

    def append(self, name: str, counts: NDArray[np.int16], time_s: FloatArray | None = None) -> None:
        if name in self.channels:
            self._counts[name] = counts

    def taken(self) -> dict[str, NDArray[np.int16]]:
        counts, self._counts = self._counts, {}
        return counts
