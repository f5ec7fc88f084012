"""The campaign that a recording shows, from its set point alone."""

from dataclasses import replace
from typing import TYPE_CHECKING

from shaftprint.arguments import refusing_none
from shaftprint.errors import SignalError
from shaftprint.signals._channels import find_channel
from shaftprint.signals._clock import clock_of
from shaftprint.signals.description._describe import Description, described
from shaftprint.signals.kinds._set_point import read_set_point

if TYPE_CHECKING:
    from shaftprint.recording._recording import Recording
    from shaftprint.vessel._vessel import Vessel

# Rate at which the set point is looked at [Hz].
_LOOKED_HZ = 200.0


@refusing_none(SignalError)
def describe_set_point(recording: "Recording", vessel: "Vessel") -> Description:
    """Return the campaign that the recorded set point shows, and what of it no campaign file can describe.

    ``recording``: the raw recording, open. ``vessel``: says which channel is the set point, and what it is in volts of
    the campaign. Raises SignalError if the
    channel of the set point is missing, in another unit, or does not move, or if nothing in it is an excitation that a
    campaign file can describe.
    """
    sensor = vessel.sensors.set_point
    channel = find_channel(recording, sensor.channel, unit=sensor.unit, use="set point", takes_messages=True)
    if channel.is_uneven:
        clock = clock_of(channel, _LOOKED_HZ)
    else:
        # samples as they are: a filter would ring where the set point jumps
        every = max(round(channel.rate_hz / _LOOKED_HZ), 1)
        clock = replace(clock_of(channel, channel.rate_hz / every), mode="thesis")
    volts = read_set_point(channel, sensor, clock, speed_rpm=vessel.working_point.engine_speed_rpm).values
    try:
        return described(
            volts,
            rate_hz=clock.rate_hz,
            start_s=clock.start_s,
            name=recording.path.stem,
            sample_rate_hz=channel.rate_hz,
        )
    except SignalError as error:
        raise SignalError(f"channel {channel.name}: {error}") from None
