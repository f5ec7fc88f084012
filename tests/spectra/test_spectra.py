"""From signals to the response: known responses come back, and what is wrong is said."""

from dataclasses import replace

import numpy as np
import pytest
from tests.made_signals import with_channels

from shaftprint.errors import ResponseError
from shaftprint.signals import Gap
from shaftprint.spectra import ExactBin, FrequencyResponse, HighestPeak, estimate_response, estimate_spectra
from shaftprint.spectra.lines._sine_fit import WholePeriodSine

RATE_HZ = 20.0
# expected amplitude of the set point: 0.6 V of 4 rev/s a volt over 20 rev/s
AMPLITUDE = 0.12
SINES = (("S1", 0.05, 20.0, 420.0), ("S2", 0.173, 450.0, 650.0), ("S3", 0.61, 680.0, 780.0), ("S4", 3.1, 800.0, 850.0))


def plant(frequency_hz):
    """A closed loop: n / n_set and M_s / n_set."""
    s = 2j * np.pi * frequency_hz
    speed = np.exp(-0.1 * s) / (1.0 + 0.3 * s)
    return np.array([speed, (0.32 * s + 2.0) * speed])


def voyage(rng, *, noise=0.0, sines=SINES, rate_hz=RATE_HZ, length_s=900.0, amplitude=AMPLITUDE):
    """Deviations of set point, speed and torque with every sine on from 20 s before its window."""
    time_s = np.arange(0.0, length_s, 1.0 / rate_hz)
    channels = np.zeros((3, time_s.size))
    for _, hz, start, stop in sines:
        on = (time_s >= start - 20.0) & (time_s <= stop)
        wave = amplitude * np.exp(2j * np.pi * hz * time_s[on])
        channels[:, on] += (np.array([1.0, *plant(hz)])[:, np.newaxis] * wave).imag
    channels[1:] += noise * rng.standard_normal((2, time_s.size))
    return channels


@pytest.fixture
def ship(make_signals, make_campaign):
    """Signals and campaign of a voyage."""

    def build(*, seed=1, noise=0.0, change=None, sines=SINES, **given):
        set_point, speed, torque = voyage(np.random.default_rng(seed), noise=noise, sines=sines)
        if change is not None:
            change(np.arange(set_point.size) / RATE_HZ, set_point)
        speeds = {"n_e": speed, "n_e1": 0.5 * speed}
        return make_signals(set_point, torque, speeds, **given), make_campaign(*sines)

    return build


def remark_of(ship, change, line="S2"):
    spectra = estimate_spectra(*ship(noise=1e-4, change=change))
    place = spectra.response.lines.index(line)
    others = np.delete(spectra.response.used, place)
    assert others.all()
    assert spectra.response.remarks.keys() == spectra.remarks.keys() == {line}
    return spectra.remarks[line], bool(spectra.response.used[place])


def test_a_known_response_comes_back(ship):
    found = estimate_response(*ship())
    assert found.frequency_hz.tolist() == [0.05, 0.173, 0.61, 3.1]
    assert found.lines == ("S1", "S2", "S3", "S4")
    assert (found.inputs, found.outputs) == (("n_set",), ("n", "M_s"))
    assert found.response[:, 0] == pytest.approx(plant(found.frequency_hz), rel=1e-9)
    assert found.used.all()
    assert not found.remarks


@pytest.mark.slow
def test_errors_are_as_large_as_stated(ship):
    weighed, rows = [], []
    for seed in range(60):
        found = estimate_response(*ship(seed=seed, noise=0.02))
        error = found.response[:, 0] - plant(found.frequency_hz)
        error = np.concatenate([error.real, error.imag])
        weighed.append(np.einsum("il,lij,jl->l", error, np.linalg.inv(found.covariance), error))
        rows.append(found.degrees_of_freedom)
    assert np.mean(weighed) == pytest.approx(4.0, rel=0.15)
    assert (np.mean(rows, axis=0) > 12.0).all()
    # white noise of 0.02 on N samples: parts of n / n_set have the variance 2 / N (0.02 / 0.12)^2
    samples = 400.0 * RATE_HZ
    expected = np.sqrt(2.0 / samples) * 0.02 / AMPLITUDE
    factor = rows[0][0] / (rows[0][0] - 4.0)
    assert np.sqrt(found.covariance[0, 0, 0] / factor) == pytest.approx(expected, rel=0.5)


