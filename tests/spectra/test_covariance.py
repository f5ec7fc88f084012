"""The stated covariance is the scatter over repeats: noise of the amplitudes, responses, open loop."""

import numpy as np
import pytest

from shaftprint.errors import ResponseError
from shaftprint.spectra import FrequencyResponse, open_loop
from shaftprint.spectra._response_covariance import (
    real_covariance,
    real_jacobian,
    response_of_line,
    weight_factor,
    with_common_error,
)
from shaftprint.spectra.lines._line_measurement import measure_line
from shaftprint.spectra.lines._sine_fit import WholePeriodSine

REPEATS = 500


def repeated(make_window, coloured, *, periods, slope, repeats=REPEATS, noise_of_input=0.0):
    """Amplitudes and stated covariances of many windows with a sine in a still, a second and a third channel."""
    rng = np.random.default_rng(periods * 10 + slope)
    amplitude, covariance, samples = [], [], 0.0
    f, rate = 0.05, 1.0
    for _ in range(repeats):
        noise = coloured(rng, int(np.ceil(periods / f * rate)), slope=slope)
        noise /= np.sqrt((2.0 / noise.shape[1]) * f**-slope)
        still = noise_of_input * rng.standard_normal(noise.shape[1])
        window = make_window(
            lambda t, n=still: np.cos(2.0 * np.pi * f * t) + n,
            lambda t, n=noise[0]: 0.9 * np.cos(2.0 * np.pi * f * t - 0.5) + 0.01 * n,
            lambda t, n=noise[1]: 2.1 * np.cos(2.0 * np.pi * f * t + 0.7) + 0.03 * n,
            frequency_hz=f,
            periods=periods,
            rate_hz=rate,
        )
        line = measure_line(window, WholePeriodSine(), excitation="n_set", speed="n_1")
        amplitude.append(line.amplitude)
        covariance.append(line.noise.covariance)
        samples = line.noise.complex_samples
    return np.array(amplitude), np.array(covariance), samples


@pytest.mark.long
@pytest.mark.parametrize("periods", [4, 7, 18])
@pytest.mark.parametrize("slope", [0, 1, 2])
def test_stated_covariance_is_the_scatter_over_repeats(make_window, coloured, periods, slope):
    amplitude, covariance, samples = repeated(make_window, coloured, periods=periods, slope=slope)
    truth = np.array([1.0, 0.9 * np.exp(-0.5j), 2.1 * np.exp(0.7j)])
    error = (amplitude - truth)[:, 1:]
    scatter = error.T @ error.conj() / REPEATS
    stated = covariance.mean(axis=0)[1:, 1:]
    # 500 complex samples know a variance to 4.5 % (one sigma); correlated noise shares it
    assert stated.diagonal().real == pytest.approx(scatter.diagonal().real, rel=0.15)
    size = np.sqrt(scatter[0, 0].real * scatter[1, 1].real)
    assert stated[0, 1] / size == pytest.approx(scatter[0, 1] / size, abs=0.13)
    # as a weight: |error|^2 over the covariance with its factor is two complex values on average
    inverse = np.linalg.inv(covariance[:, 1:, 1:] * weight_factor(samples, 2))
    weighed = np.einsum("ri,rij,rj->r", error.conj(), inverse, error).real
    assert weighed.mean() == pytest.approx(2.0, rel=0.15)


@pytest.mark.slow
@pytest.mark.parametrize("periods", [14, 30])
def test_noise_that_comes_through_the_shaft_is_not_noise_of_the_torque(make_window, coloured, periods):
    """Speed noise near a peak, torque noise (2 + tau s) times it and a little of its own, as steep as a ship's.

    Inertia and load slope come from their ratio: its stated variance is the scatter, a tenth of what the torque alone
    has and less, although the inertia turns the ratio from bin to bin.
    """
    rng = np.random.default_rng(periods)
    f, rate, repeats = 0.05, 1.0, 400
    error, stated, alone = [], [], []
    for _ in range(repeats):
        count = int(np.ceil(periods / f * rate))
        engine = coloured(rng, count, slope=0)[0]
        load = coloured(rng, count, slope=2)[1] * f
        frequency = np.fft.rfftfreq(count, 1.0 / rate)
        through = np.fft.irfft((2.0 + 2.4j * frequency / f) * np.fft.rfft(engine), count)
        window = make_window(
            lambda t: np.cos(2.0 * np.pi * f * t),
            lambda t, n=engine: 0.9 * np.cos(2.0 * np.pi * f * t) + 0.05 * n,
            lambda t, n=through, m=load: (0.9 * (2.0 + 2.4j) * np.exp(2j * np.pi * f * t)).real + 0.05 * n + 0.02 * m,
            frequency_hz=f,
            periods=periods,
            rate_hz=rate,
        )
        line = measure_line(window, WholePeriodSine(), excitation="n_set", speed="n_1")
        taken = np.array([0.0, -(2.0 + 2.4j), 1.0])
        error.append(taken @ line.amplitude)
        stated.append((taken @ line.noise.covariance @ taken.conj()).real)
        alone.append(line.noise.covariance[2, 2].real)
    scatter = np.mean(np.abs(error) ** 2)
    # 400 complex samples know a variance to 5 %
    assert np.mean(stated) == pytest.approx(scatter, rel=0.2)
    assert np.mean(alone) > 10.0 * scatter


