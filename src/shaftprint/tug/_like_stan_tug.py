"""The truth of the Stan Tug 1205 for another ship: its lever and its governor are set for that ship."""

from dataclasses import replace
from typing import TYPE_CHECKING

from shaftprint.errors import SettingsError
from shaftprint.tug._coupling import stated_coupling
from shaftprint.tug._pitch_actuation import PitchActuation, pitch_torque
from shaftprint.tug._pitch_series import steepened, torque_over_pitch
from shaftprint.tug._sailing import Sailing, with_propeller_of
from shaftprint.tug._shaft_machine import ShaftMachineTruth
from shaftprint.tug._truth import normalised_truth
from shaftprint.tug._tug import Tug
from shaftprint.vessel._vessel import Vessel

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign

# At the quay the lever asks for the working speed at -5 V, as on the Stan Tug. Its line has this inertia time [s], less
# half a per cent so that its governor is left as it is.
_AT_THE_QUAY_V, _AT_THE_QUAY_RPM = -5.0, 1183.8
_STAN_TUG_INERTIA_S = 1.33

# Truth of an electric line: dead time of a converter and its bus, torque in the middle of what current loops give, a
# slower speed controller that is as far from hunting.
_ELECTRIC = replace(Tug.stan_tug_1205(), governor_delay_s=0.0203, torque_time_s=0.0617, set_point_latency_s=0.0718)


def like_stan_tug_1205(vessel: Vessel, *, offset_v: float = _AT_THE_QUAY_V) -> Tug:
    """Return the truth of the Stan Tug 1205 as another ship would have it.

    The lever asks for the ship's working speed at -5 V where it is tested at the quay, and at the voltage of the
    campaign underway; volts are those of the tug. A line with less inertia over its torque has a governor with as much
    smaller gains, which crosses over where that of the tug does and is as far from hunting. An electric machine on the
    gearbox has the share of the vessel file; gains go with what the engine gives. A motor has the dead time and lag of
    a converter; a controllable pitch follows as the vessel file says. A ship whose vessel file states a speed of the
    ship sails free, with its wake fraction and thrust deduction. Where the links of its vessel file have one spring,
    that is its coupling.

    Parameters
    ----------
    vessel
        The ship.
    offset_v
        Voltage of the campaign between its tests [V].

    Raises
    ------
    SettingsError
        If it is to sail free with another propeller than the simulated ship has curves of.
    """
    machine = None if vessel.shaft_machine is None else ShaftMachineTruth(share=vessel.shaft_machine.share)
    tug = replace(
        Tug.stan_tug_1205() if vessel.motor is None else _ELECTRIC,
        sailing=_sailing(vessel),
        pitch=_pitch(vessel),
        coupling=stated_coupling(vessel),
        shaft_machine=machine,
    )
    further_v = offset_v - _AT_THE_QUAY_V if vessel.is_underway else 0.0
    asked_rpm = _AT_THE_QUAY_RPM + tug.set_point_slope_rpm_per_v * further_v
    speed = vessel.working_point.engine_speed_rpm / asked_rpm
    gain = min(1.0, normalised_truth(tug, vessel)["tau_t"] / _STAN_TUG_INERTIA_S)
    if machine is not None:
        gain /= 1.0 - machine.share
    return replace(
        tug,
        set_point_slope_rpm_per_v=speed * tug.set_point_slope_rpm_per_v,
        set_point_intercept_rpm=speed * tug.set_point_intercept_rpm,
        proportional_gain=gain * tug.proportional_gain,
        integral_gain_per_s=gain * tug.integral_gain_per_s,
    )


def with_lever_of(tug: Tug, vessel: Vessel, campaign: "Campaign") -> Tug:
    """Return a simulated ship with the lever for which a campaign was made, or that of its vessel file.

    At the offset of the campaign it asks for ``offset_rpm``, or for the working speed of the vessel file. The ship
    stays as it is where neither file says what the lever asks for.

    ``tug``: the simulated ship. ``vessel``: its vessel file. ``campaign``: what is put out. Raises SettingsError if the
    offset of the campaign is beyond the lever of the vessel file.
    """
    sensor, slope, offset_v = vessel.sensors.set_point, campaign.slope_rpm_per_v, campaign.offset_v
    at_offset_rpm = vessel.working_point.engine_speed_rpm if campaign.offset_rpm is None else campaign.offset_rpm
    if slope is None:
        slope, asked_rpm = sensor.slope_rpm_per_v(offset_v), sensor.asked_rpm(offset_v)
        if slope is None or asked_rpm is None:
            return tug
        if not sensor.covers(offset_v) or asked_rpm <= 0.0:
            raise SettingsError(
                f"{campaign.name}: expected offset_v within the lever of {vessel.name}, found {offset_v:g} V, which is "
                f"{float(sensor.reading(offset_v)):g} {sensor.unit} and asks for {asked_rpm:g} rpm; make a test for "
                "this lever, with `shaftprint new campaign --test short --vessel FILE` or `shaftprint plan`."
            )
        at_offset_rpm = asked_rpm
    return replace(
        tug,
        set_point_slope_rpm_per_v=slope,
        set_point_intercept_rpm=at_offset_rpm - slope * offset_v,
        set_point_offset_v=0.0,
    )


def _pitch(vessel: Vessel) -> PitchActuation | None:
    """Return how a controllable pitch follows, as the vessel file says of it; None underway or where it is fixed."""
    stated = vessel.pitch
    if stated is None or vessel.is_underway:
        return None
    actuation = PitchActuation(
        lag_s=stated.lag_s, delay_s=stated.delay_s, rate_per_s=stated.rate_per_s, play=stated.play
    )
    if stated.torque_slope is None:
        return actuation
    rest, powers = vessel.propeller.pitch_ratio, torque_over_pitch(vessel)
    factor = stated.torque_slope / (rest * pitch_torque(replace(actuation, torque_powers=powers), vessel)[1])
    return replace(actuation, torque_powers=steepened(powers, rest, factor))


def _sailing(vessel: Vessel) -> Sailing | None:
    """Return what makes a ship sail free; None at the quay."""
    if not vessel.is_underway or vessel.hull is None:
        return None
    hull = vessel.hull
    usual = Sailing()
    stated = Sailing(
        wake_fraction=usual.wake_fraction if hull.wake_fraction is None else hull.wake_fraction,
        thrust_deduction=usual.thrust_deduction if hull.thrust_deduction is None else hull.thrust_deduction,
    )
    return with_propeller_of(stated, vessel)
