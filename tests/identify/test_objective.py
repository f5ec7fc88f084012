"""The cost by hand, its derivatives by differences, and every refusal."""

import numpy as np
import pytest
from tests.identify.one_objective import build_objective

from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import MaximumLikelihood, Prior, Settings, Unweighted, identify

NOTHING = {"priors": {}, "regularisation": {}}


def cost_of(objective, theta):
    residuals, _ = objective.residuals(np.asarray(theta)[None, :])
    return 0.5 * np.sum(residuals**2)


@pytest.mark.parametrize("correlation", [0.0, 0.6])
def test_weighted_cost_is_half_the_chi_square(make_response, correlation):
    """``sum (y - f)^T C^-1 (y - f) / 2`` line by line, and ``((theta - mean) / std)^2 / 2`` for a prior."""
    shipped = structure("CL4")
    response = make_response("CL4", noise=0.05, correlation=correlation, rng=np.random.default_rng(4))
    objective = build_objective(
        shipped,
        response,
        weighting=MaximumLikelihood(),
        priors={"K_p": Prior(2.0, 0.5)},
        regularisation={"t_d": Prior(0.0, 0.1)},
    )
    values = dict.fromkeys(shipped.names, 0.0) | {
        "tau_n": 0.4, "K_p": 1.5, "K_i": 4.0, "t_d": 0.1, "omega_n": 9.0, "zeta": 0.6, "k_q": 2.0,
    }  # fmt: skip
    model = shipped.response(shipped.vector(values), 2j * np.pi * response.frequency_hz)
    expected = ((1.5 - 2.0) / 0.5) ** 2 / 2.0 + (0.1 / 0.1) ** 2 / 2.0
    for line in range(13):
        gap = response.response[:, 0, line] - model[:, line]
        parts = np.concatenate([gap.real, gap.imag])
        expected += parts @ np.linalg.solve(response.covariance[line], parts) / 2.0
    theta = [values[p.name] for p in shipped.free]
    assert cost_of(objective, theta) == pytest.approx(expected, rel=1e-12)


def test_unweighted_cost_with_output_weights_by_hand(make_response):
    """Weights multiply squares: 4 on speed, 1 on torque."""
    shipped = structure("CL4")
    response = make_response("CL4", noise=0.05, rng=np.random.default_rng(4))
    objective = build_objective(shipped, response, weighting=Unweighted({"n": 4.0}), **NOTHING)
    theta = np.array([p.value for p in shipped.free])
    model = shipped.response(objective.complete(theta), 2j * np.pi * response.frequency_hz)
    squares = np.sum(np.abs(response.response[:, 0] - model) ** 2, axis=1)
    assert cost_of(objective, theta) == pytest.approx(0.5 * (4.0 * squares[0] + squares[1]), rel=1e-12)


@pytest.mark.parametrize("weighting", [MaximumLikelihood(), Unweighted({"M_s": 0.3})])
def test_jacobian_equals_central_differences(make_response, weighting):
    shipped = structure("GAUGE-CLOSED").free_between(v=(0.5, 2.0))
    response = make_response(shipped, {}, noise=0.05, correlation=0.4, load=np.linspace(0.98, 1.03, 13))
    objective = build_objective(
        shipped, response, weighting=weighting, priors={"g": Prior(0.0, 0.1)}, regularisation={"v": Prior(1.0, 0.5)}
    )
    theta = np.array([p.value for p in shipped.free])
    _, jacobian = objective.residuals(theta[None, :])
    for i, width in enumerate(1e-6 * (objective.upper - objective.lower)):
        pair = np.array([theta, theta])
        pair[:, i] += [width, -width]
        residuals, _ = objective.residuals(pair)
        slope = (residuals[0] - residuals[1]) / (2.0 * width)
        np.testing.assert_allclose(jacobian[0, i], slope, rtol=1e-5, atol=1e-5 * np.abs(slope).max() + 1e-12)