def test_the_response_does_not_depend_on_units_or_start(ship, make_signals):
    signals, campaign = ship(noise=0.01)
    torque = signals.channels["M_s"]
    scaled = signals.with_channel("M_s", values=3.0 * torque.values, reference=3.0 * torque.reference)
    shifted = replace(signals, start_s=1000.0)
    later = tuple(
        sine.model_copy(update={key: getattr(sine, key) + 1000.0 for key in ("start_s", "settled_s", "stop_s")})
        for sine in campaign.sines
    )
    first = estimate_response(signals, campaign)
    for other in (
        estimate_response(scaled, campaign),
        estimate_response(shifted, campaign.model_copy(update={"sines": later})),
    ):
        assert other.response == pytest.approx(first.response, rel=1e-9)
        assert other.covariance == pytest.approx(first.covariance, rel=1e-6)


def test_set_point_scale_moves_both_responses_along(ship):
    signals, campaign = ship(noise=0.01)
    plain = estimate_response(signals, campaign)
    spread = estimate_response(signals.with_channel("n_set", scale_std=0.02), campaign)
    # the scale is already in the set point: the response stays, its covariance grows by (0.01 / 0.5)^2 H H^T
    assert spread.response == pytest.approx(plain.response)
    for line in range(4):
        values = plain.response[:, 0, line]
        direction = np.concatenate([values.real, values.imag])
        grown = plain.covariance[line] + 4e-4 * np.outer(direction, direction)
        assert spread.covariance[line] == pytest.approx(grown, rel=1e-9)


def test_every_speed_sensor_can_be_chosen(ship):
    signals, campaign = ship()
    spectra = estimate_spectra(signals, campaign, speed="n_e1")
    assert spectra.speed == "n_e1"
    assert spectra.response.response[0, 0] == pytest.approx(0.5 * plant(spectra.response.frequency_hz)[0], rel=1e-9)
    assert spectra.signal_to_noise.channels == ("n_set", "n_e", "n_e1", "M_s")
    with pytest.raises(ResponseError, match="Speed sensor n_e9: expected one of n_e, n_e1"):
        estimate_response(signals, campaign, speed="n_e9")


@pytest.mark.parametrize("method", [ExactBin(), HighestPeak()])
def test_the_ways_of_the_past_agree_where_there_is_no_noise(ship, method):
    found = estimate_response(*ship(), method=method)
    assert found.response[:, 0] == pytest.approx(plant(found.frequency_hz), rel=0.02)


def test_sensor_timing_and_load_go_with_the_response(ship):
    signals, campaign = ship()
    signals = signals.with_channel("n_e", averaging_s=0.05, hold_s=0.06, delay_s=0.07)
    signals = signals.with_channel("M_s", values=1.03 * signals.shaft_torque_nm)
    spectra = estimate_spectra(signals, campaign)
    found = spectra.response
    assert (found.averaging_s, found.hold_s, found.pick_up_delay_s) == (0.05, 0.06, 0.07)
    # mean torque 1.03 at mean speed 1 with the amplitude of the set point times |n / n_set|
    square = 1.0 + 0.5 * (AMPLITUDE * np.abs(plant(found.frequency_hz)[0])) ** 2
    assert found.load == pytest.approx(1.03 / square, rel=1e-3)
    assert spectra.load_drift.delta == pytest.approx(found.load - 1.0)


def test_lines_above_half_the_pulse_rate_are_aliased(ship):
    spectra = estimate_spectra(*ship(pulse_rate_hz=5.0))
    assert spectra.response.used.tolist() == [True, True, True, False]
    assert spectra.remarks == {"S4": "above 2.50 Hz, half the pulse rate of n_e: aliased"}


def test_thesis_mode_uses_all_lines_and_says_what_speaks_against_them(ship):
    spectra = estimate_spectra(*ship(pulse_rate_hz=5.0, mode="thesis"), method=ExactBin())
    assert spectra.response.used.all()
    assert list(spectra.response.remarks) == ["S4"]


