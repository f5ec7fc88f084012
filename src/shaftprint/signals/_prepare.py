"""The verb of the room: from a raw recording to signals in physical units."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.campaign import Campaign
from shaftprint.errors import SignalError
from shaftprint.signals._calibrate import calibrate, calibrate_through_wander
from shaftprint.signals._channels import find_channel
from shaftprint.signals._compare import compare_speeds
from shaftprint.signals._condition import Conditioned, conditioned
from shaftprint.signals._dc_scale import DcScale, dc_scale
from shaftprint.signals._flat_top import expect_whole_crests
from shaftprint.signals._found_test import FoundTest
from shaftprint.signals._found_tests import found_tests
from shaftprint.signals._gaps import Coverage, Gap, within
from shaftprint.signals._match import expect_campaign, left_out
from shaftprint.signals._outliers import fault_limits
from shaftprint.signals._pick_up import PickUp, read_pick_up
from shaftprint.signals._rack import rack_signal, read_rack
from shaftprint.signals._rates import expect_one_rate
from shaftprint.signals._ship_speed import read_ship_speed, ship_speed_signal
from shaftprint.signals._signals import RackSignal, Repair, SetPointCalibration, ShipSpeedSignal, Signals, WorkingPoint
from shaftprint.signals._sources import Clock, Mode, Sources, common_clock, find_sources
from shaftprint.signals._steadiness import expect_steady_gauge
from shaftprint.signals._steady import SteadyStretch, steady_stretches
from shaftprint.signals._steps import find_step_delays
from shaftprint.signals._torque import expect_moving_torque, judge_saturation, torque_limits
from shaftprint.signals._working_point import (
    expect_plausible,
    find_working_point,
    stretches_at_working_point,
    working_point_of_test,
    working_voltage,
)

if TYPE_CHECKING:
    from shaftprint.recording import Channel, Recording
    from shaftprint.vessel import SpeedSensor, Vessel

# One thread computes while the other waits for the file; more would only queue for the file.
_THREADS = 2
# Rate at which the set point alone is looked at [Hz].
_SET_POINT_HZ = 200.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Read:
    """Everything that was read, on the grid, before it is put together."""

    volts: FloatArray
    torque_nm: FloatArray
    pick_ups: tuple[PickUp, ...]
    rack: Conditioned | None
    ship_speed: Conditioned | None
    repairs: tuple[Repair, ...]
    gaps: tuple[Gap, ...]
    findings: tuple[str, ...]


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

    Raises
    ------
    SignalError
        If a channel is missing, dead, saturated or in another unit, or if the recording does not show what
        the campaign asked, or no test of it whole. What it lacks in gaps or at its ends is in the findings.
    """
    if mode not in ("shaftprint", "thesis"):
        raise SignalError(f'mode: expected "shaftprint" or "thesis", found "{mode}".')
    sources = find_sources(recording, vessel)
    clock = common_clock(sources, mode=mode, rate_hz=rate_hz, chunk_s=chunk_s, progress=progress)
    return _put_together(recording, vessel, campaign, clock, sources, _read_all(vessel, sources, clock))


def find_tests(recording: "Recording", vessel: "Vessel", campaign: Campaign) -> tuple[FoundTest, ...]:
    """Return when and how every test of a campaign was really made, from the recorded set point alone.

    Parameters
    ----------
    recording
        The raw recording, open.
    vessel
        Says which channel is the set point.
    campaign
        What was asked of the ship; its times may be off by the same amount, or each by a few seconds.

    Returns
    -------
    One entry a test, in order of time; `proposed_campaign` makes a campaign of them.

    Raises
    ------
    SignalError
        If the channel of the set point is missing, in another unit, or holds no numbers.
    """
    sensor = vessel.sensors.set_point
    channel = find_channel(recording, sensor.channel, unit=sensor.unit, use="set point")
    rate_hz = min(_SET_POINT_HZ, channel.rate_hz)
    clock = Clock(
        start_s=channel.start_s,
        rate_hz=rate_hz,
        count=int(channel.duration_s * rate_hz),
        mode="shaftprint",
        chunk_s=None,
        advance=lambda samples: None,
    )
    return found_tests(_read_set_point(channel, clock).values, campaign, rate_hz=rate_hz, start_s=clock.start_s)


