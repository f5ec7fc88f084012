"""The noise that a recording shows at each speed at which it was made, to plan or predict the next test with."""

from dataclasses import replace
from typing import TYPE_CHECKING

from shaftprint.identify.prediction._noise_levels import NoiseLevels, noise_levels
from shaftprint.units import rpm_from_rev_s

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.signals._signals import Signals
    from shaftprint.signals._working_points import WorkingPoint
    from shaftprint.spectra._frequency_response import FrequencyResponse
    from shaftprint.survey._measurement import Measurement


def noise_at_speeds(measurement: "Measurement", campaign: "Campaign") -> dict[float, NoiseLevels]:
    """Return the noise levels by engine speed [rpm], over the working point of each speed.

    ``measurement``: what a recording gives. ``campaign``: the campaign that was sailed.
    """
    signals = measurement.signals
    if not measurement.legs:
        point = signals.working_point
        return {
            rpm_from_rev_s(point.engine_speed_rev_s): _levels(
                measurement.spectra.response, campaign, signals, point, as_weights=True
            )
        }
    states, planned = {state.name: state for state in signals.legs}, {leg.name: leg for leg in campaign.legs}
    levels = {}
    for leg in measurement.legs:
        state = states[leg.name]
        level = _levels(leg.spectra.response, campaign, signals, leg.working_point)
        # a leg that was broken off has fewer periods than its campaign says
        share = state.periods * state.period_s / planned[leg.name].window_s
        speed_rpm = rpm_from_rev_s(leg.working_point.engine_speed_rev_s)
        levels[speed_rpm] = replace(level, density=share * level.density)
    return levels


def noise_of_further(measurement: "Measurement", campaign: "Campaign") -> dict[str, NoiseLevels]:
    """Return the noise levels under what was moved beside the set point of the speed, by its symbol.

    They are those of the working point; one volt is that of the input.

    ``measurement``, ``campaign``: as of ``noise_at_speeds``.
    """
    signals = measurement.signals
    turns = signals.working_point.engine_speed_rev_s
    return {
        name: noise_levels(
            one.response,
            campaign,
            set_point_per_v=abs(signals.excitations[name].per_volt / signals.excitations[name].reference),
            orders_hz=[order.per_turn * turns for order in signals.orders],
            as_weights=not measurement.legs,
        )
        for name, one in measurement.further.items()
    }


def _levels(
    response: "FrequencyResponse",
    campaign: "Campaign",
    signals: "Signals",
    point: "WorkingPoint",
    *,
    as_weights: bool = False,
) -> NoiseLevels:
    slope = abs(signals.calibration.slope_rev_s_per_v) * signals.dc_scale
    return noise_levels(
        response,
        campaign,
        set_point_per_v=slope / point.engine_speed_rev_s,
        orders_hz=[order.per_turn * point.engine_speed_rev_s for order in signals.orders],
        as_weights=as_weights,
    )
