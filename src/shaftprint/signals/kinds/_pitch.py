"""The set point of the pitch of a controllable-pitch propeller, from the voltage that asks for it."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import frozen_float
from shaftprint.errors import SignalError
from shaftprint.signals._channel_signals import ChannelRole, ExcitationSignal
from shaftprint.signals.conditioning import FaultLimits, Reading, fault_limits
from shaftprint.signals.kinds._kind import ChannelKind, Source, SteadyState, steady_parts
from shaftprint.signals.kinds._set_point import read_voltage
from shaftprint.vessel import PitchSetPointSensor

if TYPE_CHECKING:
    from shaftprint.signals._clock import Clock


class PitchSetPoint(ChannelKind[PitchSetPointSensor]):
    """Pitch over diameter that is asked for [-]; its working point is its mean while the line stands still."""

    sensor, name, use, role = "pitch_set_point", "theta_set", "pitch set point", ChannelRole.EXCITATION

    def limits(self, source: Source[PitchSetPointSensor]) -> FaultLimits:
        """Return the limits of a voltage that may stand still."""
        return fault_limits(source.channel, holds=False)

    def read(self, source: Source[PitchSetPointSensor], clock: "Clock") -> Reading:
        """Return the pitch on the grid."""
        reading = read_voltage(source.channel, clock)
        values = reading.values
        # in place: the signals of a whole test are large
        values *= source.sensor.pitch_ratio_per_v
        values += source.sensor.pitch_ratio_at_zero_v
        return reading

    def signal(self, source: Source[PitchSetPointSensor], reading: Reading, steady: SteadyState) -> ExcitationSignal:
        """Return the pitch over its mean in the stretches at the working point."""
        mean = float(np.concatenate(steady_parts(reading.values, steady.clock, steady.stretches)).mean())
        if not mean > 0.0:
            raise SignalError(
                f"channel {source.channel.name}: expected a pitch ahead while the line stands still, found P/D = "
                f"{mean:.3g}; correct pitch_ratio_per_v and pitch_ratio_at_zero_v in the vessel file."
            )
        return ExcitationSignal(
            name=self.name,
            channel=source.channel.name,
            values=frozen_float(reading.values),
            reference=mean,
            input=self.sensor,
            per_volt=source.sensor.pitch_ratio_per_v,
            scale_std=source.sensor.scale_std_fraction,
            scale_error="pitch calibration",
            from_engine=False,
            shown_unit="P/D",
            shown_reference=mean,
        )