def test_load_of_each_line_acts_on_the_propeller_slope(make_response):
    """Data made line by line with ``k_q`` times the load come back with the one ``k_q``."""
    shipped = structure("GAUGE-CORE").held_at(t_gauge=0.0)
    load = np.linspace(0.95, 1.05, 13)
    response = make_response(shipped, {"tau_dn": 0.32, "k_q": 2.1}, load=load)
    omega = 2.0 * np.pi * response.frequency_hz
    moved = 1.0 / (0.32j * omega + 2.1 * load)
    objective = build_objective(shipped, response, weighting=MaximumLikelihood(), **NOTHING)
    model = objective.structure.response(
        objective.complete(np.array([0.32, 2.1])), objective.experiments[0].s, factors=objective.experiments[0].factors
    )
    np.testing.assert_allclose(model[0], moved, rtol=1e-14)


# ---- refusals ----


def build(shipped, response, **changes):
    return build_objective(shipped, response, **({"weighting": MaximumLikelihood(), **NOTHING} | changes))


@pytest.mark.parametrize("which", ["priors", "regularisation"])
def test_knowledge_of_a_foreign_parameter_is_refused(make_response, which):
    response = make_response("OL3")
    with pytest.raises(
        IdentificationError,
        match=r"prior of omega_n: structure OL3 has the free parameters K_p, K_i, t_d\.",
    ):
        build(structure("OL3"), response, **{which: {"omega_n": Prior(10.0, 1.0)}})


def test_knowledge_of_a_held_parameter_is_refused(make_response):
    with pytest.raises(IdentificationError, match=r"prior of k_q: structure OL1 has the free parameters tau_n\."):
        build(structure("OL1"), make_response("OL1"), priors={"k_q": Prior(2.0, 0.1)})


@pytest.mark.parametrize("std", [0.0, -1.0, float("nan")])
def test_a_prior_needs_a_positive_deviation(std):
    with pytest.raises(IdentificationError, match=r"prior 2\.0 \+/- .*: expected a positive standard deviation; hold"):
        Prior(2.0, std)


@pytest.mark.parametrize("weights", [{"n_e": 1.0}, {"n": 0.0}, {"n": -2.0}])
def test_output_weights_must_name_outputs_and_be_positive(make_response, weights):
    name, weight = next(iter(weights.items()))
    with pytest.raises(
        IdentificationError, match=rf"output weight {name} = {weight}: expected a positive weight of one of n, M_s\."
    ):
        build(structure("CL1"), make_response("CL1"), weighting=Unweighted(weights))


def test_a_structure_of_other_channels_is_refused(make_response):
    with pytest.raises(
        IdentificationError,
        match=r"structure OL2 goes from e to M_s, the response from n_set to n, M_s: choose .* open_loop\(\)\.",
    ):
        build(structure("OL2"), make_response("CL1"))


def test_the_order_of_outputs_must_be_the_structures(make_response):
    """INITIAL also gives the integrated error, which no response of speed and torque has."""
    with pytest.raises(IdentificationError, match=r"to n, E_n, M_s, the response from n_set to n, M_s"):
        build(structure("INITIAL"), make_response("CL1"))


def test_unknown_lines_are_refused(make_response):
    with pytest.raises(IdentificationError, match=r"lines S14, T1 are not in the response; it has S1, S2, .*, S13\."):
        identify(structure("OL1"), make_response("OL1"), rng=np.random.default_rng(1), lines=["S1", "S14", "T1"])


def test_fewer_data_than_parameters_are_refused(make_response):
    """Two lines of one output are four numbers, OL5 has five parameters."""
    with pytest.raises(
        IdentificationError,
        match=r"structure OL5 has 5 free parameters, the response 4 usable numbers \(2 lines\): measure more",
    ):
        identify(structure("OL5"), make_response("OL5"), rng=np.random.default_rng(1), lines=["S1", "S9"])


def test_a_structure_without_free_parameters_is_refused(make_response):
    with pytest.raises(IdentificationError, match=r"structure OL1 has no free parameter: free one"):
        build(structure("OL1").held_at(tau_n=0.39), make_response("OL1"))


@pytest.mark.parametrize(
    "fields", [{"starts": 0}, {"max_iterations": 0}, {"tolerance": 0.0}, {"tolerance": float("nan")}]
)
def test_settings_must_be_positive(fields):
    with pytest.raises(IdentificationError, match=r"search settings: expected positive starts, iterations and tol"):
        Settings(**fields)
