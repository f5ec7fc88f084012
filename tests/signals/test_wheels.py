"""Wheels with gaps and further teeth, against a shaft that turns at a known, swinging speed."""

import numpy as np
import pytest
from tests.wheel_truth import CLOSEST, TEETH, Turning, wheel_pulses

from shaftprint.errors import SignalError
from shaftprint.signals import find_strips, spline_speed
from shaftprint.signals.kinds._pick_up import read_pick_up
from shaftprint.signals.pulses._pulses import number_pulses
from shaftprint.signals.pulses._strips import revolutions
from shaftprint.signals.pulses._teeth import number_teeth
from shaftprint.vessel import SpeedSensor
from shaftprint.vessel._wheel import Wheel

WHEELS = ("60-2", "36-1", "36-2-1", "12+1")


def counted_only(wheel, turning, numbers):
    """Those numbers of passing teeth that are counted: the one between the places of 12+1 is not."""
    which = turning.passing(TEETH[wheel])[1]
    return [number for number in numbers if wheel != "12+1" or which[number] < 12]


def starts(seed):
    """Every second shaft starts from rest, some after standing still; each at another angle."""
    return Turning(
        run_up_s=3.0 * (seed % 2), rest_s=0.5 * (seed % 4 == 3), start_rev=np.random.default_rng(seed).uniform()
    )


def sensor(wheel, edge="rising"):
    teeth = {"wheel": wheel} if set(wheel) & set("+-") else {"pulses_per_revolution": int(wheel)}
    return SpeedSensor(name="n", channel="P", shaft="engine", unit="V", edge=edge, **teeth)


def reading_of(volts, wheel, make_channel, *, rate_hz, edge="rising", mode="shaftprint"):
    return read_pick_up(
        make_channel(volts, name="P", rate_hz=rate_hz),
        sensor(wheel, edge),
        engine_over_shaft=1.0,
        mode=mode,
        start_s=0.0,
        rate_hz=200.0,
        count=int(volts.size / rate_hz * 200.0),
        block_samples=65_536,
    )


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("wheel", WHEELS)
def test_every_fault_of_an_edge_list_is_found_and_no_other(wheel, seed):
    turning = starts(seed)
    missing = counted_only(wheel, turning, (500, 901, 902, 1700))
    pulses = wheel_pulses(turning, wheel, jitter_s=20e-6, missing=missing, doubled=[330, 1200, 2000], seed=seed)
    train = number_teeth(pulses.rising_s * 2000.0, Wheel.parse(wheel), channel="P")
    missed = [fault for fault in train.faults if fault.kind == "missing pulse"]
    assert sum(fault.count for fault in missed) == len(missing)
    twice = [fault.position / 2000.0 for fault in train.faults if fault.kind == "doubled pulse"]
    assert twice == pytest.approx(pulses.doubled_s, abs=2e-6)
    assert train.lost == ()
    # a tooth every 1/60, 1/36, 1/12 of a turn, and none where there is none: the angle at every pulse
    angle = revolutions(train, train.nominal_rev)
    true = np.interp(train.position / 2000.0, turning.fine_s, turning.fine_rev)
    error = (angle - true) - np.median(angle - true)
    # six standard deviations of the jitter
    assert np.abs(error).max() < 6.0 * 20e-6 * turning.fine_rev_s.max()


@pytest.mark.parametrize("wheel", WHEELS)
def test_rising_and_falling_edges_give_one_mean(wheel):
    turning = starts(1)
    pulses = wheel_pulses(turning, wheel, jitter_s=20e-6)
    means = []
    for edges in (pulses.rising_s, pulses.falling_s):
        train = number_teeth(edges * 2000.0, Wheel.parse(wheel), channel="P")
        angle = revolutions(train, find_strips(train, Wheel.parse(wheel).counted, channel="P").angle_rev)
        speed = spline_speed(train.position / 2000.0, angle, start_s=5.0, step_s=0.001, count=34_001)
        means.append(float(np.trapezoid(speed, dx=0.001)) / 34.0)
    assert means[0] == pytest.approx(means[1], rel=1e-5)
    assert means[0] == pytest.approx(turning.mean_speed(5.0, 39.0), rel=1e-5)


@pytest.mark.parametrize("wheel", [*WHEELS, "24"])
def test_edge_doubled_within_a_microsecond_is_no_spike(wheel):
    turning = Turning(ripple=0.0)
    # on plain teeth and on those before and behind the gap
    pulses = wheel_pulses(turning, wheel, doubled=[*range(300, 300 + TEETH[wheel].size, 7), 400, 401])
    position = pulses.rising_s * 2000.0
    parsed = Wheel.parse(wheel)
    even = wheel == "24"
    train = number_pulses(position, channel="P") if even else number_teeth(position, parsed, channel="P")
    nominal = np.full(24, 1.0 / 24.0) if even else train.nominal_rev
    speed = spline_speed(train.position / 2000.0, revolutions(train, nominal), start_s=1.0, step_s=0.002, count=19_000)
    true = turning.speed_at(1.0 + 0.002 * np.arange(19_000))
    assert np.abs(speed / true - 1.0).max() < 0.002


