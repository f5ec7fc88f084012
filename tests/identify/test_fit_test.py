"""Whether a structure explains the data: sums, moments and single lines, against numbers by hand and simulation."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.stats

from shaftprint.catalogue import structure
from shaftprint.identify import Prior, Settings, Unweighted, identify
from shaftprint.identify.fit._fit_test import FitTest


def rng():
    return np.random.default_rng(1)


@pytest.fixture
def noisy(make_response):
    return make_response("CL4", noise=0.02, correlation=0.3, rng=np.random.default_rng(11))


# ---- the sum ----


def test_sum_over_known_covariances_by_hand(noisy):
    """``(y - f)^T C^-1 (y - f)`` line by line and a squared prior row; the p-value is scipy's."""
    settings = Settings(priors={"t_d": Prior(0.13, 0.005)})
    found = identify(structure("CL4"), noisy, rng=rng(), settings=settings)
    model = found.model(noisy.frequency_hz)
    expected = [((found.value("t_d") - 0.13) / 0.005) ** 2]
    for line in range(13):
        gap = noisy.response[:, 0, line] - model[:, line]
        parts = np.concatenate([gap.real, gap.imag])
        expected.append(parts @ np.linalg.solve(noisy.covariance[line], parts))
    assert found.chi_square == pytest.approx(sum(expected), rel=1e-9)
    assert found.chi_square == pytest.approx(2.0 * found.cost, rel=1e-9)
    assert found.degrees_of_freedom == 52 + 1 - 6
    assert found.p_value == pytest.approx(scipy.stats.chi2.sf(sum(expected), 47), rel=1e-9)
    assert [t.distance for t in found.line_tests] == pytest.approx(expected[1:], rel=1e-9)
    assert [t.name for t in found.line_tests] == list(noisy.lines)
    assert [t.p_value for t in found.line_tests] == pytest.approx(scipy.stats.chi2.sf(expected[1:], 4), rel=1e-9)
    assert found.whitened.shape == (13, 4)
    assert np.sum(found.whitened**2, axis=1) == pytest.approx(expected[1:], rel=1e-9)


def test_distance_over_an_estimated_covariance_is_hotellings(noisy):
    """12 degrees of freedom, 6 complex samples of 2 outputs: ``d^2 = 4 (4 / 5) F(4, 10)``."""
    estimated = replace(noisy, degrees_of_freedom=np.full(13, 12.0))
    found = identify(structure("CL4"), estimated, rng=rng())
    distances = np.array([t.distance for t in found.line_tests])
    expected = scipy.stats.f.sf(distances * 5.0 / 4.0 / 4.0, 4, 10)
    assert [t.p_value for t in found.line_tests] == pytest.approx(expected, rel=1e-9)
    assert found.chi_square == pytest.approx(np.sum(10.0 * np.log(1.0 + distances / 8.0)), rel=1e-9)
    assert found.chi_square == pytest.approx(2.0 * found.cost, rel=1e-9)


@pytest.mark.slow
def test_moments_of_the_sum_are_those_of_simulated_distances(noisy):
    """Wishart estimates of 6 and of 15 complex samples, noise beside them, no fit: mean and variance of the shares."""
    draw = np.random.default_rng(5)
    repeats = 200_000
    for samples in (6, 15):
        noise = draw.standard_normal((samples + 1, repeats, 2)) + 1j * draw.standard_normal((samples + 1, repeats, 2))
        estimate = np.einsum("sri,srj->rij", noise[:-1], noise[:-1].conj()) / (samples - 2)
        pulled = np.linalg.solve(estimate, noise[-1][:, :, None])[:, :, 0]
        squares = 2.0 * np.einsum("ri,ri->r", noise[-1].conj(), pulled).real
        shares = (2.0 * samples - 2.0) * np.log1p(squares / (2.0 * samples - 4.0))
        one = identify(
            structure("CL4"), replace(noisy, degrees_of_freedom=np.full(13, 2.0 * samples)), rng=rng()
        ).fit_test
        assert one.mean + 6.0 == pytest.approx(13.0 * shares.mean(), rel=0.005)
        assert one.variance + 12.0 == pytest.approx(13.0 * shares.var(), rel=0.02)


def test_regularisation_counts_neither_in_the_sum_nor_in_its_degrees_of_freedom(noisy):
    settings = Settings(regularisation={"t_d": Prior(0.13, 0.005)})
    found = identify(structure("CL4"), noisy, rng=rng(), settings=settings)
    assert found.degrees_of_freedom == 46
    assert found.chi_square == pytest.approx(np.sum(found.whitened**2), rel=1e-9)
    assert found.chi_square < 2.0 * found.cost


def test_a_parameter_that_a_bound_stopped_is_not_counted(make_response):
    """Data of a governor with ``K_p`` -0.3: the bound 0 stops it, one parameter is fitted."""
    response = make_response("OL2", {"K_p": -0.3, "K_i": 4.0})
    found = identify(structure("OL2"), response, rng=rng())
    assert found.degrees_of_freedom == 26 - 1


# ---- what it tells ----


def test_a_wrong_structure_is_rejected_and_the_right_one_is_not(make_response):
    """Data of a governor with lag; without it the fast lines lie off."""
    response = make_response(
        "OL5", {"K_p": 1.8, "K_i": 4.3, "t_d": 0.12, "omega_n": 9.0, "zeta": 1.2}, noise=0.02, rng=rng()
    )
    right, wrong = (identify(structure(name), response, rng=rng()) for name in ("OL5", "OL2"))
    assert right.p_value > 0.05
    assert wrong.p_value < 1e-10
    worst = max(wrong.line_tests, key=lambda t: t.distance)
    assert worst.name in ("S11", "S12", "S13")


def test_no_p_value_without_weights_or_without_anything_left_to_test(make_response, noisy):
    plain = identify(structure("CL4"), noisy, rng=rng(), settings=Settings(weighting=Unweighted()))
    assert plain.p_value is None
    assert plain.chi_square == pytest.approx(np.sum(plain.whitened**2))
    exact = identify(structure("OL2"), make_response("OL2"), rng=rng(), lines=["S3"])
    assert exact.degrees_of_freedom == 0
    assert exact.p_value is None


def test_the_noun_can_be_asked_for_other_sums():
    """5 % point of chi-square with ten degrees of freedom, from a printed table."""
    test = FitTest(chi_square=18.307, degrees_of_freedom=10, mean=10.0, variance=20.0, lines=())
    assert test.p_value == pytest.approx(0.05, rel=1e-3)
    assert replace(test, mean=0.0).p_value is None
