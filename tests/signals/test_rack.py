"""Percent torque of the control unit: its own clock, its gaps, its working point, and what is wrong with a channel."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.errors import SignalError
from shaftprint.recording import Channel
from shaftprint.signals import KINDS, WorkingPoint, inspect_channels, prepare_signals
from shaftprint.signals.kinds._kind import Source, SteadyState
from shaftprint.signals.kinds._rack import rack_signal, read_rack
from shaftprint.signals.levels._steady import SteadyStretch
from shaftprint.vessel import RackSensor, load_vessel

SENSOR = RackSensor(channel="X_percent", unit="%", cycle_s=0.05, latency_s=0.01, latency_std_s=0.005)
# The block in which the tests read, smaller than any channel.
BLOCK = 1000


@pytest.fixture
def messages(make_channel):
    """A channel as the bus gives it: bytes that count from -125 % on."""

    def make(percent, **changes):
        given = {"name": "X_percent", "unit": "%", "rate_hz": 20.0, "start_s": 0.013, "scale": 1.0, "offset": -125.0}
        return make_channel(np.rint(np.asarray(percent) + 125.0).astype(np.int16), **(given | changes))

    return make


def stretch(start_s, stop_s):
    return SteadyStretch(
        start_s=start_s,
        stop_s=stop_s,
        set_point_v=-5.0,
        speed_rev_s=19.7,
        speed_std_rev_s=0.01,
        torque_nm=1725.0,
        torque_std_nm=3.0,
    )


def percent_of(time_s):
    return 39.7 + 9.0 * np.sin(2.0 * np.pi * 0.31 * time_s)


def signal_of(channel, sensor=SENSOR, stretches=None, block_samples=BLOCK):
    stretches = stretches or (stretch(0.0, 60.0),)
    read = read_rack(channel, sensor, block_samples=block_samples)
    times = read.time_s if channel.is_uneven else None
    return rack_signal(
        read.values, channel, sensor, stretches, latency_s=sensor.latency_s, gaps=read.gaps, time_s=times
    )


def test_messages_stay_on_their_own_clock(messages):
    percent = percent_of(np.arange(1200) / 20.0)
    found = signal_of(messages(percent))
    assert found.values == pytest.approx(0.01 * np.rint(percent), abs=1e-12)
    assert not found.values.flags.writeable
    assert (found.rate_hz, found.cycle_s, found.nyquist_hz) == (20.0, 0.05, 10.0)
    # the first message, 10 ms late
    assert found.start_s == pytest.approx(0.003)
    assert found.stop_s == pytest.approx(60.003)
    assert (found.hold_s, found.averaging_s, found.resolution) == (0.0, 0.0, 0.01)


@pytest.mark.parametrize("block_samples", [64, 777, 1 << 20])
def test_values_that_a_logger_holds_are_means_of_a_tenth_of_a_cycle(messages, block_samples):
    percent = percent_of(np.arange(1200) / 20.0)
    held = messages(np.repeat(percent, 100), rate_hz=2000.0, start_s=1.0)
    found = signal_of(held, block_samples=block_samples)
    assert found.values.reshape(-1, 10) == pytest.approx(np.tile(0.01 * np.rint(percent), (10, 1)).T, abs=1e-12)
    assert (found.rate_hz, found.cycle_s, found.hold_s) == (200.0, 0.05, 0.05)
    assert found.averaging_s == pytest.approx(0.005)
    # the middle of the first ten samples, 10 ms late
    assert found.start_s == pytest.approx(1.0 + 4.5 / 2000.0 - 0.01)


def test_values_held_on_a_slow_logger_are_taken_one_by_one(messages):
    held = messages(np.repeat(percent_of(np.arange(1200) / 20.0), 5), rate_hz=100.0)
    found = signal_of(held)
    assert (found.rate_hz, found.hold_s, found.averaging_s) == (100.0, 0.05, 0.0)
    assert found.nyquist_hz == 10.0


def test_messages_without_a_value_are_bridged_and_listed(messages):
    percent = percent_of(np.arange(1200) / 20.0)
    spoilt = percent.copy()
    # a byte of 255 means not available, 254 error: 130 and 129 %
    spoilt[100:103] = 130.0
    spoilt[500] = 129.0
    read = read_rack(messages(spoilt), SENSOR, block_samples=BLOCK)
    fraction, repairs = read.values, read.repairs
    assert read.gaps == ()
    line = np.interp([100, 101, 102], [99, 103], np.rint(percent[[99, 103]]))
    assert fraction[100:103] == pytest.approx(0.01 * line)
    assert fraction[500] == pytest.approx(0.005 * np.rint(percent[[499, 501]]).sum())
    good = np.setdiff1d(np.arange(1200), [100, 101, 102, 500])
    assert fraction[good] == pytest.approx(0.01 * np.rint(percent[good]))
    assert [(r.channel, r.kind, r.count) for r in repairs] == [("X_percent", "dropout", 3), ("X_percent", "dropout", 1)]
    assert [r.time_s for r in repairs] == pytest.approx([0.013 + 5.0, 0.013 + 25.0])


def test_gap_in_held_values_leaves_the_good_samples(messages):
    percent = np.repeat(percent_of(np.arange(1200) / 20.0), 100)
    spoilt = percent.copy()
    spoilt[10_000:10_025] = 130.0
    read = read_rack(messages(spoilt, rate_hz=2000.0), SENSOR, block_samples=BLOCK)
    fraction, (repair,) = read.values, read.repairs
    # two groups of ten have no good sample; the third is the mean of the five that it has
    assert (repair.count, repair.time_s) == (20, pytest.approx(5.013))
    assert fraction[1002] == pytest.approx(0.01 * np.rint(percent[10_025]))


def came(percent, times, *, rate_hz=50.0):
    """Messages at times of their own, as a CAN logger stamps them."""
    values, times = np.rint(np.asarray(percent, dtype=float)), np.asarray(times)
    return Channel(
        name="X_percent",
        unit="%",
        rate_hz=rate_hz,
        start_s=float(times[0]),
        count=times.size,
        source=lambda first, stop: values[first:stop],
        stamps=lambda first, stop: times[first:stop],
        is_uneven=True,
    )


FAST = SENSOR.model_copy(update={"cycle_s": 0.02})


def stamps(count=3000, seed=4):
    """20 ms with 15 % of jitter about the cycle, 1 % lost."""
    rng = np.random.default_rng(seed)
    times = 0.0137 + 0.02 * np.arange(count) + 0.003 * np.sqrt(3.0) * rng.uniform(-1.0, 1.0, count)
    return np.delete(times, rng.permutation(count)[: count // 100])


def test_messages_keep_their_own_times_and_values():
    times = stamps()
    found = signal_of(came(percent_of(times), times), FAST)
    assert found.values == pytest.approx(0.01 * np.rint(percent_of(times)), abs=1e-12)
    assert found.time_s == pytest.approx(times - 0.01, abs=1e-12)
    assert (found.rate_hz, found.cycle_s, found.hold_s, found.averaging_s) == (50.0, 0.02, 0.0, 0.0)
    assert found.start_s == found.time_s[0]
    assert found.stop_s == pytest.approx(found.time_s[-1] + 0.02)
    assert found.gaps == ()


def test_messages_without_a_value_are_left_out_not_bridged():
    times = stamps()
    spoilt = percent_of(times)
    spoilt[100:103] = 130.0
    spoilt[500] = np.nan
    spoilt[1000:1030] = 129.0
    read = read_rack(came(spoilt, times), FAST, block_samples=BLOCK)
    good = np.setdiff1d(np.arange(times.size), [100, 101, 102, 500, *range(1000, 1030)])
    assert np.array_equal(read.time_s, times[good])
    assert read.values == pytest.approx(0.01 * np.rint(percent_of(times[good])), abs=1e-12)
    # three in a row are no hole, thirty are
    (gap,) = read.gaps
    assert (gap.start_s, gap.stop_s, gap.reason) == (times[999], times[1030], "has no messages")
    (finding,) = read.findings
    assert finding.startswith("Channel X_percent has times of its own: a message every 20 ms +/- 4.3 ms, 2.2 % lost")
    assert finding.endswith(f", 1 hole of up to {times[1030] - times[999]:.3g} s.")


def test_working_point_of_messages_is_that_of_the_steady_stretch():
    times = stamps()
    percent = np.where((times > 20.0) & (times < 40.0), 40.0, 70.0) + np.random.default_rng(5).standard_normal(
        times.size
    )
    found = signal_of(came(percent, times), FAST, stretches=(stretch(20.1, 39.9),))
    assert abs(found.reference - 0.4) < 4.0 * found.reference_std
    # noise of 1 % and steps of 1 % on 980 messages
    assert found.reference_std == pytest.approx(0.01 * np.sqrt(13.0 / 12.0 / 980.0), rel=0.4)


@pytest.mark.parametrize(
    ("make", "sensor", "message"),
    [
        (lambda t: np.full(t.size, 130.0), FAST, r"found only values above 125 %"),
        (lambda t: np.full(t.size, 40.0), FAST, r"expected a percent torque that moves, found 40 %"),
        (percent_of, SENSOR, None),
        (percent_of, SENSOR.model_copy(update={"cycle_s": 0.03}), r"expected 33\.3333 samples a second.* found 50"),
        (
            lambda t: 10.0 * percent_of(np.floor(t / 0.1) * 0.1) - 390.0,
            FAST,
            r"each sent again for 0\.1 s; set cycle_s",
        ),
    ],
    ids=["none", "still", "held", "another rate", "sent again"],
)
def test_messages_that_cannot_be_used_are_refused(make, sensor, message):
    times = stamps()
    channel = came(np.clip(make(times), -125.0, 130.0), times)
    if message is None:
        # a value every 50 ms that is asked for every 20 ms: as old as it may be, by half of 50 ms on average
        assert signal_of(channel, sensor).hold_s == 0.05
        return
    with pytest.raises(SignalError, match=message):
        signal_of(channel, sensor)


def test_messages_in_place_of_samples_are_refused(ship, vessel, campaign):
    recording = ship.recording()
    times = 0.02 * np.arange(12_500) + 0.004 * np.sin(np.arange(12_500.0))
    bus = replace(came(np.zeros(times.size), times), name="PTM_1", unit="V")
    recording = replace(recording, channels=dict(recording.channels) | {"PTM_1": bus})
    with pytest.raises(SignalError, match=r"channel PTM_1: expected samples at one rate for the .*, found a message"):
        prepare_signals(recording, vessel, campaign)


REFUSALS = {
    "constant": (np.full(1200, 40.0), {}, r"expected a percent torque that moves, found 40 % from beginning to end"),
    "never available": (np.full(1200, 130.0), {}, r"found only values above 125 %.*take \[sensors\.rack\] out"),
    "another rate": (
        percent_of(np.arange(1200) / 20.0),
        {"rate_hz": 30.0},
        r"expected 20 samples a second, one a message as cycle_s = 0\.05 says, .* found 30; correct cycle_s",
    ),
    "motored": (-percent_of(np.arange(1200) / 20.0), {}, r"expected a positive percent torque .* found -39\.\d %"),
    "logged too late": (
        percent_of(np.arange(1200) / 20.0),
        {"start_s": 100.0},
        r"while the line stands still, as near 0 s, found none there",
    ),
}


@pytest.mark.parametrize(("percent", "changes", "message"), REFUSALS.values(), ids=REFUSALS)
def test_useless_channel_is_refused_in_one_sentence(messages, percent, changes, message):
    with pytest.raises(SignalError, match=message) as caught:
        signal_of(messages(percent, **changes))
    assert "X_percent" in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("nothing", [130.0, np.nan])
def test_long_gap_is_kept_out_of_the_working_point(make_channel, nothing):
    """Messages 400 to 444 are lost, and those around them are wrong by so much that a mean would show it."""
    percent = percent_of(np.arange(1200) / 20.0)
    whole = signal_of(make_channel(percent.copy(), name="X", unit="%", rate_hz=20.0), stretches=(stretch(30.0, 60.0),))
    percent[380:465] = 90.0
    percent[400:445] = nothing
    channel = make_channel(percent, name="X", unit="%", rate_hz=20.0)
    found = signal_of(channel, stretches=(stretch(18.0, 25.0), stretch(30.0, 60.0)))
    (gap,) = found.gaps
    assert (gap.start_s, gap.stop_s) == pytest.approx((20.0 - SENSOR.latency_s, 22.25 - SENSOR.latency_s))
    assert gap.reason == "has no torque available"
    assert found.reference == whole.reference
    assert np.isfinite(found.values).all()


@pytest.mark.parametrize("noise_steps", [0.0, 0.2, 0.4, 1.0])
def test_working_point_is_as_uncertain_as_stated(messages, noise_steps):
    """Steps of 1 % do not average out where the rack stands still: the error of the mean over many true levels."""
    rng = np.random.default_rng(11)
    stretches = (stretch(0.0, 30.0), stretch(30.0, 60.0))
    errors, stated = [], []
    for true in rng.uniform(35.0, 45.0, 300):
        percent = true + noise_steps * rng.standard_normal(1200)
        percent[-1] += 5.0
        found = signal_of(messages(percent, start_s=0.0), stretches=stretches)
        errors.append(100.0 * found.reference - true)
        stated.append(100.0 * found.reference_std)
    ratio = np.sqrt(np.mean(np.square(errors)) / np.mean(np.square(stated)))
    # noise of a fifth of a step is half hidden by the steps: the uncertainty is then stated twice too large
    assert 0.45 < ratio < 1.1


@pytest.mark.parametrize("apart", [0.0, 2.0])
def test_another_load_of_a_stretch_is_no_error_of_the_working_point(messages, apart):
    """Noise and steps of 1 % on 600 messages a stretch leave 0.030 % of their mean, however they differ."""
    rng = np.random.default_rng(12)
    percent = 40.0 + rng.standard_normal(1200) + np.repeat([-0.5 * apart, 0.5 * apart], 600)
    percent[-1] += 5.0
    found = signal_of(messages(percent, start_s=0.0), stretches=(stretch(0.0, 30.0), stretch(30.0, 60.0)))
    assert 100.0 * found.reference_std == pytest.approx(np.sqrt((1.0 + 1.0 / 12.0) / 1200), rel=0.25)


@pytest.fixture(scope="module")
def with_bus():
    return load_vessel("stan-tug-1205-ecu")


@pytest.fixture
def logged(ship, messages):
    """The small ship with its torque on a bus, which is a second shorter than the logger's channels."""

    def make(spoil=lambda percent: percent, **changes):
        recording = ship.recording()
        start = changes.get("start_s", 0.013)
        time_s = start + np.arange(round((ship.campaign.duration_s - 1.0) * 20.0)) / 20.0
        # 10 ms ago; 1700 N m are 39.1 % of the rated torque behind gear and losses
        torque = np.interp(time_s - 0.01, ship.time_s, ship.torque_nm)
        channel = messages(spoil(100.0 * torque / (3.82 * 0.97 * 1172.44)), **changes)
        return replace(recording, channels=dict(recording.channels) | {"X_percent": channel})

    return make


