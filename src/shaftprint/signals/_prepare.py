"""The verb of the room: from a raw recording to signals in physical units."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray
from shaftprint.campaign._campaign import Campaign
from shaftprint.errors import SignalError
from shaftprint.memory import give_back_memory
from shaftprint.reasons import Reason
from shaftprint.signals._changes import changes_of_gauge, changes_of_set_point, orders_against_speed, with_unseen_gains
from shaftprint.signals._channel_readings import ChannelReadings, logger_channels, read_channels
from shaftprint.signals._channel_signals import ChannelSignal, SpeedSignal
from shaftprint.signals._channels import find_channel
from shaftprint.signals._clock import Mode, clock_of
from shaftprint.signals._demand import delay_of_demand
from shaftprint.signals._gaps import Coverage, bridge
from shaftprint.signals._leg_steady_state import samples_of_legs, steady_state_of_legs, stopped_generators
from shaftprint.signals._orders import tracked_orders
from shaftprint.signals._rates import expect_one_rate
from shaftprint.signals._readings import Readings, usable_readings
from shaftprint.signals._signals import SetPointCalibration, Signals
from shaftprint.signals._working_points import LegState
from shaftprint.signals.excitation._found_test import FoundTest
from shaftprint.signals.excitation._found_tests import found_tests
from shaftprint.signals.excitation._match import expect_campaign, expect_no_swap, left_out
from shaftprint.signals.excitation._message_lines import joined_about_lines
from shaftprint.signals.excitation._quantum import take_out_steps
from shaftprint.signals.excitation._steps import find_step_delays
from shaftprint.signals.kinds._compare import compare_speeds
from shaftprint.signals.kinds._kind import Source, SteadyState
from shaftprint.signals.kinds._pick_up import Speed
from shaftprint.signals.kinds._set_point import SetPointMessages, read_set_point
from shaftprint.signals.kinds._torque import expect_moving_torque, expect_one_sign
from shaftprint.signals.levels._calibrate import calibrate, calibrate_through_wander
from shaftprint.signals.levels._dc_scale import DcScale, dc_scale, scale_of_sines
from shaftprint.signals.levels._leg_state import leg_states
from shaftprint.signals.levels._steady import steady_stretches
from shaftprint.signals.levels._working_point import (
    expect_driving,
    expect_stated_lever,
    expect_stated_slope,
    find_working_point,
    stretches_at_working_point,
    working_point_of_test,
    working_voltage,
)
from shaftprint.signals.pulses._flat_top import expect_whole_crests

if TYPE_CHECKING:
    from shaftprint.recording._recording import Recording
    from shaftprint.vessel._set_point import SetPointSensor
    from shaftprint.vessel._vessel import Vessel

# Rate at which the set point alone is looked at [Hz].
_SET_POINT_HZ = 200.0


@refusing_none(SignalError)
def prepare_signals(
    recording: "Recording",
    vessel: "Vessel",
    campaign: Campaign,
    *,
    mode: Mode = "shaftprint",
    rate_hz: float = 200.0,
    chunk_s: float | None = None,
    progress: Callable[[float], None] | None = None,
    readings: ChannelReadings | None = None,
) -> Signals:
    """Turn a raw recording into speeds, torque and set point in physical units on one grid.

    Parameters
    ----------
    recording
        The raw recording, open.
    vessel
        Says which channel carries what.
    campaign
        Says what was asked of the ship and when.
    mode
        ``"shaftprint"``, or ``"thesis"`` to do each step as the thesis did.
    rate_hz
        Rate of the grid [Hz], at most that of the channels.
    chunk_s
        How much of a channel is read at a time [s]; by default one block of the native container.
        The result is the same, bit for bit, for any value.
    progress
        Is told the finished share of the reading, from 0 to 1; it may be called from other threads.
    readings
        What `read_channels` gave of the same recording, vessel, mode and rate, so that it is not read again.

    Raises
    ------
    SignalError
        If a channel is missing, dead, saturated or in another unit, or if the recording does not show what
        the campaign asked, or no test of it whole. What it lacks in gaps or at its ends is in the findings.
    """
    if mode not in ("shaftprint", "thesis"):
        raise SignalError(f'mode: expected "shaftprint" or "thesis", found "{mode}".')
    if readings is None:
        channels = read_channels(recording, vessel, mode=mode, rate_hz=rate_hz, chunk_s=chunk_s, progress=progress)
        return _prepared(recording, vessel, campaign, usable_readings(channels))
    usable = usable_readings(readings)
    # a set point becomes a speed in place, and what was read belongs to the caller
    voltage = usable.by_name["n_set"]
    own = replace(voltage, values=voltage.values.copy())
    return _prepared(recording, vessel, campaign, replace(usable, by_name={**usable.by_name, "n_set": own}))


def _prepared(recording: "Recording", vessel: "Vessel", campaign: Campaign, readings: Readings) -> Signals:
    """Return the signals of what was read; its set point becomes a speed in place."""
    readings, clock = _about_lines(readings, campaign), readings.clock
    reasons = [
        *expect_one_rate(recording, logger_channels(readings.sources)),
        *readings.reasons,
        *_cut_crests(readings.sources),
    ]
    lost, mismatches = _differences_from_campaign(recording, vessel, campaign, readings)
    _without_steps_in_place(readings, campaign)
    sensor = vessel.sensors.demand
    late, asked = (None, ()) if sensor is None else delay_of_demand(recording, sensor, campaign, readings)
    _straightened_in_place(readings.set_point, vessel.sensors.set_point, campaign)
    reasons += changes_of_set_point(vessel, campaign, readings)
    differences = compare_speeds(readings.pick_ups, vessel, rate_hz=clock.rate_hz, start_s=clock.start_s)
    legs = samples_of_legs(campaign, readings)
    stopped = stopped_generators(legs, readings)
    states: tuple[LegState, ...]
    if campaign.legs and not campaign.sines:
        steady, states = steady_state_of_legs(campaign, readings, legs, channel=vessel.sensors.set_point.channel)
        expect_driving(steady.working_point, vessel)
        _calibrated_in_place(readings.set_point, steady.calibration)
    else:
        states = leg_states(legs)
        steady = _steady_state(vessel, campaign, readings)
    changed, unseen = changes_of_gauge(vessel, campaign, readings)
    reasons += changed
    steady, states = with_unseen_gains(steady, states, unseen)
    signals, absent = _signals_by_name(readings, steady)
    reasons += orders_against_speed(vessel, signals, readings)
    delays, missed = find_step_delays(
        readings.set_point,
        readings.pick_ups[0].values,
        campaign.of_input(),
        rate_hz=clock.rate_hz,
        start_s=clock.start_s,
        coverage=readings.coverage,
    )
    scale = steady.scale
    give_back_memory()
    return Signals(
        rate_hz=clock.rate_hz,
        start_s=clock.start_s,
        channels=signals,
        working_point=steady.working_point,
        calibration=steady.calibration,
        dc_scale=scale.value,
        dc_scale_std=scale.std,
        strips=tuple(pick_up.strips for pick_up in readings.pick_ups if pick_up.strips is not None),
        step_delays=delays,
        legs=states,
        read_hz=next(source.channel.rate_hz for source in readings.sources if isinstance(source.kind, Speed)),
        set_point_delay=late,
        orders=tracked_orders(vessel, {one.name: one for one in signals.values() if isinstance(one, SpeedSignal)}),
        repairs=readings.repairs,
        gaps=readings.gaps,
        mode=clock.mode,
        findings=(
            *lost,
            *readings.findings,
            *mismatches,
            *stopped,
            *expect_stated_lever(steady.working_point, steady.calibration, vessel),
            *expect_stated_slope(steady.calibration, campaign),
            *differences,
            *asked,
            *scale.findings,
            *absent,
            *missed,
        ),
        reasons=tuple(reasons),
        recording_sha256=recording.sha256,
        recording_name=recording.path.name,
    )


def find_tests(
    recording: "Recording", vessel: "Vessel", campaign: Campaign, *, readings: ChannelReadings | None = None
) -> tuple[FoundTest, ...]:
    """Return when and how every test of a campaign was really made, from the recorded set point alone.

    Parameters
    ----------
    recording
        The raw recording, open.
    vessel
        Says which channel is the set point.
    campaign
        What was asked of the ship; its times may be off by the same amount, or each by a few seconds.
    readings
        What `read_channels` gave of the same recording and vessel, so that it is not read again.

    Returns
    -------
    One entry a test, in order of time; `proposed_campaign` makes a campaign of them.

    Raises
    ------
    SignalError
        If the channel of the set point is missing, in another unit, or holds no numbers.
    """
    if readings is not None and "n_set" in readings.by_name:
        values, clock = readings.by_name["n_set"].values, readings.clock
        return found_tests(values, campaign.of_input(), rate_hz=clock.rate_hz, start_s=clock.start_s)
    sensor = vessel.sensors.set_point
    channel = find_channel(
        recording,
        sensor.channel,
        unit=sensor.unit,
        use="set point",
        takes_messages=True,
        sensors=vessel.sensors,
    )
    rate_hz = min(_SET_POINT_HZ, channel.rate_hz)
    clock = clock_of(channel, rate_hz)
    volts = read_set_point(channel, sensor, clock, speed_rpm=vessel.working_point.engine_speed_rpm).values
    return found_tests(volts, campaign.of_input(), rate_hz=rate_hz, start_s=clock.start_s)


def _cut_crests(sources: "Sequence[Source[Any]]") -> tuple[Reason, ...]:
    """Return a reason where the crests of the torque are cut off."""
    return tuple(expect_whole_crests(next(source.channel for source in sources if source.name == "M_s")))


def _differences_from_campaign(
    recording: "Recording", vessel: "Vessel", campaign: Campaign, readings: Readings
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return what the recording does not hold of a campaign, and what differs from it.

    Raises SignalError if it does not show what the campaign asked, or the torque does not move.
    """
    sensors, coverage = vessel.sensors, readings.coverage
    grid = {"rate_hz": readings.clock.rate_hz, "start_s": readings.clock.start_s}
    lost = left_out(campaign, coverage, name=str(recording.path))
    expect_no_swap(readings.set_point, readings.torque_nm, campaign.of_input(), sensors, **grid)
    mismatches = expect_campaign(
        readings.set_point, campaign.of_input(), **grid, channel=sensors.set_point.channel, coverage=coverage
    )
    expect_one_sign(readings.torque_nm, sensors.shaft_torque, **grid)
    expect_moving_torque(readings.torque_nm, campaign.of_input(), sensors.shaft_torque, **grid, coverage=coverage)
    return lost, mismatches


