"""The set point of the speed, from what asks the governor for it: a voltage, or messages of a bus.

Messages are joined by a cubic spline. Their steps are no noise under a slow sine, whose values stay the same for many
messages: what they do to a sine is found from its course and taken out, where the campaign is known
(``excitation/_quantum.py``).
"""

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from shaftprint.arrays import frozen_float
from shaftprint.errors import SignalError
from shaftprint.signals._channel_signals import ChannelRole, ExcitationSignal
from shaftprint.signals._channels import middle_of
from shaftprint.signals.conditioning._condition import Reading
from shaftprint.signals.conditioning._outliers import FaultLimits, fault_limits
from shaftprint.signals.kinds._kind import ChannelKind, Source, SteadyState, conditioned_on
from shaftprint.signals.kinds._message_reading import expect_within, read_messages
from shaftprint.signals.kinds._splined_messages import comes_in_messages, splined
from shaftprint.units import MILLI, rpm_from_rev_s
from shaftprint.vessel._set_point import SetPointSensor

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.signals._clock import Clock

# Of a percentage, values above say "error" and "not available" (SAE J1939-71).
_HIGHEST_PERCENT = 101.0
# What the middle of a set point in mV is at least; below it is a share.
_FEWEST_MILLIVOLTS = 101.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SetPointMessages(Reading):
    """A set point that came in messages, in volts of the campaign [V]."""

    step_v: float
    """Step of the values [V]; 0 where they have none, or are what the governor obeys."""


class SetPoint(ChannelKind[SetPointSensor]):
    """Engine speed that is asked for [rev/s]; its line from the voltage is found in the recording."""

    sensor, name, use, role, needed = "set_point", "n_set", "set point", ChannelRole.EXCITATION, True
    takes_messages = True

    def limits(self, source: Source[SetPointSensor]) -> FaultLimits | None:
        """Return the limits of a voltage that may stand still; nothing for messages."""
        if source.channel.is_uneven:
            return None
        return fault_limits(source.channel, holds=False)

    def read(self, source: Source[SetPointSensor], clock: "Clock") -> Reading:
        """Return the set point on the grid, in volts of the campaign [V]."""
        speed_rpm = source.vessel.working_point.engine_speed_rpm
        return read_set_point(source.channel, source.sensor, clock, speed_rpm=speed_rpm)

    def signal(self, source: Source[SetPointSensor], reading: Reading, steady: SteadyState) -> ExcitationSignal:
        """Return the set point, whose values have become a speed by its line."""
        calibration, scale, speed_rev_s = steady.calibration, steady.scale, steady.working_point.engine_speed_rev_s
        return ExcitationSignal(
            name=self.name,
            channel=source.channel.name,
            values=frozen_float(reading.values),
            reference=speed_rev_s,
            reference_std=steady.working_point.engine_speed_std_rev_s,
            per_volt=calibration.slope_rev_s_per_v,
            scale_std=scale.std / scale.value,
            shown_unit="rpm",
            shown_reference=rpm_from_rev_s(speed_rev_s),
            value_rate_hz=reading.value_rate_hz,
            is_obeyed=isinstance(reading, SetPointMessages) and source.sensor.is_obeyed,
        )


def read_set_point(channel: "Channel", sensor: SetPointSensor, clock: "Clock", *, speed_rpm: float) -> Reading:
    """Return the set point of the speed on the grid, in volts of the campaign [V].

    ``channel``, ``sensor``: the channel, and what the vessel file says of it. ``clock``: the grid. ``speed_rpm``:
    engine speed of the working point [rpm]. Raises SignalError if the values cannot be in the unit that is stated; the
    message names one that would fit.
    """
    middle = middle_of(channel)
    unit = sensor.unit_that_fits(middle, speed_rpm)
    if unit is not None:
        line = "" if unit == "V" else f", with v_per_unit for one {unit}"
        raise SignalError(
            f"channel {channel.name}: expected a set point in {sensor.unit}, found {middle:.4g}; "
            f"{unit} would fit, if recording and sensors.set_point state it{line}{_milli_words(middle, sensor)}."
        )
    if comes_in_messages(channel, clock):
        return _read_messages(channel, sensor, clock)
    reading = read_voltage(channel, clock)
    return replace(reading, values=sensor.volts(reading.values))


def _milli_words(middle: float, sensor: SetPointSensor) -> str:
    """Return that a set point in V may be one in mV which was called V, where it is too large for V."""
    if sensor.unit != "V" or abs(middle) < _FEWEST_MILLIVOLTS:
        return ""
    return f", or V with v_per_unit = {sensor.slope_v / MILLI:g} where these are mV"


def _read_messages(channel: "Channel", sensor: SetPointSensor, clock: "Clock") -> SetPointMessages:
    """Return a set point that came in messages, in volts of the campaign [V]."""
    latency_s = clock.latency_s(sensor.message_latency_s)
    highest = _HIGHEST_PERCENT if sensor.unit == "%" else math.inf
    came = read_messages(channel, highest=highest)
    expect_within(came, channel, highest=highest)
    on_grid = splined(came, channel, clock, latency_s)
    in_volts = on_grid.of(sensor.volts, earlier_s=latency_s)
    return SetPointMessages(
        values=in_volts.values,
        repairs=(),
        gaps=in_volts.gaps,
        findings=came.findings if channel.is_uneven else (),
        sent=in_volts.sent,
        step_v=0.0 if sensor.is_obeyed else abs(sensor.slope_v) * came.messages.step,
    )


def read_voltage(channel: "Channel", clock: "Clock") -> Reading:
    """Return the voltage of a set point on the grid [V]."""
    return conditioned_on(clock, channel, fault_limits(channel, holds=False))