def test_signals_hold_the_rack_and_are_otherwise_the_same(logged, with_bus, vessel, campaign):
    recording = logged()
    plain = prepare_signals(recording, vessel, campaign)
    signals = prepare_signals(recording, with_bus, campaign)
    assert "X" not in plain.channels
    assert np.array_equal(plain.shaft_torque_nm, signals.shaft_torque_nm)
    assert np.array_equal(plain.set_point_rev_s, signals.set_point_rev_s)
    assert np.array_equal(plain.engine_speed.speed_rev_s, signals.engine_speed.speed_rev_s)
    assert (plain.working_point, plain.repairs, plain.findings) == (
        signals.working_point, signals.repairs, signals.findings,
    )  # fmt: skip
    rack = signals.channels["X"]
    expected = signals.working_point.shaft_torque_nm / (3.82 * 0.97 * 1172.44)
    assert abs(rack.reference - expected) < 3.0 * rack.reference_std
    assert rack.reference_std == pytest.approx(0.01 / np.sqrt(12.0), rel=0.5)
    assert rack.start_s == pytest.approx(0.003)
    assert prepare_signals(recording, with_bus, campaign, mode="thesis").channels["X"].start_s == pytest.approx(0.013)


def test_bridged_messages_are_among_the_repairs(logged, with_bus, campaign):
    def lose(percent):
        percent = percent.copy()
        percent[2000:2004] = 130.0
        return percent

    repairs = prepare_signals(logged(lose), with_bus, campaign).repairs
    assert [(r.channel, r.time_s, r.count) for r in repairs if r.channel == "X_percent"] == [
        ("X_percent", pytest.approx(100.013), 4)
    ]
    assert list(repairs) == sorted(repairs, key=lambda repair: repair.time_s)


