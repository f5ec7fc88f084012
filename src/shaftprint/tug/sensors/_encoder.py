"""An encoder that shows the angle of a shaft: counts of its counter, or an angle in 16 bits."""

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.errors import SettingsError
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.tug.sensors._counts import LoggedChannel
from shaftprint.tug.sensors._faults import Faultless
from shaftprint.tug.sensors._late import Late
from shaftprint.tug.sensors._turns import motion_of, turns_of
from shaftprint.vessel._sensors import SpeedSensor
from shaftprint.vessel._vessel import Vessel

# Values of a channel of 16 bits; the lowest stands for an angle of 0.
_VALUES, _LOWEST = 65_536, -32_768


class Encoder(Faultless):
    """Stream of the raw counts of one angle, a latency late, with white noise."""

    def __init__(
        self, sensor: SpeedSensor, tug: Tug, vessel: Vessel, *, rate_hz: float, rng: np.random.Generator
    ) -> None:
        turn = 1.0 / sensor.rev_per_unit
        whole = turn if sensor.rolls_over_at is None else sensor.rolls_over_at
        scale = 1.0 if sensor.unit == "counts" else whole / _VALUES
        if whole > _VALUES * scale:
            raise SettingsError(
                f"vessel {vessel.name}: expected rolls_over_at of at most {_VALUES} counts for channel "
                f"{sensor.channel}, which is simulated in 16 bits, found {whole:g}."
            )
        self.logged = LoggedChannel(
            name=sensor.channel,
            unit=sensor.unit,
            scale=scale,
            offset=-_LOWEST * scale,
            long_name=f"angle of the {sensor.shaft} shaft",
        )
        self._sensor, self._turns = sensor, turns_of(sensor, vessel)
        self._counts_per_rev, self._counts = turn / scale, whole / scale
        self._phase_rev = float(rng.uniform())
        self._error_rev = tug.encoder_error_deg / 360.0
        self._rate_hz, self._late = rate_hz, Late(sensor.latency_s * rate_hz)
        self._rng = rng

    def next(self, stretch: Stretch) -> NDArray[np.int16]:
        """Return the counts of the next stretch, shape (steps,)."""
        # before the start the line ran steadily
        speed_rev_s, angle_rev = motion_of(self._sensor, stretch)
        step = self._turns * speed_rev_s[0] / self._rate_hz
        shown = self._late.next(self._turns * angle_rev, before=step)
        shown += self._phase_rev + self._error_rev * self._rng.standard_normal(shown.size)
        counts: FloatArray = np.floor(shown * self._counts_per_rev) % self._counts
        return (counts + _LOWEST).astype(np.int16)
