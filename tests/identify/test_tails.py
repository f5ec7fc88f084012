"""How much far lines count: densities, derivatives, and averages over noise and estimated covariances."""

import numpy as np
import pytest
import scipy.stats

from shaftprint.identify import MaximumLikelihood, StudentT, Unweighted
from shaftprint.identify.likelihood._tails import estimated_tails, student_tails

FREEDOM = np.array([12.7, 34.6, np.inf])
RNG_SEED = 5


def table(size, lines, scale, seed=RNG_SEED):
    """Residuals of one start and their derivatives to three parameters."""
    rng = np.random.default_rng(seed)
    found = rng.standard_normal((1, 4, size, lines))
    found[:, 0] *= scale
    return found


def cost(tails, residuals):
    return 0.5 * np.sum(tails.shaped(residuals[:, None])[:, 0] ** 2)


# ---- densities ----


@pytest.mark.parametrize("size", [2, 4, 6])
def test_student_cost_is_the_logarithm_of_the_t_density(size):
    """Differences of scipy's log-density, times one factor, whatever the distance."""
    tails = student_tails(np.array([np.inf]), size, 4.0)
    density = scipy.stats.multivariate_t(np.zeros(size), np.eye(size), df=4.0)
    points = np.concatenate([table(size, 1, scale)[:, 0] for scale in (0.01, 0.3, 1.0, 5.0, 50.0)])
    costs = np.array([cost(tails, point[None]) for point in points])
    logs = -density.logpdf(points[:, :, 0]) + density.logpdf(np.zeros(size))
    ratio = costs / logs
    assert ratio == pytest.approx(np.full(5, ratio[0]), rel=1e-9)
    assert ratio[0] == pytest.approx(1.0, abs=0.11)


@pytest.mark.parametrize("size", [2, 4])
def test_cost_of_an_estimated_covariance_is_the_determinant_of_its_sample_with_the_residual(size):
    """``|S + e e^H / n|`` to a power: what a complex normal sample says once its covariance is integrated out.

    The power makes one channel's ``2 cost`` exactly a chi-square; here only that it is one power for all residuals.
    """
    channels, samples = size // 2, 9
    rng = np.random.default_rng(3)
    noise = rng.standard_normal((samples, channels)) + 1j * rng.standard_normal((samples, channels))
    estimate = noise.T @ noise.conj() / samples
    tails = estimated_tails(np.array([2.0 * samples]), size)
    weight = estimate * samples / (samples - channels)
    powers = []
    for scale in (0.1, 1.0, 6.0):
        residual = scale * (rng.standard_normal(channels) + 1j * rng.standard_normal(channels))
        squared = 2.0 * (residual.conj() @ np.linalg.solve(weight, residual)).real
        whitened = np.zeros((1, size, 1))
        whitened[0, 0, 0] = np.sqrt(squared)
        grown = np.linalg.det(estimate + np.outer(residual, residual.conj()) / samples).real
        powers.append(cost(tails, whitened) / np.log(grown / np.linalg.det(estimate).real))
    assert powers == pytest.approx([powers[0]] * 3, rel=1e-9)
    assert powers[0] == pytest.approx(samples - channels + 1)


def test_a_known_covariance_has_no_tail():
    tails = estimated_tails(np.array([np.inf, np.inf]), 4)
    plain = table(4, 2, 3.0)
    assert tails.normal
    np.testing.assert_allclose(tails.shaped(plain), plain, rtol=1e-14)
    np.testing.assert_allclose(tails.curvature(plain), plain[:, 1:], rtol=1e-14)
    assert not estimated_tails(FREEDOM, 4).normal


def test_many_degrees_of_freedom_are_a_known_covariance():
    plain = table(4, 1, 3.0)
    np.testing.assert_allclose(estimated_tails(np.array([1e7]), 4).shaped(plain), plain, rtol=1e-5)


def test_fewer_degrees_of_freedom_than_numbers_still_give_a_cost():
    tails = estimated_tails(np.array([1.0, 4.0]), 4)
    assert np.all(np.isfinite(tails.shaped(table(4, 2, 100.0))))
    assert np.all(tails.information > 0.0)


# ---- derivatives ----


@pytest.mark.parametrize("tails", [estimated_tails(FREEDOM, 4), student_tails(FREEDOM, 4, 4.0)])
@pytest.mark.parametrize("scale", [1e-3, 1.0, 30.0])
def test_derivatives_are_those_of_the_shaped_residuals(tails, scale):
    """A linear model: residuals move along their derivatives."""
    plain = table(4, 3, scale)
    shaped = tails.shaped(plain)
    for i in (1, 2, 3):
        step = 1e-6 * scale
        ahead, behind = (tails.shaped((plain[:, 0] + s * step * plain[:, i])[:, None])[:, 0] for s in (1.0, -1.0))
        np.testing.assert_allclose(shaped[:, i], (ahead - behind) / (2.0 * step), rtol=1e-6, atol=1e-9)


def test_curvature_is_the_second_derivative_of_the_cost_of_a_linear_model():
    tails = estimated_tails(FREEDOM, 4)
    plain = table(4, 3, 0.5)
    rows = tails.curvature(plain).reshape(3, -1)
    step = 1e-4

    def at(*along):
        return cost(tails, plain[:, 0] + sum(s * step * plain[:, i] for i, s in along))

    for i in (1, 2, 3):
        for j in (1, 2, 3):
            expected = (at((i, 1), (j, 1)) - at((i, 1), (j, -1)) - at((i, -1), (j, 1)) + at((i, -1), (j, -1))) / (
                4.0 * step**2
            )
            assert rows[i - 1] @ rows[j - 1] == pytest.approx(expected, rel=1e-4, abs=1e-4)


