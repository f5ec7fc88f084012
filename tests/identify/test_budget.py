"""Uncertainty budgets against numbers worked out by hand, refits and simulated tests."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import Prior, Settings, StudentT, Unweighted, budget, identify, identify_jointly, refit
from shaftprint.models import Combination, Gain, Parameter, Structure

GAUGE = {"tau_dn": 0.32, "tau_up": 1.016, "k_q": 2.0, "g": 0.0, "v": 1.0, "K_p": 5.7, "K_i": 4.27, "t_d": 0.07}
GAUGE |= {"t_sp": 0.05, "omega_n": 10.3, "zeta": 0.47, "c_set": 1.0, "t_gauge": 0.0}
PRIORS = {
    "g": Prior(0.0, 0.1),
    "tau_up": Prior(1.016, 0.05, {"TVC": 0.04, "gauge scale": -0.03}),
    "t_gauge": Prior(0.0, 0.002, {"telemetry latency": 0.002}),
}


def number(name, of):
    return Combination(name=name, unit="-", of=of, meaning="a number")


def gains(*outputs):
    """One gain ``k``, seen at every output."""
    gain = Gain(Parameter("k", "-", 0.0, 10.0, 1.0, "gain"))
    return Structure(name="GAIN", title="a gain", input="u", outputs=dict.fromkeys(outputs, gain))


def gauge_fit(make_response, *, noise=0.01, correlation=0.0, seed=8, **settings):
    rng = None if seed is None else np.random.default_rng(seed)
    response = make_response(structure("GAUGE-CLOSED"), GAUGE, noise=noise, correlation=correlation, rng=rng)
    chosen = Settings(starts=20, **{"priors": PRIORS} | settings)
    return identify(structure("GAUGE-CLOSED"), response, rng=np.random.default_rng(1), settings=chosen)


# ---- by hand ----


def test_a_gain_known_beforehand_and_measured_thirteen_times(make_response):
    """Precisions: 13 lines of 1 / 0.1^2 and a prior of 1 / 0.05^2, together 1700; 400 of them are the prior's."""
    prior = Prior(1.0, 0.05, {"first": 0.03, "second": -0.04})
    found = identify(
        gains("y"),
        make_response(gains("y"), {"k": 1.0}, noise=0.1),
        rng=np.random.default_rng(1),
        settings=Settings(priors={"k": prior}),
    )
    row = budget(found).row("k")
    assert row.std == pytest.approx(1700.0**-0.5)
    assert row.shares == pytest.approx(
        {"noise of y": 1300.0 / 1700.0, "first": 0.36 * 400.0 / 1700.0, "second": 0.64 * 400.0 / 1700.0}
    )


def test_two_outputs_whose_noise_is_not_correlated_share_by_their_precisions(make_response):
    """The same gain at two outputs, of 10 % and 5 % noise: precisions 100 and 400, shares 1/5 and 4/5."""
    both = gains("one", "two")
    response = make_response(both, {"k": 1.0}, noise=0.1)
    covariance = response.covariance * np.outer([1.0, 0.5, 1.0, 0.5], [1.0, 0.5, 1.0, 0.5])
    found = identify(both, replace(response, covariance=covariance), rng=np.random.default_rng(1))
    assert budget(found).row("k").shares == pytest.approx({"noise of one": 0.2, "noise of two": 0.8})


def test_noise_common_to_two_outputs_may_count_negative(make_response):
    """Variances 1 and 4 with the covariance 1.5: weights 2.5 / 2 and -0.5 / 2, variance 0.875.

    The first output has ``1.25 (1.25 * 1 - 0.25 * 1.5) = 1.09375``, the second ``-0.25 (1.25 * 1.5 - 0.25 * 4)``.
    """
    both = gains("one", "two")
    response = make_response(both, {"k": 5.0}, frequency_hz=np.array([1.0]), names=("only",))
    block = np.array([[1.0, 1.5], [1.5, 4.0]])
    covariance = np.kron(np.eye(2), block)[None]
    found = identify(both, replace(response, covariance=covariance), rng=np.random.default_rng(1))
    row = budget(found).row("k")
    assert row.std == pytest.approx(0.875**0.5)
    assert row.variances == pytest.approx({"noise of one": 1.09375, "noise of two": -0.21875})


