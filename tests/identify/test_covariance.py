"""Stated covariances against hand-derived ones and against the scatter of simulated tests."""

import numpy as np
import pytest
from tests.identify.one_objective import build_objective

from shaftprint.catalogue import structure
from shaftprint.identify import MaximumLikelihood, Prior, Settings, Unweighted, identify
from shaftprint.identify.fit._covariance import estimate_covariance
from shaftprint.identify.search._levenberg_marquardt import descend
from shaftprint.models import Constant, Gain, Parameter, Structure

REPEATS = 400


def fitted_repeats(response, objective, truth, seed):
    """Fit many tests that differ in their noise only, each from the truth; return estimates and costs."""
    rng = np.random.default_rng(seed)
    (experiment,) = objective.experiments
    lines, size = experiment.data.shape
    noise = np.einsum(
        "fab,kfb->kfa", np.linalg.cholesky(experiment.covariance), rng.normal(size=(REPEATS, lines, size))
    )
    moved = np.einsum("fab,kfb->kaf", experiment.weights, noise).reshape(REPEATS, lines * size)
    shift = np.pad(moved, ((0, 0), (0, objective.prior_rows.shape[0])))

    def residuals(theta, starts):
        r, jacobian = objective.residuals(theta)
        return r + shift[starts], jacobian

    start = np.tile([truth[p.name] for p in objective.structure.free], (REPEATS, 1))
    found = descend(residuals, start, objective.lower, objective.upper, tolerance=1e-9, max_iterations=200)
    assert found.converged.mean() > 0.99
    return found.theta, found.cost


def problem(make_response, name, weighting, truths, priors=None, **noise):
    shipped = structure(name)
    response = make_response(name, **noise)
    priors = priors or {}
    objective = build_objective(shipped, response, weighting=weighting, priors=priors, regularisation={})
    truth = np.array([truths[name][p.name] for p in shipped.free])
    return response, objective, truth


# ---- by hand ----


def test_fisher_information_of_the_core_by_hand(make_response):
    """``dH/dtau = -s / (tau s + 2)^2``; each part of a line has the deviation ``0.02 |H|``."""
    response = make_response("OL1", noise=0.02)
    found = identify(structure("OL1"), response, rng=np.random.default_rng(1))
    s = 2j * np.pi * response.frequency_hz
    # relative slope |s / (tau s + 2)|, squared, over 0.02^2, summed over the two parts of each line as |.|^2
    information = np.sum(np.abs(s / (0.3897 * s + 2.0)) ** 2) / 0.02**2
    assert found.parameters[0].std == pytest.approx(information**-0.5, rel=1e-6)


def linear_problem(response):
    """OL2 is linear: ``[Re; Im]`` = X [K_p; K_i]; return X and the covariance of the data, lines in one row."""
    omega = 2.0 * np.pi * response.frequency_hz
    columns = np.stack([np.stack([np.ones(13), np.zeros(13)]), np.stack([np.zeros(13), -1.0 / omega])])
    design = columns.transpose(2, 1, 0).reshape(26, 2)
    covariance = np.zeros((26, 26))
    for i in range(13):
        covariance[2 * i : 2 * i + 2, 2 * i : 2 * i + 2] = response.covariance[i]
    return design, covariance


@pytest.mark.parametrize("correlation", [0.0, 0.6, -0.9])
def test_weighted_fit_of_a_linear_structure_is_generalised_least_squares(make_response, correlation):
    response = make_response("OL2", noise=0.05, correlation=correlation, rng=np.random.default_rng(3))
    design, covariance = linear_problem(response)
    data = np.stack([response.response[0, 0].real, response.response[0, 0].imag], axis=1).ravel()
    inverse = np.linalg.inv(covariance)
    expected = np.linalg.inv(design.T @ inverse @ design)
    found = identify(structure("OL2"), response, rng=np.random.default_rng(1))
    np.testing.assert_allclose(found.covariance, expected, rtol=1e-9)
    np.testing.assert_allclose(found.values, expected @ design.T @ inverse @ data, rtol=1e-8)


@pytest.mark.parametrize("correlation", [0.0, 0.6])
def test_unweighted_fit_of_a_linear_structure_has_the_sandwich(make_response, correlation):
    """``(X^T X)^-1 X^T C X (X^T X)^-1``: the noise as it is, not as the weights would have it."""
    response = make_response("OL2", noise=0.05, correlation=correlation, rng=np.random.default_rng(3))
    design, covariance = linear_problem(response)
    plain = np.linalg.inv(design.T @ design)
    expected = plain @ design.T @ covariance @ design @ plain
    found = identify(
        structure("OL2"), response, rng=np.random.default_rng(1), settings=Settings(weighting=Unweighted())
    )
    np.testing.assert_allclose(found.covariance, expected, rtol=1e-9)


