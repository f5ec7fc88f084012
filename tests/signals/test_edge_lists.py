"""Speed from the list of edges of a toothed wheel, as a logic analyser writes it, against a known shaft."""

import numpy as np
import pytest
from tests.wheel_truth import TEETH, Turning, wheel_pulses

from shaftprint.recording import read_recording
from shaftprint.signals.kinds._pick_up import read_pick_up
from shaftprint.vessel import SpeedSensor

WHEELS = ("24", "60-2", "36-1", "36-2-1", "12+1")


def listed(path, rising_s, falling_s):
    """Write the level behind each edge, or the times alone where falling edges are not known."""
    if falling_s is None:
        lines = ["time [s]", *(f"{time:.9f}" for time in rising_s)]
    else:
        times = np.concatenate([rising_s, falling_s])
        levels = np.repeat([1, 0], [rising_s.size, falling_s.size])
        order = np.argsort(times, kind="stable")
        rows = zip(times[order].tolist(), levels[order].tolist(), strict=True)
        lines = ["Time [s],Channel 0", "0.0,0", *(f"{time:.9f},{level}" for time, level in rows)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def reading_of(path, wheel, *, edge="rising", duration_s=40.0):
    teeth = {"wheel": wheel} if set(wheel) & set("+-") else {"pulses_per_revolution": int(wheel)}
    with read_recording(path) as recording:
        (channel,) = recording.channels.values()
        return read_pick_up(
            channel,
            SpeedSensor(name="n", channel=channel.name, shaft="engine", unit="V", edge=edge, **teeth),
            engine_over_shaft=1.0,
            mode="shaftprint",
            start_s=0.0,
            rate_hz=200.0,
            count=round(200.0 * duration_s),
            block_samples=65_536,
        )


def counted_only(wheel, turning, numbers):
    """Those numbers of passing teeth that are counted: the one between the places of 12+1 is not."""
    which = turning.passing(TEETH[wheel])[1]
    return [number for number in numbers if wheel != "12+1" or which[number] < 12]


@pytest.mark.parametrize("wheel", WHEELS)
def test_forty_seconds_from_rest_give_the_mean_with_either_edge(wheel, tmp_path):
    turning = Turning(run_up_s=3.0, rest_s=0.5)
    missing = counted_only(wheel, turning, (500, 901, 902, 1700))
    pulses = wheel_pulses(turning, wheel, jitter_s=20e-6, missing=missing, doubled=[330, 1200], seed=3)
    means = []
    for edge in ("rising", "falling"):
        reading = reading_of(listed(tmp_path / "edges.csv", pulses.rising_s, pulses.falling_s), wheel, edge=edge)
        means.append(reading.values[1000:7900].mean())
        assert reading.gaps == ()
        assert {one.kind for one in reading.repairs} == {"missing pulse"}
        assert sum(one.count for one in reading.repairs) == len(missing)
    true = turning.mean_speed(5.0 - 0.0025, 39.5 - 0.0025)
    assert means[0] == pytest.approx(means[1], rel=1e-5)
    assert means[0] == pytest.approx(true, rel=1e-5)


@pytest.mark.parametrize("wheel", WHEELS)
def test_times_alone_give_the_same_mean(wheel, tmp_path):
    turning = Turning()
    pulses = wheel_pulses(turning, wheel, jitter_s=20e-6, missing=counted_only(wheel, turning, (900, 901)))
    reading = reading_of(listed(tmp_path / "times.csv", pulses.rising_s, None), wheel)
    assert reading.values[1000:7900].mean() == pytest.approx(turning.mean_speed(4.9975, 39.4975), rel=1e-5)
    assert sum(one.count for one in reading.repairs) == len(counted_only(wheel, turning, (900, 901)))
    assert reading.gaps == ()
    assert reading.findings == ()


@pytest.mark.parametrize("wheel", WHEELS)
def test_an_edge_doubled_within_a_microsecond_is_no_spike(wheel, tmp_path):
    turning = Turning(ripple=0.0, duration_s=25.0)
    readings = []
    for doubled in ([], [*range(300, 300 + TEETH[wheel].size, 7), 400, 401]):
        pulses = wheel_pulses(turning, wheel, doubled=doubled)
        path = listed(tmp_path / "edges.csv", pulses.rising_s, pulses.falling_s)
        readings.append(reading_of(path, wheel, duration_s=25.0))
    clean, spoilt = readings
    # times are written to the nanosecond
    assert spoilt.values == pytest.approx(clean.values, rel=1e-6)
    assert spoilt.repairs == ()
    true = turning.speed_at(np.arange(5000) / 200.0)
    assert clean.values[100:4900] == pytest.approx(true[100:4900], rel=5e-4)


def test_a_standstill_ends_in_a_sentence(tmp_path):
    first = wheel_pulses(Turning(duration_s=10.0), "36-1")
    again = wheel_pulses(Turning(rest_s=4.0, run_up_s=3.0, duration_s=30.0), "36-1")
    path = listed(
        tmp_path / "edges.csv",
        np.concatenate([first.rising_s, 10.0 + again.rising_s]),
        np.concatenate([first.falling_s, 10.0 + again.falling_s]),
    )
    reading = reading_of(path, "36-1")
    assert reading.gaps[0].sentence.startswith("channel Channel 0 has no pulses from ")
    assert (reading.gaps[0].start_s, reading.gaps[0].stop_s) == pytest.approx((10.0, 14.1), abs=0.2)
    assert reading.repairs == ()


def test_a_shaft_that_turns_back_ends_in_a_sentence(tmp_path):
    fine = np.linspace(0.0, 40.0, 800_001)
    turned = np.cumsum(5.0 * np.clip((20.0 - fine) / 4.0, -1.0, 1.0)) * fine[1]
    high = np.any([(turned - tooth) % 1.0 < 0.5 / 60.0 for tooth in TEETH["60-2"]], axis=0)
    rising, falling = (fine[1:][change] for change in (high[1:] & ~high[:-1], high[:-1] & ~high[1:]))
    reading = reading_of(listed(tmp_path / "edges.csv", rising, falling), "60-2")
    (gap,) = reading.gaps
    assert gap.sentence.startswith("channel Channel 0 has teeth in another order than before, as where a shaft stops")
    assert gap.start_s == pytest.approx(19.0, abs=1.5)