def test_thesis_mode_normalises_each_line_by_its_own_offset(ship):
    """A set point 1 % too low everywhere is, over its own mean, 1 % too large in its sines; one whose scale is 1 % too
    low is not. Over one working point it is the other way round."""
    for mode, method, shifted, scaled in (
        ("thesis", ExactBin(), 0.99, 1.0),
        ("shaftprint", WholePeriodSine(), 1.0, 1.0 / 0.99),
    ):
        signals, campaign = ship(mode=mode)
        plain = estimate_response(signals, campaign, method=method).response
        point = signals.working_point.engine_speed_rev_s
        for set_point, factor in (
            (signals.set_point_rev_s - 0.01 * point, shifted),
            (0.99 * signals.set_point_rev_s, scaled),
        ):
            found = estimate_response(signals.with_channel("n_set", values=set_point), campaign, method=method).response
            assert found / plain == pytest.approx(np.full(plain.shape, factor), rel=1e-6)


def test_a_spline_of_the_pulses_is_corrected(ship):
    # 3.1 Hz at 10 pulses a second: the spline shows 0.957 of it
    plain, corrected = (estimate_response(*ship(pulse_rate_hz=rate)) for rate in (np.inf, 10.0))
    ratio = np.abs(corrected.response[0, 0] / plain.response[0, 0])
    assert ratio[3] == pytest.approx(1.0 / 0.957, abs=1e-3)
    assert ratio[0] == pytest.approx(1.0, abs=1e-6)
    assert corrected.response[1] == pytest.approx(plain.response[1])


def test_a_gap_costs_its_line_and_is_never_looked_at(ship):
    """In the gap stands what would spoil every mean."""
    signals, campaign = ship()
    second = next(sine for sine in campaign.sines if sine.name == "S2")
    first = round((second.settled_s + 5.0 - signals.start_s) * signals.rate_hz)
    torque = signals.shaft_torque_nm.copy()
    torque[first : first + 400] = 1e9
    gap = Gap(
        channel="M_s",
        start_s=second.settled_s + 5.0,
        stop_s=second.settled_s + 5.0 + 400.0 / signals.rate_hz,
        reason="has no values",
    )
    whole = estimate_spectra(signals, campaign)
    spectra = estimate_spectra(replace(signals.with_channel("M_s", values=torque), gaps=(gap,)), campaign)
    assert spectra.response.lines == tuple(line for line in whole.response.lines if line != "S2")
    assert spectra.remarks["S2"] == f"left out: {gap.sentence}"
    kept = [whole.response.lines.index(line) for line in spectra.response.lines]
    assert np.array_equal(spectra.response.response, whole.response.response[..., kept])


def test_a_recording_that_ends_early_keeps_the_lines_it_holds(ship):
    signals, campaign = ship()
    cut = with_channels(
        signals, **{name: replace(one, values=one.values[:13_400]) for name, one in signals.channels.items()}
    )
    spectra = estimate_spectra(cut, campaign)
    assert spectra.response.lines == ("S1", "S2")
    assert spectra.remarks["S3"].startswith("left out: the recording lasts from 0.0 to 670.0 s")
    with pytest.raises(ResponseError, match=r"test.h5: expected at least one sine of campaign test, found none"):
        estimate_response(replace(cut, start_s=5000.0), campaign)


def test_a_line_near_half_the_rate_is_left_out(ship):
    spectra = estimate_spectra(*ship(sines=(*SINES[:3], ("S4", 9.2, 800.0, 850.0))))
    assert spectra.response.lines == ("S1", "S2", "S3")
    assert spectra.remarks["S4"] == "left out: 9.2 Hz is above 9 Hz, what signals of 20 Hz show"


def test_a_campaign_in_rad_s_is_found_out(ship, make_campaign):
    signals, _ = ship(noise=1e-3)
    wrong = make_campaign(*((name, 2.0 * np.pi * hz, start, stop) for name, hz, start, stop in SINES[:3]))
    with pytest.raises(
        ResponseError,
        match=r"S1: expected the set point to move at 0.314159 Hz, found 0.05 Hz, 1/\(2 pi\) of it, likewise in 3 of 3",
    ):
        estimate_response(signals, wrong)