def test_a_prior_counts_and_a_regularisation_only_pulls(make_response):
    """Both move the estimate alike; ``M = X^T C^-1 X + R``: covariance ``M^-1`` or ``M^-1 (M - R) M^-1``."""
    response = make_response("OL2", noise=0.05, rng=np.random.default_rng(3))
    design, covariance = linear_problem(response)
    data = np.stack([response.response[0, 0].real, response.response[0, 0].imag], axis=1).ravel()
    information = design.T @ np.linalg.inv(covariance) @ design
    row = np.diag([1.0 / 0.02**2, 0.0])
    total = np.linalg.inv(information + row)
    expected = total @ (design.T @ np.linalg.inv(covariance) @ data + np.array([1.2 / 0.02**2, 0.0]))
    pull = {"K_p": Prior(1.2, 0.02)}
    known = identify(structure("OL2"), response, rng=np.random.default_rng(1), settings=Settings(priors=pull))
    pulled = identify(structure("OL2"), response, rng=np.random.default_rng(1), settings=Settings(regularisation=pull))
    np.testing.assert_allclose(known.values, expected, rtol=1e-8)
    np.testing.assert_allclose(pulled.values, expected, rtol=1e-8)
    np.testing.assert_allclose(known.covariance, total, rtol=1e-8)
    np.testing.assert_allclose(pulled.covariance, total @ information @ total, rtol=1e-8)
    assert (known.degrees_of_freedom, pulled.degrees_of_freedom) == (25, 24)
    assert known.data_count == pulled.data_count == 26


# ---- by simulation ----

CASES = {
    "OL1": ("OL1", 0.02, 0.0),
    "OL5": ("OL5", 0.005, 0.0),
    "OL5, parts correlated": ("OL5", 0.005, 0.7),
    "CL4, speed and torque correlated": ("CL4", 0.01, 0.5),
}


@pytest.mark.parametrize("weighting", [MaximumLikelihood(), Unweighted()], ids=["covariance", "unweighted"])
@pytest.mark.parametrize("case", CASES)
def test_stated_covariance_is_the_scatter_over_repeats(make_response, truths, case, weighting):
    """400 tests: a deviation is known to 3.5 % then, so 12 % is more than three of its own."""
    name, noise, correlation = CASES[case]
    response, objective, truth = problem(make_response, name, weighting, truths, noise=noise, correlation=correlation)
    theta, _ = fitted_repeats(response, objective, truths[name], seed=17)
    stated = estimate_covariance(objective, truth)
    scatter = np.atleast_2d(np.cov(theta.T))
    np.testing.assert_allclose(np.sqrt(np.diag(scatter)), np.sqrt(np.diag(stated)), rtol=0.12)
    std = np.sqrt(np.diag(stated))
    assert np.max(np.abs((scatter - stated) / np.outer(std, std))) < 0.25
    # no bias beyond what 400 repeats can hide, plus a tenth of a deviation for curvature
    assert np.all(np.abs(theta.mean(axis=0) - truth) < (3.5 / REPEATS**0.5 + 0.1) * std)


@pytest.mark.parametrize("case", CASES)
def test_intervals_cover_the_truth_in_95_of_100_tests(make_response, truths, case):
    """Each test states its own covariance at its own estimate."""
    name, noise, correlation = CASES[case]
    response, objective, truth = problem(
        make_response, name, MaximumLikelihood(), truths, noise=noise, correlation=correlation
    )
    theta, _ = fitted_repeats(response, objective, truths[name], seed=23)
    std = np.array([np.sqrt(np.diag(estimate_covariance(objective, row))) for row in theta])
    covered = np.mean(np.abs(theta - truth) < 1.96 * std, axis=0)
    assert np.all(covered > 0.92)
    assert np.all(covered < 0.98)


@pytest.mark.parametrize("case", CASES)
def test_twice_the_cost_is_a_chi_square(make_response, truths, case):
    """Mean and variance of chi-square: its degrees of freedom and twice them."""
    name, noise, correlation = CASES[case]
    response, objective, _ = problem(
        make_response, name, MaximumLikelihood(), truths, noise=noise, correlation=correlation
    )
    _, cost = fitted_repeats(response, objective, truths[name], seed=29)
    freedom = objective.data_count - len(objective.free)
    assert np.mean(2.0 * cost) == pytest.approx(freedom, abs=3.5 * (2.0 * freedom / REPEATS) ** 0.5)
    assert np.var(2.0 * cost) == pytest.approx(2.0 * freedom, rel=0.3)


