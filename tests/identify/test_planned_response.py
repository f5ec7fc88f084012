"""Planned lines against textbook variances, simulated noise, and the signal-to-noise ratios of the thesis."""

import numpy as np
import pytest

from shaftprint.campaign import Campaign, Multisine, Sine, load_campaign
from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import NoiseLevels, expected_response, identify, planned_lines, planned_response
from shaftprint.identify.prediction._noise_levels import noise_levels
from shaftprint.identify.prediction._planned_legs import planned_legs
from shaftprint.spectra import FrequencyResponse
from shaftprint.survey import STAN_TUG_NOISE

TRUTH = {"K_p": 5.7, "K_i": 4.27, "t_d": 0.0703, "omega_n": 10.3, "zeta": 0.47, "tau_dn": 0.32, "tau_up": 1.016}

# Thesis table 3.7: local signal-to-noise ratios [dB] of n_e and M_s. S1 to S4 are left out because 40 bins are as wide
# as their frequency, S6 because of a fault in that window.
TABLE_3_7 = {
    "S5": (45.7, 23.5),
    "S7": (38.0, 23.6),
    "S8": (41.3, 27.2),
    "S9": (38.5, 34.9),
    "S10": (35.9, 34.3),
    "S11": (31.9, 31.9),
    "S12": (17.0, 17.2),
}


def white(density, *, outputs=("n",), set_point_per_v=0.2):
    matrix = np.atleast_2d(np.asarray(density, dtype=complex))
    return NoiseLevels(
        frequency_hz=np.array([0.01, 10.0]),
        density=np.stack([matrix, matrix]),
        outputs=outputs,
        set_point_per_v=set_point_per_v,
    )


def two_sines(**changed):
    fields = {"frequency_hz": 0.5, "amplitude_v": 0.6, "start_s": 0.0, "settled_s": 10.0, "stop_s": 60.0}
    other = {"name": "fast", "frequency_hz": 2.0, "start_s": 70.0, "settled_s": 80.0, "stop_s": 100.3}
    sines = (Sine(name="slow", **(fields | changed)), Sine(**(fields | other)))
    return Campaign(name="two sines", duration_s=200.0, offset_v=-5.0, sines=sines)


def test_variance_of_a_sine_in_white_noise():
    """``2 sigma^2 / N`` of each part of an amplitude from ``N`` samples (Kay, Estimation Theory, example 3.14)."""
    sigma, rate, length, amplitude = 0.03, 50.0, 40.0, 0.12
    one_sided = 2.0 * sigma**2 / rate
    response = planned_lines([0.5], noise=white(one_sided), amplitude=amplitude, duration_s=length)
    expected = 2.0 * sigma**2 / (length * rate) / amplitude**2
    assert response.covariance[0] == pytest.approx(expected * np.eye(2), rel=1e-12)


def test_covariance_is_that_of_simulated_amplitudes():
    """Correlated noise of two outputs, one of them late: 4000 windows of sines, fitted by their Fourier amplitude."""
    rng = np.random.default_rng(5)
    rate, count, frequency, amplitude, lag = 20.0, 400, 0.5, 0.1, 4
    common = rng.normal(size=(4000, count + lag))
    first = 0.02 * common[:, lag:] + 0.01 * rng.normal(size=(4000, count))
    second = 0.05 * common[:, :-lag] + 0.03 * rng.normal(size=(4000, count))
    wave = np.exp(-2j * np.pi * frequency * np.arange(count) / rate) * (2.0 / count) / amplitude
    error = np.stack([first @ wave, second @ wave], axis=1)
    parts = np.concatenate([error.real, error.imag], axis=1)
    turn = np.exp(-2j * np.pi * frequency * lag / rate)
    crossed = 0.02 * 0.05 * np.conj(turn)
    density = 2.0 / rate * np.array([[0.02**2 + 0.01**2, crossed], [np.conj(crossed), 0.05**2 + 0.03**2]])
    noise = white(density, outputs=("n", "M_s"))
    planned = planned_lines([frequency], noise=noise, amplitude=amplitude, duration_s=count / rate)
    scatter = np.cov(parts.T)
    scale = np.sqrt(np.diag(scatter))
    # a correlation from 4000 windows has a standard deviation of 0.016
    assert planned.covariance[0] / np.outer(scale, scale) == pytest.approx(scatter / np.outer(scale, scale), abs=0.06)


