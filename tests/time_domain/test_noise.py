"""Noise of known colour: what is found, what is left after the filter, nothing across gaps."""

import numpy as np
import pytest
from scipy.signal import lfilter
from scipy.special import chdtrc
from tests.time_domain.whiteness import whiteness_p_value

from shaftprint.errors import IdentificationError
from shaftprint.time_domain._noise_model import NoiseModel, estimate_noise, white_noise
from shaftprint.time_domain._whitening import Whitening

FIRST = np.array([[0.9, 0.1], [-0.3, 0.5]])
SECOND = np.array([[-0.4, 0.05], [0.1, -0.2]])
INNOVATION = np.array([[1.0, 0.6], [0.6, 2.0]])


def autoregression(count, rng, coefficients=(FIRST, SECOND), covariance=INNOVATION, before=500):
    """Return noise made by the recursion itself, shape (count, outputs)."""
    root = np.linalg.cholesky(covariance)
    e = np.zeros((count + before, covariance.shape[0]))
    v = rng.standard_normal(e.shape) @ root.T
    for t in range(len(coefficients), e.shape[0]):
        e[t] = v[t] + sum(a @ e[t - 1 - k] for k, a in enumerate(coefficients))
    return e[before:]


def whole(values):
    return [slice(0, values.shape[0])]


def filtered(model, residuals, stretches):
    return Whitening(noise=model).whitened(residuals[None], stretches)[0]


def test_known_autoregression_is_found():
    """Standard deviations of coefficients are about 1 / sqrt(N): 0.007 here."""
    e = autoregression(20_000, np.random.default_rng(1))
    found = estimate_noise(e, whole(e), max_order=12)
    assert found.order == 2
    np.testing.assert_allclose(found.coefficients, [FIRST, SECOND], atol=0.035)
    np.testing.assert_allclose(found.covariance, INNOVATION, rtol=0.05)


def test_gaps_do_not_bend_what_is_found():
    """Samples in gaps are wrong by a thousand; 200 stretches of 100 samples give what one of 20,000 does."""
    rng = np.random.default_rng(2)
    e = autoregression(24_000, rng)
    used = np.arange(24_000) % 120 < 100
    e[~used] = 1e3
    stretches = [slice(k, k + 100) for k in range(0, 24_000, 120)]
    found = estimate_noise(e, stretches, max_order=12)
    assert found.order == 2
    np.testing.assert_allclose(found.coefficients, [FIRST, SECOND], atol=0.035)
    np.testing.assert_allclose(found.covariance, INNOVATION, rtol=0.05)


@pytest.mark.parametrize("cut", [None, 7, 300])
def test_filtered_noise_is_independent_with_unit_variance(cut):
    """Also the first samples after each gap, in stretches shorter than the memory of the noise and longer."""
    e = autoregression(21_000, np.random.default_rng(3))
    model = NoiseModel(coefficients=np.array([FIRST, SECOND]), covariance=INNOVATION)
    stretches = whole(e) if cut is None else [slice(k, k + cut) for k in range(0, e.shape[0], cut)]
    left = filtered(model, e, stretches)
    np.testing.assert_allclose(left.T @ left / left.shape[0], np.eye(2), atol=0.04)
    lengths = [s.stop - s.start for s in stretches]
    assert whiteness_p_value(left, lags=10 if cut != 7 else 5, fitted=0, lengths=lengths) > 0.01


def test_start_up_covariance_is_that_of_many_starts():
    rng = np.random.default_rng(4)
    model = NoiseModel(coefficients=np.array([FIRST, SECOND]), covariance=INNOVATION)
    e = autoregression(100_000, rng)
    starts = e.reshape(-1, 5, 2)[:, :2].reshape(-1, 4)
    np.testing.assert_allclose(model.start_up, starts.T @ starts / starts.shape[0], rtol=0.1, atol=0.1)


def test_sum_of_squares_is_the_exact_quadratic_form():
    """``e^T Gamma^-1 e`` with the covariance of a whole stretch built from the autocovariance of a scalar AR(1):
    ``s^2 a^|k| / (1 - a^2)``."""
    a, s = 0.8, 0.3
    model = NoiseModel(coefficients=np.array([[[a]]]), covariance=np.array([[s**2]]))
    lag = np.abs(np.subtract.outer(np.arange(6), np.arange(6)))
    gamma = s**2 * a**lag / (1 - a**2)
    e = np.random.default_rng(5).standard_normal((6, 1))
    left = filtered(model, e, whole(e))
    assert np.sum(left**2) == pytest.approx(float(e[:, 0] @ np.linalg.solve(gamma, e[:, 0])), rel=1e-12)
    split = filtered(model, e, [slice(0, 2), slice(3, 6)])
    expected = e[:2, 0] @ np.linalg.solve(gamma[:2, :2], e[:2, 0]) + e[3:, 0] @ np.linalg.solve(gamma[:3, :3], e[3:, 0])
    assert np.sum(split**2) == pytest.approx(float(expected), rel=1e-12)