def test_no_weights_do_better_than_the_full_covariance(make_response, truths):
    """Gauss and Markov: the covariance of any other weighting exceeds it by a positive matrix."""
    _, best, truth = problem(make_response, "CL4", MaximumLikelihood(), truths, noise=0.01, correlation=0.8)
    for weighting in (Unweighted(), Unweighted({"n": 4.0})):
        _, other, _ = problem(make_response, "CL4", weighting, truths, noise=0.01, correlation=0.8)
        excess = estimate_covariance(other, truth) - estimate_covariance(best, truth)
        scale = np.sqrt(np.diag(estimate_covariance(best, truth)))
        assert np.all(np.linalg.eigvalsh(excess / np.outer(scale, scale)) > -1e-9)
        assert np.all(np.diag(excess) > 0.0)


# ---- what the data do not tell ----


def test_a_product_is_known_although_its_factors_are_not(make_response):
    """Benchmark (eq. 2.34): ``v``, ``K_p``, ``K_i`` are infinite, ``v K_p`` as known as with ``v`` held."""
    shipped = structure("BENCHMARK")
    truth = {"tau_n": 0.4, "K_p": 4.0, "K_i": 5.0, "g": -0.5, "v": 1.0}
    response = make_response(shipped, truth, noise=0.01, rng=np.random.default_rng(1))
    loose = identify(shipped, response, rng=np.random.default_rng(0))
    held = identify(shipped.held_at(v=1.0), response, rng=np.random.default_rng(0))
    std = {p.name: p.std for p in loose.parameters}
    assert {name for name, value in std.items() if np.isinf(value)} == {"K_p", "K_i", "v"}
    for free, fixed in zip(loose.combinations, held.combinations, strict=True):
        assert free.value == pytest.approx(fixed.value, rel=1e-4)
        assert free.std == pytest.approx(fixed.std, rel=1e-3)
    for name in ("tau_n", "g"):
        assert std[name] == pytest.approx({p.name: p.std for p in held.parameters}[name], rel=1e-3)
    places = [p.name for p in loose.parameters]
    correlation = loose.correlation
    assert np.all(np.isnan(correlation[places.index("v")]))
    assert correlation[places.index("g"), places.index("g")] == pytest.approx(1.0)


def test_a_prior_makes_the_factors_known(make_response):
    shipped = structure("BENCHMARK")
    truth = {"tau_n": 0.4, "K_p": 4.0, "K_i": 5.0, "g": -0.5, "v": 1.0}
    response = make_response(shipped, truth, noise=0.01, rng=np.random.default_rng(1))
    settings = Settings(priors={"v": Prior(1.0, 0.05)})
    found = identify(shipped, response, rng=np.random.default_rng(0), settings=settings)
    std = {p.name: p.std for p in found.parameters}
    product = next(c for c in found.combinations if c.name == "v K_p")
    assert std["v"] == pytest.approx(0.05, rel=1e-6)
    assert (std["K_p"] / found.value("K_p")) ** 2 == pytest.approx(
        0.05**2 / found.value("v") ** 2 + (product.std / product.value) ** 2, rel=1e-3
    )


def test_a_parameter_without_influence_is_unknown_and_leaves_the_others_alone(make_response):
    k, idle = (Parameter(name, "-", 0.0, 10.0, 1.0, "test") for name in ("k", "idle"))
    own = Structure(name="OWN", title="", input="u", outputs={"y": Gain(k) + Constant(0.0) * Gain(idle)})
    response = make_response(own, {"k": 3.0}, noise=0.02, rng=np.random.default_rng(5))
    found = identify(own, response, rng=np.random.default_rng(1), settings=Settings(starts=5))
    std = {p.name: p.std for p in found.parameters}
    assert np.isinf(std["idle"])
    # thirteen real parts of deviation 0.06 each
    assert std["k"] == pytest.approx(0.06 / 13**0.5, rel=1e-9)
    assert found.derived("k + idle", "-", lambda p: p["k"] + p["idle"]).std == np.inf
    assert found.derived("2 k", "-", lambda p: 2.0 * p["k"]).std == pytest.approx(0.12 / 13**0.5, rel=1e-6)
