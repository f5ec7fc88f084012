"""p-values of likelihood ratios are uniform where the smaller structure is the truth, and tiny where it is not."""

import numpy as np
import pytest
import scipy.stats

from shaftprint.catalogue import structure
from shaftprint.identify import Prior, Settings, Unweighted, identify, refit
from shaftprint.identify.comparison._likelihood_ratio import likelihood_ratio
from shaftprint.identify.comparison._nesting import Nesting, nesting
from shaftprint.models import Gain, Parameter, PIGovernor, RationalBlock, Structure

LAGGED = {"tau_n": 0.35, "K_p": 1.6, "K_i": 4.4, "t_d": 0.0, "omega_n": 10.0, "zeta": 0.6}
SETTINGS = Settings(starts=10)


def pair(response, small, large, settings=SETTINGS):
    fits = [identify(s, response, rng=np.random.default_rng(4), settings=settings) for s in (small, large)]
    return *fits, nesting(*fits, rng=np.random.default_rng(5))


def drawn(response, made_of, values, count, rng):
    """Responses of a truth with the covariance of a response, shape (count, outputs, lines)."""
    truth = made_of.response(made_of.vector(values), 2j * np.pi * response.frequency_hz)
    root = np.linalg.cholesky(response.covariance)
    noise = np.einsum("fab,kfb->kaf", root, rng.normal(size=(count, *response.covariance.shape[:2])))
    half = truth.shape[0]
    return truth + noise[:, :half] + 1j * noise[:, half:]


def statistics(small, large, nested, responses):
    costs = [refit(fit, responses, start=start).cost for fit, start in ((small, None), (large, nested.values))]
    return 2.0 * (costs[0] - costs[1])


def test_of_a_held_parameter_inside_its_bounds_they_are_uniform(make_response):
    """300 draws of CL4 with its delay held at the truth against the delay free: chi-square with one freedom."""
    truth = {**LAGGED, "t_d": 0.12}
    response = make_response("CL4", truth, noise=0.02, correlation=0.3, rng=np.random.default_rng(1))
    small, large, nested = pair(response, structure("CL4").held_at(t_d=0.12), structure("CL4"))
    responses = drawn(response, structure("CL4"), truth, 300, np.random.default_rng(7))
    p = [nested.p_value(d) for d in statistics(small, large, nested, responses)]
    assert scipy.stats.kstest(p, "uniform").pvalue > 0.01
    found = likelihood_ratio(small, large, nested, rng=np.random.default_rng(1))
    assert found.draws == 0
    assert found.p_value == pytest.approx(scipy.stats.chi2.sf(2.0 * (small.cost - large.cost), 1), rel=1e-6)


def test_of_a_delay_that_cannot_be_negative_half_are_one_and_half_uniform(make_response):
    """Self and Liang: half of all draws would have a negative delay, and stop at 0."""
    response = make_response("CL4", LAGGED, noise=0.02, correlation=0.3, rng=np.random.default_rng(1))
    small, large, nested = pair(response, structure("CL3"), structure("CL4"))
    responses = drawn(response, structure("CL4"), LAGGED, 400, np.random.default_rng(7))
    gained = statistics(small, large, nested, responses)
    p = np.array([nested.p_value(d) for d in gained])
    stopped = gained < 1e-6
    assert np.all(p[stopped] == 1.0)
    assert abs(stopped.mean() - 0.5) < 3.0 * 0.5 / np.sqrt(400)
    assert scipy.stats.kstest(2.0 * p[~stopped], "uniform").pvalue > 0.01


def peaked(upper=1.0):
    k_p, k_i = structure("OL2").parameters
    a = Parameter("a", "-", -5.0, 5.0, 0.0, "test")
    time = Parameter("T", "s", 0.05, upper, 0.1, "test")
    lag = RationalBlock(lambda a, time: ((a,), (time, 1.0)), (a, time))
    return Structure(name="PI+lag", title="", input="e", outputs={"M_s": PIGovernor(k_p, k_i) + lag})


GOVERNOR = {"K_p": 3.0, "K_i": 4.3}


@pytest.mark.slow
def test_where_a_parameter_means_nothing_they_come_from_draws_and_are_uniform(make_response):
    """The lag's time means nothing without its gain: chi-square with one or two freedoms would both be wrong."""
    p = []
    rng = np.random.default_rng(11)
    for _ in range(40):
        response = make_response("OL2", GOVERNOR, noise=0.05, rng=rng)
        small, large, nested = pair(response, structure("OL2"), peaked())
        found = likelihood_ratio(small, large, nested, rng=rng, draws=59)
        assert found.draws == 59
        assert "T" in found.reason
        p.append(found.p_value)
    assert scipy.stats.kstest(p, "uniform").pvalue > 0.01
    assert min(p) >= 1.0 / 60.0
    assert max(p) <= 1.0


