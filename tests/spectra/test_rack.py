"""The fuel rack on its own clock: known responses come back, its covariance with speed and torque is right."""

from dataclasses import replace

import numpy as np
import pytest
from tests.made_signals import with_channels
from tests.measured_outputs import measured

from shaftprint.errors import ResponseError
from shaftprint.signals import Gap, MessageSignal
from shaftprint.spectra import ExactBin, FrequencyResponse, estimate_response, estimate_spectra, open_loop
from shaftprint.spectra._open_loop import governor_and_engine
from shaftprint.spectra.lines._line_fit import WindowSamples
from shaftprint.spectra.lines._message_line import times_of_values
from shaftprint.spectra.lines._sine_fit import WholePeriodSine
from shaftprint.spectra.lines._windows import Window

RATE_HZ = 20.0
AMPLITUDE = 0.12
WORKING_POINT = 0.4
SINES = (("S1", 0.05, 20.0, 420.0), ("S2", 0.173, 450.0, 650.0), ("S3", 0.61, 680.0, 780.0), ("S4", 3.1, 800.0, 850.0))


def plant(frequency_hz):
    """A PI-governed line: n, M_s and X over n_set; the governor sees the set point 50 ms late."""
    s = 2j * np.pi * np.asarray(frequency_hz)
    governor = 3.0 + 4.0 / s
    engine = np.exp(-0.04 * s) / ((1.3 * s + 2.0) * (1.0 + 0.05 * s))
    speed = governor * engine / (1.0 + governor * engine) * np.exp(-0.05 * s)
    return np.array([speed, (0.32 * s + 2.0) * speed, governor * (np.exp(-0.05 * s) - speed)])


def waves(time_s, response, sines=SINES):
    """Deviations that a response to the sines of the set point makes at given times."""
    values = np.zeros(time_s.size)
    for _, hz, start, stop in sines:
        on = (time_s >= start - 20.0) & (time_s <= stop + 1.0)
        values[on] += (AMPLITUDE * response(hz) * np.exp(2j * np.pi * hz * time_s[on])).imag
    return values


def rack_of(deviation, **changes):
    given = {
        "name": "X",
        "channel": "X_percent",
        "values": WORKING_POINT * (1.0 + deviation),
        "rate_hz": 20.0,
        "start_s": 0.0,
        "resolution": 1e-9,
        "cycle_s": 0.05,
        "averaging_s": 0.0,
        "hold_s": 0.0,
        "reference": WORKING_POINT,
        "reference_std": 0.001,
    }
    return MessageSignal(**(given | changes))


@pytest.fixture
def ship(make_signals, make_campaign):
    """Signals with a rack of other rate and start than the grid, and their campaign."""

    def build(*, rate_hz=20.0, start_s=0.0137, length_s=900.0, step=0.0, sines=SINES, **given):
        time_s = np.arange(0.0, length_s, 1.0 / RATE_HZ)
        set_point, speed, torque = (
            waves(time_s, part, sines) for part in (lambda hz: 1.0, lambda hz: plant(hz)[0], lambda hz: plant(hz)[1])
        )
        rack_s = start_s + np.arange(round((length_s - 1.0) * rate_hz)) / rate_hz
        deviation = waves(rack_s, lambda hz: plant(hz)[2], sines)
        if step:
            deviation = step * np.rint(deviation / step)
        rack = rack_of(
            deviation,
            rate_hz=rate_hz,
            start_s=start_s,
            cycle_s=1.0 / rate_hz,
            resolution=WORKING_POINT * step if step else 1e-9,
        )
        signals = make_signals(set_point, torque, {"n_e": speed}, **given)
        return with_channels(signals, X=rack), make_campaign(*sines)

    return build


@pytest.mark.parametrize(("rate_hz", "start_s"), [(20.0, 0.0137), (10.0, -0.07), (31.0, 0.0)])
def test_a_known_response_comes_back_from_any_clock(ship, rate_hz, start_s):
    signals, campaign = ship(rate_hz=rate_hz, start_s=start_s)
    found = estimate_response(signals, campaign)
    assert found.outputs == ("n", "M_s", "X")
    assert found.response[:, 0] == pytest.approx(plant(found.frequency_hz), rel=1e-8)
    assert measured(found).all()
    assert found.used.all()
    assert not found.remarks


