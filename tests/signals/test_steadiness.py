"""A torque gauge whose gain changes within a test, and a set point whose amplitude does: made-up legs and sines."""

import tracemalloc

import numpy as np
import pytest
from scipy.signal import lfilter

from shaftprint.campaign import Campaign
from shaftprint.signals.levels._fast_gain import fast_gains
from shaftprint.signals.levels._set_point_steadiness import Amplitudes, change_of, expect_steady_set_point
from shaftprint.signals.levels._steadiness import expect_steady_gauge, loads_of
from shaftprint.signals.levels._unseen_gain import unseen_gains

RATE_HZ, PERIOD_S = 50.0, 20.0
HARMONICS = (1, 3, 7, 13, 21, 31, 43)
HERTZ = (0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2)


@pytest.fixture(scope="module")
def two_speeds():
    leg = {
        "period_s": PERIOD_S,
        "harmonics": list(HARMONICS),
        "amplitudes_v": [0.2] * len(HARMONICS),
        "phases_rad": [0.7 * k * k for k in range(len(HARMONICS))],
    }
    return Campaign.model_validate(
        {
            "name": "two speeds",
            "duration_s": 440.0,
            "offset_v": -5.0,
            "ramp_s": 4.0,
            "multisines": [
                leg | {"name": "M1", "level_v": -5.0, "start_s": 10.0, "settled_s": 15.0, "stop_s": 215.0},
                leg | {"name": "M2", "level_v": -3.5, "start_s": 220.0, "settled_s": 225.0, "stop_s": 425.0},
            ],
        }
    )


@pytest.fixture(scope="module")
def sines():
    windows = [
        {
            "name": f"S{place}",
            "frequency_hz": hertz,
            "amplitude_v": 0.5,
            "start_s": 50.0 * place,
            "settled_s": 50.0 * place + 5.0,
            "stop_s": 50.0 * place + 45.0,
        }
        for place, hertz in enumerate(HERTZ)
    ]
    return Campaign.model_validate({"name": "sines", "duration_s": 350.0, "offset_v": -5.0, "sines": windows})


def put_out(campaign):
    time = np.arange(round(campaign.duration_s * RATE_HZ)) / RATE_HZ
    volts = np.full(time.size, campaign.offset_v)
    for test in (*campaign.sines, *campaign.legs):
        inside = (time >= test.start_s) & (time < test.stop_s)
        if campaign.legs:
            volts[inside] = test.value_at(time[inside])
        else:
            volts[inside] += test.amplitude_v * np.sin(2 * np.pi * test.frequency_hz * (time[inside] - test.start_s))
    return time, volts


def ship(volts, *, inertia_s=0.35, load=0.0, seed=0):
    """Speed of first order behind the set point, torque of a propeller and an inertia, 1 % of wander and of noise."""
    rng = np.random.default_rng(seed)
    share = 1.0 - np.exp(-1.0 / RATE_HZ / 0.15)
    speed = 20.0 + lfilter([share], [1.0, share - 1.0], -4.0 * (volts + 5.0))
    relative = speed / 20.0
    slow = np.exp(-1.0 / RATE_HZ / 30.0)
    wander = 0.01 * lfilter([np.sqrt(1.0 - slow**2)], [1.0, -slow], rng.standard_normal(speed.size))
    torque = relative**2 * (1.0 + load + wander) + inertia_s * np.gradient(relative) * RATE_HZ
    return speed, 1500.0 * (torque + 0.01 * rng.standard_normal(speed.size))


def gauge(campaign, gain=1.0, **of_ship):
    time, volts = put_out(campaign)
    speed, torque = ship(volts, **of_ship)
    shown = torque * (gain(time) if callable(gain) else gain)
    reasons, _ = expect_steady_gauge(
        campaign, set_point=volts, speed_rev_s=speed, torque_nm=shown, rate_hz=RATE_HZ, start_s=0.0, channel="M_s"
    )
    return [(reason.kind, reason.sentence) for reason in reasons]


def set_point(campaign, of):
    time, volts = put_out(campaign)
    found = expect_steady_set_point(campaign, of(time, volts), rate_hz=RATE_HZ, start_s=0.0, channel="U")
    return [(reason.kind, reason.sentence) for reason in found]


@pytest.mark.parametrize("seed", range(3))
def test_a_gauge_that_stays_as_it_is_is_not_named(two_speeds, sines, seed):
    assert gauge(two_speeds, seed=seed) == []
    assert gauge(sines, seed=seed) == []


