"""What says that a channel changed within the tests, or does not show what the shafts do."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from shaftprint.reasons import Reason
from shaftprint.signals._channel_signals import SpeedSignal
from shaftprint.signals._order_scale import reasons_of_orders
from shaftprint.signals.excitation._quantum import left_by_steps
from shaftprint.signals.kinds._set_point import SetPointMessages
from shaftprint.signals.levels._set_point_steadiness import expect_steady_set_point
from shaftprint.signals.levels._steadiness import expect_steady_gauge

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.signals._channel_signals import ChannelSignal
    from shaftprint.signals._readings import Readings
    from shaftprint.signals._working_points import LegState
    from shaftprint.signals.kinds._kind import SteadyState
    from shaftprint.vessel._vessel import Vessel


def changes_of_set_point(vessel: "Vessel", campaign: "Campaign", readings: "Readings") -> tuple[Reason, ...]:
    """Return what says that the set point changed within the tests.

    ``vessel``, ``campaign``, ``readings``: of the recording; the set point still in volts.
    """
    clock = readings.clock
    if clock.mode == "thesis":
        return ()
    reading = readings.by_name["n_set"]
    sent = reading.sent
    rounding = None
    if sent is not None and isinstance(reading, SetPointMessages):
        rounding = partial(left_by_steps, time_s=sent.time_s, step_v=reading.step_v)
    return expect_steady_set_point(
        campaign.of_input(),
        readings.set_point,
        rate_hz=clock.rate_hz,
        start_s=clock.start_s,
        channel=vessel.sensors.set_point.channel,
        coverage=readings.coverage,
        rounding=rounding,
    )


def changes_of_gauge(
    vessel: "Vessel", campaign: "Campaign", readings: "Readings"
) -> tuple[tuple[Reason, ...], dict[str, float]]:
    """Return what says that the torque gauge changed within the tests, and what each leg may hold unseen, by name.

    ``vessel``, ``campaign``, ``readings``: of the recording.
    """
    clock = readings.clock
    if clock.mode == "thesis":
        return (), {}
    return expect_steady_gauge(
        campaign.of_input(),
        set_point=readings.set_point,
        speed_rev_s=readings.pick_ups[0].values,
        torque_nm=readings.torque_nm,
        rate_hz=clock.rate_hz,
        start_s=clock.start_s,
        channel=vessel.sensors.shaft_torque.channel,
        coverage=readings.coverage,
    )


def with_unseen_gains(
    steady: "SteadyState", states: "tuple[LegState, ...]", unseen: Mapping[str, float]
) -> "tuple[SteadyState, tuple[LegState, ...]]":
    """Return the steady states of the recording and of its legs with the gain of the gauge that each may be off."""
    known = [
        replace(state, working_point=replace(state.working_point, unseen_gain=unseen.get(state.name, 0.0)))
        for state in states
    ]
    pairs = zip(states, known, strict=True)
    main = (one.working_point for state, one in pairs if state.working_point == steady.working_point)
    return replace(steady, working_point=next(main, steady.working_point)), tuple(known)


def orders_against_speed(
    vessel: "Vessel", signals: "Mapping[str, ChannelSignal]", readings: "Readings"
) -> tuple[Reason, ...]:
    """Return what the orders of the shafts in the torque say against the scale of the speed.

    ``vessel``, ``readings``: of the recording. ``signals``: its channels by name.
    """
    clock = readings.clock
    if clock.mode == "thesis":
        return ()
    return reasons_of_orders(
        next(one for one in signals.values() if isinstance(one, SpeedSignal)),
        signals["M_s"].values,
        vessel,
        rate_hz=clock.rate_hz,
        start_s=clock.start_s,
        coverage=readings.coverage,
    )