def test_lines_of_a_campaign_last_whole_periods():
    """The slow sine has 50 s, 25 periods; the fast one 20.3 s, of which 40 periods are 20 s."""
    noise = white(1e-5)
    response = planned_response(two_sines(), noise)
    assert response.lines == ("slow", "fast")
    assert response.frequency_hz == pytest.approx([0.5, 2.0])
    variance = 1e-5 / (np.array([50.0, 20.0]) * (0.2 * 0.6) ** 2)
    assert response.covariance[:, 0, 0] == pytest.approx(variance, rel=1e-12)
    assert (response.inputs, response.outputs) == (("n_set",), ("n",))


def test_double_amplitude_quarters_the_variance():
    one, other = planned_response(two_sines(), white(1e-5)), planned_response(two_sines(amplitude_v=1.2), white(1e-5))
    assert other.covariance[0] == pytest.approx(one.covariance[0] / 4.0)


def test_levels_go_there_and_back():
    """A recording with the planned covariance has the noise that it was planned with."""
    density = np.array([[2e-6, 1e-6 + 3e-6j], [1e-6 - 3e-6j, 8e-6]])
    noise = white(density, outputs=("n", "M_s"))
    found = noise_levels(planned_response(two_sines(), noise), two_sines(), set_point_per_v=0.2)
    assert found.frequency_hz == pytest.approx([0.5, 2.0])
    assert found.density == pytest.approx(np.stack([density, density]), rel=1e-12)


def test_a_covariance_that_was_estimated_is_larger_than_the_noise():
    """From 20 complex samples, two outputs weighed together: 20 / 18 of the noise, which the levels are without."""
    density = np.array([[2e-6, 1e-6 + 3e-6j], [1e-6 - 3e-6j, 8e-6]])
    noise = white(density, outputs=("n", "M_s"))
    lines = {"frequency_hz": [0.5, 2.0], "amplitude": 0.2 * 0.6, "duration_s": [50.0, 20.0], "lines": ("slow", "fast")}
    known = planned_lines(noise=noise, **lines)
    estimated = planned_lines(noise=noise, degrees_of_freedom=np.array([40.0, 40.0]), **lines)
    assert estimated.covariance == pytest.approx(known.covariance * 20.0 / 18.0)
    found = noise_levels(estimated, two_sines(), set_point_per_v=0.2)
    assert found.density == pytest.approx(np.stack([density, density]), rel=1e-12)


def test_levels_between_frequencies_follow_a_power_law():
    noise = NoiseLevels(
        frequency_hz=np.array([0.1, 1.0]),
        density=np.array([[[1e-3]], [[1e-5]]], dtype=complex),
        outputs=("M_s",),
        set_point_per_v=0.2,
    )
    assert noise.at([0.2, 0.5])[:, 0, 0].real == pytest.approx([1e-5 / 0.2**2, 1e-5 / 0.5**2])
    assert noise.at([0.01, 5.0])[:, 0, 0].real == pytest.approx([1e-3, 1e-5])


def test_lines_beyond_what_is_known_are_not_used():
    response = planned_lines([1.0, 15.0], noise=white(1e-5), amplitude=0.1, duration_s=20.0, lines=("low", "high"))
    assert list(response.used) == [True, False]
    assert response.remarks == {"high": "above 10 Hz, beyond which nothing is known of the noise"}


