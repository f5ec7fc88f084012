"""The truth of the Stan Tug 1205 for another ship: its lever and its governor are set for that ship."""

from dataclasses import replace

from shaftprint.tug._truth import normalised_truth
from shaftprint.tug._tug import Tug
from shaftprint.vessel import Vessel

# What the default line asks for at -5 V, the working point of the Stan Tug, and the inertia time of its line [s], less
# half a per cent so that its governor is left as it is.
_STAN_TUG_RPM = 1183.8
_STAN_TUG_INERTIA_S = 1.33

# Truth of an electric line: dead time of a converter and its bus, torque in the middle of what current loops give, a
# slower speed controller that is as far from hunting.
_ELECTRIC = replace(Tug.stan_tug_1205(), governor_delay_s=0.0203, torque_time_s=0.0617, set_point_latency_s=0.0718)


def like_stan_tug_1205(vessel: Vessel) -> Tug:
    """Return the truth of the Stan Tug 1205 as another ship would have it.

    The lever asks for the ship's own speed where that of the tug asks for 1183.8 rpm; volts are those of the tug. A
    line with less inertia over its torque has a governor with as much smaller gains, which crosses over where that of
    the tug does and is as far from hunting. A motor has the dead time and lag of a converter.
    """
    tug = Tug.stan_tug_1205() if vessel.motor is None else _ELECTRIC
    speed = vessel.working_point.engine_speed_rpm / _STAN_TUG_RPM
    gain = min(1.0, normalised_truth(tug, vessel)["tau_t"] / _STAN_TUG_INERTIA_S)
    return replace(
        tug,
        set_point_slope_rpm_per_v=speed * tug.set_point_slope_rpm_per_v,
        set_point_intercept_rpm=speed * tug.set_point_intercept_rpm,
        proportional_gain=gain * tug.proportional_gain,
        integral_gain_per_s=gain * tug.integral_gain_per_s,
    )
