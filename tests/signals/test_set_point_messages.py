"""A set point that a control unit sends in messages: joined through their times, without what their steps do to it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from shaftprint.recording import Recording
from shaftprint.signals import find_tests, prepare_signals
from shaftprint.signals.excitation._quantum import rounding_error, steps_of_lines
from shaftprint.vessel import Vessel

# A pedal of 0 to 100 %, 0.4 % a bit: 19 mV. The offset of -5 V is shown as -4.991 V.
V_PER_PERCENT, V_AT_ZERO, STEP = -0.047814, -2.7150, 0.4


def sent(rng, count, *, jitter_s=0.003, lost=0.01):
    """Times of messages every 20 ms, of which some are lost."""
    times = 0.0137 + 0.02 * np.arange(count) + jitter_s * np.sqrt(3.0) * rng.uniform(-1.0, 1.0, count)
    return times[rng.random(count) > lost]


def amplitude(time_s, values, frequency_hz):
    phase = 2.0 * np.pi * frequency_hz * time_s
    design = np.column_stack([np.cos(phase), np.sin(phase), np.ones(time_s.size), time_s - time_s.mean()])
    cosine, sinus = np.linalg.lstsq(design, values, rcond=None)[0][:2]
    return cosine - 1j * sinus


def rounded_errors(steps, frequency_hz, *, noise=0.0, tests=30):
    """Errors of the amplitude, in shares of it, as it stands in the values and without their steps."""
    rng, raw, without = np.random.default_rng(11), [], []
    for _ in range(tests):
        time = sent(rng, 1500 if frequency_hz > 0.1 else 4000)
        time = time[time < np.floor(frequency_hz * time[-1]) / frequency_hz]
        true = steps * np.sin(2.0 * np.pi * frequency_hz * time + rng.uniform(0.0, 6.3))
        shown = np.rint(true + rng.uniform() + noise * rng.standard_normal(time.size))
        goal = amplitude(time, true, frequency_hz)
        raw.append(amplitude(time, shown, frequency_hz) / goal - 1.0)
        left = shown - steps_of_lines(time, shown, (frequency_hz,))
        without.append(amplitude(time, left, frequency_hz) / goal - 1.0)
    return np.sqrt(np.mean(np.abs(raw) ** 2)), np.sqrt(np.mean(np.abs(without) ** 2))


@pytest.mark.parametrize(("steps", "most"), [(31.4, 2e-4), (15.7, 5e-4), (10.5, 1e-3)])
@pytest.mark.parametrize("frequency_hz", [0.035, 0.5, 3.3])
def test_steps_are_taken_out_of_a_sine(steps, most, frequency_hz):
    """A sine without noise is wrong by up to 0.3 %, and the same at every line of one amplitude."""
    raw, without = rounded_errors(steps, frequency_hz)
    assert without < min(0.35 * raw, most)


@pytest.mark.parametrize(("steps", "most"), [(12.0, 0.008), (20.0, 0.005), (40.0, 0.002)])
def test_steps_are_taken_out_of_a_leg(steps, most):
    """Rounding makes every period wrong by the same: lines of 20 steps from crest to trough by 2 %.

    What is asked for is known to a scale, to a latency and to the generator's clock.
    """
    rng, period_s, raw, without = np.random.default_rng(4), 30.0, [], []
    harmonics = np.unique(np.geomspace(1.0, 100.0, 57).round())
    sizes = 1.0 / np.sqrt(harmonics)
    for _ in range(3):
        time = sent(rng, 13_500)
        phases = rng.uniform(0.0, 6.3, harmonics.size)

        def course(seconds, phases=phases):
            return np.cos(2.0 * np.pi / period_s * np.outer(seconds, harmonics) + phases) @ sizes

        share = steps / np.ptp(course(time))
        true = share * course((1.0 + 3e-5) * time)
        shown = np.rint(true + rng.uniform())
        asked = 0.99 * share * course(time - 0.02)
        left = shown - steps_of_lines(time, shown, harmonics / period_s, asked)
        turn = 2.0 * np.pi / period_s * np.outer(time, harmonics)
        design = np.hstack([np.cos(turn), np.sin(turn), np.ones((time.size, 1))])
        goal, *found = (np.linalg.lstsq(design, one, rcond=None)[0][:-1] for one in (true, shown, left))
        size = np.tile(share * sizes, 2)
        raw.append((found[0] - goal) / size)
        without.append((found[1] - goal) / size)
    assert np.std(without) < min(0.35 * np.std(raw), most)


def test_lines_that_few_messages_do_not_tell_apart_are_left():
    """Even messages, 5 a second: 3.4 Hz looks like 1.6 Hz."""
    time = 0.2 * np.arange(1500)
    true = 9.0 * np.sin(2.0 * np.pi * 0.13 * time) + 0.3 * np.sin(2.0 * np.pi * 3.4 * time)
    shown = np.rint(true)
    left = shown - steps_of_lines(time, shown, (0.13, 1.6, 3.4))
    assert np.std(left - true) < 0.5 * np.std(shown - true)
    assert not steps_of_lines(time, shown, (3.4,)).any()


@pytest.mark.parametrize("noise", [0.1, 0.2, 0.35, 0.6])
def test_steps_that_noise_has_spread_are_left(noise):
    """What is taken out is never worse than what was there."""
    raw, without = rounded_errors(15.7, 0.5, noise=noise)
    assert without < 1.05 * raw


def test_what_noise_leaves_of_rounding():
    """Against rounding itself, by chance: 200,000 values."""
    rng, values = np.random.default_rng(3), np.linspace(-0.6, 0.6, 7)
    for noise in (0.03, 0.1, 0.25):
        drawn = values + noise * rng.standard_normal((200_000, values.size))
        assert rounding_error(values, noise) == pytest.approx((np.rint(drawn) - drawn).mean(axis=0), abs=0.004)
    assert rounding_error(values) == pytest.approx(np.rint(values) - values, abs=1e-12)


def test_a_course_that_is_no_sine_is_left_alone():
    time = sent(np.random.default_rng(1), 3000)
    steps = np.rint(8.0 * np.sign(np.sin(2.0 * np.pi * 0.3 * time)) + 5.0 * np.sin(2.0 * np.pi * 0.77 * time))
    assert not steps_of_lines(time, steps, (0.3,)).any()
    # a sine that one step holds says nothing
    assert not steps_of_lines(time, np.rint(0.3 * np.sin(2.0 * np.pi * 0.3 * time)), (0.3,)).any()


def recording_of(ship, make_channel, *, late_s=0.0, hole_s=(0.0, 0.0), even=False):
    time = sent(np.random.default_rng(5), 12_490, jitter_s=0.0 if even else 0.003, lost=0.0 if even else 0.01)
    time = time[(time < hole_s[0]) | (time > hole_s[1])]
    volts = (
        np.interp(time - late_s, ship.time_s, ship.set_point_rev_s) - ship.intercept_rev_s
    ) / ship.slope_rev_s_per_v
    shown = STEP * np.rint((volts - V_AT_ZERO) / V_PER_PERCENT / STEP)
    if not even:
        # "error" and "not available"
        shown[[3000, 3001]] = 101.6, 102.0
    pedal = make_channel(shown, name="Pedal", unit="%", rate_hz=50.0, start_s=float(time[0]))
    if not even:
        pedal = replace(pedal, stamps=lambda first, stop: time[first:stop], is_uneven=True)
    channels = dict(replace(ship, prepared=ship).recording().channels) | {"Pedal": pedal}
    return Recording(path=Path("ship.nc"), sha256="0" * 64, format="memory", channels=channels)


def vessel_with_pedal(vessel, **more):
    content = vessel.model_dump()
    content["sensors"]["set_point"] = {
        "channel": "Pedal", "unit": "%", "v_per_unit": V_PER_PERCENT, "v_at_zero": V_AT_ZERO, **more,
    }  # fmt: skip
    return Vessel.model_validate(content)


@pytest.mark.parametrize("even", [False, True])
def test_a_set_point_in_messages_is_that_of_the_voltage(vessel, ship, campaign, make_channel, even):
    raw = recording_of(ship, make_channel, late_s=0.03, even=even)
    signals = prepare_signals(raw, vessel_with_pedal(vessel, message_latency_s=0.03), campaign)
    time = signals.start_s + np.arange(signals.samples) / signals.rate_hz
    true = np.interp(time, ship.time_s, ship.set_point_rev_s)
    for sine in campaign.sines:
        inside = (time >= sine.settled_s) & (time < sine.window_stop_s)
        found, goal = (
            amplitude(time[inside], values[inside], sine.frequency_hz) for values in (signals.set_point_rev_s, true)
        )
        # the scale is that of speed over set point, which the noise of the pick-ups knows to 5e-4
        assert abs(found / goal - 1.0) < 1.5e-3
        assert np.angle(found / goal) == pytest.approx(0.0, abs=5e-4)
    # the sines say where the level between them lies
    assert signals.working_point.set_point_v == pytest.approx(-5.0, abs=1e-3)
    moved = signals.excitations["n_set"]
    assert (moved.nyquist_hz, moved.is_obeyed) == (25.0, False)
    # by the law of the cardinal spline
    assert moved.gain(15.0) == pytest.approx(0.963, abs=1e-3)
    assert any("Pedal has times of its own: a message every 20 ms" in one for one in signals.findings) is not even
    assert all(test.is_found for test in find_tests(raw, vessel_with_pedal(vessel), campaign))


def test_the_deviation_of_the_line_holds_the_steps(vessel, ship, campaign, make_channel):
    """Three levels, each somewhere within a step of 19 mV."""
    raw = recording_of(ship, make_channel)
    signals, exact = (prepare_signals(raw, one, campaign) for one in (vessel_with_pedal(vessel), vessel))
    levels = signals.calibration.level_v
    stated = 4.18 * 0.4 * abs(V_PER_PERCENT) / np.sqrt(12.0) / np.linalg.norm(levels - levels.mean())
    slope_std = np.sqrt(signals.calibration.covariance[0, 0])
    assert slope_std == pytest.approx(np.hypot(stated, np.sqrt(exact.calibration.covariance[0, 0])), rel=0.2)
    assert abs(signals.calibration.slope_rev_s_per_v + 4.18) < 3.0 * slope_std


def test_messages_that_are_obeyed_are_held(vessel, ship, campaign, make_channel):
    """The governor holds each until the next: sinc and half of the time late; their steps are what it follows."""
    raw = recording_of(ship, make_channel)
    reported, obeyed = (
        prepare_signals(raw, vessel_with_pedal(vessel, is_obeyed=one), campaign) for one in (False, True)
    )
    held = obeyed.excitations["n_set"].gain(5.0) / reported.excitations["n_set"].gain(5.0)
    assert 1.0 / held == pytest.approx(np.sinc(0.1) * np.exp(-0.1j * np.pi), rel=1e-12)
    values = obeyed.set_point_rev_s[200 * 120 : 200 * 155]
    change = np.abs(values - reported.set_point_rev_s[200 * 120 : 200 * 155]).max()
    assert 0.3 < change / (STEP * 4.18 * abs(V_PER_PERCENT)) < 1.5


def test_a_hole_costs_the_tests_that_it_touches(vessel, ship, campaign, make_channel):
    raw = recording_of(ship, make_channel, hole_s=(180.0, 181.0))
    signals = prepare_signals(raw, vessel_with_pedal(vessel, message_latency_s=0.03), campaign)
    (gap,) = signals.gaps
    assert (gap.channel, gap.reason) == ("Pedal", "has no messages")
    assert (gap.start_s, gap.stop_s) == (pytest.approx(179.95, abs=0.03), pytest.approx(180.98, abs=0.03))
    assert any("S2" in finding and "Pedal" in finding for finding in signals.findings)