def _steady_state(vessel: "Vessel", campaign: Campaign, readings: Readings) -> SteadyState:
    """Return working point and line of the set point.

    The values of the set point become a speed, in place since the signals of a whole test are large.
    """
    clock, channel = readings.clock, vessel.sensors.set_point.channel
    tests = campaign.of_input()
    n_set, speed, torque = readings.set_point, readings.pick_ups[0].values, readings.torque_nm
    grid = {"rate_hz": clock.rate_hz, "start_s": clock.start_s}
    coverage = readings.coverage
    stretches = steady_stretches(n_set, speed, torque, campaign, **grid, coverage=coverage)
    quiet = stretches_at_working_point(stretches, campaign, channel=channel)
    scale = DcScale(value=1.0, std=0.0, findings=())
    if clock.mode == "thesis":
        calibration, point = calibrate(stretches, channel=channel), find_working_point(quiet)
        expect_driving(point, vessel)
        _calibrated_in_place(n_set, calibration)
    else:
        about_v = working_voltage(quiet)
        calibration, *at = calibrate_through_wander(
            stretches,
            tests,
            about_v=about_v,
            set_point_v=n_set,
            speed_rev_s=speed,
            channel=channel,
            bend_std=vessel.sensors.set_point.line_bend_std,
            **grid,
            step_v=_step_v(readings),
            coverage=coverage,
        )
        point = working_point_of_test(speed, torque, at_v=about_v, at=(at[0], at[1]), **grid, coverage=coverage)
        expect_driving(point, vessel)
        _calibrated_in_place(n_set, calibration)
        if calibration.level_v.size > 1:
            scale = _rescale(n_set, speed, tests, coverage, calibration, **grid, about=point.engine_speed_rev_s)
        else:
            scale = scale_of_sines(calibration)
    return SteadyState(
        clock=clock, stretches=quiet, working_point=point, calibration=calibration, scale=scale, speed_rev_s=speed
    )


