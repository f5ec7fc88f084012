"""Shaft torque from the gauge: unit, zero, known latency, dropouts, and whether the gauge is alive."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float, in_blocks
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitations import Sine
from shaftprint.digits import in_nm
from shaftprint.errors import SignalError
from shaftprint.reasons import OTHER_SHIP
from shaftprint.signals._channel_signals import ChannelSignal
from shaftprint.signals._channels import middle_of
from shaftprint.signals._gaps import EVERYTHING, Coverage
from shaftprint.signals._signals import Repair
from shaftprint.signals.conditioning._condition import Reading
from shaftprint.signals.conditioning._outliers import FaultLimits, fault_limits
from shaftprint.signals.kinds._current_loop import alive_counts
from shaftprint.signals.kinds._kind import ChannelKind, Source, SteadyState, conditioned_on
from shaftprint.signals.kinds._splined_messages import comes_in_messages
from shaftprint.signals.kinds._torque_messages import torque_messages
from shaftprint.vessel._current_loop import LIVE_ZERO_MA
from shaftprint.vessel._shaft_torque import ShaftTorqueSensor

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.signals._clock import Clock
    from shaftprint.vessel._vessel import Vessel

# So near to full scale counts as there.
_RAIL_SHARE = 0.999
_LARGEST_SATURATED_SHARE = 1e-3

# Less than this part of the torque at the working point, or more than this multiple, is not the load of another day. A
# recording may idle for most of its time.
_SMALL_PART, _MULTIPLE = 0.1, 2.5
# Beyond this multiple a gauge at full scale is not the whole cause.
_LARGER = 1.5
_CHECK = f"{OTHER_SHIP}, gearbox.ratio and the scale of the gauge"

# Seconds whose torque is beyond this share of the usual one, on both sides of nothing in this share of the time.
_CLEAR, _BOTH_SIGNS = 0.3, 0.05

# Torque follows slow excitations; faster ones say nothing about the gauge.
_SLOW_HZ = 1.0
_LEAST_MOVEMENT = 1e-3


class ShaftTorque(ChannelKind[ShaftTorqueSensor]):
    """Torque of the propeller shaft at its gauge [N m]."""

    sensor, name, use, needed = "shaft_torque", "M_s", "shaft torque", True
    takes_messages = True

    def limits(self, source: Source[ShaftTorqueSensor]) -> FaultLimits:
        """Return the limits of the gauge."""
        return torque_limits(source.channel, source.sensor)

    def read(self, source: Source[ShaftTorqueSensor], clock: "Clock") -> Reading:
        """Return the torque on the grid."""
        channel = source.channel
        expect_unit(channel, source.vessel)
        latency_s = clock.latency_s(source.sensor.latency_s)
        reading: Reading
        if comes_in_messages(channel, clock):
            reading = torque_messages(source, self.limits(source), clock, latency_s)
        else:
            reading = conditioned_on(clock, source.channel, self.limits(source), latency_s)
        return reading.of(source.vessel.driving_torque_nm, earlier_s=latency_s)

    def judge(self, source: Source[ShaftTorqueSensor], reading: Reading) -> tuple[str, ...]:
        """Return a finding where crests are cut off; too many are refused."""
        return *reading.findings, *judge_saturation(source.channel, reading.repairs, source.vessel)

    def signal(self, source: Source[ShaftTorqueSensor], reading: Reading, steady: SteadyState) -> ChannelSignal:
        """Return the torque over that of the working point."""
        return ChannelSignal(
            name=self.name,
            channel=source.channel.name,
            values=frozen_float(reading.values),
            reference=steady.working_point.shaft_torque_nm,
            reference_std=steady.working_point.shaft_torque_std_nm,
            value_rate_hz=reading.value_rate_hz,
        )


def torque_limits(channel: "Channel", sensor: ShaftTorqueSensor) -> FaultLimits:
    """Return what counts as a fault of the gauge, with rails at the full scale of the telemetry."""
    reach = abs(sensor.full_scale_nm / sensor.scale_nm_per_unit)
    ends = [(sensor.live_zero + side * reach - channel.offset) / channel.scale for side in (-1.0, 1.0)]
    middle, half = 0.5 * (ends[0] + ends[1]), 0.5 * abs(ends[1] - ends[0]) * _RAIL_SHARE
    lowest, highest = middle - half, middle + half
    if sensor.unit == "mA" and sensor.live_zero >= LIVE_ZERO_MA:
        least, most = alive_counts(channel)
        lowest, highest = max(lowest, least), min(highest, most)
    if channel.read(0, 1).dtype == np.int16:
        lowest, highest = max(lowest, -32768.0), min(highest, 32767.0)
    return fault_limits(channel, holds=True, lowest=lowest, highest=highest)


def expect_unit(channel: "Channel", vessel: "Vessel") -> None:
    """Check by stretches all over the recording that the torque is not one of another unit than is stated.

    Raises SignalError if it is a small part or a multiple of what is expected, and would be as expected in another
    unit that can be meant by the one that the recording states; the message names it. Raises it too where the torque
    is a multiple beyond full scale.
    """
    sensor, expected = vessel.sensors.shaft_torque, vessel.working_point.shaft_torque_nm
    torque = float(sensor.torque_nm(middle_of(channel)))
    fitting = sensor.scale_that_fits(torque, expected)
    # a torque of the other sign is no other unit: that it has the other sign is said with the working point
    same_sign = (torque + sensor.zero_nm) / expected > 0.0
    if fitting is not None and same_sign and not _SMALL_PART < torque / expected < _MULTIPLE:
        raise SignalError(
            f"channel {channel.name}: expected a torque around {in_nm(expected)} by working_point of the vessel file, "
            f"found {in_nm(torque)} with the unit {sensor.unit} of the vessel file; {fitting}; check "
            f"{OTHER_SHIP} too."
        )
    # half of the samples saturated would leave gaps in place of a torque
    if abs(torque) > max(sensor.full_scale_nm, _MULTIPLE * abs(expected)):
        raise SignalError(
            f"channel {channel.name}: expected a torque around {in_nm(expected)} by working_point of the vessel file "
            f"and within the full scale of {in_nm(sensor.full_scale_nm)}, found {in_nm(torque)}; check {_CHECK}."
        )
    if abs(torque) > sensor.full_scale_nm:
        raise SignalError(
            f"channel {channel.name}: expected a full scale of the telemetry above the torque, {in_nm(torque)}, found "
            f"{sensor.full_scale_nm:g} N m{sensor.full_scale_words(torque)}; correct "
            "sensors.shaft_torque.full_scale_nm."
        )


def judge_saturation(channel: "Channel", repairs: Sequence[Repair], vessel: "Vessel") -> tuple[str, ...]:
    """Return a finding where crests of the torque are cut off at full scale.

    ``channel``, ``repairs``: the torque, and what was replaced in it. ``vessel``: what is expected of it.
    Raises SignalError if more than a thousandth of the samples are.
    """
    saturated = [repair for repair in repairs if repair.kind == "saturated"]
    if not saturated:
        return ()
    count = sum(repair.count for repair in saturated)
    where = f"from {saturated[0].time_s:.1f} s on"
    if count > _LARGEST_SATURATED_SHARE * channel.count:
        expected_nm = vessel.working_point.driving_torque_nm
        torque_nm = vessel.driving_torque_nm(middle_of(channel))
        other = (
            f" The torque is around {in_nm(float(torque_nm))}, {in_nm(expected_nm)} at the working point of the vessel "
            f"file: check {_CHECK}."
            if float(torque_nm) > _LARGER * expected_nm
            else ""
        )
        raise SignalError(
            f"channel {channel.name}: expected a torque within full scale, found "
            f"{count / channel.count:.1%} of the samples saturated {where}; check full_scale_nm in "
            f"the vessel file or choose a larger range of the telemetry.{other}"
        )
    return (f"channel {channel.name} reaches full scale {where}: {count} samples are cut off there",)


def expect_moving_torque(
    torque_nm: FloatArray,
    campaign: Campaign,
    sensor: ShaftTorqueSensor,
    *,
    rate_hz: float,
    start_s: float,
    coverage: Coverage = EVERYTHING,
) -> None:
    """Check that the torque moves during every slow excitation.

    Raises SignalError if the gauge stands still; the message says from when on.
    """
    for excitation in campaign.excitations:
        if isinstance(excitation, Sine) and excitation.frequency_hz > _SLOW_HZ:
            continue
        if coverage.missing(excitation.start_s, excitation.stop_s):
            continue
        first = max(round((excitation.start_s - start_s) * rate_hz), 0)
        stop = round((excitation.stop_s - start_s) * rate_hz)
        if stop <= first:
            continue
        spread = float(np.std(torque_nm[first:stop]))
        if spread < _LEAST_MOVEMENT * sensor.full_scale_nm:
            raise SignalError(
                f"channel {sensor.channel}: expected the torque to move during {excitation.name}, "
                f"found it dead near {float(torque_nm[first]):.0f} N m from "
                f"{excitation.start_s:.1f} s on; check the gauge, its telemetry and the unit of the channel."
            )


def expect_one_sign(torque_nm: FloatArray, sensor: ShaftTorqueSensor, *, rate_hz: float, start_s: float) -> None:
    """Check that the torque does not turn its sign for a part of the recording: a shaft that turns on does not do so.

    Raises SignalError if it does; the message says when.
    """
    length = max(round(rate_hz), 1)
    seconds = in_blocks(torque_nm, length).mean(axis=1)
    if not seconds.size:
        return
    clear = _CLEAR * float(np.median(np.abs(seconds)))
    below, above = seconds < -clear, seconds > clear
    if min(below.mean(), above.mean()) < _BOTH_SIGNS:
        return
    fewer = below if below.sum() < above.sum() else above
    where = np.flatnonzero(fewer)
    raise SignalError(
        f"channel {sensor.channel}: expected a torque of one sign while the shaft turns on, found it turned round "
        f"from {start_s + where[0] * length / rate_hz:.0f} to {start_s + (where[-1] + 1) * length / rate_hz:.0f} s; "
        "check the gauge, its wiring and its amplifier for a sign that was changed during the test."
    )