def test_a_campaign_of_another_recording_is_found_out(ship, make_campaign):
    signals, _ = ship()
    wrong = make_campaign(("S1", 0.11, 20.0, 420.0), ("S2", 0.5, 450.0, 650.0))
    with pytest.raises(
        ResponseError, match=r"expected the set point to move at 0.11 Hz .* found 0.05 Hz, and no other"
    ):
        estimate_response(signals, wrong)


def test_a_set_point_that_never_moves(ship):
    def still(time_s, set_point):
        set_point[:] = 0.0

    with pytest.raises(ResponseError, match=r"S1: .* between 20 and 420 s, found a set point that does not move"):
        estimate_response(*ship(change=still))


def test_one_line_that_was_not_sailed(ship):
    def still(time_s, set_point):
        set_point[(time_s > 430.0) & (time_s < 660.0)] = 0.0

    spectra = estimate_spectra(*ship(change=still))
    assert spectra.response.lines == ("S1", "S3", "S4")
    assert spectra.response.used.all()
    assert spectra.remarks == {
        "S2": "left out: set point has an amplitude of 0 rpm where the campaign asks for 144 rpm"
    }


def test_one_line_of_noise_alone(ship):
    def noise(time_s, set_point):
        there = (time_s > 430.0) & (time_s < 660.0)
        set_point[there] = 0.005 * np.random.default_rng(4).standard_normal(np.count_nonzero(there))

    remark, used = remark_of(ship, noise)
    assert remark.startswith("set point has an amplitude of 0.")
    assert not used


def test_one_line_of_hardly_any_amplitude(ship):
    def weak(time_s, set_point):
        set_point[(time_s > 430.0) & (time_s < 660.0)] *= 0.05

    remark, used = remark_of(ship, weak)
    assert remark == "set point has an amplitude of 7.2 rpm where the campaign asks for 144 rpm"
    assert not used


def test_one_line_of_half_the_amplitude_is_used(ship):
    def weak(time_s, set_point):
        set_point[(time_s > 430.0) & (time_s < 660.0)] *= 0.5

    remark, used = remark_of(ship, weak)
    assert remark == "set point has an amplitude of 72 rpm where the campaign asks for 144 rpm"
    assert used


def test_one_line_of_another_frequency(ship):
    def other(time_s, set_point):
        there = (time_s > 430.0) & (time_s < 660.0)
        set_point[there] = AMPLITUDE * np.sin(2.0 * np.pi * 0.25 * time_s[there])

    remark, used = remark_of(ship, other)
    assert remark == "set point moves at 0.25 Hz where the campaign says 0.173 Hz"
    assert not used


def test_one_line_with_a_frequency_misread_by_a_digit(ship):
    # 0.1735 for 0.173: a tenth of a bin; used, but said
    def near(time_s, set_point):
        there = (time_s > 430.0) & (time_s < 660.0)
        set_point[there] = AMPLITUDE * np.sin(2.0 * np.pi * 0.1735 * time_s[there])

    remark, used = remark_of(ship, near)
    assert remark == "set point runs at 0.1735 Hz where the campaign says 0.173 Hz"
    assert used


def test_a_misread_frequency_is_said_with_the_digits_that_differ(ship):
    """0.4 mHz, 0.08 of a bin: with four digits both would be 1.234 Hz."""

    def near(time_s, set_point):
        there = (time_s > 430.0) & (time_s < 660.0)
        set_point[there] = AMPLITUDE * np.sin(2.0 * np.pi * 1.2344 * time_s[there])

    sines = (*SINES[:1], ("S2", 1.234, 450.0, 650.0), *SINES[3:])
    remark = estimate_spectra(*ship(noise=1e-4, change=near, sines=sines)).remarks["S2"]
    assert remark == "set point runs at 1.2344 Hz where the campaign says 1.234 Hz"


