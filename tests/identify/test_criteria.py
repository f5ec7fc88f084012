"""Information criteria: hand-computed numbers, laws, and how often they find the true structure."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.identify import Prior, Settings, StudentT, Unweighted, identify
from shaftprint.identify.comparison._criteria import criteria_of


def fitted(make_response, name, wanted, *, seed=1, noise=0.02, **settings):
    rng = np.random.default_rng(seed)
    response = make_response(name, noise=noise, rng=rng)
    return identify(structure(wanted), response, rng=rng, settings=Settings(**settings))


def test_criteria_of_a_likelihood_fit_written_out(make_response):
    """13 lines of one output: 26 data; OL3 has three free parameters."""
    found = fitted(make_response, "OL3", "OL3")
    square = found.chi_square
    criteria = criteria_of(found)
    assert (criteria.data, criteria.parameters) == (26, pytest.approx(3.0, abs=1e-9))
    assert criteria.deviance == pytest.approx(square, rel=1e-12)
    assert criteria.aic == pytest.approx(square + 6.0)
    assert criteria.bic == pytest.approx(square + 3.0 * 3.258096538021482)
    assert criteria.aicc == pytest.approx(square + 6.0 + 24.0 / 22.0)
    assert criteria.fpe == pytest.approx(square / 26.0 * 29.0 / 23.0)


def test_without_weights_the_deviance_is_that_of_an_unknown_common_variance(make_response):
    found = fitted(make_response, "OL3", "OL3", weighting=Unweighted())
    criteria = criteria_of(found)
    assert criteria.deviance == pytest.approx(26.0 * np.log(2.0 * found.cost / 26.0))
    assert criteria.fpe == pytest.approx(2.0 * found.cost / 26.0 * 29.0 / 23.0)


def test_differences_without_weights_do_not_depend_on_the_unit_of_the_outputs(make_response):
    rng = np.random.default_rng(3)
    response = make_response("OL3", noise=0.02, rng=rng)
    larger = replace(response, response=10.0 * response.response, covariance=100.0 * response.covariance)
    gap = []
    for data, factor in ((response, 1.0), (larger, 10.0)):
        bounds = {"K_p": (0.0, 10.0 * factor), "K_i": (0.0, 10.0 * factor)}
        settings = Settings(weighting=Unweighted())
        fits = [
            identify(structure(name).free_between(**bounds), data, rng=np.random.default_rng(1), settings=settings)
            for name in ("OL2", "OL3")
        ]
        gap.append(criteria_of(fits[0]).bic - criteria_of(fits[1]).bic)
    assert gap[0] == pytest.approx(gap[1], rel=1e-6)


def test_a_robust_fit_has_the_deviance_of_its_own_density(make_response):
    found = fitted(make_response, "OL3", "OL3", weighting=StudentT())
    assert criteria_of(found).deviance == pytest.approx(2.0 * found.cost)


def test_a_parameter_known_beforehand_counts_as_far_as_the_data_had_to_find_it(make_response):
    """A prior as sharp as the data leaves half a parameter, a very sharp one none."""
    free = fitted(make_response, "OL1", "OL1")
    std = free.parameters[0].std
    for share, left in ((1.0, 0.5), (1e-4, 0.0), (1e4, 1.0)):
        prior = Prior(free.values[0], share * std)
        found = fitted(make_response, "OL1", "OL1", priors={"tau_n": prior})
        assert criteria_of(found).parameters == pytest.approx(left, abs=1e-3)


def test_criteria_that_too_few_data_cannot_give_are_not_numbers(make_response):
    response = make_response("OL5", noise=0.02, rng=np.random.default_rng(2))
    found = identify(structure("OL5"), response, rng=np.random.default_rng(2), lines=["S9", "S10", "S11"])
    criteria = criteria_of(found)
    assert np.isnan(criteria.aicc)
    assert np.isfinite(criteria.bic)
    assert np.isfinite(criteria.fpe)
    found = identify(structure("CL1"), make_response("CL1"), rng=np.random.default_rng(2), lines=["S9"])
    assert np.isfinite(criteria_of(found).fpe)
    found = identify(structure("OL4").held_at(zeta=0.88, K_i=4.3), response, rng=np.random.default_rng(2), lines=["S9"])
    assert np.isnan(criteria_of(found).fpe)


@pytest.mark.long
@pytest.mark.parametrize(
    ("truth", "others"),
    [("CL3", ("CL1", "CL4")), ("CL4", ("CL1", "CL3")), ("OL3", ("OL2", "OL4", "OL5")), ("OL5", ("OL2", "OL3", "OL4"))],
)
def test_bic_finds_the_true_structure_in_95_of_100_draws(make_response, truth, others):
    """A parameter too many wins where a chi-square of one freedom exceeds ``ln 52``, 4.7 %; half that at a bound."""
    values = {"CL3": {"tau_n": 0.329, "K_p": 1.6, "K_i": 4.4, "omega_n": 9.8, "zeta": 0.5}}.get(truth)
    settings = Settings(starts=6, stability="ignored")
    right = 0
    for seed in range(100):
        rng = np.random.default_rng(1000 + seed)
        response = make_response(truth, values, noise=0.05, correlation=0.3, rng=rng)
        found = {
            name: criteria_of(identify(structure(name), response, rng=rng, settings=settings)).bic
            for name in (truth, *others)
        }
        right += min(found, key=found.__getitem__) == truth
    assert right >= 95
