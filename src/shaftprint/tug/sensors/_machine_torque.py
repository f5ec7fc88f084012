"""The torque of an electric machine on the gearbox as its converter shows it."""

from typing import Self

import numpy as np
from numpy.typing import NDArray

from shaftprint.tug._shaft_machine import ShaftMachineTruth
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._physics import working_point
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.tug.sensors._counts import VOLT_PER_COUNT, LoggedChannel, as_counts
from shaftprint.tug.sensors._faults import Faultless
from shaftprint.tug.sensors._late import Late
from shaftprint.vessel._machine_torque import MachineTorqueSensor
from shaftprint.vessel._shaft_machine import ShaftMachine
from shaftprint.vessel._vessel import Vessel


class MachineTorque(Faultless):
    """Stream of the raw counts of the machine's torque, a latency late, with white noise."""

    @classmethod
    def of(cls, tug: Tug, vessel: Vessel, *, rate_hz: float, rng: np.random.Generator) -> Self | None:
        """Return the stream of a ship; None where it has no such machine or no channel of it."""
        sensor, geared, machine = vessel.sensors.machine_torque, vessel.shaft_machine, tug.shaft_machine
        if sensor is None or geared is None or machine is None:
            return None
        _, torque_nm = working_point(tug, vessel)
        return cls(sensor, geared, machine, torque_nm=torque_nm, rate_hz=rate_hz, rng=rng)

    def __init__(
        self,
        sensor: MachineTorqueSensor,
        geared: ShaftMachine,
        truth: ShaftMachineTruth,
        *,
        torque_nm: float,
        rate_hz: float,
        rng: np.random.Generator,
    ) -> None:
        words = "torque of the electric machine on the gearbox, from its converter"
        self.logged = LoggedChannel(name=sensor.channel, unit="V", long_name=words)
        self._sensor, self._rng = sensor, rng
        self._machine_nm = truth.shown / geared.shaft_nm(1.0)
        self._rms_nm = truth.shown_rms * torque_nm / geared.shaft_nm(1.0)
        self._late = Late(sensor.latency_s * rate_hz)

    def next(self, stretch: Stretch) -> NDArray[np.int16]:
        """Return the counts of the next stretch, shape (steps,)."""
        shown = self._machine_nm * self._late.next(stretch.machine_nm)
        shown += self._rms_nm * self._rng.standard_normal(shown.size)
        volts = (shown - self._sensor.torque_nm_at_zero_v) / self._sensor.torque_nm_per_v
        return as_counts(volts / VOLT_PER_COUNT)
