"""Clocks of two loggers, against clocks that were set apart by hand."""

import numpy as np
import pytest
from scipy import signal

from shaftprint.clocks import ClockMap, align
from shaftprint.errors import ClockError
from shaftprint.recording import Channel
from shaftprint.signals import Content

RATE_HZ = 50.0


def speed_of_a_test(duration_s, *, seed=0):
    """Return the speed [rev/s] of a chirp, steps and a sea, as a function of the reference time."""
    time_s = np.arange(-200.0, duration_s + 200.0, 0.01)
    sea = signal.lfilter([0.01], [1.0, -0.99], np.random.default_rng(seed).standard_normal(time_s.size))
    chirp = 0.2 * np.sin(2.0 * np.pi * (0.02 * time_s + 0.5 * 1.0 / duration_s * time_s**2))
    steps = 0.3 * np.sign(np.sin(2.0 * np.pi * time_s / 97.0) + 0.6 * np.sin(2.0 * np.pi * time_s / 61.8))
    asked = signal.lfilter(*signal.butter(2, 1.0, fs=100.0), chirp * (np.abs(time_s - duration_s / 3) < 150) + steps)
    return lambda at: 16.67 + np.interp(at, time_s, asked + 0.05 * sea)


def two_loggers(duration_s, offset_s, drift, *, rate_hz=RATE_HZ, noise=0.005, seed=1):
    """Return what both loggers show, the second in rpm, and the reference time of each of its values."""
    rng, speed = np.random.default_rng(seed), speed_of_a_test(duration_s)
    time_s = np.arange(0.0, duration_s, 1.0 / RATE_HZ)
    reference = speed(time_s) + noise * rng.standard_normal(time_s.size)
    own_s = 3.0 + np.arange(0.0, 0.9 * duration_s, 1.0 / rate_hz)
    true_s = own_s + offset_s + drift * own_s
    other = 60.0 * (speed(true_s) + noise * rng.standard_normal(own_s.size)) + 1.0
    return (
        Content(name="n_b", start_s=3.0, rate_hz=rate_hz, values=other),
        Content(name="n_a", start_s=0.0, rate_hz=RATE_HZ, values=reference),
        true_s,
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("duration_s", "offset_s", "drift", "rate_hz", "within_s"),
    [
        (7200.0, 0.4, 30e-6, 50.0, 1e-3),
        (7200.0, -41.7, -180e-6, 10.0, 2e-3),
        (1200.0, 12.0, 0.0, 20.0, 3e-3),
        # the other logger is the faster one
        (1200.0, -3.3, 60e-6, 100.0, 3e-3),
    ],
)
def test_offset_and_drift_are_found(duration_s, offset_s, drift, rate_hz, within_s):
    other, reference, true_s = two_loggers(duration_s, offset_s, drift, rate_hz=rate_hz)
    found = align(other, reference)
    errors = found.map.reference_s(other.time_s) - true_s
    assert np.abs(errors).max() < within_s
    assert found.worst_std_s < within_s
    assert found.map.drift == pytest.approx(drift, abs=4.0 * np.sqrt(found.map.covariance[1, 1]))


@pytest.mark.long
def test_the_standard_deviation_is_right():
    """Forty draws of the noise: distances from the truth in standard deviations at either end."""
    away = []
    for seed in range(40):
        other, reference, true_s = two_loggers(900.0, 0.7, 20e-6, rate_hz=20.0, noise=0.02, seed=seed)
        clock = align(other, reference).map
        ends = other.time_s[[0, -1]]
        away.append((clock.reference_s(ends) - true_s[[0, -1]]) / clock.std_s(ends))
    size = np.sqrt(np.mean(np.square(away)))
    # 80 numbers, in pairs: their root mean square is known to about a tenth
    assert 0.6 < size < 1.35


def test_a_known_latency_is_taken_off():
    other, reference, true_s = two_loggers(1200.0, 0.4, 30e-6)
    late = Content(name="late", start_s=other.start_s + 0.08, rate_hz=other.rate_hz, values=other.values)
    found = align(late, reference, latency_s=0.08, latency_std_s=0.01)
    assert found.map.reference_s(other.time_s) == pytest.approx(true_s, abs=3e-3)
    assert found.worst_std_s == pytest.approx(0.01, rel=0.05)


