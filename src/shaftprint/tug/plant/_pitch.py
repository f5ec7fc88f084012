"""The pitch of a controllable-pitch propeller: from the voltage that asks for it to the blades, behind a lag."""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.campaign import Campaign, setpoint
from shaftprint.errors import SettingsError
from shaftprint.kernels import compiled
from shaftprint.tug._tug import Tug
from shaftprint.vessel import Vessel

INPUT = "pitch_set_point"
_ROUNDING = 1e-9


@compiled(nogil=True)
def lag(asked: FloatArray, last_asked, pitch, kept, ramp) -> None:  # type: ignore[no-untyped-def]
    """Write what a first-order lag makes of values that are joined by straight lines, in place."""
    for j in range(asked.size):
        now = asked[j]
        pitch = kept * pitch + (1.0 - kept) * last_asked + ramp * (now - last_asked)
        last_asked = now
        asked[j] = pitch


class PitchActuator:
    """Stream of the pitch on half steps, as the deviation of ``P/D`` from that of the propeller's curves.

    A vessel without controllable pitch keeps it: all values are zero.
    """

    def __init__(self, tug: Tug, vessel: Vessel, campaign: Campaign, *, start_s: float, step_s: float) -> None:
        self._sensor = vessel.sensors.pitch_set_point
        self._campaign = campaign
        self._start_s = start_s
        self._half_step_s = 0.5 * step_s
        self._count = 0
        moves = INPUT in campaign.inputs
        if moves and (self._sensor is None or tug.sailing is None):
            raise SettingsError(
                f"campaign {campaign.name}: expected a vessel with [sensors.{INPUT}] and a tug that sails free where "
                "the pitch is moved, found none; leave out the sines of the pitch."
            )
        self._moves, self._pitch, self._asked = moves, 0.0, 0.0
        if not moves or tug.sailing is None:
            return
        self._rest = tug.sailing.pitch_ratio
        self._pitch = self._asked = float(self._deviation(np.array([start_s]))[0])
        if abs(self._pitch) > _ROUNDING:
            raise SettingsError(
                f"campaign {campaign.name}: expected a pitch of {self._rest:g} at {start_s:g} s, that of the tug's "
                f"curves, found {self._rest + self._pitch:.6g}; change further_offsets_v.{INPUT}."
            )
        ratio = self._half_step_s / tug.sailing.pitch_lag_s
        self._kept = float(np.exp(-ratio))
        self._ramp = 1.0 - (1.0 - self._kept) / ratio

    def next(self, steps: int) -> FloatArray:
        """Return the deviation of ``P/D`` at the nodes and middles of the next steps, shape (2 steps + 1,)."""
        values: FloatArray = np.zeros(2 * steps + 1)
        if not self._moves:
            return values
        values[0] = self._pitch
        half_steps = np.arange(self._count + 1, self._count + 2 * steps + 1, dtype=np.float64)
        pitch = self._deviation(self._start_s + self._half_step_s * half_steps)
        last = float(pitch[-1])
        lag(pitch, self._asked, self._pitch, self._kept, self._ramp)
        values[1:] = pitch
        self._count += 2 * steps
        self._pitch, self._asked = float(pitch[-1]), last
        return values

    def _deviation(self, time_s: FloatArray) -> FloatArray:
        if self._sensor is None:
            return np.zeros(time_s.size)
        voltage = setpoint(self._campaign, time_s, input=INPUT)
        pitch: FloatArray = self._sensor.pitch_ratio_at_zero_v + self._sensor.pitch_ratio_per_v * voltage - self._rest
        return pitch