def test_plain_mean_of_neighbours_would_be_wrong_under_four_periods(make_window, coloured):
    # the reason for the slope: bins 2, 3, 5 and 6 of 1/f^2 noise have 1.7 times the density of bin 4 on average
    place = np.array([2.0, 3.0, 5.0, 6.0])
    assert np.mean((4.0 / place) ** 2) == pytest.approx(1.72, abs=0.01)
    amplitude, covariance, _ = repeated(make_window, coloured, periods=4, slope=2, repeats=200)
    error = amplitude[:, 1] - 0.9 * np.exp(-0.5j)
    assert covariance[:, 1, 1].real.mean() < 1.3 * np.mean(np.abs(error) ** 2)


@pytest.mark.slow
def test_response_covariance_holds_with_noise_of_the_input(make_window, coloured):
    amplitude, covariance, samples = repeated(make_window, coloured, periods=8, slope=1, noise_of_input=0.05)
    truth = np.array([0.9 * np.exp(-0.5j), 2.1 * np.exp(0.7j)])
    errors, inverses, stated = [], [], []
    for line, noise in zip(amplitude, covariance, strict=True):
        response, spread = response_of_line(line, noise, complex_samples=samples)
        errors.append(np.concatenate([(response - truth).real, (response - truth).imag]))
        stated.append(spread / weight_factor(samples, 2))
        inverses.append(np.linalg.inv(spread))
    errors, stated = np.array(errors), np.mean(stated, axis=0)
    scatter = errors.T @ errors / REPEATS
    assert stated.diagonal() == pytest.approx(scatter.diagonal(), rel=0.2)
    size = np.sqrt(np.outer(scatter.diagonal(), scatter.diagonal()))
    assert stated / size == pytest.approx(scatter / size, abs=0.15)
    # the noise of the input makes speed and torque err together
    assert abs(scatter[0, 1] / size[0, 1]) > 0.2
    weighed = np.einsum("ri,rij,rj->r", errors, np.array(inverses), errors)
    assert weighed.mean() == pytest.approx(4.0, rel=0.15)


def test_real_covariance_is_that_of_drawn_noise():
    rng = np.random.default_rng(3)
    root = rng.standard_normal((3, 3)) + 1j * rng.standard_normal((3, 3))
    drawn = root @ (rng.standard_normal((3, 200_000)) + 1j * rng.standard_normal((3, 200_000))) * np.sqrt(0.5)
    found = np.cov(np.concatenate([drawn.real, drawn.imag]))
    assert real_covariance(root @ root.conj().T) == pytest.approx(found, abs=0.06)


def test_real_jacobian_is_the_complex_product_in_parts():
    rng = np.random.default_rng(4)
    jacobian = rng.standard_normal((2, 3)) + 1j * rng.standard_normal((2, 3))
    x = rng.standard_normal(3) + 1j * rng.standard_normal(3)
    y = jacobian @ x
    assert real_jacobian(jacobian) @ np.concatenate([x.real, x.imag]) == pytest.approx(np.concatenate([y.real, y.imag]))


def test_weight_factor_is_the_mean_of_an_inverse_wishart():
    # with 8 complex samples of 2 outputs the inverse is 8 / 6 too large on average
    rng = np.random.default_rng(5)
    z = (rng.standard_normal((20_000, 2, 8)) + 1j * rng.standard_normal((20_000, 2, 8))) * np.sqrt(0.5)
    inverse = np.linalg.inv(z @ np.swapaxes(z, 1, 2).conj() / 8.0).mean(axis=0)
    assert inverse.diagonal().real == pytest.approx(weight_factor(8.0, 2), rel=0.02)
    assert weight_factor(8.0, 2) == pytest.approx(8.0 / 6.0)
    # hardly more samples than outputs: bounded, not negative
    assert weight_factor(2.0, 2) == pytest.approx(4.0)


