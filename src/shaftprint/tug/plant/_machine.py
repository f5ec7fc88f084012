"""The electric machine on the gearbox: from the voltage that asks for its torque to the shaft, behind a lag."""

import numpy as np
import scipy

from shaftprint.arrays import FloatArray
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._setpoint import setpoint
from shaftprint.errors import SettingsError
from shaftprint.tug._tug import Tug
from shaftprint.vessel._vessel import Vessel

INPUT = "machine_torque"


class GearedMachine:
    """Stream of the machine's torque at the propeller shaft [N m] on half steps, behind delay and lag.

    Where it is not moved, and where there is none, the torque is what it is at the working point.
    """

    def __init__(
        self,
        tug: Tug,
        vessel: Vessel,
        campaign: Campaign,
        steady_nm: float,
        *,
        start_s: float,
        step_s: float,
    ) -> None:
        self._steady_nm, self._campaign = steady_nm, campaign
        self._half_step_s, self._start_s, self._count = 0.5 * step_s, start_s, 0
        self._moves = INPUT in campaign.inputs
        sensor, machine, geared = vessel.sensors.machine_torque, tug.shaft_machine, vessel.shaft_machine
        if not self._moves:
            return
        if sensor is None or machine is None or geared is None:
            raise SettingsError(
                f"campaign {campaign.name}: expected a vessel with [shaft_machine] and [sensors.{INPUT}] where the "
                f"torque of a machine on the gearbox is moved, found none; leave out the sines of {INPUT}."
            )
        self._nm_per_v = geared.shaft_nm(1.0) * sensor.torque_nm_per_v
        self._delay_s, self._middle_v = machine.delay_s, campaign.middle_v(INPUT)
        # a lag of values that are joined by straight lines
        ratio = self._half_step_s / machine.torque_time_s
        kept = float(np.exp(-ratio))
        ramp = 1.0 - (1.0 - kept) / ratio
        self._filter = [ramp, 1.0 - kept - ramp], [1.0, -kept]
        first = self._asked(np.array([start_s]))
        # before the start it stood still
        self._state = np.array([(1.0 - kept - ramp + kept) * first[0]])
        self._last = float(first[0])

    def next(self, steps: int) -> FloatArray:
        """Return the torque at the nodes and middles of the next steps, shape (2 steps + 1,)."""
        torque: FloatArray = np.full(2 * steps + 1, self._steady_nm)
        if not self._moves:
            return torque
        half_steps = np.arange(self._count + 1, self._count + 2 * steps + 1, dtype=np.float64)
        followed, self._state = scipy.signal.lfilter(
            *self._filter, self._asked(self._start_s + self._half_step_s * half_steps), zi=self._state
        )
        torque[0] += self._last
        torque[1:] += followed
        self._count += 2 * steps
        self._last = float(followed[-1])
        return torque

    def _asked(self, time_s: FloatArray) -> FloatArray:
        """Return what is asked for beyond the torque of the working point, after the delay [N m]."""
        voltage = setpoint(self._campaign, time_s - self._delay_s, input=INPUT)
        asked: FloatArray = self._nm_per_v * (voltage - self._middle_v)
        return asked
