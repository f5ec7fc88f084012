"""What a test really asked of the simulated ship: how near it came to each limit inside the windows of its legs."""

from dataclasses import dataclass

import numpy as np

from shaftprint.campaign import Campaign
from shaftprint.tug import Tug
from shaftprint.tug.plant._demand import demanded_speed, helm_voltage
from shaftprint.tug.plant._disturbance import Disturbance
from shaftprint.tug.plant._voyage import voyage
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel import Vessel

# A limit of torque or rack may act for so much of a leg.
TOUCHED = 5e-4
# The speed may pass its limits by so much, which the noise of four deviations leaves.
SPEED_NOISE = 0.005
_CHUNK = 262_144


@dataclass(frozen=True, kw_only=True)
class SailedLimits:
    """How near a test came to the limits, inside the windows, with the noise."""

    limited: float
    """Largest share of a window in which a limit of torque or rack acted."""
    at_full_load: float
    """Largest brake torque over the full-load torque at its speed."""
    at_motoring: float
    """Largest negative brake torque over the motoring torque at its speed."""
    lowest_speed: float
    """Lowest speed over the lowest that is allowed."""
    highest_speed: float
    """Highest speed over the highest that is allowed."""
    set_point_rpm: float
    """Largest deviation of the set point from the level of its leg [rpm]."""
    rate_rpm_per_s: float
    """Fastest change of the set point [rpm/s]."""

    @property
    def are_kept(self) -> bool:
        """Whether no limit was left."""
        return (
            self.limited <= TOUCHED
            and self.lowest_speed >= 1.0 - SPEED_NOISE
            and self.highest_speed <= 1.0 + SPEED_NOISE
        )


def sailed_limits(tug: Tug, vessel: Vessel, campaign: Campaign, *, seed: int, rate_hz: float = 1000.0) -> SailedLimits:
    """Return what a ship does in a campaign, with process noise of its own, limits acting."""
    step_s = 1.0 / rate_hz
    legs = list(
        voyage(
            tug,
            vessel,
            campaign,
            step_s=step_s,
            steps=round(campaign.duration_s * rate_hz),
            chunk=_CHUNK,
            disturbance=Disturbance(tug.noise, step_s, np.random.default_rng(seed)),
        )
    )
    time_s, speed_rev_s, brake_nm, limited = (
        np.concatenate([getattr(leg, name) for leg in legs])
        for name in ("time_s", "shaft_speed_rev_s", "brake_torque_nm", "limited")
    )
    speed_rpm = rpm_from_rev_s(vessel.gearbox.ratio * speed_rev_s)
    full_nm = np.interp(speed_rpm, vessel.engine.full_load_speed_rpm, vessel.engine.full_load_torque_nm)
    motoring_nm = np.interp(speed_rpm, vessel.limits.motoring_speed_rpm, vessel.limits.motoring_torque_nm)
    windows = [(time_s >= leg.settled_s) & (time_s < leg.stop_s) for leg in campaign.legs]
    inside = np.any(windows, axis=0)
    # by the line of this ship, which may bend
    asked = [
        rpm_from_rev_s(
            demanded_speed(tug, vessel, helm_voltage(tug, campaign, time_s[one]))
            - demanded_speed(tug, vessel, np.array([leg.level_v + tug.set_point_offset_v]))
        )
        for one, leg in zip(windows, campaign.multisines, strict=True)
    ]
    return SailedLimits(
        limited=max(float(limited[one].mean()) for one in windows),
        at_full_load=float((brake_nm / full_nm)[inside].max()),
        at_motoring=float((-brake_nm / motoring_nm)[inside].max()),
        lowest_speed=float(speed_rpm[inside].min()) / (vessel.limits.lowest_speed_rpm or vessel.engine.idle_speed_rpm),
        highest_speed=float(speed_rpm[inside].max())
        / (vessel.limits.highest_speed_rpm or vessel.engine.rated_speed_rpm),
        set_point_rpm=max(float(np.abs(one).max()) for one in asked),
        rate_rpm_per_s=max(float(np.abs(np.diff(one)).max()) for one in asked) * rate_hz,
    )
