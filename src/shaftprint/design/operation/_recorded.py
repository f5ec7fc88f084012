"""What a recording shows that ship and engine did."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.design.operation._operation import Operation
from shaftprint.units import rpm_from_rev_s

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.signals._signals import Signals
    from shaftprint.vessel._vessel import Vessel

# Speed and torque are averaged over it, so that the noise of a derivative does not count as torque; a swing of 1.2 Hz
# loses 2 % of its height.
_AVERAGED_S = 0.1


def recorded_operation(signals: "Signals", campaign: "Campaign", vessel: "Vessel") -> Operation:
    """Return what was recorded of a test, averaged over a tenth of a second, every twentieth of a second.

    The brake torque follows from the torque at the gauge and the inertia upstream of it, which the vessel file states:
    ``i eta M_b = M_s + 2 pi I_up dn_s/dt``.

    Parameters
    ----------
    signals
        The prepared recording.
    campaign
        What was asked of the ship.
    vessel
        Ratio and efficiency of the gearbox, and the upstream inertia.
    """
    count = max(1, round(_AVERAGED_S * signals.rate_hz))
    speed_rev_s = _averaged(signals.engine_speed.values, count)
    gauge_nm = _averaged(signals.shaft_torque_nm, count)
    gearbox = vessel.gearbox
    step_s = max(1, count // 2) / signals.rate_hz
    change = np.gradient(speed_rev_s, step_s) / gearbox.ratio
    at_shaft_nm = gauge_nm + 2.0 * np.pi * vessel.inertia_upstream_kg_m2 * change
    time_s = signals.start_s + step_s * np.arange(speed_rev_s.size, dtype=np.float64)
    usable = ~signals.coverage.lost(time_s)
    # the ends are no means
    usable[:2] = usable[-2:] = False
    return Operation(
        campaign=campaign,
        time_s=time_s[usable],
        set_point_rpm=rpm_from_rev_s(_averaged(signals.set_point_rev_s, count))[usable],
        speed_rpm=rpm_from_rev_s(speed_rev_s)[usable],
        brake_torque_nm=(at_shaft_nm / gearbox.shaft_over_brake)[usable],
    )


def _averaged(values: FloatArray, count: int) -> FloatArray:
    # neighbours share half of their samples, so that no peak is lost
    return np.convolve(values, np.full(count, 1.0 / count), mode="same")[:: max(1, count // 2)].copy()