def _step_v(readings: Readings) -> float:
    """Return the step of the messages of a set point [V]; 0 where it has none."""
    reading = readings.by_name["n_set"]
    return reading.step_v if isinstance(reading, SetPointMessages) else 0.0


def _signals_by_name(readings: Readings, steady: SteadyState) -> tuple[dict[str, ChannelSignal], tuple[str, ...]]:
    """Return every channel as a signal by name, and a finding on each that says nothing in this test."""
    signals, absent = {}, []
    for source in readings.sources:
        signal = source.kind.signal(source, readings.by_name[source.name], steady)
        if signal is None:
            kind = source.kind
            absent.append(f"the {kind.use} in channel {source.channel.name} was left out: {kind.absence}")
        else:
            signals[source.name] = signal
    return signals, tuple(absent)


def _about_lines(readings: Readings, campaign: Campaign) -> Readings:
    """Return readings whose messages are joined about the lines of a campaign instead of by a spline alone."""
    if readings.clock.mode == "thesis":
        return readings
    by_name = dict(readings.by_name)
    for name, reading in readings.by_name.items():
        joined = reading.sent and joined_about_lines(reading.sent, campaign, readings.clock)
        if joined:
            sent, values = joined
            bridge(values, reading.gaps, start_s=readings.clock.start_s, rate_hz=readings.clock.rate_hz)
            by_name[name] = replace(reading, sent=sent, values=values)
    return replace(readings, by_name=by_name)