@pytest.mark.parametrize("at_s", [120.0, 218.0, 300.0])
def test_a_step_of_the_gain_is_named_with_size_and_time_within_a_leg_and_between_two(two_speeds, at_s):
    ((kind, sentence),) = gauge(two_speeds, lambda time: 1.0 + 0.05 * (time >= at_s))
    assert kind == "gauge steadiness"
    assert sentence.startswith("The gain of the torque gauge in channel M_s is ")
    words = sentence.split()
    assert float(words[words.index("higher") - 2]) == pytest.approx(5.0, abs=0.8)
    assert float(words[words.index("from") + 1]) == pytest.approx(at_s, abs=8.0)


def test_a_gauge_that_warms_up_is_named_with_its_time(two_speeds):
    ((_, sentence),) = gauge(two_speeds, lambda time: 1.0 - 0.08 * np.exp(-time / 80.0))
    words = sentence.split()
    assert "warms up" in sentence
    # from 0.93 at the begin of the first leg to 1 is 7.6 %
    assert float(words[words.index("by") + 1]) == pytest.approx(7.6, abs=1.2)
    assert 50.0 < float(words[words.index("about") + 1]) < 130.0


def test_a_load_that_jumps_is_no_gain(two_speeds):
    time, _ = put_out(two_speeds)
    ((kind, sentence),) = gauge(two_speeds, load=0.15 * (time >= 110.0))
    assert kind == "gauge steadiness"
    assert "zero of the torque gauge" in sentence
    assert "gain" not in sentence


def test_a_torque_that_loses_time_at_one_speed_is_no_gain(sines):
    time, volts = put_out(sines)
    speed, torque = ship(volts)
    for at_s in (160.0, 230.0):
        late = np.interp(time + 0.1 * (time >= at_s), time, torque)
        found, _ = expect_steady_gauge(
            sines, set_point=volts, speed_rev_s=speed, torque_nm=late, rate_hz=RATE_HZ, start_s=0.0, channel="M_s"
        )
        assert not any("gain" in reason.sentence for reason in found)


def test_a_speed_that_stands_still_says_nothing_of_the_gain(two_speeds):
    _, volts = put_out(two_speeds)
    rng = np.random.default_rng(1)
    still = 20.0 + 0.001 * rng.standard_normal(volts.size)
    torque = 1500.0 + rng.standard_normal(volts.size)
    reasons, unseen = expect_steady_gauge(
        two_speeds, set_point=volts, speed_rev_s=still, torque_nm=torque, rate_hz=RATE_HZ, start_s=0.0, channel="M"
    )
    assert reasons == ()
    # a load that stands still tells the gain within each speed, and nothing between them
    assert sum(unseen.values()) == pytest.approx(0.0, abs=1e-12)


def test_what_is_unseen_is_what_is_known_of_gauges_where_nothing_is_told():
    means = np.array([[0.25], [0.75]])
    told = {"size": np.zeros(1), "power": np.zeros(1), "twice": np.zeros(1)}
    # one gauge in five changes, by 5 %: root of 1/5 of 0.05^2, of which a drift leaves a quarter on either side
    off = 0.25 * np.sqrt(0.2) * 0.05
    assert np.abs(unseen_gains(means, ["drift"], **told)) == pytest.approx([off, off])
    assert unseen_gains(means, ["drift"], **told).sum() == pytest.approx(0.0, abs=1e-15)
    # what is told exactly to be none leaves nothing, and a change of 8 % that is certain all of it
    for size, twice, left in ((0.0, 0.0, 0.0), (0.08, 400.0, 0.02)):
        told = {"size": np.full(1, size), "power": np.full(1, 1e9), "twice": np.full(1, twice)}
        assert np.abs(unseen_gains(means, ["drift"], **told)) == pytest.approx([left, left], abs=1e-5)
    assert unseen_gains(means[:1], ["drift"], **told) == pytest.approx([0.0])


@pytest.mark.parametrize("at_s", [97.0, 112.0, 180.0, 222.0])
@pytest.mark.parametrize("about_v", [0.0, -5.0])
def test_an_amplitude_that_changes_is_named(two_speeds, sines, at_s, about_v):
    for campaign in (two_speeds, sines):
        ((kind, sentence),) = set_point(
            campaign, lambda time, volts: about_v + (volts - about_v) * (1.0 + 0.015 * (time >= at_s))
        )
        words = sentence.split()
        assert kind == "set-point shape"
        assert float(words[words.index("%") - 1]) == pytest.approx(1.5, abs=0.3)
        first_s, last_s = (float(words[words.index("(between") + place]) for place in (1, 3))
        assert first_s - 1.0 <= at_s <= last_s + 1.0


@pytest.mark.parametrize("corner_hz", [1.5, 4.0, 10.0])
def test_a_set_point_behind_a_filter_is_not_named(sines, two_speeds, corner_hz):
    share = 1.0 - np.exp(-2 * np.pi * corner_hz / RATE_HZ)

    def filtered(_, volts):
        return volts[0] + lfilter([share], [1.0, share - 1.0], volts - volts[0])

    assert set_point(sines, filtered) == []
    assert set_point(two_speeds, filtered) == []


