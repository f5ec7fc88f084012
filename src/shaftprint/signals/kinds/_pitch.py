"""The pitch of a controllable-pitch propeller: its set point, from the voltage that asks for it, and its feedback."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import SignalError
from shaftprint.signals._channel_signals import ChannelRole, ChannelSignal, ExcitationSignal
from shaftprint.signals.conditioning._condition import Reading
from shaftprint.signals.conditioning._outliers import FaultLimits, fault_limits
from shaftprint.signals.kinds._kind import ChannelKind, Source, SteadyState, conditioned_on, steady_parts
from shaftprint.signals.kinds._set_point import read_voltage
from shaftprint.vessel._pitch_sensors import PitchSensor, PitchSetPointSensor

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
        mean = _mean_ahead(source.channel.name, reading.values, steady)
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


class Pitch(ChannelKind[PitchSensor]):
    """Pitch over diameter that the blades have [-], as the feedback of its actuator shows it.

    The set point of the speed leaves it, but for a lever that asks for both.
    """

    sensor, name, use, role = "pitch", "theta", "pitch", ChannelRole.SIDE

    def limits(self, source: Source[PitchSensor]) -> FaultLimits:
        """Return the limits of a voltage that may stand still."""
        return fault_limits(source.channel, holds=False)

    def read(self, source: Source[PitchSensor], clock: "Clock") -> Reading:
        """Return the pitch on the grid."""
        sensor = source.sensor
        latency_s = clock.latency_s(sensor.latency_s)
        reading = conditioned_on(clock, source.channel, self.limits(source), latency_s)
        values = sensor.pitch_ratio_per_v * reading.values + sensor.pitch_ratio_at_zero_v
        return replace(reading, values=values, gaps=tuple(gap.earlier(latency_s) for gap in reading.gaps))

    def signal(self, source: Source[PitchSensor], reading: Reading, steady: SteadyState) -> ChannelSignal:
        """Return the pitch over its mean in the stretches at the working point."""
        return ChannelSignal(
            name=self.name,
            channel=source.channel.name,
            role=self.role,
            values=frozen_float(reading.values),
            reference=_mean_ahead(source.channel.name, reading.values, steady),
            # a lever that asks for speed and pitch moves both
            moved_by=PitchSetPoint.name if source.vessel.combinator is None else "",
        )


def _mean_ahead(channel: str, pitch_ratio: FloatArray, steady: SteadyState) -> float:
    """Return the mean pitch in the stretches at the working point.

    Raises SignalError if it is none ahead.
    """
    mean = float(np.concatenate(steady_parts(pitch_ratio, steady.clock, steady.stretches)).mean())
    if not mean > 0.0:
        raise SignalError(
            f"channel {channel}: expected a pitch ahead while the line stands still, found P/D = {mean:.3g}; correct "
            "pitch_ratio_per_v and pitch_ratio_at_zero_v in the vessel file."
        )
    return mean
