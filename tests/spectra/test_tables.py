"""Signal-to-noise ratios, harmonics, load drift and pick-up gain against numbers worked out by hand."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from shaftprint.signals import SpeedSignal
from shaftprint.spectra import ExactBin, signal_to_noise
from shaftprint.spectra.lines._harmonics import collect_harmonics
from shaftprint.spectra.lines._line_measurement import measure_line, strongest_frequency_hz
from shaftprint.spectra.lines._load_drift import load_drift
from shaftprint.spectra.lines._modulation import without_modulation
from shaftprint.spectra.lines._noise import ShaftRelation, residual_spectrum
from shaftprint.spectra.lines._sine_fit import WholePeriodSine

UNRELATED = ShaftRelation(speed=1, torque=2, ratio=0.0)


def tone(amplitude, cycles, phase_rad=0.0):
    """A tone of so many cycles in a window of 100 s."""
    return lambda t: amplitude * np.cos(0.02 * np.pi * cycles * t + phase_rad)


def together(*parts):
    return lambda t: sum(part(t) for part in parts)


@pytest.fixture
def measured(make_window):
    def measure(*channels, periods=30, method=None):
        window = make_window(*channels, frequency_hz=periods / 100.0, periods=periods, rate_hz=10.0)
        return measure_line(window, method or WholePeriodSine(), excitation="n_set", speed="n_1")

    return measure


@pytest.mark.parametrize("method", [WholePeriodSine(), ExactBin()])
def test_equal_variances_are_zero_decibel(measured, method):
    # the line, and three tones beside it that together have its variance; a fourth is 21 bins away
    beside = together(tone(0.6, 10), tone(0.48, 29), tone(0.64, 50), tone(5.0, 9))
    line = measured(together(tone(1.0, 30), beside), tone(1.0, 30), tone(1.0, 30), method=method)
    # the parabola in the fit takes a little of the tones
    assert line.variances.local_db[0] == pytest.approx(0.0, abs=0.02)
    assert line.variances.signal[0] == pytest.approx(0.5, rel=1e-3)


def test_overall_ratio_by_hand(measured):
    # two windows: lines of variance 1/2 and 2, noise of variance 1/2 in the second: sqrt(2.5 / 3)
    channels = [tone(1.0, 30)] * 2
    first = measured(tone(1.0, 30), *channels)
    second = measured(together(tone(2.0, 30), tone(1.0, 90)), *channels)
    table = signal_to_noise([first.variances, second.variances], lines=("S1", "S2"), channels=("n_set", "n_e", "M_s"))
    assert table.overall == pytest.approx([np.sqrt(2.5 / 3.0), 1.0, 1.0])
    assert table.local_db.shape == (2, 3)
    # nothing but rounding beside the line
    assert table.local_db[0, 0] > 250.0


def test_a_channel_that_never_moves_has_no_signal(measured):
    line = measured(tone(1.0, 30), lambda t: 0.0 * t, tone(1.0, 30))
    table = signal_to_noise([line.variances], lines=("S1",), channels=("n_set", "n_e", "M_s"))
    assert table.overall[1] == 0.0
    assert table.local_db[0, 1] == pytest.approx(0.0)


def test_a_slow_line_has_fewer_neighbours_below(measured):
    # bins 1 to 3 and 5 to 24 of a line of 4 periods; bin 25 is out of reach
    noisy = together(tone(1.0, 4), tone(0.1, 24), tone(1.0, 25))
    line = measured(noisy, tone(1.0, 4), tone(1.0, 4), periods=4)
    assert line.variances.local_db[0] == pytest.approx(20.0, abs=0.05)


def test_harmonics_of_a_quadratic_propeller(measured):
    # n = 1 + a cos x and M_s = n^2 = 1 + a^2/2 + 2 a cos x + a^2/2 cos 2x
    a = 0.12
    speed = together(lambda t: 1.0, tone(a, 30))
    line = measured(tone(a, 30), speed, lambda t: speed(t) ** 2)
    table = collect_harmonics([line], speed="n_1")
    assert table.orders == (2, 3)
    assert table.fundamental[0] == pytest.approx([a, 2.0 * a])
    assert table.amplitude[0] == pytest.approx(np.array([[0.0, 0.0], [a**2 / 2.0, 0.0]]), abs=1e-12)
    assert table.expected_second_torque == pytest.approx([a**2 / 2.0])


@pytest.mark.slow
def test_deviation_of_a_harmonic_is_its_scatter(make_window):
    rng = np.random.default_rng(7)
    found, stated = [], []
    for _ in range(300):
        noise = rng.standard_normal(1000)
        window = make_window(
            tone(1.0, 30), tone(1.0, 30), lambda t, n=noise: tone(1.0, 30)(t) + n,
            frequency_hz=0.3, periods=30, rate_hz=10.0,
        )  # fmt: skip
        line = measure_line(window, WholePeriodSine(), excitation="n_set", speed="n_1")
        found.append(line.harmonic[0, 2].real)
        stated.append(collect_harmonics([line], speed="n_1").standard_deviation[0, 1, 0] ** 2)
    # white noise of unit variance: amplitude parts have variance 2 / N
    assert np.mean(stated) == pytest.approx(2.0 / 1000.0, rel=0.1)
    assert np.var(found) == pytest.approx(2.0 / 1000.0, rel=0.2)


def test_bin_picking_has_no_harmonics(measured):
    line = measured(tone(1.0, 30), tone(1.0, 30), tone(1.0, 30), method=ExactBin())
    table = collect_harmonics([line], speed="n_1")
    assert np.isnan(table.amplitude).all()
    assert np.isnan(table.standard_deviation).all()


def test_load_of_a_window_without_the_mean_shift_of_the_sine(measured):
    # the mean of (0.98 + 0.15 cos)^2 is 0.98^2 + 0.15^2 / 2; loads 3 % and -1 %
    def propeller(load):
        speed = together(lambda t: 0.98, tone(0.15, 30))
        return measured(tone(0.15, 30), speed, lambda t: (1.0 + load) * speed(t) ** 2)

    drift = load_drift([propeller(0.03), propeller(-0.01)], speed="n_1")
    assert drift.delta == pytest.approx([0.03, -0.01], abs=1e-9)
    assert drift.standard_deviation == pytest.approx(0.04 / np.sqrt(2.0))
    assert load_drift([propeller(0.03)], speed="n_1").standard_deviation == 0.0


def test_sidebands_of_a_drifting_load_are_not_noise(make_window):
    # torque (1 + load) (1 + 2 a cos), speed with half of the modulation: what is left beside the line is the noise
    rng = np.random.default_rng(8)
    noise = 1e-4 * rng.standard_normal(1000)
    load = together(tone(0.02, 2, 0.3), tone(0.01, 5, 1.0))
    torque = lambda t: (1.0 + load(t)) * (1.0 + tone(0.25, 30)(t))  # noqa: E731
    window = make_window(
        tone(0.12, 30),
        lambda t: (1.0 + 0.5 * load(t)) * tone(0.12, 30)(t) + noise,
        lambda t: torque(t) + noise,
        frequency_hz=0.3,
        periods=30,
        rate_hz=10.0,
    )
    fit = WholePeriodSine().fit(window)
    raw = residual_spectrum(fit)
    spectrum = without_modulation(raw, window.values[-1], UNRELATED, periods=30)
    sidebands = [25, 28, 32, 35]
    assert np.abs(raw[2, sidebands]) == pytest.approx(0.125 * np.array([0.01, 0.02, 0.02, 0.01]), rel=0.1)
    assert np.abs(spectrum[1, sidebands]).max() < 2e-5
    # the parabola in the fit spreads a little of the load itself over the bins of the torque
    assert np.abs(spectrum[2, sidebands]).max() < 1.2e-4
    # two slow bins and eight neighbours: too few to tell one from the other
    few = make_window(*[tone(0.1, 8)] * 3, frequency_hz=0.2, periods=8, rate_hz=10.0)
    raw = residual_spectrum(WholePeriodSine().fit(few))
    assert without_modulation(raw, few.values[-1], UNRELATED, periods=8) is raw


def test_taking_sidebands_out_leaves_the_noise_as_strong_as_it_was(make_window):
    """White noise and nothing else: what least squares take of it by chance is given back on average."""
    rng = np.random.default_rng(9)
    before, after = 0.0, 0.0
    for _ in range(200):
        noise = rng.standard_normal((3, 500))
        window = make_window(
            *[lambda t, n=row: tone(1.0, 10)(t) + 1e-3 * n for row in noise], frequency_hz=0.2, periods=10, rate_hz=10.0
        )
        raw = residual_spectrum(WholePeriodSine().fit(window))
        cleaned = without_modulation(raw, window.values[-1], UNRELATED, periods=10)
        beside = [6, 7, 8, 9, 11, 12, 13, 14]
        before += float(np.sum(np.abs(raw[1, beside]) ** 2))
        after += float(np.sum(np.abs(cleaned[1, beside]) ** 2))
    # 1600 complex samples: 2.5 %
    assert after / before == pytest.approx(1.0, abs=0.06)


@pytest.mark.parametrize("place", [0.1, 0.2, 0.32, 0.45])
def test_gain_of_a_spline_through_pulses(place):
    # truth: a sine in the speed, its angle at the pulses, SciPy's spline, and the sine fitted to the derivative
    pulse_rate_hz, depth = 20.0, 1e-4
    f = place * pulse_rate_hz
    knot_s = np.arange(4000) / pulse_rate_hz
    angle_rev = knot_s * pulse_rate_hz + depth * np.sin(2.0 * np.pi * f * knot_s) / (2.0 * np.pi * f)
    time_s = np.linspace(50.0, 150.0, 200_001)[:-1]
    speed = CubicSpline(knot_s, angle_rev).derivative()(time_s) - pulse_rate_hz
    found = 2.0 * np.mean(speed * np.exp(-2j * np.pi * f * time_s)) / depth
    signal = SpeedSignal(
        name="n_e", channel="PTM_e", values=time_s, reference=1.0, pulse_rate_hz=pulse_rate_hz,
    )  # fmt: skip
    assert signal.gain(f) == pytest.approx(found, abs=2e-5)
    assert signal.gain(10.1) == 1.0


def test_an_averaged_speed_is_left_to_the_model():
    signal = SpeedSignal(
        name="n_e", channel="PTM_e", values=np.ones(2), reference=1.0, pulse_rate_hz=20.0, averaging_s=0.05,
        hold_s=0.05, delay_s=0.05,
    )  # fmt: skip
    assert signal.gain(5.0) == 1.0


def test_strongest_frequency_lies_between_bins():
    time_s = np.arange(2000) / 10.0
    values = 3.0 + np.cos(2.0 * np.pi * 0.0873 * time_s)
    assert strongest_frequency_hz(values, 10.0) == pytest.approx(0.0873, abs=0.05 * 0.005)
    assert np.isnan(strongest_frequency_hz(np.ones(2000), 10.0))
    assert np.isnan(strongest_frequency_hz(np.random.default_rng(9).standard_normal(2000), 10.0))
