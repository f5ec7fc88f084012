"""Shaft torque from the gauge: unit, zero, known latency, dropouts, and whether the gauge is alive."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.campaign import Campaign, Sine
from shaftprint.errors import SignalError
from shaftprint.signals._gaps import EVERYTHING, Coverage
from shaftprint.signals._outliers import FaultLimits, fault_limits
from shaftprint.signals._signals import Repair

if TYPE_CHECKING:
    from shaftprint.recording import Channel
    from shaftprint.vessel import ShaftTorqueSensor

# So near to full scale counts as there.
_RAIL_SHARE = 0.999
_LARGEST_SATURATED_SHARE = 1e-3

# Torque follows slow excitations; faster ones say nothing about the gauge.
_SLOW_HZ = 1.0
_LEAST_MOVEMENT = 1e-3


def torque_limits(channel: "Channel", sensor: "ShaftTorqueSensor") -> FaultLimits:
    """Return what counts as a fault of the gauge, with rails at the full scale of the telemetry."""
    reach = abs(sensor.full_scale_nm / sensor.scale_nm_per_unit)
    ends = [(side * reach - channel.offset) / channel.scale for side in (-1.0, 1.0)]
    middle, half = 0.5 * (ends[0] + ends[1]), 0.5 * abs(ends[1] - ends[0]) * _RAIL_SHARE
    lowest, highest = middle - half, middle + half
    if channel.read(0, 1).dtype == np.int16:
        lowest, highest = max(lowest, -32768.0), min(highest, 32767.0)
    return fault_limits(channel, holds=True, lowest=lowest, highest=highest)


def judge_saturation(channel: "Channel", repairs: list[Repair]) -> tuple[str, ...]:
    """Return a finding where crests of the torque are cut off at full scale.

    Raises
    ------
    SignalError
        If more than a thousandth of the samples are.
    """
    saturated = [repair for repair in repairs if repair.kind == "saturated"]
    if not saturated:
        return ()
    count = sum(repair.count for repair in saturated)
    where = f"from {saturated[0].time_s:.1f} s on"
    if count > _LARGEST_SATURATED_SHARE * channel.count:
        raise SignalError(
            f"channel {channel.name}: expected a torque within full scale, found "
            f"{count / channel.count:.1%} of the samples saturated {where}; check full_scale_nm in "
            "the vessel file or choose a larger range of the telemetry."
        )
    return (f"channel {channel.name} reaches full scale {where}: {count} samples are cut off there",)


def expect_moving_torque(
    torque_nm: FloatArray,
    campaign: Campaign,
    sensor: "ShaftTorqueSensor",
    *,
    rate_hz: float,
    start_s: float,
    coverage: Coverage = EVERYTHING,
) -> None:
    """Check that the torque moves during every slow excitation.

    Raises
    ------
    SignalError
        If the gauge stands still; the message says from when on.
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
                f"{excitation.start_s:.1f} s on; check the gauge and its telemetry."
            )
