"""The torque of an electric machine on the gearbox, as its converter shows it, referred to the propeller shaft."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import frozen_float
from shaftprint.errors import SignalError
from shaftprint.signals._channel_signals import ChannelRole, ExcitationSignal
from shaftprint.signals.conditioning._condition import Reading
from shaftprint.signals.conditioning._outliers import FaultLimits, fault_limits
from shaftprint.signals.kinds._kind import ChannelKind, Source, SteadyState, conditioned_on, steady_parts
from shaftprint.vessel._machine_torque import MachineTorqueSensor

if TYPE_CHECKING:
    from shaftprint.signals._clock import Clock

# A share that is further from the vessel file's than this is another working point, or another scale.
_FARTHEST = 0.15


class MachineTorque(ChannelKind[MachineTorqueSensor]):
    """Torque of the electric machine at the propeller shaft [N m], as it is reached: its lag is in no response."""

    sensor, name, use, role = "machine_torque", "M_m", "torque of the electric machine", ChannelRole.EXCITATION

    def limits(self, source: Source[MachineTorqueSensor]) -> FaultLimits:
        """Return the limits of a voltage that may stand still."""
        return fault_limits(source.channel, holds=False)

    def read(self, source: Source[MachineTorqueSensor], clock: "Clock") -> Reading:
        """Return the torque on the grid."""
        sensor = source.sensor
        latency_s = clock.latency_s(sensor.latency_s)
        reading = conditioned_on(clock, source.channel, self.limits(source), latency_s)
        geared = self._geared(source)
        values = geared * (sensor.torque_nm_per_v * reading.values + sensor.torque_nm_at_zero_v)
        return replace(reading, values=values, gaps=tuple(gap.earlier(latency_s) for gap in reading.gaps))

    def signal(self, source: Source[MachineTorqueSensor], reading: Reading, steady: SteadyState) -> ExcitationSignal:
        """Return the torque over that of the shaft at the working point."""
        torque_nm = steady.working_point.shaft_torque_nm
        mean_nm = float(np.concatenate(steady_parts(reading.values, steady.clock, steady.stretches)).mean())
        share, machine = mean_nm / torque_nm, source.vessel.shaft_machine
        if machine is not None and abs(share - machine.share) > _FARTHEST:
            raise SignalError(
                f"channel {source.channel.name}: expected about {machine.share:g} of the shaft torque, "
                f"shaft_machine.share of the vessel file, found {share:.3g} of {torque_nm:.4g} N m; correct the share, "
                "torque_nm_per_v of sensors.machine_torque, or the ratio of the machine."
            )
        return ExcitationSignal(
            name=self.name,
            channel=source.channel.name,
            values=frozen_float(reading.values),
            reference=torque_nm,
            reference_std=steady.working_point.shaft_torque_std_nm,
            input=self.sensor,
            per_volt=self._geared(source) * source.sensor.torque_nm_per_v,
            from_engine=False,
            shown_unit="N m",
            shown_reference=torque_nm,
            share=share,
        )

    def _geared(self, source: Source[MachineTorqueSensor]) -> float:
        """Return the torque at the propeller shaft for one at the machine's."""
        machine = source.vessel.shaft_machine
        return 1.0 if machine is None else machine.shaft_nm(1.0)