def test_shipped_levels_agree_with_the_thesis():
    """Signal variance over that of 40 bins, ``S 40 / T``, for the response of the simulated tug; each within 6 dB."""
    thesis = load_campaign("thesis")
    gauge = structure("GAUGE-CLOSED")
    sines = {sine.name: sine for sine in thesis.sines}
    for name, printed in TABLE_3_7.items():
        sine = sines[name]
        response = gauge.response(gauge.vector(TRUTH), 2j * np.pi * np.array([sine.frequency_hz]))[:, 0]
        signal = 0.5 * np.abs(response * STAN_TUG_NOISE.set_point_per_v * sine.amplitude_v) ** 2
        noise = np.diagonal(STAN_TUG_NOISE.at([sine.frequency_hz])[0]).real * 40.0 / sine.window_s
        assert 10.0 * np.log10(signal / noise) == pytest.approx(printed, abs=6.0), name


def test_shipped_set_point():
    """250.7 rpm for a volt (thesis eq. 3.2 says 250.97) at 1183.8 rpm."""
    assert STAN_TUG_NOISE.set_point_per_v == pytest.approx(250.9 / 1183.8, rel=2e-3)


def test_expected_response_is_a_test_without_noise():
    """A fit to it finds what it was made with."""
    gauge = structure("CL4")
    values = {"tau_n": 0.33, "K_p": 1.6, "K_i": 4.4, "t_d": 0.12, "omega_n": 9.8, "zeta": 0.5}
    planned = planned_response(load_campaign("thesis"), STAN_TUG_NOISE)
    found = identify(gauge, expected_response(planned, gauge, values), rng=np.random.default_rng(1))
    assert {p.name: p.value for p in found.parameters} == pytest.approx(values, rel=1e-6)


# ---- refusals ----


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"density": np.ones((2, 2, 2))}, r"expected densities of shape \(2, 1, 1\), found \(2, 2, 2\)"),
        ({"frequency_hz": np.array([2.0, 1.0])}, "positive, ascending frequencies"),
        ({"set_point_per_v": 0.0}, "a positive set point for one volt, found 0.0"),
        ({"density": np.array([[[1.0]], [[-1.0]]])}, "noise levels at 2 Hz: expected a Hermitian, positive definite"),
    ],
)
def test_levels_that_make_no_sense(changed, message):
    fields = {"frequency_hz": np.array([1.0, 2.0]), "density": np.ones((2, 1, 1)), "outputs": ("n",)}
    with pytest.raises(IdentificationError, match=message):
        NoiseLevels(**({"set_point_per_v": 0.2} | fields | changed))


def test_levels_of_another_campaign():
    planned = planned_response(two_sines(), white(1e-5))
    with pytest.raises(IdentificationError, match="has no line slow, fast; give the campaign that the recording"):
        noise_levels(planned, load_campaign("thesis"), set_point_per_v=0.2)


def test_levels_of_no_used_line():
    planned = planned_lines([15.0], noise=white(1e-5), amplitude=0.1, duration_s=20.0)
    with pytest.raises(IdentificationError, match="found 1 inputs and 0 used lines"):
        noise_levels(planned, two_sines(), set_point_per_v=0.2)


def test_lines_of_no_length():
    with pytest.raises(IdentificationError, match="positive amplitudes and lengths"):
        planned_lines([1.0], noise=white(1e-5), amplitude=0.1, duration_s=0.0)


def test_expected_response_of_other_channels():
    planned = planned_response(two_sines(), white(1e-5))
    with pytest.raises(IdentificationError, match="structure CL4 goes from n_set to n, M_s, the planned response"):
        expected_response(planned, structure("CL4"))


def test_outputs_can_be_chosen():
    assert STAN_TUG_NOISE.of_outputs("M_s").outputs == ("M_s",)
    assert STAN_TUG_NOISE.of_outputs("M_s").density[:, 0, 0] == pytest.approx(STAN_TUG_NOISE.density[:, 1, 1])
    with pytest.raises(IdentificationError, match="expected outputs of n, M_s, found X"):
        STAN_TUG_NOISE.of_outputs("X")


def test_plain_response_keeps_its_type():
    assert isinstance(planned_response(two_sines(), white(1e-5)), FrequencyResponse)


