"""What a block shows: set point, engine speed, shaft torque and other channels in physical units, as it comes."""

from collections import deque
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.live._block import Block, LiveChannel
from shaftprint.vessel._sensors import SpeedSensor
from shaftprint.vessel._vessel import Vessel

# Intervals between pulses of which the middle one counts: a missing or doubled pulse makes no speed.
_INTERVALS = 3
# Crests and troughs of pulses are looked for over so many samples.
_LEVEL_SAMPLES = 4000


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Sight:
    """What one block shows."""

    block: Block
    """The block."""
    set_point_v: float
    """Mean of the logged set point [V of the campaign]."""
    speed_rpm: float
    """Engine speed [rpm]; not a number before the first turns."""
    torque_nm: float
    """Shaft torque [N m], mean over a turn of the propeller shaft: without the orders of engine and shaft."""
    means: dict[str, float]
    """Mean of every channel in its unit; not a number where a sample is none."""

    @property
    def time_s(self) -> float:
        """End of the block, by the counterpart's clock [s]."""
        return self.block.stop_s


class Observer:
    """Turns blocks into what they show; it keeps what it needs of those before."""

    def __init__(self, vessel: Vessel, channels: tuple[LiveChannel, ...]) -> None:
        """Look for the sensors of a vessel file among the channels of a counterpart.

        A sensor whose channel is not sent gives no number; `missing` names it.
        """
        self._vessel = vessel
        self._by_name = {one.name: one for one in channels}
        sensors = vessel.sensors
        needed = (sensors.set_point.channel, sensors.shaft_torque.channel)
        self.missing = tuple(name for name in needed if name not in self._by_name)
        """Channels of the vessel file that the counterpart does not send."""
        sent = [one for one in sensors.speed if one.channel in self._by_name and not one.gives_angle]
        if not sent:
            self.missing += (sensors.speed[0].channel,)
        self._speed = min(sent, key=self._turn_s) if sent else None
        """The sensor that shows a change of speed first."""
        self._pulses = _Pulses(self._speed) if self._speed is not None and self._speed.gives_pulses else None
        turn_s = 60.0 * vessel.gearbox.ratio / vessel.working_point.engine_speed_rpm
        torque = self._by_name.get(sensors.shaft_torque.channel)
        self._tail: FloatArray = np.empty(0)
        self._counter: int | None = None
        self._turn_samples = 1 if torque is None else max(1, round(turn_s * torque.rate_hz))

    @property
    def speed_channel(self) -> str:
        """Channel of the speed that is watched."""
        return "" if self._speed is None else self._speed.channel

    def _turn_s(self, sensor: SpeedSensor) -> float:
        ratio = self._vessel.gearbox.ratio if sensor.shaft == "propeller" else 1.0
        return ratio if sensor.gives_pulses else 0.0

    def see(self, block: Block) -> Sight:
        """Return what a block shows."""
        sensors = self._vessel.sensors
        if self._counter is not None and block.counter != self._counter + 1:
            # across lost blocks there is neither an interval between pulses nor a turn of the shaft
            self._tail = np.empty(0)
            if self._pulses is not None:
                self._pulses.begin_anew()
        self._counter = block.counter
        values = {name: block.values(channel) for name, channel in self._by_name.items()}
        set_point = sensors.set_point.volts(values.get(sensors.set_point.channel, np.empty(0)))
        torque = self._vessel.driving_torque_nm(values.get(sensors.shaft_torque.channel, np.empty(0)))
        self._tail = np.concatenate([self._tail, torque])[-self._turn_samples :]
        return Sight(
            block=block,
            set_point_v=_mean(set_point),
            speed_rpm=self._speed_rpm(block, values),
            torque_nm=_mean(self._tail),
            means={name: _mean(one) for name, one in values.items() if one.size},
        )

    def _speed_rpm(self, block: Block, values: dict[str, FloatArray]) -> float:
        sensor = self._speed
        if sensor is None:
            return float("nan")
        shown, rate_hz = values[sensor.channel], self._by_name[sensor.channel].rate_hz
        if self._pulses is None:
            rev_s = _mean(sensor.speed_rev_s(shown))
        else:
            rev_s = self._pulses.speed_rev_s(block.source_s, shown, rate_hz)
        return 60.0 * rev_s * (self._vessel.gearbox.ratio if sensor.shaft == "propeller" else 1.0)


class _Pulses:
    """Speed of a shaft from the times between pulses, over whole turns."""

    def __init__(self, sensor: SpeedSensor) -> None:
        self._per_turn = sensor.pulses_per_revolution
        self._edges: deque[float] = deque(maxlen=self._per_turn + _INTERVALS)
        self._levels: FloatArray = np.empty(0)
        self._last: float | None = None

    def begin_anew(self) -> None:
        """Forget the pulses so far: what lies between them and the next is not known."""
        self._edges.clear()
        self._last = None

    def speed_rev_s(self, start_s: float, volts: FloatArray, rate_hz: float) -> float:
        """Return the speed after more samples [rev/s]; not a number before the first turns."""
        if not volts.size or not np.isfinite(volts).all():
            return float("nan")
        self._levels = np.concatenate([self._levels, volts])[-_LEVEL_SAMPLES:]
        middle = 0.5 * (float(self._levels.min()) + float(self._levels.max()))
        before = volts[:1] if self._last is None else np.array([self._last])
        high = np.concatenate([before, volts])
        rises = np.flatnonzero((high[:-1] < middle) & (high[1:] >= middle))
        for place in rises.tolist():
            part = (middle - high[place]) / (high[place + 1] - high[place])
            self._edges.append(start_s + (place - 1 + part) / rate_hz)
        self._last = float(volts[-1])
        return self._over_turns(start_s + volts.size / rate_hz)

    def _over_turns(self, now_s: float) -> float:
        edges = np.array(self._edges)
        turns = edges[self._per_turn :] - edges[: -self._per_turn] if edges.size > self._per_turn else np.empty(0)
        if turns.size < _INTERVALS:
            return float("nan")
        turn_s = float(np.median(turns))
        # where no pulse comes any more, the shaft is slower than one that would have given it by now
        waiting_s = (now_s - float(edges[-1])) * self._per_turn
        return 1.0 / max(turn_s, waiting_s if waiting_s > 2.0 * turn_s else 0.0)


def _mean(values: FloatArray) -> float:
    return float(values.mean()) if values.size else float("nan")