def test_speed_and_torque_are_what_they_are_without_a_rack(ship):
    signals, campaign = ship(scale_std=0.003)
    rng = np.random.default_rng(3)
    torque = signals.shaft_torque_nm + 20.0 * rng.standard_normal(signals.samples)
    signals = signals.with_channel("M_s", values=torque)
    # without noise of its own the covariance of the speed is rounding, and positive on some processors only
    speed = signals.speeds["n_e"].speed_rev_s + 1e-4 * rng.standard_normal(signals.samples)
    signals = signals.with_channel("n_e", values=speed)
    alone = estimate_response(with_channels(signals, X=None), campaign)
    some = estimate_response(signals, campaign).of_outputs("n", "M_s")
    assert np.array_equal(some.response, alone.response)
    assert some.covariance == pytest.approx(alone.covariance, rel=1e-9, abs=1e-18)
    assert np.array_equal(some.degrees_of_freedom, alone.degrees_of_freedom)
    for with_rack, without in zip(
        open_loop(estimate_response(signals, campaign), set_point_latency_s=0.05),
        open_loop(alone, set_point_latency_s=0.05),
        strict=True,
    ):
        assert np.array_equal(with_rack.response, without.response)
        assert with_rack.covariance == pytest.approx(without.covariance, rel=1e-9, abs=1e-15)


def test_what_a_logger_holds_is_divided_out(ship):
    """Messages every 50 ms, each repeated at 2000 Hz until the next, averaged over 5 ms."""
    signals, campaign = ship()
    phase_s = 0.0213
    time_s = np.arange(0.0, 899.0, 1.0 / 2000.0)
    sent_s = phase_s + 0.05 * np.floor((time_s - phase_s) / 0.05 + 1e-9)
    held = waves(sent_s, lambda hz: plant(hz)[2]).reshape(-1, 10).mean(axis=1)
    rack = rack_of(held, rate_hz=200.0, start_s=4.5 / 2000.0, averaging_s=0.005, hold_s=0.05)
    found = estimate_response(with_channels(signals, X=rack), campaign)
    # the logger sees a message up to a sample late: a quarter of a millisecond on average, 0.3 degrees at 3.1 Hz
    assert np.abs(found.response[2, 0] / plant(found.frequency_hz)[2] - 1.0).max() < 0.006
    plain = estimate_response(with_channels(signals, X=replace(rack, hold_s=0.0)), campaign)
    assert np.abs(plain.response[2, 0, -1] / plant(3.1)[2] - 1.0) > 0.4


def sent_times(rng, *, jitter_s=0.003, lost=0.01, length_s=899.0):
    """Messages of a sender that keeps a cycle of 20 ms but for 15 % of it; one in a hundred is lost."""
    count = round(length_s / 0.02)
    times = 0.0137 + 0.02 * np.arange(count) + np.sqrt(3.0) * jitter_s * rng.uniform(-1.0, 1.0, count)
    return times[rng.random(count) >= lost]


def messages_at(times, deviation, **changes):
    given = {"times": times, "rate_hz": 50.0, "start_s": float(times[0]), "cycle_s": 0.02}
    return rack_of(deviation, **(given | changes))


def test_messages_at_times_of_their_own_show_the_response_exactly(ship):
    signals, campaign = ship()
    times = sent_times(np.random.default_rng(6))
    rack = messages_at(times, waves(times, lambda hz: plant(hz)[2]))
    found = estimate_response(with_channels(signals, X=rack), campaign)
    assert found.response[:, 0] == pytest.approx(plant(found.frequency_hz), rel=1e-8)
    # taken for samples of a clock, the fast line is 2 % too small
    by_rate = estimate_response(with_channels(signals, X=replace(rack, times=None)), campaign)
    assert np.abs(by_rate.response[2, 0, -1] / plant(3.1)[2] - 1.0) > 0.01
    # bins need one rate: the older ways measure messages by least squares too
    older = estimate_response(with_channels(signals, X=rack), campaign, method=ExactBin())
    assert older.response[2, 0] == pytest.approx(found.response[2, 0], rel=0.02)