def test_missing_channel_and_other_unit_are_refused(ship, logged, with_bus, campaign):
    with pytest.raises(SignalError, match=r'expected a channel "X_percent" for the fuel rack, as the vessel file says'):
        prepare_signals(ship.recording(), with_bus, campaign)
    with pytest.raises(SignalError, match=r'channel X_percent: expected the unit "%" for the fuel rack, found "1"'):
        prepare_signals(logged(unit="1"), with_bus, campaign)


def test_inspection_tells_of_the_rack(logged, with_bus, vessel):
    assert "fuel rack" not in [report.use for report in inspect_channels(logged(), vessel)]
    report = inspect_channels(logged(), with_bus)[-1]
    assert (report.channel, report.use, report.unit, report.rate_hz) == ("X_percent", "fuel rack", "%", 20.0)
    assert report.problem is None
    assert report.pulses is None
    assert 20.0 < report.lowest < 39.0 < report.highest < 60.0
    dead = inspect_channels(logged(lambda percent: np.full_like(percent, 39.0)), with_bus)[-1]
    assert "expected a percent torque that moves, found 39 %" in dead.problem
    assert (dead.lowest, dead.highest) == (39.0, 39.0)


@pytest.mark.parametrize("way", ["load", "fuel rate"])
def test_load_and_fuel_rate_become_the_rack_by_the_speed(way):
    """One rack as a share of the full-load curve and as litres an hour, while the speed swings by 15 %."""
    vessel = load_vessel("stan-tug-1205-ecu")
    engine = vessel.engine
    times = stamps()
    grid_s = 0.005 * np.arange(12_000)

    def speed_rpm(when):
        return 1200.0 + 180.0 * np.sin(0.4 * when)

    # what a message shows is 10 ms old
    rack, rpm = 0.4 + 0.02 * np.sin(3.0 * (times - 0.01)), speed_rpm(times - 0.01)
    if way == "load":
        shown = 100.0 * rack * 1172.44 / np.interp(rpm, engine.full_load_speed_rpm, engine.full_load_torque_nm)
        fields = {"unit": "%", "shows": "load", "resolution_percent": 1.0}
    else:
        shown, fields = 58.0 * rack * rpm / 1800.0, {"unit": "L/h", "rated_l_h": 58.0}
    sensor = RackSensor(channel="X_percent", cycle_s=0.02, latency_s=0.01, **fields)
    channel = replace(came(shown, times), unit=fields["unit"], source=lambda first, stop: shown[first:stop])
    kind = KINDS["X"]
    source = Source(kind=kind, name="X", channel=channel, sensor=sensor, vessel=vessel)
    clock = SimpleNamespace(
        time_s=grid_s,
        latency_s=lambda stated_s: stated_s,
        block_samples=lambda _: BLOCK,
    )
    point = WorkingPoint(
        engine_speed_rev_s=19.7, shaft_torque_nm=1725.0, engine_speed_std_rev_s=0.01, shaft_torque_std_nm=3.0,
        set_point_v=-5.0, load_std=0.001,
    )  # fmt: skip
    steady = SteadyState(
        clock=clock, stretches=(stretch(0.0, 60.0),), working_point=point, calibration=None, scale=None,
        speed_rev_s=speed_rpm(grid_s) / 60.0,
    )  # fmt: skip
    signal = kind.signal(source, kind.read(source, clock), steady)
    assert signal.values == pytest.approx(rack, rel=1e-4)


def test_a_fuel_rate_needs_what_it_is_at_rated_power():
    fields = {"channel": "LFE", "unit": "L/h", "cycle_s": 0.1, "latency_s": 0.0}
    with pytest.raises(ValueError, match="expected rated_l_h for a channel in L/h, found none"):
        RackSensor(**fields)
    with pytest.raises(ValueError, match=r"expected rated_l_h left out for a channel in %, found 58\."):
        RackSensor(**fields | {"unit": "%", "rated_l_h": 58.0})
    with pytest.raises(ValueError, match='expected shows left out for a channel in L/h, found "load"'):
        RackSensor(**fields | {"rated_l_h": 58.0, "shows": "load"})
    assert RackSensor(**fields | {"unit": "l/h", "rated_l_h": 58.0}).unit == "L/h"
