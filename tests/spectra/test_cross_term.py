"""The torque of a quadratic propeller, taken apart by a numerical Fourier integral."""

import numpy as np
import pytest

from shaftprint.spectra._line_responses import without_cross_term

PLACES = {"speed": 1, "torque": 2}


def line_of(values):
    """Complex amplitude of the first harmonic of one period."""
    angle = np.arange(values.size) / values.size * 2.0 * np.pi
    return 2.0 * np.mean(values * np.exp(-1j * angle))


@pytest.mark.parametrize("load", [1.0, 0.97, 1.05])
def test_what_is_left_is_the_line_of_the_linear_propeller(load):
    speed_line, second = 0.15 * np.exp(-0.6j), 0.004 * np.exp(2.1j)
    angle = np.arange(4096) / 4096 * 2.0 * np.pi
    speed = np.real(speed_line * np.exp(1j * angle) + second * np.exp(2j * angle))
    torque = load * (1.0 + speed) ** 2
    amplitude = np.array([0.127, speed_line, line_of(torque)])
    cleaned, _ = without_cross_term(amplitude, np.eye(3), harmonic=second, variance=0.0, load=load, **PLACES)
    assert abs(amplitude[2] - 2.0 * load * speed_line) == pytest.approx(load * 0.15 * 0.004, rel=1e-9)
    assert cleaned[2] == pytest.approx(2.0 * load * speed_line, abs=1e-12)
    np.testing.assert_array_equal(cleaned[:2], amplitude[:2])


def test_noise_of_the_harmonic_becomes_noise_of_the_torque():
    rng = np.random.default_rng(5)
    amplitude = np.array([0.1, 0.2j, 0.4 + 0j])
    noisy = 1e-3 * (rng.standard_normal(4000) + 1j * rng.standard_normal(4000))
    _, spread = without_cross_term(amplitude, np.zeros((3, 3)), harmonic=0.0, variance=2e-6, load=1.1, **PLACES)
    torque = [
        without_cross_term(amplitude, np.zeros((3, 3)), harmonic=b, variance=2e-6, load=1.1, **PLACES)[0][2]
        for b in noisy
    ]
    assert spread[2, 2].real == pytest.approx(np.var(torque), rel=0.06)
    assert np.count_nonzero(spread) == 1


def test_a_method_that_fits_no_harmonic_changes_nothing():
    amplitude, noise = np.array([0.1, 0.2j, 0.4 + 0j]), np.eye(3)
    cleaned, spread = without_cross_term(amplitude, noise, harmonic=complex("nan"), variance=np.nan, load=1.0, **PLACES)
    assert cleaned is amplitude
    assert spread is noise