def two_legs():
    leg = {"period_s": 20.0, "harmonics": (1, 5), "amplitudes_v": (0.4, 0.2), "phases_rad": (0.0, 0.0)}
    slow = Multisine(name="slow", level_v=-3.5, start_s=10.0, settled_s=20.0, stop_s=105.0, **leg)
    fast = Multisine(name="fast", level_v=-5.2, start_s=110.0, settled_s=120.0, stop_s=220.0, **leg)
    return Campaign(name="legs", duration_s=240.0, offset_v=-5.0, ramp_s=5.0, multisines=(slow, fast))


@pytest.mark.parametrize(("rises", "ratio"), [(False, 1.0 - 0.2 * 1.7), (True, 1.0 + 0.2 * 1.7)])
def test_each_leg_is_planned_at_its_own_speed(rises, ratio):
    """Of 0.2 of the speed a volt, 1.7 V apart; two lines of 100 and 80 s in white noise of 1e-6 1/Hz."""
    fast, slow = planned_legs(two_legs(), white(1e-6), rises=rises)
    assert (fast.name, fast.speed_share, slow.name) == ("fast", 1.0, "slow")
    assert slow.speed_share == pytest.approx(ratio)
    assert slow.response.lines == ("slow/1", "slow/5")
    assert slow.response.frequency_hz == pytest.approx([0.05, 0.25])
    # 2 S / (T A^2) of both parts together, with the amplitude over the speed of the leg; as a weight it is larger, for
    # the noise is estimated beside each line
    for leg, seconds in ((fast, 100.0), (slow, 80.0)):
        for row, amplitude_v in enumerate((0.4, 0.2)):
            amplitude = 0.2 * amplitude_v / leg.speed_share
            enlarged = leg.response.weight_factors[row]
            assert 1.0 < enlarged < 1.5
            assert leg.response.covariance[row, 0, 0] / enlarged == pytest.approx(1e-6 / (seconds * amplitude**2))
    gauge = structure("GAUGE-CLOSED")
    assert slow.structure(gauge).factors["tau_dn"] == pytest.approx(1.0 / ratio)
    assert fast.structure(gauge) == gauge


def test_legs_may_be_planned_about_a_working_point_that_is_none_of_them():
    """The first leg at 1.15 of it, the other 1.7 V of 0.2 of it slower; amplitudes are over the speed of each leg."""
    fast, slow = planned_legs(two_legs(), white(1e-6), rises=False, first_share=1.15)
    assert (fast.speed_share, slow.speed_share) == pytest.approx((1.15, 1.15 - 0.2 * 1.7))
    for leg, seconds in ((fast, 100.0), (slow, 80.0)):
        amplitude = 0.2 * 0.4 / leg.speed_share
        errors = leg.response.covariance[0, 0, 0] / leg.response.weight_factors[0]
        assert errors == pytest.approx(1e-6 / (seconds * amplitude**2))


def test_the_noise_of_a_leg_plans_the_same_leg_again():
    """The levels of a recorded leg give back its covariance at the lines that it had."""
    levels = white(3e-6)
    fast, _ = planned_legs(two_legs(), levels, rises=False)
    again = noise_levels(fast.response, two_legs(), set_point_per_v=0.2)
    assert again.density == pytest.approx(levels.density)


def test_a_line_that_clocks_put_beside_the_last_one_of_a_recording_is_used():
    """The recording has it at 0.6874997 Hz, the plan at 0.6875 Hz; one a hundredth faster is another line."""
    density = np.eye(1, dtype=complex)[None] * 1e-6
    noise = NoiseLevels(
        frequency_hz=np.array([0.1, 0.6874997]),
        density=np.repeat(density, 2, axis=0),
        outputs=("n",),
        set_point_per_v=0.2,
    )
    response = planned_lines([0.5, 0.6875, 0.695], noise=noise, amplitude=0.1, duration_s=100.0)
    assert response.used.tolist() == [True, True, False]


def test_lines_of_another_input_have_its_symbol():
    response = planned_lines([0.5], noise=white(1e-5), amplitude=0.1, duration_s=100.0, excitation="theta_set")
    assert response.inputs == ("theta_set",)