def test_a_source_that_enters_twice_may_cancel(make_response):
    """``I = tau M``: the prior of ``tau`` falls by 2 % where ``M`` rises by 2 %; the test says nothing of ``tau``."""
    tau = Structure(
        name="TAU", title="tau", input="u", outputs={"y": Gain(Parameter("tau", "s", 0.0, 10.0, 1.0, "inertia time"))}
    )
    prior = Prior(1.0, 0.05, {"TVC": 0.046, "gauge scale": -((0.05**2 - 0.046**2) ** 0.5)})
    response = make_response(tau, {"tau": 1.0}, noise=1e4)
    found = identify(tau, response, rng=np.random.default_rng(1), settings=Settings(priors={"tau": prior}))
    inertia = number("I", lambda p: 50.0 * p["tau"])
    scale = 50.0 * (0.05**2 - 0.046**2) ** 0.5
    cancelled = budget(found, [inertia], direct={"I": {"gauge scale": scale}}).row("I")
    assert cancelled.std == pytest.approx(50.0 * 0.046, rel=1e-6)
    assert cancelled.variances["gauge scale"] == pytest.approx(0.0, abs=1e-9)
    added = budget(found, [inertia], direct={"I": {"gauge scale": -scale, "air": 3.0}})
    assert added.row("I").variances["gauge scale"] == pytest.approx(4.0 * scale**2, rel=1e-6)
    assert added.row("I").variances["air"] == pytest.approx(9.0)
    assert added.sources == ("noise of y", "TVC", "gauge scale", "air")


def test_what_moves_all_outputs_of_a_line_together_is_told_apart(make_response):
    """Two outputs of unit noise and a common error of 0.5 on both: weights 1/2, variance (1 + 1) / 4 + 0.25."""
    both = gains("one", "two")
    response = make_response(both, {"k": 5.0}, frequency_hz=np.array([1.0]), names=("only",))
    common = np.full((2, 1, 1), 0.5 + 0.0j)
    covariance = np.eye(4)[None] + np.outer([0.5, 0.5, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0])
    told = replace(response, covariance=covariance, common={"set-point calibration": common})
    row = budget(identify(both, told, rng=np.random.default_rng(1))).row("k")
    assert row.variances == pytest.approx({"noise of one": 0.25, "noise of two": 0.25, "set-point calibration": 0.25})


# ---- laws ----


@pytest.mark.parametrize(
    "weighting", [None, Unweighted(), StudentT(degrees_of_freedom=4.0)], ids=["covariance", "unweighted", "student"]
)
def test_parts_add_up_to_the_covariance(make_response, weighting):
    settings = {} if weighting is None else {"weighting": weighting}
    found = gauge_fit(make_response, correlation=0.5, **settings)
    rows = budget(found).rows
    stated = [*found.parameters, *found.combinations]
    assert [row.name for row in rows] == [estimate.name for estimate in stated]
    np.testing.assert_allclose([row.std for row in rows], [estimate.std for estimate in stated], rtol=1e-6)
    np.testing.assert_allclose([sum(row.shares.values()) for row in rows], 1.0, rtol=1e-12)


def test_parts_of_a_joint_fit_add_up_too(make_response):
    core, governor = structure("OL1"), structure("OL5")
    pairs = [
        (model, make_response(model, None, noise=0.02, rng=np.random.default_rng(seed)))
        for model, seed in ((core, 1), (core, 2), (governor, 3))
    ]
    found = identify_jointly(pairs, rng=np.random.default_rng(1))
    stated = budget(found)
    assert stated.sources == ("noise of n", "noise of M_s")
    np.testing.assert_allclose([row.std for row in stated.rows], np.sqrt(np.diag(found.covariance)), rtol=1e-9)
    assert stated.row("tau_n").shares == pytest.approx({"noise of n": 1.0, "noise of M_s": 0.0})
    assert stated.row("K_p").shares == pytest.approx({"noise of n": 0.0, "noise of M_s": 1.0})