@pytest.mark.slow
def test_messages_are_unbiased_and_as_uncertain_as_stated(ship):
    """15 % of jitter, 1 % lost, steps of 1 % of the torque, noise of the rack: the error over 60 logs."""
    signals, campaign = ship()
    rng = np.random.default_rng(8)
    step = 0.025
    errors, stated = [], []
    for _ in range(60):
        times = sent_times(rng)
        rough = waves(times, lambda hz: plant(hz)[2]) + 0.02 * rng.standard_normal(times.size)
        rack = messages_at(times, step * np.rint(rough / step), resolution=WORKING_POINT * step)
        found = estimate_response(with_channels(signals, X=rack), campaign)
        errors.append(found.response[2, 0] - plant(found.frequency_hz)[2])
        stated.append(found.covariance[:, 2, 2] + found.covariance[:, 5, 5])
    std = np.sqrt(np.mean(stated, axis=0))
    # a mean of 60 is known to 0.13 of their deviation
    assert (np.abs(np.mean(errors, axis=0)) < 0.4 * std).all()
    ratio = np.mean(np.abs(errors) ** 2, axis=0) / np.mean(stated, axis=0)
    assert ratio == pytest.approx(np.full(4, 0.85), abs=0.35)


@pytest.mark.parametrize("cycle_s", [0.05, 0.0613])
def test_values_that_are_asked_for_more_often_than_they_come_are_as_old_as_they_may_be(ship, cycle_s):
    """A program asks every 20 ms, 15 % of jitter, for a value that is new every 50 or 61 ms."""
    signals, campaign = ship()
    times = sent_times(np.random.default_rng(6))
    asked = waves(0.011 + cycle_s * np.floor((times - 0.011) / cycle_s), lambda hz: plant(hz)[2])
    rack = messages_at(times, asked, cycle_s=cycle_s, hold_s=cycle_s)
    found = estimate_response(with_channels(signals, X=rack), campaign)
    # what is left are the ages that the polls of a value happen to have
    assert np.abs(found.response[2, 0] / plant(found.frequency_hz)[2] - 1.0).max() < 0.01
    plain = estimate_response(with_channels(signals, X=replace(rack, hold_s=0.0)), campaign)
    assert np.abs(plain.response[2, 0, -1] / plant(3.1)[2] - 1.0) > 0.4


def late_stamps(rng, count=44_950, *, share, lost=0.01):
    """Stamps with 3 ms of jitter, and the times of the values: those of the cycle but for a share of the jitter."""
    cycle = 0.0137 + 0.02 * np.arange(count)
    jitter = 0.003 * np.sqrt(3.0) * rng.uniform(-1.0, 1.0, count)
    kept = rng.random(count) >= lost
    return (cycle + jitter)[kept], (cycle + share * jitter)[kept]


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_messages_that_are_late_are_told_from_values_that_are(ship, share):
    """Up to 0.2 % of the fast line is lost to stamps that are late; what is in the values is no error."""
    signals, campaign = ship()
    rng = np.random.default_rng(12)
    stamps, taken = late_stamps(rng, share=share)
    deviation = waves(taken, lambda hz: plant(hz)[2]) + 0.005 * rng.standard_normal(taken.size)
    found = estimate_response(with_channels(signals, X=messages_at(stamps, deviation)), campaign)
    error = found.response[2, 0] / plant(found.frequency_hz)[2] - 1.0
    std = np.sqrt(found.covariance[:, 2, 2] + found.covariance[:, 5, 5]) / np.abs(plant(found.frequency_hz)[2])
    assert (np.abs(error) < 3.0 * std).all()
    assert std[-1] < 1.5e-3


@pytest.mark.parametrize(("frequency_hz", "loss"), [(7.2, 0.0092), (3.1, 0.0017)])
def test_stamps_that_are_late_make_no_sine_smaller(frequency_hz, loss):
    """``exp(-(omega 3 ms)^2 / 2)`` at the stamps; nothing at the times of the cycle. Sixty seconds, steps, noise."""
    rng = np.random.default_rng(3)
    window = Window(line="S", frequency_hz=frequency_hz, start_s=0.0, periods=int(60.0 * frequency_hz))
    at_stamps, at_cycle = [], []
    for share in [0.0] * 20 + [1.0] * 20:
        stamps, taken = late_stamps(rng, 3100, share=share)
        inside = (stamps >= 0.0) & (stamps < window.stop_s)
        rough = np.cos(2.0 * np.pi * frequency_hz * taken) + 0.04 * rng.standard_normal(taken.size)
        values = 0.1 * np.rint(rough / 0.1)[np.newaxis, inside]
        samples = WindowSamples(window=window, rate_hz=50.03, time_s=stamps[inside], channels=("X",), values=values)
        fit = WholePeriodSine().fit(samples)
        times = times_of_values(fit)
        assert (times is None) == (share == 1.0)
        if times is not None:
            at_stamps.append(fit.amplitude[0, 0])
            at_cycle.append(WholePeriodSine().fit(replace(samples, time_s=times)).amplitude[0, 0])
    assert 1.0 - np.mean(at_stamps).real == pytest.approx(loss, rel=0.15)
    assert np.mean(at_cycle) == pytest.approx(1.0, abs=1e-3)


