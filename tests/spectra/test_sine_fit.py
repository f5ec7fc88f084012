import numpy as np
import pytest

from shaftprint.spectra import ExactBin, HighestPeak, plan_windows
from shaftprint.spectra.lines._line_fit import cut_window
from shaftprint.spectra.lines._sine_fit import WholePeriodSine

METHODS = [WholePeriodSine(), ExactBin(), HighestPeak()]


def sine(amplitude, frequency_hz, phase_rad=0.0):
    return lambda t: amplitude * np.cos(2.0 * np.pi * frequency_hz * t + phase_rad)


@pytest.mark.parametrize("first_s", [0.0, 0.07])
def test_everything_in_the_model_is_found_exactly_without_whole_samples(make_window, first_s):
    # 7 periods of 0.137 Hz at 10 Hz are 510.9 samples
    f = 0.137
    samples = make_window(
        lambda t: (
            3.0 + 0.02 * t - 1e-4 * t**2 + sine(2.0, f, 0.4)(t) + sine(0.5, 2 * f, 1.0)(t) + sine(0.25, 3 * f, -2.0)(t)
        ),
        sine(5.0, f, -1.0),
        frequency_hz=f,
        periods=7,
        rate_hz=10.0,
        first_s=first_s,
    )
    fit = WholePeriodSine().fit(samples)
    assert fit.amplitude[:, 0] == pytest.approx([2.0 * np.exp(0.4j), 0.5 * np.exp(1j), 0.25 * np.exp(-2j)], abs=1e-12)
    assert fit.amplitude[:, 1] == pytest.approx([5.0 * np.exp(-1j), 0.0, 0.0], abs=1e-12)
    # mean of 3 + 0.02 t - 1e-4 t^2 over T = 7 / f
    duration = 7 / f
    assert fit.mean[0] == pytest.approx(3.0 + 0.01 * duration - 1e-4 * duration**2 / 3.0)
    assert np.abs(fit.residual).max() < 1e-12


@pytest.mark.parametrize("method", METHODS)
def test_the_measurement_is_linear(make_window, method):
    rng = np.random.default_rng(1)
    noise = rng.standard_normal((2, 600))
    first = lambda t: sine(30.0, 0.1)(t) + noise[0]  # noqa: E731
    second = lambda t: sine(20.0, 0.1, 1.0)(t) + noise[1]  # noqa: E731
    total = lambda t: 2.0 * first(t) - 3.0 * second(t)  # noqa: E731
    fit = method.fit(make_window(first, second, total, frequency_hz=0.1, periods=6, rate_hz=10.0))
    assert fit.amplitude[0, 2] == pytest.approx(2.0 * fit.amplitude[0, 0] - 3.0 * fit.amplitude[0, 1])
    assert fit.residual[2] == pytest.approx(2.0 * fit.residual[0] - 3.0 * fit.residual[1], abs=1e-10)


@pytest.mark.parametrize("method", METHODS)
def test_a_delay_turns_the_phase_back(make_window, method):
    delay_s, f = 0.3, 0.1
    fit = method.fit(
        make_window(
            sine(1.0, f), lambda t: sine(1.0, f)(t - delay_s), frequency_hz=f, periods=5, rate_hz=10.0, first_s=0.05
        )
    )
    assert fit.amplitude[0, 1] / fit.amplitude[0, 0] == pytest.approx(np.exp(-2j * np.pi * f * delay_s), abs=2e-3)


def test_exact_bin_is_the_fit_on_whole_samples(make_window):
    rng = np.random.default_rng(2)
    noise = rng.standard_normal(500)
    samples = make_window(lambda t: sine(1.0, 0.1, 0.3)(t) + noise, frequency_hz=0.1, periods=5, rate_hz=10.0)
    bin_5 = np.fft.fft(samples.values[0])[5] * 2.0 / 500
    fit = ExactBin().fit(samples)
    assert fit.amplitude[0, 0] == pytest.approx(bin_5, rel=1e-12)
    assert fit.mean[0] == pytest.approx(samples.values.mean())
    # least squares of offset and sine alone is the same number
    basis = np.stack([np.ones(500), np.cos(0.2 * np.pi * samples.time_s), np.sin(0.2 * np.pi * samples.time_s)], axis=1)
    _, cosine, sinus = np.linalg.lstsq(basis, samples.values[0])[0]
    assert fit.amplitude[0, 0] == pytest.approx(cosine - 1j * sinus, rel=1e-10)