def test_a_sine_that_repeats_itself_is_refused():
    time_s = np.arange(0.0, 900.0, 0.02)
    rng = np.random.default_rng(2)
    one, two = (np.sin(2.0 * np.pi * 0.25 * time_s) + 0.05 * rng.standard_normal(time_s.size) for _ in range(2))
    reference, other = (Content(name=n, start_s=0.0, rate_hz=50.0, values=x) for n, x in (("a", one), ("b", two)))
    with pytest.raises(ClockError, match=r"occur once.*shift by \d.*step or a chirp"):
        align(other, reference)


def test_noise_in_common_with_nothing_is_refused():
    rng = np.random.default_rng(3)
    reference, other = (
        Content(name=name, start_s=0.0, rate_hz=50.0, values=rng.standard_normal(60_000)) for name in "ab"
    )
    with pytest.raises(ClockError, match=r"channels a and b: expected the same movements.*no more than chance"):
        align(other, reference)


def test_a_channel_that_stands_still_is_refused():
    reference = two_loggers(900.0, 0.0, 0.0)[1]
    with pytest.raises(ClockError, match="same movements"):
        align(Content(name="b", start_s=0.0, rate_hz=50.0, values=np.ones(45_000)), reference)


@pytest.mark.slow
def test_a_logger_that_stopped_for_a_while_is_refused():
    other, reference, _ = two_loggers(3600.0, 0.4, 30e-6)
    cut = np.concatenate([other.values[:75_000], other.values[95_000:]])
    with pytest.raises(ClockError, match=r"same movements throughout.*align the parts"):
        align(Content(name="b", start_s=3.0, rate_hz=50.0, values=cut), reference)


def test_too_short_and_too_slow_are_refused():
    other, reference, _ = two_loggers(900.0, 0.4, 30e-6)
    with pytest.raises(ClockError, match=r"at least 5 s in both recordings, found 4\.0 s"):
        align(Content(name="b", start_s=0.0, rate_hz=50.0, values=other.values[:200]), reference)
    with pytest.raises(ClockError, match="at least 5 values a second, found 1"):
        align(Content(name="b", start_s=0.0, rate_hz=1.0, values=other.values[::50]), reference)


# ---- short recordings ----


def short_pair(kind, duration_s, noise, seed, *, shares=True):
    """Return what two loggers show of a step, a ringing shaft or a sea, and by how much their clocks are apart [s]."""
    rng = np.random.default_rng(seed)
    time_s = np.arange(-5.0, duration_s + 5.0, 1e-3)

    def shown():
        if kind == "step":
            lag = 1e-3 / 0.3
            x = signal.lfilter([lag], [1.0, lag - 1.0], (time_s > duration_s * rng.uniform(0.3, 0.7)).astype(float))
        elif kind == "ringing":
            since_s = np.maximum(time_s - duration_s * rng.uniform(0.2, 0.6), 0.0)
            x = np.exp(-14.0 * since_s) * np.sin(138.0 * since_s)
        elif kind == "sine":
            x = np.sin(4.0 * np.pi * time_s + rng.uniform(0.0, 6.0))
        else:
            x = signal.lfilter(*signal.butter(2, 0.5, fs=1000.0), rng.standard_normal(time_s.size))
            x = x / x.std()
        return signal.filtfilt(*signal.butter(6, 40.0, fs=1000.0), x)

    seen, offset_s = shown(), rng.uniform(-1.0, 1.0)
    own_s = np.arange(0.0, duration_s, 0.005)
    one = np.interp(own_s, time_s, seen) + noise * rng.standard_normal(own_s.size)
    seen = seen if shares else shown()
    two = 7.0 * (np.interp(own_s + offset_s, time_s, seen) + noise * rng.standard_normal(own_s.size)) + 2.0
    return (
        Content(name="b", start_s=3.0, rate_hz=200.0, values=two),
        Content(name="a", start_s=0.0, rate_hz=200.0, values=one),
        offset_s - 3.0,
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "duration_s", "noise", "std_s"),
    [
        # by hand: noise of both over the root of 200 Hz times the integral of the squared slope, 1 / (2 * 0.3 s)
        ("step", 20.0, 0.005, 0.00707 / np.sqrt(200.0 / 0.6)),
        # the slope squared of a decaying sine: 138^2 / (4 * 14)
        ("ringing", 5.0, 0.01, 0.0141 / np.sqrt(200.0 * 138.0**2 / 56.0)),
        ("sea", 8.0, 0.02, None),
    ],
)
def test_the_offset_of_a_short_recording_has_the_right_deviation(kind, duration_s, noise, std_s):
    away, stated_s = [], []
    for seed in range(40):
        other, reference, truth_s = short_pair(kind, duration_s, noise, seed)
        clock = align(other, reference).map
        stated_s.append(clock.std_s(np.array([clock.middle_s])).item())
        away.append((clock.offset_s - truth_s) / stated_s[-1])
    # 40 numbers: their root mean square is known to a ninth, and 5 % of them lie beyond 1.96
    assert 0.65 < np.sqrt(np.mean(np.square(away))) < 1.35
    assert np.mean(np.abs(away) < 1.96) >= 0.87
    if std_s is not None:
        assert np.median(stated_s) == pytest.approx(std_s, rel=0.5)