@pytest.mark.slow
@pytest.mark.parametrize("edge", ["rising", "falling"])
@pytest.mark.parametrize("seed", [0, 3])
@pytest.mark.parametrize("wheel", WHEELS)
def test_four_samples_a_tooth_are_enough(wheel, seed, edge, make_channel):
    turning = starts(seed)
    rate_hz = 4.05 * CLOSEST[wheel] * turning.fine_rev_s.max()
    missing = counted_only(wheel, turning, (500, 901, 902, 1700))
    pulses = wheel_pulses(turning, wheel, jitter_s=20e-6, missing=missing, doubled=[330, 1200], seed=seed)
    reading = reading_of(pulses.voltage(rate_hz, 40.0), wheel, make_channel, rate_hz=rate_hz, edge=edge)
    found = {kind: sum(one.count for one in reading.repairs if one.kind == kind) for kind in ("missing pulse",)}
    # the microsecond between two edges is not sampled; of falling edges the pulse before a missing one is missing too
    assert found == {"missing pulse": len(missing)}
    assert {one.kind for one in reading.repairs} == {"missing pulse"}
    assert reading.gaps == ()
    assert reading.values[1000:7900].mean() == pytest.approx(turning.mean_speed(5.0 - 0.0025, 39.5 - 0.0025), rel=1e-4)


@pytest.mark.parametrize("wheel", WHEELS)
def test_speed_follows_a_swing_within_a_thousandth(wheel, make_channel):
    turning = Turning(ripple=0.0, duration_s=25.0)
    pulses = wheel_pulses(turning, wheel)
    rate_hz = 20_000.0
    reading = reading_of(pulses.voltage(rate_hz, 25.0), wheel, make_channel, rate_hz=rate_hz)
    true = turning.speed_at(np.arange(5000) / 200.0)
    error = reading.values[100:4900] / true[100:4900] - 1.0
    # two edges, each within half a sample, in the time from tooth to tooth
    assert np.sqrt(np.mean(error**2)) < np.sqrt(2.0 / 12.0) * CLOSEST[wheel] * 5.0 / rate_hz
    assert abs(error.mean()) < 1e-5


@pytest.mark.parametrize("wheel", WHEELS)
def test_errors_of_the_pitch_are_found_and_removed(wheel):
    teeth = TEETH[wheel].size
    errors = np.random.default_rng(5).normal(0.0, 0.1, teeth) / 360.0
    # between the places of 12+1 stands one that is not counted
    counted = 12 if wheel == "12+1" else teeth
    pulses = wheel_pulses(Turning(swing=0.01, swing_hz=0.1), wheel, jitter_s=5e-6, errors_rev=errors)
    train = number_teeth(pulses.rising_s * 2000.0, Wheel.parse(wheel), channel="P")
    found = find_strips(train, counted, channel="P")
    true = np.diff(np.append((TEETH[wheel] + errors)[:counted], 1.0 + errors[0]))
    turned = [np.roll(true, shift) for shift in range(counted)]
    closest = min(turned, key=lambda angles: float(np.abs(angles - found.angle_rev).max()))
    assert found.angle_rev == pytest.approx(closest, abs=0.01 / 360.0)
    assert found.angle_rev.sum() == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("true", "entered", "expected"),
    [
        (
            "60-2",
            "60",
            r'P: expected evenly spaced pulses, found .* wheel 60-2, .*; write wheel = "60-2" in place',
        ),
        ("60-2", "58", r'write wheel = "60-2" in place of pulses_per_revolution'),
        ("36-1", "36", r'write wheel = "36-1" in place'),
        (
            "36-2-1",
            "36-1",
            r'channel P: expected the teeth of a wheel 36-1.*found .* wheel 36-2-1.* wheel = "36-2-1" in',
        ),
        ("36-1", "60-2", r"expected the teeth of a wheel 60-2.*found those of a wheel 36-1"),
        ("36-2-1", "36", r'write wheel = "36-2-1" in place'),
        ("12+1", "12", r'write wheel = "12\+1" in place'),
        ("12+1", "60-2", r'write wheel = "12\+1" in the vessel file'),
        ("24", "60-2", r"found \d+ pulses of which none is missing or too many turn after turn; write pulses_per_rev"),
        ("24", "12+1", r"found \d+ pulses of which none is missing or too many turn after turn"),
    ],
)
def test_a_wrong_wheel_is_named_by_the_one_that_fits(true, entered, expected, make_channel):
    volts = wheel_pulses(Turning(duration_s=20.0), true, missing=[200, 333]).voltage(8000.0, 20.0)
    with pytest.raises(SignalError, match=expected):
        reading_of(volts, entered, make_channel, rate_hz=8000.0)