def test_a_truth_that_needs_the_larger_structure_gives_tiny_ones(make_response):
    rng = np.random.default_rng(3)
    response = make_response("CL4", {**LAGGED, "t_d": 0.12}, noise=0.01, rng=rng)
    small, large, nested = pair(response, structure("CL3"), structure("CL4"))
    found = likelihood_ratio(small, large, nested, rng=rng)
    assert found.statistic == pytest.approx(2.0 * (small.cost - large.cost))
    assert scipy.stats.chi2.sf(found.statistic, 1) / 2.0 <= found.p_value < 1e-9


@pytest.mark.parametrize(
    "settings",
    [
        Settings(starts=10, weighting=Unweighted()),
        Settings(starts=10, priors={"t_d": Prior(0.05, 0.05), "tau_n": Prior(0.35, 0.02)}),
    ],
    ids=["unweighted", "prior"],
)
def test_where_the_law_of_maximum_likelihood_does_not_hold_draws_are_made(make_response, settings):
    rng = np.random.default_rng(3)
    response = make_response("CL4", {**LAGGED, "t_d": 0.12}, noise=0.01, rng=rng)
    of_others = {name: prior for name, prior in settings.priors.items() if name != "t_d"}
    own = Settings(starts=10, weighting=settings.weighting, priors=of_others)
    small = identify(structure("CL4").held_at(t_d=0.12), response, rng=rng, settings=own)
    large = identify(structure("CL4"), response, rng=rng, settings=settings)
    nested = nesting(small, large, rng=rng)
    found = likelihood_ratio(small, large, nested, rng=rng, draws=99)
    assert found.draws == 99
    assert found.p_value > 0.01
    wrong = identify(structure("CL4").held_at(t_d=0.05), response, rng=rng, settings=own)
    found = likelihood_ratio(wrong, large, nesting(wrong, large, rng=rng), rng=rng, draws=99)
    assert found.p_value <= 0.01 + 1e-12


@pytest.mark.parametrize(("at_bound", "weights"), [((), (0.0, 0.0, 1.0)), (("t",), (0.0, 0.5, 0.5))])
def test_law_of_two_parameters_more(at_bound, weights):
    law = Nesting(values=np.zeros(3), extra=2, at_bound=at_bound, meaningless=())
    for d in (0.5, 3.0, 20.0):
        assert law.p_value(d) == pytest.approx(weights[1] * scipy.stats.chi2.sf(d, 1) + weights[2] * np.exp(-d / 2.0))


def redundant(upper):
    """``b (K_p + K_i / s)``: a PI governor with a gain that does nothing which its own gains cannot do."""
    k_p, k_i = structure("OL2").parameters
    b = Parameter("b", "-", 0.5, upper, 1.0, "test")
    return Structure(name="PI+gain", title="", input="e", outputs={"M_s": PIGovernor(k_p, k_i) * Gain(b)})


def test_a_redundant_parameter_is_worth_nothing(make_response):
    """Both reach the same responses: no degree of freedom more, no gain, and nothing to be drawn."""
    response = make_response("OL2", GOVERNOR, noise=0.05, rng=np.random.default_rng(3))
    small, large, nested = pair(response, structure("OL2"), redundant(2.0))
    assert nested.extra == 0
    found = likelihood_ratio(small, large, nested, rng=np.random.default_rng(1))
    assert (found.extra, found.p_value, found.draws) == (0, 1.0, 0)


def test_a_redundant_parameter_that_widens_the_bounds_is_not_taken_for_a_law(make_response):
    """With K_i held below the truth of 4.3 the gain reaches it all the same: the bounds, not a parameter, are worth."""
    response = make_response("OL2", GOVERNOR, noise=0.02, rng=np.random.default_rng(3))
    small, large, nested = pair(response, *(s.free_between(K_i=(1.0, 4.0)) for s in (structure("OL2"), redundant(2.0))))
    assert nested.extra == 0
    found = likelihood_ratio(small, large, nested, rng=np.random.default_rng(1), draws=59)
    assert found.reason == "the data find no parameter more"
    assert found.p_value < 0.02