def test_amplitudes_that_were_set_by_hand_are_not_named(sines):
    by_hand = np.array([1.012, 0.993, 1.008, 0.985, 1.015, 0.996, 1.004])

    def put(time, volts):
        return -5.0 + (volts + 5.0) * by_hand[np.minimum(time // 50.0, 6).astype(int)]

    assert set_point(sines, put) == []


@pytest.mark.parametrize(("size", "named"), [(0.0, 0), (0.05, 24)])
def test_scatter_that_grows_with_the_frequency_is_no_change_of_the_amplitude(size, named):
    """Values that a gateway sends late by a time of their own make it so; by chance three stretches may look higher."""
    hertz = np.repeat((0.02, 0.04, 0.06, 0.15, 0.3, 0.5, 0.8, 1.25, 2.0, 3.3), 6)
    start_s = 25.0 * np.arange(hertz.size)
    found = []
    for seed in range(24):
        noise = 0.006 * hertz * np.random.default_rng(seed).standard_normal(hertz.size)
        found.append(
            change_of(
                Amplitudes(
                    start_s=start_s,
                    stop_s=start_s + 25.0,
                    log_ratio=noise + size * (start_s > 700.0),
                    test=np.repeat(np.arange(10), 6),
                    kinds=("sine",) * 10,
                    frequency_hz=hertz[::6],
                    rounding=np.zeros(10),
                )
            )
        )
    assert sum(one is not None for one in found) == named


@pytest.mark.parametrize(("inertia_s", "load"), [(0.06, 0.0), (0.06, -0.04)])
def test_a_small_inertia_and_a_load_of_its_own_at_each_speed_are_no_gain(two_speeds, inertia_s, load):
    """What the pieces say of the gain between the two speeds scatters as it states, and the inertia is right."""
    time, volts = put_out(two_speeds)
    border_s = np.linspace(10.0, 425.0, 42)
    of_second = (border_s[1:] > 220.0).astype(float)[:, np.newaxis]
    apart, found_s = [], []
    for seed in range(12):
        speed, torque = ship(volts, inertia_s=inertia_s, load=np.where(time > 218.0, load, 0.0), seed=seed)
        gains = fast_gains(
            volts,
            speed,
            torque,
            rate_hz=RATE_HZ,
            start_s=0.0,
            border_s=border_s,
            whole=np.ones(41, dtype=np.bool_),
        )
        along, power = gains.of_courses(of_second)
        apart.append(along.item() / np.sqrt(power.item()))
        # at the mean speed and torque
        found_s.append(gains.inertia_s * (torque / 1500.0).mean() / (speed / 20.0).mean())
    assert np.sqrt(np.mean(np.square(apart))) < 1.3
    assert np.mean(found_s) == pytest.approx(inertia_s, rel=0.02)


def test_loads_in_windows_are_means_and_hold_three_signals_at_most():
    count = 400_000
    torque = np.repeat([1.0, 3.0], count // 2)
    begin_s, end_s = np.array([0.0, 10.0, 3990.0]), np.array([10.0, 20.0, 4000.0])
    tracemalloc.start()
    loads = loads_of(
        begin_s,
        end_s,
        speed_rev_s=np.full(count, 5.0),
        torque_nm=torque,
        inertia_s=0.1,
        rate_hz=100.0,
        start_s=0.0,
    )
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert loads.load == pytest.approx(np.array([0.5, 0.5, 1.5]) / np.mean([0.5, 0.5, 1.5]), rel=1e-9)
    assert peak < 3.1 * torque.nbytes


def test_the_gain_of_the_gauge_is_told_within_the_bytes_of_a_few_signals():
    rng = np.random.default_rng(3)
    count = 400_000
    set_point = np.repeat(rng.choice([-1.0, 1.0], count // 400), 400)
    speed = 5.0 + 0.1 * np.convolve(set_point, np.exp(-np.arange(400) / 80.0) / 80.0)[:count]
    torque = 2.0 * speed**2 + 3.0 * np.gradient(speed) * 200.0 + 0.1 * rng.standard_normal(count)
    tracemalloc.start()
    gains = fast_gains(
        set_point,
        speed,
        torque,
        rate_hz=200.0,
        start_s=0.0,
        border_s=np.arange(0.0, 2000.1, 100.0),
        whole=np.ones(20, dtype=np.bool_),
    )
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert np.all(np.abs(gains.gain - 1.0) < 4.0 * gains.std + 1e-9)
    # terms and motion, white and not, are at a tenth of the rate
    assert peak < 3.5 * torque.nbytes
