"""The parametric bootstrap against analytic covariances, profiles and hand-derived numbers."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import Prior, Settings, Unweighted, bootstrap, identify, identify_jointly, profile_intervals
from shaftprint.identify.likelihood._wishart import estimated_shapes
from shaftprint.models import Combination, Gain, Parameter, Structure

GAUGE = {"tau_dn": 0.32, "tau_up": 1.016, "k_q": 2.0, "g": 0.0, "v": 1.0, "K_p": 5.7, "K_i": 4.27, "t_d": 0.07}
GAUGE |= {"t_sp": 0.05, "omega_n": 10.3, "zeta": 0.47, "c_set": 1.0, "t_gauge": 0.0}


def gain(upper=10.0):
    block = Gain(Parameter("k", "-", 0.0, upper, 1.0, "gain"))
    return Structure(name="GAIN", title="a gain", input="u", outputs={"y": block})


def fitted(make_response, **settings):
    """A gain of 1 at 13 lines of 10 % noise: a precision of 1300."""
    response = make_response(gain(), {"k": 1.0}, noise=0.1)
    return identify(gain(), response, rng=np.random.default_rng(1), settings=Settings(**settings))


@pytest.mark.parametrize("weighting", [None, Unweighted()], ids=["covariance", "unweighted"])
def test_of_a_linear_structure_is_the_covariance(make_response, weighting):
    """4000 repeats: a standard deviation is known to 1.1 %."""
    settings = Settings() if weighting is None else Settings(weighting=weighting)
    response = make_response("OL2", noise=0.05, correlation=0.5, rng=np.random.default_rng(2))
    found = identify(structure("OL2"), response, rng=np.random.default_rng(1), settings=settings)
    repeats = bootstrap(found, count=4000, rng=np.random.default_rng(7))
    assert repeats.names == ("K_p", "K_i")
    assert repeats.failed_share == 0.0
    np.testing.assert_allclose(np.cov(repeats.values.T), found.covariance, rtol=0.12)
    for parameter in found.parameters:
        spread = repeats.estimates[parameter.name]
        assert (spread.name, spread.unit, spread.value) == (parameter.name, parameter.unit, parameter.value)
        assert spread.std == pytest.approx(parameter.std, rel=0.045)
        assert abs(repeats.bias[parameter.name]) < 4.0 * parameter.std / 4000**0.5
        # an end at 2.5 % of 4000 is known to 0.042 standard deviations
        assert spread.interval_95 == pytest.approx(parameter.limits_95, abs=0.15 * parameter.std)
        assert repeats.basic_95(parameter.name) == pytest.approx(parameter.limits_95, abs=0.15 * parameter.std)


def test_means_of_priors_are_drawn_and_those_of_a_regularisation_are_not(make_response):
    """Precisions: 1300 of the data, 400 of the other row. Drawn or not: ``1700^-1/2`` or ``1300^1/2 / 1700``."""
    row = {"k": Prior(1.0, 0.05)}
    for settings, expected in (({"priors": row}, 1700.0**-0.5), ({"regularisation": row}, 1300.0**0.5 / 1700.0)):
        repeats = bootstrap(fitted(make_response, **settings), count=3000, rng=np.random.default_rng(5))
        assert repeats.estimates["k"].std == pytest.approx(expected, rel=0.05)


def test_intervals_of_a_growing_number_are_not_even(make_response):
    """``exp(10 k)`` of a normal ``k``: a log-normal, reflected in the basic interval."""
    growing = Combination(name="growing", unit="-", of=lambda p: np.exp(10.0 * p["k"]), meaning="grows")
    repeats = bootstrap(fitted(make_response), [growing], count=4000, rng=np.random.default_rng(5))
    spread = repeats.estimates["growing"]
    share, middle = 10.0 * 1300.0**-0.5, np.exp(10.0)
    low, high = middle * np.exp(-1.96 * share), middle * np.exp(1.96 * share)
    assert spread.interval_95 == pytest.approx((low, high), rel=0.05)
    assert repeats.basic_95("growing") == pytest.approx((2.0 * middle - high, 2.0 * middle - low), abs=0.05 * high)
    assert repeats.bias["growing"] == pytest.approx(middle * (np.exp(0.5 * share**2) - 1.0), rel=0.35)


def test_at_a_bound_half_of_the_repeats_stay_there(make_response):
    response = make_response(gain(), {"k": 1.0}, noise=0.1)
    found = identify(gain(upper=1.0), response, rng=np.random.default_rng(1))
    repeats = bootstrap(found, count=2000, rng=np.random.default_rng(5))
    assert np.mean(repeats.values == 1.0) == pytest.approx(0.5, abs=0.04)
    assert repeats.estimates["k"].interval_95[1] == 1.0


@pytest.mark.parametrize(("name", "noise", "truth"), [("OL5", 0.05, None), ("GAUGE-CLOSED", 0.002, GAUGE)])
def test_spread_agrees_with_the_profile(make_response, name, noise, truth):
    model = structure(name) if truth else name
    priors = {"g": Prior(0.0, 0.1), "tau_up": Prior(1.016, 0.05)} if truth else {}
    response = make_response(model, truth, noise=noise, rng=np.random.default_rng(5))
    found = identify(structure(name), response, rng=np.random.default_rng(1), settings=Settings(priors=priors))
    intervals = profile_intervals(found)
    repeats = bootstrap(found, count=2000, rng=np.random.default_rng(3))
    assert repeats.failed_share < 0.01
    for key, interval in intervals.items():
        if interval.lower_open or interval.upper_open:
            continue
        low, high = repeats.estimates[key].interval_95
        assert (high - low) / (interval.upper - interval.lower) == pytest.approx(1.0, abs=0.15)


def test_of_a_joint_fit_draws_every_response(make_response):
    pairs = [(gain(), make_response(gain(), {"k": 1.0}, noise=noise)) for noise in (0.1, 0.05)]
    found = identify_jointly(pairs, rng=np.random.default_rng(1))
    spread = bootstrap(found, count=3000, rng=np.random.default_rng(5)).estimates["k"]
    assert spread.std == pytest.approx((1300.0 + 5200.0) ** -0.5, rel=0.05)


def test_lines_that_are_not_fitted_are_not_drawn(make_response):
    response = make_response(gain(), {"k": 1.0}, noise=0.1, used=np.arange(13) < 4)
    found = identify(gain(), response, rng=np.random.default_rng(1))
    spread = bootstrap(found, count=3000, rng=np.random.default_rng(5)).estimates["k"]
    assert spread.std == pytest.approx(400.0**-0.5, rel=0.05)


def test_a_number_that_is_infinite_in_a_repeat_is_left_out(make_response):
    """The reciprocal of a gain that some repeats put at its bound 0."""
    reciprocal = Combination(name="1 / k", unit="-", of=lambda p: 1.0 / p["k"], meaning="reciprocal")
    response = make_response(gain(), {"k": 1.0}, noise=3.0)
    found = identify(gain(), response, rng=np.random.default_rng(1))
    estimates = bootstrap(found, [reciprocal], count=200, rng=np.random.default_rng(5)).estimates
    assert set(estimates) == {"k"}


def test_estimated_covariances_scatter_as_those_of_complex_samples_do():
    """Sample covariances of complex normal pairs, straight from their definition, and drawn."""
    rng = np.random.default_rng(8)
    samples, count = 6, 20_000
    pairs = (rng.standard_normal((count, samples, 2)) + 1j * rng.standard_normal((count, samples, 2))) * 0.5**0.5
    expected = np.einsum("ksi,ksj->kij", pairs, pairs.conj()) / samples
    found = estimated_shapes(np.array([2.0 * samples, np.inf]), 2, count, rng)
    np.testing.assert_array_equal(found[:, 1], np.broadcast_to(np.eye(4), (count, 4, 4)))
    drawn = found[:, 0]
    np.testing.assert_allclose(drawn[:, :2, :2], drawn[:, 2:, 2:])
    np.testing.assert_allclose(drawn[:, :2, 2:], -drawn[:, 2:, :2])
    np.testing.assert_allclose(drawn.mean(axis=0), np.eye(4), atol=0.02)
    for theirs, ours in (
        (expected[:, 0, 0].real, drawn[:, 0, 0]),
        (expected[:, 1, 1].real, drawn[:, 1, 1]),
        (expected[:, 1, 0].real, drawn[:, 1, 0]),
        (expected[:, 1, 0].imag, drawn[:, 3, 0]),
        (np.linalg.det(expected).real, np.linalg.det(drawn) ** 0.5),
    ):
        assert np.std(ours) == pytest.approx(np.std(theirs), rel=0.05)
        assert np.mean(ours) == pytest.approx(np.mean(theirs), abs=0.02)


def test_few_samples_behind_the_covariance_widen_the_spread(make_response):
    response = make_response(gain(), {"k": 1.0}, noise=0.1)
    few = replace(response, degrees_of_freedom=np.full(13, 8.0))
    spreads = [
        bootstrap(identify(gain(), data, rng=np.random.default_rng(1)), count=2000, rng=np.random.default_rng(5))
        .estimates["k"]
        .std
        for data in (response, few)
    ]
    # the noise itself is 6 / 8 of the stated variance, and its estimate adds some of it again
    assert spreads[1] > (6.0 / 8.0) ** 0.5 * 1.05 * spreads[0]


def test_same_seed_same_repeats(make_response):
    found = fitted(make_response)
    once, twice = (bootstrap(found, count=5, rng=np.random.default_rng(4)).values for _ in range(2))
    np.testing.assert_array_equal(once, twice)


def test_refusals(make_response):
    found = fitted(make_response)
    with pytest.raises(IdentificationError, match="bootstrap: expected 2 repeats or more, found 1"):
        bootstrap(found, count=1, rng=np.random.default_rng(1))
    hasty = replace(found, settings=replace(found.settings, max_iterations=1))
    with pytest.raises(IdentificationError, match="bootstrap of GAIN: expected two fits or more that settle, found 0"):
        bootstrap(hasty, count=20, rng=np.random.default_rng(1))