def test_random_faults_are_no_wheel():
    rng = np.random.default_rng(4)
    position = np.delete(
        100.0 * np.arange(4000) + rng.standard_normal(4000), rng.choice(np.arange(5, 3990), 150, False)
    )
    train = number_pulses(position, channel="P")
    assert sum(fault.count for fault in train.faults) == 150


def there_and_back(wheel):
    """Edges of a shaft that slows down, turns back after 20 s, and is fast again after 40 s."""
    fine = np.linspace(0.0, 40.0, 800_001)
    turned = np.cumsum(5.0 * np.clip((20.0 - fine) / 4.0, -1.0, 1.0)) * fine[1]
    rising = []
    width = 0.5 / CLOSEST[wheel]
    for tooth in TEETH[wheel]:
        high = (turned - tooth) % 1.0 < width
        rising += fine[1:][high[1:] & ~high[:-1]].tolist()
    return np.sort(rising)


@pytest.mark.parametrize("wheel", ["60-2", "36-2-1"])
def test_a_shaft_that_turns_back_ends_in_a_sentence(wheel, make_channel):
    rising = there_and_back(wheel)
    train = number_teeth(rising * 2000.0, Wheel.parse(wheel), channel="P")
    assert len(train.lost) == 1
    # within two turns of the moment
    assert train.lost[0].first / 2000.0 == pytest.approx(19.0, abs=1.5)
    time = np.arange(80_000) / 2000.0
    since = time - rising[np.maximum(np.searchsorted(rising, time) - 1, 0)]
    volts = np.where((since < 0.0012) & (time > rising[0]), 4.7, 0.3)
    reading = reading_of(volts, wheel, make_channel, rate_hz=2000.0)
    assert [gap.sentence.split(" from ")[0] for gap in reading.gaps] == [
        "channel P has teeth in another order than before, as where a shaft stops or turns back,"
    ]


def test_a_standstill_ends_in_a_sentence(make_channel):
    turning = Turning(rest_s=4.0, run_up_s=3.0, duration_s=30.0)
    first = wheel_pulses(Turning(duration_s=10.0), "36-1")
    again = wheel_pulses(turning, "36-1")
    volts = np.concatenate([first.voltage(4000.0, 10.0), again.voltage(4000.0, 30.0)])
    reading = reading_of(volts, "36-1", make_channel, rate_hz=4000.0)
    sentence = reading.gaps[0].sentence
    assert sentence.startswith("channel P has no pulses from ")
    assert (reading.gaps[0].start_s, reading.gaps[0].stop_s) == pytest.approx((10.0, 14.1), abs=0.2)
    assert reading.repairs == ()


@pytest.mark.parametrize("edge", ["rising", "falling"])
@pytest.mark.parametrize("rest_s", [1.2, 4.0])
def test_an_engine_that_starts_behind_a_lone_edge_is_counted_once(rest_s, edge, make_channel):
    """The level at which a logger begins looks like a pulse; then nothing, until the shaft turns."""
    turning = Turning(speed_rev_s=15.0, swing=0.02, duration_s=4.0)
    volts = np.full(round(10_000.0 * rest_s), 0.3)
    volts[3:8] = 4.7
    volts = np.append(volts, wheel_pulses(turning, "60-2").voltage(10_000.0, 4.0))
    reading = reading_of(volts, "60-2", make_channel, rate_hz=10_000.0, edge=edge)
    # 58 teeth a turn; first and last tooth stand anywhere within the turn of 0.07 s
    assert reading.pulse_rate_hz == pytest.approx(58.0 * turning.mean_speed(0.0, 4.0), rel=0.002)
    assert [gap.reason for gap in reading.gaps] == ["has no pulses"]
    assert reading.gaps[0].stop_s == pytest.approx(rest_s, abs=0.1)


def test_a_rate_that_is_too_slow_is_refused_with_the_rate_that_would_do(make_channel):
    turning = Turning(swing=0.0, ripple=0.0)
    volts = wheel_pulses(turning, "60-2").voltage(1000.0, 40.0)
    # 60 teeth at 5 turns a second, four samples each; a turn of 199 samples seems to be the fastest
    with pytest.raises(
        SignalError, match=r"found 3\.3 at 5\.03 turns a second of the wheel 60-2 and 1000 Hz; log at 1300 Hz"
    ):
        reading_of(volts, "60-2", make_channel, rate_hz=1000.0)


def test_thesis_mode_knows_the_gaps(make_channel):
    turning = Turning(swing=0.0, ripple=0.0)
    volts = wheel_pulses(turning, "36-2-1").voltage(20_000.0, 40.0)
    reading = reading_of(volts, "36-2-1", make_channel, rate_hz=20_000.0, mode="thesis")
    # whole samples of a period of 111
    assert reading.values == pytest.approx(np.full(8000, 5.0), rel=1.0 / 111.0)