def test_exact_bin_leaks_where_the_least_squares_sine_does_not(make_window):
    # 209.73 samples: the line lies 0.03 of a bin beside bin 24
    f = 3.433
    samples = make_window(sine(1.0, f), frequency_hz=f, periods=24, rate_hz=30.0)
    exact, fitted = ExactBin().fit(samples), WholePeriodSine().fit(samples)
    assert abs(fitted.amplitude[0, 0] - 1.0) < 1e-12
    assert abs(exact.amplitude[0, 0] - 1.0) > 1e-2


def test_drift_is_rejected_by_the_fit_and_not_by_the_bin(make_window):
    f, periods = 0.1, 4
    drift = 0.05
    samples = make_window(lambda t: sine(1.0, f)(t) + drift * t, frequency_hz=f, periods=periods, rate_hz=10.0)
    assert WholePeriodSine().fit(samples).amplitude[0, 0] == pytest.approx(1.0, abs=1e-12)
    # a ramp of slope b over T has the Fourier amplitude b T / (pi i) at bin i, in the sine part
    expected = 1.0 + 1j * drift * (periods / f) / (np.pi * periods)
    assert ExactBin().fit(samples).amplitude[0, 0] == pytest.approx(expected, abs=6e-3)


def test_highest_peak_takes_the_wrong_one_where_noise_is_stronger(make_window):
    f = 0.1
    samples = make_window(
        sine(1.0, f),
        lambda t: sine(0.5, f)(t) + sine(0.8, 0.3)(t),
        frequency_hz=f,
        periods=5,
        rate_hz=10.0,
    )
    peak, exact = HighestPeak().fit(samples), ExactBin().fit(samples)
    assert np.abs(peak.amplitude[0]) == pytest.approx([1.0, 0.8])
    assert np.abs(exact.amplitude[0]) == pytest.approx([1.0, 0.5])


def test_harmonics_above_half_the_rate_are_left_out(make_window):
    fit = WholePeriodSine().fit(make_window(sine(1.0, 2.0), frequency_hz=2.0, periods=40, rate_hz=10.0))
    assert len(fit.amplitude) == 2
    fit = WholePeriodSine().fit(make_window(sine(1.0, 4.0), frequency_hz=4.0, periods=40, rate_hz=10.0))
    assert len(fit.amplitude) == 1
    fit = WholePeriodSine(harmonics=1).fit(make_window(sine(1.0, 0.1), frequency_hz=0.1, periods=4, rate_hz=10.0))
    assert len(fit.amplitude) == 1


def test_a_straight_line_is_the_drift_of_three_periods(make_window):
    f = 0.1
    samples = make_window(
        lambda t: sine(1.0, f)(t) + 0.05 * t,
        lambda t: 1e-3 * (t - 15.0) ** 2,
        frequency_hz=f,
        periods=3,
        rate_hz=10.0,
    )
    fit = WholePeriodSine().fit(samples)
    assert fit.amplitude[0, 0] == pytest.approx(1.0, abs=1e-12)
    # parabola c (t - T/2)^2: Fourier amplitude c T^2 / (pi i)^2
    assert fit.amplitude[0, 1] == pytest.approx(1e-3 * 900.0 / (3.0 * np.pi) ** 2, abs=2e-3)


def test_a_window_is_cut_by_time(make_campaign):
    window = plan_windows(make_campaign(("S1", 0.3, 10.03, 20.5)))[0]
    values = np.arange(400.0)
    cut = cut_window(window, {"n": values}, rate_hz=10.0, start_s=5.0)
    # 10.03 to 20.03 s: the first sample at 10.1 s is number 51, the last at 20.0 s number 150
    assert cut.values[0, [0, -1]].tolist() == [51.0, 150.0]
    assert cut.time_s[[0, -1]] == pytest.approx([0.07, 9.97])
    assert cut_window(window, {"n": values}, rate_hz=10.0, start_s=10.15) is None
    assert cut_window(window, {"n": values[:150]}, rate_hz=10.0, start_s=5.0) is None