def test_what_is_not_known_has_no_budget(make_response):
    truth = {"tau_n": 0.4, "K_p": 4.0, "K_i": 5.0, "g": -0.5, "v": 1.0}
    response = make_response(structure("BENCHMARK"), truth, noise=0.01, rng=np.random.default_rng(4))
    stated = budget(identify(structure("BENCHMARK"), response, rng=np.random.default_rng(0)))
    assert stated.row("v").variances == {}
    assert stated.row("v").shares == {}
    assert stated.row("v").std == np.inf
    assert stated.row("v K_p").std < 0.05 * stated.row("v K_p").value
    with pytest.raises(IdentificationError, match="budget: there is no speed; it has K_p, K_i"):
        stated.row("speed")


def test_a_regularisation_is_no_source(make_response):
    found = gauge_fit(make_response, regularisation={"zeta": Prior(0.5, 0.1)})
    stated = budget(found)
    assert stated.sources == (
        "noise of n",
        "noise of M_s",
        "prior of g",
        "TVC",
        "gauge scale",
        "telemetry latency",
    )
    np.testing.assert_allclose(
        [row.std for row in stated.rows[:12]], [estimate.std for estimate in found.parameters], rtol=1e-9
    )


# ---- refits and simulation ----


def test_estimates_follow_the_mean_of_a_prior_as_stated(make_response):
    """Move the mean of a prior by a hundredth of its source and fit again."""
    found = gauge_fit(make_response, seed=None)
    stated = budget(found)
    share = 0.01
    for place, (parameter, source) in enumerate(
        (("g", "prior of g"), ("tau_up", "gauge scale"), ("t_gauge", "telemetry latency"))
    ):
        part = PRIORS[parameter].sources.get(source, PRIORS[parameter].std)
        means = np.tile(found.objective.prior_rows[:, 1], (2, 1))
        means[:, place] += share * part * np.array([-1.0, 1.0])
        data = np.repeat(found.response.response[None, :, 0], 2, axis=0)
        low, high = refit(found, data, prior_means=means).values
        for i, estimate in enumerate(found.parameters):
            moved = (high[i] - low[i]) / (2.0 * share)
            expected = stated.row(estimate.name).variances[source]
            assert moved**2 == pytest.approx(expected, abs=1e-4 * estimate.std**2, rel=0.02)


def test_spread_from_the_noise_of_one_output_is_its_part(make_response):
    """600 tests in which only the torque, then only the speed is noisy: a deviation is known to 3 % then."""
    found = gauge_fit(make_response, noise=0.002)
    stated = budget(found)
    true = found.structure.response(found.values, 2j * np.pi * found.response.frequency_hz)
    std = np.sqrt(np.diagonal(found.response.covariance, axis1=1, axis2=2).T)[:2]
    rng = np.random.default_rng(3)
    means = np.tile(found.values[[found.structure.names.index(name) for name in PRIORS]], (600, 1))
    for output, place in (("n", 0), ("M_s", 1)):
        drawn = np.repeat(true[None], 600, axis=0)
        noise = rng.normal(size=(2, 600, std.shape[1])) * std[place]
        drawn[:, place] += noise[0] + 1j * noise[1]
        spread = np.std(refit(found, drawn, prior_means=means).values, axis=0)
        for i, estimate in enumerate(found.parameters):
            part = stated.row(estimate.name).variances[f"noise of {output}"]
            assert spread[i] == pytest.approx(part**0.5, rel=0.12, abs=0.02 * estimate.std)