def test_a_short_recording_does_not_tell_the_drift():
    other, reference, _ = short_pair("step", 10.0, 0.002, 1)
    found = align(other, reference)
    assert (found.map.drift, found.map.covariance[1, 1]) == (0.0, pytest.approx(1e-8))
    assert (len(found.stretches), found.scatter) == (1, None)


@pytest.mark.parametrize(("kind", "shares"), [("sine", True), ("sea", False)])
def test_a_short_recording_that_cannot_tell_is_refused(kind, shares):
    for seed in range(6):
        other, reference, _ = short_pair(kind, 5.0, 0.01, seed, shares=shares)
        with pytest.raises(ClockError, match=r"same movements in both|movements that occur once"):
            align(other, reference)


# ---- the map itself ----

CLOCK = ClockMap(offset_s=0.4, drift=30e-6, middle_s=1000.0, covariance=np.diag([1e-6, 1e-14]))


def test_reads_times_and_their_deviations():
    """By hand: 0.4 + 30e-6 * 4000 = 0.52; sqrt(1e-6 + 1e-14 * 4000^2) = 1.077e-3."""
    assert CLOCK.reference_s(np.array([5000.0])) == pytest.approx(5000.52, abs=1e-9)
    assert CLOCK.std_s(np.array([5000.0])) == pytest.approx(1.0770e-3, rel=1e-3)


def test_the_inverse_leads_back():
    time_s = np.array([0.0, 1000.0, 11_450.0])
    back = CLOCK.inverse()
    assert back.reference_s(CLOCK.reference_s(time_s)) == pytest.approx(time_s, abs=1e-9)
    assert back.std_s(CLOCK.reference_s(time_s)) == pytest.approx(CLOCK.std_s(time_s), rel=1e-4)


def test_a_deviation_is_counted_in_the_seconds_of_its_clock():
    """A reference that runs a quarter faster: 5 ms of its time are 4 ms of the other's."""
    fast = ClockMap(offset_s=0.4, drift=0.25, middle_s=0.0, covariance=np.diag([2.5e-5, 0.0]))
    assert fast.inverse().std_s(np.array([0.4, 100.0])) == pytest.approx(4e-3)


def test_a_channel_keeps_its_samples_and_changes_its_clock():
    counts = np.arange(10, dtype=np.int16)
    channel = Channel(name="x", unit="V", rate_hz=2000.0, start_s=5.0, count=10, source=lambda a, b: counts[a:b])
    moved = CLOCK.applied(channel)
    np.testing.assert_array_equal(moved.read(0, 10), counts)
    assert moved.time_s(0, 10) == pytest.approx(CLOCK.reference_s(channel.time_s(0, 10)), abs=1e-9)