def test_sender_that_keeps_no_cycle_has_the_times_of_its_stamps():
    rng = np.random.default_rng(3)
    stamps = np.cumsum(rng.uniform(0.016, 0.024, 2900))
    window = Window(line="S", frequency_hz=7.0, start_s=0.0, periods=400)
    values = np.cos(2.0 * np.pi * 7.0 * (stamps + 0.003 * rng.standard_normal(stamps.size)))
    samples = WindowSamples(window=window, rate_hz=50.0, time_s=stamps, channels=("X",), values=values[np.newaxis])
    assert times_of_values(WholePeriodSine().fit(samples)) is None


def test_a_hole_costs_the_windows_that_it_touches(ship):
    signals, campaign = ship()
    times = sent_times(np.random.default_rng(6))
    times = times[(times < 500.0) | (times > 500.4)]
    hole = Gap(channel="X_percent", start_s=500.0, stop_s=500.4, reason="has no messages")
    rack = messages_at(times, waves(times, lambda hz: plant(hz)[2]), gaps=(hole,))
    found = estimate_response(with_channels(signals, X=rack), campaign)
    assert measured(found)[2].tolist() == [True, False, True, True]
    assert found.remarks["S2"] == "X is not measured: channel X_percent has no messages from 500.00 to 500.40 s"
    late = messages_at(times[20_000:], rack.values[20_000:] / WORKING_POINT - 1.0)
    found = estimate_response(with_channels(signals, X=late), campaign)
    assert measured(found)[2].tolist() == [False, True, True, True]
    assert "the window is not inside 40" in found.remarks["S1"]


def correlated(coloured, make_signals, make_campaign, *, slope, repeats):
    """Responses of a window of 12 periods in noise that torque and rack share, sampled at 20 Hz and at 15 Hz."""
    hz, duration_s = 0.31, 12.0 / 0.31
    sines = (("S1", hz, 0.0, duration_s + 0.01),)
    rng = np.random.default_rng(17 + slope)
    time_s = np.arange(0.0, duration_s + 1.0, 1.0 / 60.0)
    for _ in range(repeats):
        noise = coloured(rng, time_s.size, slope=slope, correlation=0.9)
        noise *= 0.02 / np.sqrt((2.0 / time_s.size) * hz**-slope)
        set_point, speed, torque, rack = (
            waves(time_s, part, sines)
            for part in (lambda f: 1.0, lambda f: plant(f)[0], lambda f: plant(f)[1], lambda f: plant(f)[2])
        )
        speed = speed + 0.003 * rng.standard_normal(time_s.size)
        torque, rack = torque + 0.1 * noise[0], rack + 0.2 * noise[1]
        signals = make_signals(set_point[::3], torque[::3], {"n_e": speed[::3]})
        logged = rack_of(rack[1::4], rate_hz=15.0, start_s=1.0 / 60.0, cycle_s=1.0 / 15.0)
        yield estimate_response(with_channels(signals, X=logged), make_campaign(*sines))


@pytest.mark.slow
def test_covariance_is_the_scatter_over_repeats(coloured, make_signals, make_campaign):
    errors, stated, weighed = [], [], []
    for found in correlated(coloured, make_signals, make_campaign, slope=2, repeats=400):
        error = found.response[:, 0, 0] - plant(0.31)
        parts = np.concatenate([error.real, error.imag])
        errors.append(parts)
        samples = 0.5 * found.degrees_of_freedom[0]
        stated.append(found.covariance[0] * (samples - 3.0) / samples)
        weighed.append(parts @ np.linalg.solve(found.covariance[0], parts))
    scatter, mean = np.cov(np.array(errors).T), np.mean(stated, axis=0)
    # 400 repeats know a variance to 7 % and a correlation to 0.05; what of steep noise leaks into the window is not
    # alike in real and imaginary part
    assert np.diagonal(mean) == pytest.approx(np.diagonal(scatter), rel=0.25)
    ratio = (np.diagonal(mean) / np.diagonal(scatter)).reshape(2, 3).mean(axis=0)
    assert ratio == pytest.approx(np.ones(3), abs=0.15)
    for found in (mean, scatter):
        found /= np.sqrt(np.outer(np.diagonal(found), np.diagonal(found)))
    assert mean == pytest.approx(scatter, abs=0.15)
    # torque and rack: 0.9 at an angle of 0.5 rad, which puts 0.79 into the real parts and 0.43 across
    assert abs(scatter[1, 2]) > 0.7
    assert abs(scatter[1, 5]) > 0.3
    assert np.mean(weighed) == pytest.approx(6.0, rel=0.15)