def test_a_line_so_far_off_that_its_cost_bends_down_has_no_curvature_along_its_residual():
    far = np.zeros((1, 2, 4, 1))
    far[0, 0, 0, 0], far[0, 1, 0, 0] = 100.0, 1.0
    np.testing.assert_allclose(estimated_tails(np.array([12.0]), 4).curvature(far), 0.0, atol=1e-9)


def test_heavy_tails_take_the_average_curvature_but_for_a_bad_line():
    """``(1 + limit / 4) / (1 + 400 / 4)`` of it at 20 standard deviations, with a limit of 4 + 6 sqrt(8)."""
    tails = student_tails(np.array([np.inf, np.inf]), 4, 4.0)
    lines = np.zeros((1, 2, 4, 2))
    lines[0, 0, 0] = [3.0, 20.0]
    lines[0, 1] = 1.0
    squares = tails.curvature(lines)[0, 0] ** 2
    left = (1.0 + (4.0 + 6.0 * 8.0**0.5) / 4.0) / 101.0
    np.testing.assert_allclose(squares, tails.information * [[1.0, left]] * np.ones((4, 1)), rtol=1e-12)


# ---- averages ----


def sampled_averages(tails, freedom, size, repeats=300_000):
    """Curvature of the cost and variance of its slope per real number, over noise and estimated covariances."""
    rng = np.random.default_rng(11)
    channels, samples = size // 2, int(freedom // 2)
    noise = rng.standard_normal((2, repeats, channels)) / np.sqrt(2.0)
    noise = noise[0] + 1j * noise[1]
    sums = np.zeros((repeats, channels, channels), dtype=complex)
    for _ in range(samples):
        one = (rng.standard_normal((repeats, channels)) + 1j * rng.standard_normal((repeats, channels))) / np.sqrt(2.0)
        sums += one[:, :, None] * one[:, None].conj()
    inverse = np.linalg.inv(sums / (samples - channels))
    pulled = np.einsum("rij,rj->ri", inverse, noise)
    squares = 2.0 * np.einsum("ri,ri->r", noise.conj(), pulled).real
    level = 1.0 + squares * tails.bend[0]
    weight, change = tails.gain[0] / level, -tails.gain[0] * tails.bend[0] / level**2
    curvature = np.mean(weight * np.trace(inverse, axis1=1, axis2=2).real) / channels
    along = np.mean(2.0 * change * np.sum(np.abs(pulled) ** 2, axis=1)) / channels
    return curvature + along, np.mean(weight**2 * np.sum(np.abs(pulled) ** 2, axis=1)) / channels


@pytest.mark.parametrize("size", [2, 4])
@pytest.mark.parametrize("freedom", [12.0, 34.0])
@pytest.mark.parametrize("kind", ["estimated", "student"])
def test_curvature_is_the_variance_of_the_slope_and_both_are_the_information(size, freedom, kind):
    """By sampling complex Wishart matrices: what makes likelihood ratios chi-square."""
    given = np.array([freedom])
    tails = estimated_tails(given, size) if kind == "estimated" else student_tails(given, size, 4.0)
    curvature, variance = sampled_averages(tails, freedom, size)
    assert curvature == pytest.approx(tails.information[0], rel=0.01)
    assert variance == pytest.approx(tails.information[0], rel=0.02)


@pytest.mark.parametrize("size", [2, 4, 6, 8])
def test_efficiency_of_the_t_density_for_known_normal_noise(size):
    """``E[w + 2 w' d^2 / m]^2 / (E[w^2 d^2] / m)`` by integration over chi-square: above 0.9 at ``nu`` = 4."""
    share = (np.arange(100_000) + 0.5) / 100_000
    squares = scipy.stats.chi2.ppf(share, size)
    weight, change = 1.0 / (4.0 + squares), -1.0 / (4.0 + squares) ** 2
    expected = np.mean(weight + 2.0 * change * squares / size) ** 2 / (np.mean(weight**2 * squares) / size)
    found = student_tails(np.array([np.inf]), size, 4.0).information[0]
    assert found == pytest.approx(expected, rel=1e-4)
    assert found > 0.9


def test_information_of_an_estimated_covariance_by_hand():
    """12 real degrees of freedom, two outputs: 6 complex samples, ``(6 - 2 + 1) / (6 + 1)``."""
    assert estimated_tails(np.array([12.0]), 4).information[0] == pytest.approx(5.0 / 7.0)


# ---- weightings ----


def test_weightings_choose_their_tails():
    freedom = np.array([12.0, np.inf])
    assert MaximumLikelihood().tails(freedom, 4).bend == pytest.approx([1.0 / 8.0, 0.0])
    assert Unweighted().tails(freedom, 4).normal
    bend = StudentT(5.0).tails(freedom, 4).bend
    assert bend == pytest.approx([10.0 / 8.0 / 5.0, 1.0 / 5.0])


def test_a_t_density_is_never_lighter_than_the_covariance_allows():
    """3 degrees of freedom beyond the numbers of a line: the density of the covariance has 5."""
    few = StudentT(30.0).tails(np.array([7.0]), 4)
    assert few.bend == pytest.approx([1.0 / 3.0])
    assert few.information == pytest.approx(MaximumLikelihood().tails(np.array([7.0]), 4).information)
