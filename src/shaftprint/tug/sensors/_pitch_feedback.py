"""The feedback of a controllable pitch: a voltage that follows the piston of its actuator."""

import math

import numpy as np
import scipy
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.tug._pitch_actuation import PitchActuation
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.tug.sensors._counts import VOLT_PER_COUNT, LoggedChannel, as_counts
from shaftprint.tug.sensors._faults import Faultless
from shaftprint.tug.sensors._late import Late
from shaftprint.vessel._pitch_sensors import PitchSensor


class PitchFeedback(Faultless):
    """Stream of the raw counts of the pitch, a latency late, with white noise and one that wanders slowly."""

    def __init__(
        self,
        sensor: PitchSensor,
        actuation: PitchActuation,
        *,
        pitch_ratio: float,
        rate_hz: float,
        rng: np.random.Generator,
    ) -> None:
        words = "feedback of the pitch of the propeller"
        self.logged = LoggedChannel(name=sensor.channel, unit="V", long_name=words)
        self._sensor, self._actuation, self._rest = sensor, actuation, pitch_ratio
        # before the start the pitch stood still
        self._late = Late(sensor.latency_s * rate_hz)
        self._rng = rng
        self._kept = math.exp(-1.0 / (rate_hz * actuation.sensor_wander_s))
        self._wander = float(actuation.sensor_wander_rms * rng.standard_normal())

    def next(self, stretch: Stretch) -> NDArray[np.int16]:
        """Return the counts of the next stretch, shape (steps,)."""
        shown = self._actuation.sensor_scale * self._late.next(stretch.pitch_change)
        shown += self._actuation.sensor_rms * self._rng.standard_normal(shown.size)
        shown += self._next_wander(shown.size)
        volts = (self._rest + shown - self._sensor.pitch_ratio_at_zero_v) / self._sensor.pitch_ratio_per_v
        return as_counts(volts / VOLT_PER_COUNT)

    def _next_wander(self, count: int) -> FloatArray:
        """Return the slow noise of the next samples, a first-order process that goes on from the last."""
        step = self._actuation.sensor_wander_rms * math.sqrt(1.0 - self._kept**2)
        wander: FloatArray
        wander, _ = scipy.signal.lfilter(
            [1.0], [1.0, -self._kept], step * self._rng.standard_normal(count), zi=[self._kept * self._wander]
        )
        self._wander = float(wander[-1])
        return wander
