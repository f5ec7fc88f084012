"""Signals of a campaign with legs: the steady state of each, and the signals about the working point of one of them."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.errors import SignalError
from shaftprint.signals._channel_signals import ChannelSignal, ExcitationSignal, SpeedSignal
from shaftprint.signals.kinds import SteadyState
from shaftprint.signals.levels import (
    DcScale,
    LegSamples,
    calibration_of_legs,
    leg_periods,
    leg_state,
    stretch_of,
)
from shaftprint.units import rpm_from_rev_s

if TYPE_CHECKING:
    from shaftprint.campaign import Campaign
    from shaftprint.signals._readings import Readings
    from shaftprint.signals._signals import LegState, Signals


def samples_of_legs(campaign: "Campaign", readings: "Readings") -> tuple[LegSamples, ...]:
    """Return set point, speed and torque of every leg of which the recording holds two whole periods.

    Parameters
    ----------
    campaign
        What was asked of the ship.
    readings
        What was read, the set point still in volts.
    """
    clock = readings.clock
    grid = {"rate_hz": clock.rate_hz, "start_s": clock.start_s}
    inside = ((leg, leg_periods(leg, readings.coverage)) for leg in campaign.legs)
    return tuple(
        LegSamples(
            leg=leg,
            periods=periods,
            set_point_v=periods.cut(readings.set_point, **grid),
            speed_rev_s=periods.cut(readings.pick_ups[0].values, **grid),
            torque_nm=periods.cut(readings.torque_nm, **grid),
        )
        for leg, periods in inside
        if periods is not None
    )


def steady_state_of_legs(
    campaign: "Campaign", readings: "Readings", samples: tuple[LegSamples, ...], *, channel: str
) -> tuple[SteadyState, tuple["LegState", ...]]:
    """Return the steady state of a campaign of legs alone, and the state of each leg.

    The leg whose level is nearest to the offset of the campaign is the working point of the recording.

    Parameters
    ----------
    campaign, readings
        What was asked of the ship, and what was read.
    samples
        From `samples_of_legs`.
    channel
        Name of the set-point channel, for messages.

    Raises
    ------
    SignalError
        If the recording holds no leg, or the speed does not follow the set point.
    """
    if not samples:
        first = campaign.legs[0]
        raise SignalError(
            f'expected at least two whole periods of a leg of campaign "{campaign.name}", such as {first.name} from '
            f"{first.settled_s:g} s on, found none without a gap; check that campaign and recording belong together."
        )
    states = tuple(leg_state(one) for one in samples)
    calibration = calibration_of_legs(samples, states, channel=channel)
    main = min(states, key=lambda state: abs(state.working_point.set_point_v - campaign.offset_v))
    slope_std = float(calibration.covariance[0, 0]) ** 0.5 / abs(calibration.slope_rev_s_per_v)
    steady = SteadyState(
        clock=readings.clock,
        stretches=(stretch_of(main),),
        working_point=main.working_point,
        calibration=calibration,
        scale=DcScale(value=1.0, std=slope_std, findings=()),
    )
    return steady, states


def about_leg(signals: "Signals", name: str) -> "Signals":
    """Return the signals with the working point of one leg as what everything is divided by.

    Channels with a clock of their own are left out: a leg has no response of them yet. The scale of the set point
    carries no deviation: what the line of the set point is off, it is off at every line of every leg alike, which
    the structures have as a parameter.

    Parameters
    ----------
    signals
        Signals of a campaign with legs.
    name
        Name of the leg.

    Raises
    ------
    SignalError
        If the recording holds no such leg.
    """
    states = {state.name: state for state in signals.legs}
    if name not in states:
        raise SignalError(
            f"leg {name}: expected one of {', '.join(states) or 'none'}, found no such leg in the signals."
        )
    state = states[name]
    channels = {
        symbol: _about(signal, state, signals)
        for symbol, signal in signals.channels.items()
        if symbol not in signals.messages
    }
    return replace(signals, working_point=state.working_point, channels=channels)


def _about(signal: ChannelSignal, state: "LegState", signals: "Signals") -> ChannelSignal:
    point = state.working_point
    speed_rev_s, speed_std = point.engine_speed_rev_s, point.engine_speed_std_rev_s
    if isinstance(signal, SpeedSignal):
        # a pick-up gives so many pulses a revolution, whatever the speed
        faster = speed_rev_s / float(signal.values.mean())
        return replace(
            signal,
            reference=speed_rev_s,
            reference_std=speed_std,
            pulse_rate_hz=signal.pulse_rate_hz * faster,
            averaging_s=signal.averaging_s / faster,
            hold_s=signal.hold_s / faster,
            delay_s=signal.delay_s / faster,
        )
    if isinstance(signal, ExcitationSignal) and signal.name == "n_set":
        return replace(
            signal,
            reference=speed_rev_s,
            reference_std=speed_std,
            scale_std=0.0,
            shown_reference=rpm_from_rev_s(speed_rev_s),
        )
    if signal.name == "M_s":
        return replace(signal, reference=point.shaft_torque_nm, reference_std=point.shaft_torque_std_nm)
    first, stop = (round((instant - signals.start_s) * signals.rate_hz) for instant in (state.start_s, state.stop_s))
    return replace(signal, reference=float(np.mean(signal.values[first:stop])))