def _without_steps_in_place(readings: Readings, campaign: Campaign) -> None:
    """Take out of a set point what the steps of its messages make of the sines and legs of a campaign."""
    reading, clock = readings.by_name["n_set"], readings.clock
    sent = reading.sent
    if clock.mode == "thesis" or sent is None or not isinstance(reading, SetPointMessages) or not reading.step_v:
        return
    take_out_steps(
        reading.values,
        sent.time_s,
        sent.values,
        campaign.of_input(),
        step_v=reading.step_v,
        rate_hz=clock.rate_hz,
        start_s=clock.start_s,
    )


def _straightened_in_place(volts: FloatArray, sensor: "SetPointSensor", campaign: Campaign) -> None:
    """Make the set point one of which the speed is a line, where the vessel file has a table of it.

    Only now: the campaign says what was put out, not what it asks for.
    """
    if sensor.table_rpm is None:
        return
    if not sensor.covers(campaign.offset_v):
        raise SignalError(
            f"channel {sensor.channel}: expected table_rpm of the vessel file to reach the offset of the campaign, "
            f"{float(sensor.reading(campaign.offset_v)):.4g} {sensor.unit}, found readings from "
            f"{sensor.table_rpm[0][0]:g} to {sensor.table_rpm[-1][0]:g}; add a reading of the lever beyond it, or make "
            "the test within them."
        )
    volts[:] = sensor.straightened(volts, about_v=campaign.offset_v)


def _calibrated_in_place(n_set: FloatArray, calibration: SetPointCalibration) -> None:
    n_set *= calibration.slope_rev_s_per_v
    n_set += calibration.intercept_rev_s


def _rescale(
    n_set: FloatArray,
    speed: FloatArray,
    campaign: Campaign,
    coverage: Coverage,
    calibration: SetPointCalibration,
    *,
    rate_hz: float,
    start_s: float,
    about: float,
) -> DcScale:
    """Stretch the set point about a speed, in place since the signals of a whole test are large; return how far."""
    slope_std = float(calibration.covariance[0, 0]) ** 0.5 / abs(calibration.slope_rev_s_per_v)
    scale = dc_scale(n_set, speed, campaign, rate_hz=rate_hz, start_s=start_s, slope_std=slope_std, coverage=coverage)
    n_set -= about
    n_set *= scale.value
    n_set += about
    return scale