def test_a_sine_that_starts_late(ship):
    def late(time_s, set_point):
        set_point[(time_s > 430.0) & (time_s < 490.0)] = 0.0

    remark, used = remark_of(ship, late)
    # stretches of 5 periods, 28.9 s: the first is silent, the second partly
    assert remark == "set-point sine is disturbed in 2 of 6 parts of the window, between 450.0 and 507.8 s"
    assert used


def test_a_sine_that_hides_in_something_else(ship):
    def rough(time_s, set_point):
        there = (time_s > 430.0) & (time_s < 660.0)
        set_point[there] += np.where(time_s[there] % 20.0 < 10.0, 0.2, -0.2)

    remark, used = remark_of(ship, rough)
    assert "Hz where the campaign says 0.173 Hz" in remark or "not a clean sine" in remark
    assert not used


def test_noise_that_drowns_the_set_point(ship):
    def noisy(time_s, set_point):
        there = (time_s > 430.0) & (time_s < 660.0)
        set_point[there] += 0.3 * np.random.default_rng(2).standard_normal(np.count_nonzero(there))

    remark, used = remark_of(ship, noisy)
    assert remark.startswith("set point is not a clean sine: the line is ")
    assert not used


def test_a_noisy_set_point_among_clean_ones_is_said(ship):
    # like S6 of the thesis, 26.5 dB where its neighbours have 57 to 74 dB
    def noisy(time_s, set_point):
        there = (time_s > 430.0) & (time_s < 660.0)
        set_point[there] += 0.06 * np.random.default_rng(3).standard_normal(np.count_nonzero(there))

    remark, used = remark_of(ship, noisy)
    assert remark.startswith("set point is not a clean sine: signal-to-noise 2")
    assert used


def test_a_dead_torque_gauge(ship):
    signals, campaign = ship()
    torque = np.full(signals.samples, 1700.0)
    with pytest.raises(ResponseError, match="S1: expected M_s to move, found a constant between 20 and 420 s"):
        estimate_response(signals.with_channel("M_s", values=torque), campaign)


def test_values_that_are_not_numbers(ship):
    signals, campaign = ship()
    torque = signals.shaft_torque_nm.copy()
    torque[10_000] = np.nan
    with pytest.raises(ResponseError, match=r"S2: expected numbers in M_s, found one that is not finite at 500.000 s"):
        estimate_response(signals.with_channel("M_s", values=torque), campaign)


def test_a_single_line_has_no_neighbours_to_compare(ship):
    signals, campaign = ship(sines=SINES[1:2])
    found = estimate_response(signals, campaign)
    assert found.lines == ("S2",)
    assert not found.remarks


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"frequency_hz": np.array([2.0, 1.0])}, "expected positive, ascending"),
        ({"frequency_hz": np.array([1.0, 2.0, 3.0])}, r"response: expected shape \(1, 1, 3\), found \(1, 1, 2\)"),
        ({"response": np.array([[[1.0, np.nan]]])}, "response: found values that are not finite"),
        ({"covariance": np.array([[[1.0, 0.5], [0.0, 1.0]]] * 2)}, "expected symmetric"),
        ({"covariance": np.array([np.eye(2), np.diag([1.0, 0.0])])}, "covariance of line 2: expected a positive"),
        ({"lines": ("S1",)}, "expected 2 names, one a frequency, found 1"),
        ({"load": np.ones(3)}, r"load: expected shape \(2,\), found \(3,\)"),
    ],
)
def test_a_response_checks_itself(change, message):
    good = {
        "frequency_hz": np.array([1.0, 2.0]),
        "response": np.ones((1, 1, 2)),
        "covariance": np.array([np.eye(2)] * 2),
        "inputs": ("n_set",),
        "outputs": ("n",),
    }
    found = FrequencyResponse(**good)
    assert found.omega_rad_s == pytest.approx([2.0 * np.pi, 4.0 * np.pi])
    assert found.lines == ("line 1", "line 2")
    assert np.isinf(found.degrees_of_freedom).all()
    assert found.load.tolist() == [1.0, 1.0]
    with pytest.raises(ValueError, match="read-only"):
        found.response[0, 0, 0] = 2.0
    with pytest.raises(ResponseError, match=message):
        FrequencyResponse(**(good | change))