def test_moving_average_is_whitened_by_a_long_enough_memory():
    """ARMA(2, 1) of a peak at a quarter of the rate; the fitted spectrum follows the true one."""
    rng = np.random.default_rng(6)
    numerator, denominator = [1.0, 0.6], [1.0, -0.2, 0.8]
    e = lfilter(numerator, denominator, 0.5 * rng.standard_normal(10_500))[500:, None]
    found = estimate_noise(e, whole(e), max_order=40)
    left = filtered(found, e, whole(e))
    assert whiteness_p_value(left, lags=40, fitted=found.order) > 0.01
    assert found.covariance[0, 0] == pytest.approx(0.25, rel=0.05)
    frequency = np.linspace(0.5, 9.5, 40)
    z = np.exp(-2j * np.pi * frequency / 20.0)
    true = np.abs((1 + 0.6 * z) / (1 - 0.2 * z + 0.8 * z**2)) ** 2 * 0.25 / 20.0
    np.testing.assert_allclose(found.spectrum(frequency, 20.0)[:, 0, 0].real, true, rtol=0.3)


def test_white_noise_needs_no_memory():
    e = np.random.default_rng(7).standard_normal((5000, 2)) * [2.0, 0.1]
    found = estimate_noise(e, whole(e), max_order=20)
    assert found.order == 0
    np.testing.assert_allclose(filtered(found, e, whole(e)).std(axis=0), 1.0, rtol=0.03)
    plain = white_noise(e, whole(e))
    np.testing.assert_allclose(np.sqrt(np.diag(plain.covariance)), [2.0, 0.1], rtol=0.03)
    assert plain.covariance[0, 1] == 0.0


def test_slow_noise_that_hardly_forgets_stays_stable():
    """A random walk is no stable noise: what is found still is."""
    e = np.cumsum(np.random.default_rng(8).standard_normal((400, 1)), axis=0)
    found = estimate_noise(e, whole(e), max_order=10)
    assert np.all(np.linalg.eigvalsh(found.start_up) > 0.0)
    assert np.isfinite(filtered(found, e, whole(e))).all()


def test_few_samples_get_a_short_memory():
    e = autoregression(30, np.random.default_rng(9))
    assert estimate_noise(e, whole(e), max_order=40).order <= 1


@pytest.mark.parametrize("residuals", [np.zeros((50, 1)), np.ones((50, 2)) * np.arange(50)[:, None]])
def test_no_noise_is_refused(residuals):
    with pytest.raises(IdentificationError, match="residuals of every output"):
        estimate_noise(residuals, whole(residuals), max_order=3)


def test_portmanteau_rejects_colour_and_keeps_its_level():
    rng = np.random.default_rng(10)
    e = autoregression(2000, rng)
    assert whiteness_p_value(e, lags=10, fitted=0) < 1e-6
    p = [whiteness_p_value(rng.standard_normal((600, 2)), lags=8, fitted=0) for _ in range(400)]
    assert 0.02 < np.mean(np.array(p) < 0.05) < 0.09
    assert chdtrc(4 * 8, 0.0) == 1.0


def test_stretches_too_short_for_a_lag_say_nothing_of_it():
    left = np.random.default_rng(11).standard_normal((30, 1))
    assert 0.0 < whiteness_p_value(left, lags=5, fitted=0, lengths=[3] * 10) <= 1.0


@pytest.mark.parametrize("often", [3, 5, 8])
def test_noise_that_is_drift_alone_still_has_a_filter(often):
    """Its best autoregression has all poles at one: the covariance of samples in a row has no inverse."""
    for seed in range(4):
        drift = np.random.default_rng(seed).standard_normal((3000, 2))
        for _ in range(often):
            drift = lfilter([1.0], [1.0, -0.99], drift, axis=0)
        drift /= drift.std(axis=0)
        drift += 1e-7 * np.random.default_rng(seed + 9).standard_normal(drift.shape)
        white = Whitening(noise=estimate_noise(drift, [slice(0, 3000)], max_order=40)).whitened(
            drift[None], [slice(0, 3000)]
        )
        assert np.isfinite(white).all()