def test_steps_of_the_channel_are_in_the_covariance(ship):
    """One per cent of the torque is 2.5 % of the working point, and nothing but the sine moves it from step to step."""
    for place, start_s in enumerate((0.0137, 0.031, -0.002)):
        found = estimate_response(*ship(step=0.025, start_s=start_s))
        error = found.response[2, 0] - plant(found.frequency_hz)[2]
        std = np.sqrt(found.covariance[:, 2, 2] + found.covariance[:, 5, 5])
        assert (np.abs(error) < 3.0 * std).all(), place
        assert (std < 0.15 * np.abs(found.response[2, 0])).all()
        assert (np.abs(error) > 1e-4).all()


@pytest.mark.slow
def test_steps_are_white_noise_where_noise_moves_the_rack(ship):
    """Noise of two steps: as if the channel had no steps but noise of ``q^2 / 12`` more."""
    signals, campaign = ship()
    rng = np.random.default_rng(8)
    errors, stated = [], []
    step, logged = 0.01, signals.channels["X"].values
    for _ in range(40):
        rough = logged / WORKING_POINT - 1.0 + 2.0 * step * rng.standard_normal(logged.size)
        rack = rack_of(step * np.rint(rough / step), start_s=0.0137, resolution=WORKING_POINT * step)
        found = estimate_response(with_channels(signals, X=rack), campaign)
        errors.append(found.response[2, 0] - plant(found.frequency_hz)[2])
        stated.append(found.covariance[:, 2, 2] + found.covariance[:, 5, 5])
    ratio = np.mean(np.abs(errors) ** 2, axis=0) / np.mean(stated, axis=0)
    # the covariance is right as a weight: up to a quarter larger than the errors
    assert ratio == pytest.approx(np.full(4, 0.85), abs=0.35)
    expected = (4.0 * step**2 + step**2 / 12.0) * 4.0 / (400.0 * RATE_HZ) / AMPLITUDE**2
    # three channels, whose covariance is enlarged as a weight
    samples = 0.5 * found.degrees_of_freedom[0]
    assert np.mean(stated, axis=0)[0] == pytest.approx(expected * samples / (samples - 3.0), rel=0.2)


def test_line_too_fast_for_the_messages_keeps_speed_and_torque(ship):
    signals, campaign = ship(rate_hz=5.0, scale_std=0.002)
    spectra = estimate_spectra(signals, campaign)
    found = spectra.response
    assert measured(found).tolist() == [[True] * 4, [True] * 4, [True, True, True, False]]
    assert found.used.all()
    assert found.remarks == {"S4": "X is not measured: 3.1 Hz is above 2.25 Hz, what messages show"}
    assert found.response[:2, 0] == pytest.approx(plant(found.frequency_hz)[:2], rel=1e-8)
    fast = found.covariance[3]
    assert (fast[2, 2], fast[5, 5]) == pytest.approx((1e4, 1e4), rel=1e-12)
    assert not np.any(np.delete(fast[2], 2))
    alone = estimate_response(with_channels(signals, X=None), campaign)
    # the covariance stays positive definite in double precision: 1e-15 of the largest is added to all
    assert found.of_outputs("n", "M_s").covariance == pytest.approx(alone.covariance, rel=1e-9, abs=2e-11)
    # a governor of gain 3, and a model that is wrong by as much: it weighs next to nothing
    far = np.array([0.0, 0.0, 3.0, 0.0, 0.0, -3.0])
    assert far @ np.linalg.solve(fast, far) < 2e-3
    ratios = spectra.signal_to_noise
    assert ratios.channels == ("n_set", "n_e", "M_s", "X")
    assert np.isnan(ratios.local_db[3, 3])
    assert np.isfinite(ratios.local_db[:3]).all()
    assert ratios.overall[3] == pytest.approx(1.0, abs=1e-3)