def _read_all(vessel: "Vessel", sources: Sources, clock: Clock) -> _Read:
    """Read every channel, two at a time; a pick-up that fails is left out unless it is the first."""
    sensors = vessel.sensors.speed
    pool = ThreadPoolExecutor(max_workers=_THREADS)
    try:
        torque_job = pool.submit(_read_torque, sources.torque, vessel, clock)
        volts_job = pool.submit(_read_set_point, sources.set_point, clock)
        speed_jobs = [
            pool.submit(_read_speed, channel, sensor, vessel, clock)
            for channel, sensor in zip(sources.speed, sensors, strict=True)
        ]
        torque, volts = torque_job.result(), volts_job.result()
        rack = _read_rack(sources, vessel, clock)
        ship_speed = _read_ship_speed(sources, vessel, clock)
        pick_ups = [speed_jobs[0].result()]
        gaps = [*torque.gaps, *volts.gaps, *pick_ups[0].gaps, *(() if ship_speed is None else ship_speed.gaps)]
        findings = list(judge_saturation(sources.torque, torque.repairs))
        for sensor, job in zip(sensors[1:], speed_jobs[1:], strict=True):
            try:
                pick_ups.append(_expect_whole(job.result(), gaps))
            except SignalError as error:
                findings.append(f"{sensor.name} was left out: {error}")
    finally:
        pool.shutdown(cancel_futures=True)
    repairs = [*torque.repairs, *volts.repairs, *(() if rack is None else rack.repairs)]
    repairs += [repair for pick_up in pick_ups for repair in pick_up.repairs]
    return _Read(
        volts=volts.values,
        torque_nm=torque.values,
        pick_ups=tuple(pick_ups),
        rack=rack,
        ship_speed=ship_speed,
        repairs=tuple(sorted(repairs, key=lambda repair: repair.time_s)),
        gaps=tuple(sorted((gap for gap in gaps if gap.last_s > clock.start_s), key=lambda gap: gap.start_s)),
        findings=(*findings, *(finding for pick_up in pick_ups for finding in pick_up.findings)),
    )


def _expect_whole(pick_up: PickUp, gaps: Sequence[Gap]) -> PickUp:
    """Return a further pick-up if it misses nothing but what the other channels miss too.

    Raises
    ------
    SignalError
        If it has a gap of its own: that must not cost the windows of the first pick-up.
    """
    for gap in pick_up.gaps:
        if not within(gap, gaps):
            raise SignalError(f"{gap.sentence}; check the pick-up.")
    return pick_up


def _read_torque(channel: "Channel", vessel: "Vessel", clock: Clock) -> Conditioned:
    sensor = vessel.sensors.shaft_torque
    latency_s = 0.0 if clock.mode == "thesis" else sensor.latency_s
    found = conditioned(
        channel,
        torque_limits(channel, sensor),
        clock.grid(channel, latency_s),
        mode=clock.mode,
        block_samples=clock.block_samples(channel),
        advance=clock.advance,
    )
    gaps = (replace(gap, start_s=gap.start_s - latency_s, stop_s=gap.stop_s - latency_s) for gap in found.gaps)
    return Conditioned(values=sensor.torque_nm(found.values), repairs=found.repairs, gaps=tuple(gaps))


def _read_set_point(channel: "Channel", clock: Clock) -> Conditioned:
    return conditioned(
        channel,
        fault_limits(channel, holds=False),
        clock.grid(channel),
        mode=clock.mode,
        block_samples=clock.block_samples(channel),
        advance=clock.advance,
    )


def _read_rack(sources: Sources, vessel: "Vessel", clock: Clock) -> Conditioned | None:
    sensor = vessel.sensors.rack
    if sources.rack is None or sensor is None:
        return None
    return read_rack(sources.rack, sensor, block_samples=clock.block_samples(sources.rack))


def _read_ship_speed(sources: Sources, vessel: "Vessel", clock: Clock) -> Conditioned | None:
    channel, sensor = sources.ship_speed, vessel.sensors.ship_speed
    if channel is None or sensor is None:
        return None
    latency_s = 0.0 if clock.mode == "thesis" else sensor.latency_s
    return read_ship_speed(channel, sensor, clock, latency_s=latency_s)


def _rack_signal(
    sources: Sources,
    vessel: "Vessel",
    clock: Clock,
    read: Conditioned | None,
    stretches: tuple[SteadyStretch, ...],
    point: WorkingPoint,
) -> RackSignal | None:
    sensor = vessel.sensors.rack
    if sources.rack is None or sensor is None or read is None:
        return None
    latency_s = 0.0 if clock.mode == "thesis" else sensor.latency_s
    load = point.shaft_torque_nm / find_working_point(stretches).shaft_torque_nm
    return rack_signal(read.values, sources.rack, sensor, stretches, latency_s=latency_s, gaps=read.gaps, load=load)