def test_a_common_factor_moves_both_outputs_along():
    spread = with_common_error(np.eye(4), np.array([1.0 + 0.0j, 0.0 + 2.0j]), 0.1)
    assert spread == pytest.approx(np.eye(4) + 0.01 * np.outer([1.0, 0.0, 0.0, 2.0], [1.0, 0.0, 0.0, 2.0]))


def closed_loop(response, covariance, frequency_hz=0.1):
    return FrequencyResponse(
        frequency_hz=np.array([frequency_hz]),
        response=np.asarray(response)[:, np.newaxis, np.newaxis],
        covariance=np.asarray(covariance)[np.newaxis],
        inputs=("n_set",),
        outputs=("n", "M_s"),
        lines=("S1",),
        degrees_of_freedom=np.array([12.0]),
        remarks={"S1": "noted before"},
        load=np.array([1.02]),
        pick_up_delay_s=0.05,
    )


def test_open_loop_covariance_is_the_scatter_of_converted_draws():
    rng = np.random.default_rng(6)
    truth = np.array([0.6 - 0.5j, 1.4 - 0.3j])
    root = 0.004 * rng.standard_normal((4, 4))
    latency_s, frequency_hz = 0.4, 0.1
    drawn = root @ rng.standard_normal((4, 100_000))
    speed, torque = truth[:, np.newaxis] + drawn[:2] + 1j * drawn[2:]
    delayed = np.exp(-2j * np.pi * frequency_hz * latency_s)
    governor, core = open_loop(closed_loop(truth, root @ root.T, frequency_hz), set_point_latency_s=latency_s)
    for found, values in ((governor, torque / (delayed - speed)), (core, speed / torque)):
        assert found.response[0, 0, 0] == pytest.approx(values.mean(), rel=2e-3)
        scatter = np.cov(np.stack([values.real, values.imag]))
        assert found.covariance[0] == pytest.approx(scatter, rel=0.03, abs=2e-2 * scatter.max())


def test_open_loop_by_hand():
    # n / n_set = 1/2, M_s / n_set = 1: e = n_set / 2
    governor, core = open_loop(closed_loop([0.5, 1.0], 1e-6 * np.eye(4)))
    assert governor.response[0, 0, 0] == pytest.approx(2.0)
    assert core.response[0, 0, 0] == pytest.approx(0.5)
    # d(M/e) = 2 dM + 4 dn; d(n/M) = dn - dM / 2
    assert governor.covariance[0] == pytest.approx(20e-6 * np.eye(2))
    assert core.covariance[0] == pytest.approx(1.25e-6 * np.eye(2))
    assert (governor.inputs, governor.outputs) == (("e",), ("M_s",))
    assert (core.inputs, core.outputs) == (("M_s",), ("n",))
    for found in (governor, core):
        assert found.degrees_of_freedom.tolist() == [12.0]
        assert found.load.tolist() == [1.02]
        assert found.pick_up_delay_s == 0.05
        assert found.used.tolist() == [True]
        assert found.remarks == {"S1": "noted before"}


def test_an_error_signal_lost_in_noise_is_not_used():
    governor, core = open_loop(closed_loop([0.995, 2.0], 1e-4 * np.eye(4)))
    assert governor.used.tolist() == [False]
    assert governor.remarks["S1"] == "noted before; error signal is lost in noise (|e/n_set| = 0.005)"
    assert core.used.tolist() == [True]
    assert core.remarks == {"S1": "noted before"}


def test_open_loop_refuses_other_responses():
    governor, _ = open_loop(closed_loop([0.5, 1.0], 1e-6 * np.eye(4)))
    with pytest.raises(ResponseError, match="expected a response from n_set to n and M_s, found e to M_s"):
        open_loop(governor)
    with pytest.raises(ResponseError, match="S1: expected e to differ from 0"):
        open_loop(closed_loop([1.0, 2.0], 1e-6 * np.eye(4)))
    with pytest.raises(ResponseError, match="S1: expected M_s to differ from 0"):
        open_loop(closed_loop([0.5, 0.0], 1e-6 * np.eye(4)))