def test_line_that_was_not_logged_or_does_not_move_is_left_open(ship):
    signals, campaign = ship()
    late = signals.with_channel("X", values=signals.channels["X"].values[9500:], start_s=475.0137)
    found = estimate_response(late, campaign)
    assert measured(found)[2].tolist() == [False, False, True, True]
    assert found.remarks["S2"] == ("X is not measured: the window is not inside 475.0 to 899.0 s, when it was logged")
    still = signals.channels["X"].values.copy()
    still[13_000:16_000] = WORKING_POINT
    found = estimate_response(signals.with_channel("X", values=still), campaign)
    assert measured(found)[2].tolist() == [True, True, False, True]
    assert found.remarks["S3"] == "X is not measured: it moves by less than the step of its channel"
    assert found.used.all()


def test_ways_of_the_past_measure_the_rack_too(ship):
    signals, campaign = ship(mode="thesis")
    found = estimate_response(signals, campaign, method=ExactBin())
    assert np.abs(found.response[2, 0] / plant(found.frequency_hz)[2] - 1.0).max() < 0.02


def test_governor_and_engine_come_apart(ship):
    found = estimate_response(*ship())
    governor, engine = governor_and_engine(found, set_point_latency_s=0.05)
    s = 1j * found.omega_rad_s
    assert (governor.inputs, governor.outputs) == (("e",), ("X",))
    assert governor.response[0, 0] == pytest.approx(3.0 + 4.0 / s, rel=1e-6)
    assert (engine.inputs, engine.outputs) == (("X",), ("M_s",))
    drive = np.exp(-0.04 * s) / ((1.3 * s + 2.0) * (1.0 + 0.05 * s))
    assert engine.response[0, 0] == pytest.approx((0.32 * s + 2.0) * drive, rel=1e-6)


def noisy_response():
    """Three lines with correlated errors of a few per cent."""
    hz = np.array([0.1, 0.4, 1.1])
    values = plant(hz)[:, np.newaxis]
    rng = np.random.default_rng(2)
    root = 0.004 * rng.standard_normal((3, 6, 6)) * np.abs(np.concatenate([values, values])[:, 0].T)[:, :, np.newaxis]
    return FrequencyResponse(
        frequency_hz=hz,
        response=values,
        covariance=root @ np.swapaxes(root, 1, 2),
        inputs=("n_set",),
        outputs=("n", "M_s", "X"),
    )


def test_covariance_of_governor_and_engine_is_that_of_many_draws():
    found = noisy_response()
    governor, engine = governor_and_engine(found, set_point_latency_s=0.05)
    rng = np.random.default_rng(4)
    for line, hz in enumerate(found.frequency_hz):
        draws = rng.multivariate_normal(np.zeros(6), found.covariance[line], 20_000)
        n, m, x = found.response[:, 0, line, np.newaxis] + draws[:, :3].T + 1j * draws[:, 3:].T
        for one, values in ((governor, x / (np.exp(-2j * np.pi * hz * 0.05) - n)), (engine, m / x)):
            scatter = np.cov(np.stack([values.real, values.imag]))
            size = np.sqrt(np.outer(np.diagonal(scatter), np.diagonal(scatter)))
            assert one.covariance[line] / size == pytest.approx(scatter / size, abs=0.06)


def test_lines_lost_in_noise_are_not_used():
    found = noisy_response()
    loud = found.covariance.copy()
    loud[0] *= 1e4
    governor, engine = governor_and_engine(replace(found, covariance=loud), set_point_latency_s=0.05)
    assert governor.used.tolist() == engine.used.tolist() == [False, True, True]
    assert "fuel rack is lost in noise (|X/n_set| = " in engine.remarks["line 1"]
    assert "error signal is lost in noise (|e/n_set| = " in governor.remarks["line 1"]
    assert "error signal" not in engine.remarks["line 1"]


def test_line_without_rack_is_used_for_torque_over_error_only(ship):
    found = estimate_response(*ship(rate_hz=5.0))
    both, core = open_loop(found, set_point_latency_s=0.05)
    assert both.used.all()
    assert core.used.all()
    governor, engine = governor_and_engine(found, set_point_latency_s=0.05)
    assert governor.used.tolist() == engine.used.tolist() == [True, True, True, False]


def test_response_without_rack_is_refused(ship):
    signals, campaign = ship()
    found = estimate_response(with_channels(signals, X=None), campaign)
    with pytest.raises(ResponseError, match="expected a response from n_set to n, M_s and X, found n_set to n, M_s"):
        governor_and_engine(found)
    silent = noisy_response()
    nothing = silent.response.copy()
    nothing[2, 0, 1] = 0.0
    with pytest.raises(ResponseError, match="line 2: expected X to differ from 0, found 0: leave the line out"):
        governor_and_engine(replace(silent, response=nothing))