def _ship_speed_signal(
    sources: Sources, vessel: "Vessel", clock: Clock, read: Conditioned | None, stretches: tuple[SteadyStretch, ...]
) -> tuple[ShipSpeedSignal | None, tuple[str, ...]]:
    """Return the speed of the ship, and a finding where its log says that the ship had no way on."""
    channel, sensor = sources.ship_speed, vessel.sensors.ship_speed
    if channel is None or sensor is None or read is None:
        return None, ()
    found = ship_speed_signal(read.values, channel, sensor, clock, stretches)
    if found is None:
        return None, (f"the speed of the ship in channel {channel.name} was left out: the ship had no way on",)
    return found, ()


def _read_speed(channel: "Channel", sensor: "SpeedSensor", vessel: "Vessel", clock: Clock) -> PickUp:
    return read_pick_up(
        channel,
        sensor,
        gear_ratio=vessel.gearbox.ratio,
        mode=clock.mode,
        start_s=clock.start_s,
        rate_hz=clock.rate_hz,
        count=clock.count,
        block_samples=clock.block_samples(channel),
        advance=clock.advance,
    )


def _put_together(
    recording: "Recording", vessel: "Vessel", campaign: Campaign, clock: Clock, sources: Sources, read: _Read
) -> Signals:
    """Calibrate the set point, find the working point and the steps, and say what was found."""
    channel = vessel.sensors.set_point.channel
    rate_hz, start_s = clock.rate_hz, clock.start_s
    speeds = tuple(pick_up.speed for pick_up in read.pick_ups)
    speed, torque, n_set = speeds[0].speed_rev_s, read.torque_nm, read.volts
    reasons = [*expect_one_rate(recording, sources.every), *expect_whole_crests(sources.torque)]
    coverage = Coverage(start_s=start_s, stop_s=start_s + clock.count / rate_hz, step_s=1.0 / rate_hz, gaps=read.gaps)
    lost = left_out(campaign, coverage, name=str(recording.path))
    grid = {"rate_hz": rate_hz, "start_s": start_s}
    mismatches = expect_campaign(n_set, campaign, **grid, channel=channel, coverage=coverage)
    expect_moving_torque(torque, campaign, vessel.sensors.shaft_torque, **grid, coverage=coverage)
    differences = compare_speeds(speeds, vessel)
    stretches = steady_stretches(n_set, speed, torque, campaign, **grid, coverage=coverage)
    thesis = clock.mode == "thesis"
    quiet = stretches_at_working_point(stretches, campaign, channel=channel)
    if thesis:
        calibration = calibrate(stretches, channel=channel)
        working_point = find_working_point(quiet)
    else:
        about_v = working_voltage(quiet)
        calibration, *at = calibrate_through_wander(
            stretches,
            campaign,
            about_v=about_v,
            set_point_v=n_set,
            speed_rev_s=speed,
            channel=channel,
            **grid,
            coverage=coverage,
        )
        working_point = working_point_of_test(speed, torque, at_v=about_v, at=(at[0], at[1]), **grid, coverage=coverage)
    strange = expect_plausible(working_point, vessel)
    if not thesis:
        reasons += expect_steady_gauge(
            stretches,
            campaign,
            speed_rev_s=speed,
            torque_nm=torque,
            **grid,
            channel=vessel.sensors.shaft_torque.channel,
            coverage=coverage,
        )
    n_set *= calibration.slope_rev_s_per_v
    n_set += calibration.intercept_rev_s
    scale = DcScale(value=1.0, std=0.0, findings=())
    if not thesis:
        scale = _rescale(n_set, speed, campaign, coverage, calibration, **grid, about=working_point.engine_speed_rev_s)
    ship_speed, moored = _ship_speed_signal(sources, vessel, clock, read.ship_speed, quiet)
    delays, missed = find_step_delays(n_set, speed, campaign, **grid, coverage=coverage)
    return Signals(
        rate_hz=rate_hz,
        start_s=start_s,
        set_point_rev_s=frozen_float(n_set),
        shaft_torque_nm=frozen_float(torque),
        speeds={speed.name: speed for speed in speeds},
        working_point=working_point,
        calibration=calibration,
        dc_scale=scale.value,
        dc_scale_std=scale.std,
        strips=tuple(pick_up.strips for pick_up in read.pick_ups if pick_up.strips is not None),
        step_delays=delays,
        repairs=read.repairs,
        gaps=read.gaps,
        mode=clock.mode,
        findings=(*lost, *read.findings, *mismatches, *strange, *differences, *scale.findings, *moored, *missed),
        reasons=tuple(reasons),
        recording_sha256=recording.sha256,
        recording_name=recording.path.name,
        set_point_channel=channel,
        rack=_rack_signal(sources, vessel, clock, read.rack, quiet, working_point),
        ship_speed=ship_speed,
    )


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
