"""Several responses in one fit: parameters of one name are one parameter, everything else follows."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import (
    MaximumLikelihood,
    Prior,
    Settings,
    Unweighted,
    identify,
    identify_jointly,
    profile_intervals,
    refit,
)
from shaftprint.identify.likelihood._build_objective import build_joint_objective
from shaftprint.models import Constant, Delay, Gain, Parameter, PIGovernor, Sensitivity, Shaft, Structure
from shaftprint.spectra import FrequencyResponse


def rng():
    return np.random.default_rng(1)


def lines_of(response, chosen):
    """Part of a response by the places of its lines."""
    return replace(
        response,
        frequency_hz=response.frequency_hz[chosen],
        response=response.response[..., chosen],
        covariance=response.covariance[chosen],
        lines=tuple(np.array(response.lines)[chosen]),
        degrees_of_freedom=response.degrees_of_freedom[chosen],
        used=response.used[chosen],
        load=response.load[chosen],
    )


@pytest.fixture
def noisy(make_response):
    return make_response("CL4", noise=0.02, correlation=0.3, rng=np.random.default_rng(11))


# ---- what it must agree with ----


def test_the_same_response_twice_has_half_the_covariance(noisy):
    one = identify(structure("CL4"), noisy, rng=rng())
    two = identify_jointly([(structure("CL4"), noisy), (structure("CL4"), noisy)], rng=rng())
    np.testing.assert_allclose(two.values, one.values, rtol=1e-6)
    np.testing.assert_allclose(two.covariance, one.covariance / 2.0, rtol=1e-4)
    assert two.cost == pytest.approx(2.0 * one.cost, rel=1e-9)
    assert (two.data_count, two.degrees_of_freedom) == (104, 98)
    assert two.chi_square == pytest.approx(2.0 * one.chi_square, rel=1e-9)
    assert [t.experiment for t in two.line_tests] == [0] * 13 + [1] * 13


@pytest.mark.parametrize("weighting", [MaximumLikelihood(), Unweighted({"n": 3.0})], ids=["covariance", "unweighted"])
def test_a_response_in_two_parts_is_the_whole(noisy, weighting):
    settings = Settings(weighting=weighting, priors={"t_d": Prior(0.12, 0.01)})
    whole = identify(structure("CL4"), noisy, rng=rng(), settings=settings)
    parts = [(structure("CL4"), lines_of(noisy, np.arange(13) % 3 == k)) for k in range(3)]
    joint = identify_jointly(parts, rng=rng(), settings=settings)
    np.testing.assert_allclose(joint.values, whole.values, rtol=1e-6)
    np.testing.assert_allclose(joint.covariance, whole.covariance, rtol=1e-4)
    assert joint.cost == pytest.approx(whole.cost, rel=1e-9)
    assert joint.degrees_of_freedom == whole.degrees_of_freedom == 52 + 1 - 6


def test_two_linear_responses_are_generalised_least_squares(make_response):
    """OL2 is linear in both parameters; two responses of different noise, by the normal equations."""
    shipped = structure("OL2")
    pairs = [
        (shipped, make_response("OL2", noise=noise, correlation=c, rng=np.random.default_rng(seed)))
        for noise, c, seed in ((0.05, 0.6, 3), (0.1, -0.4, 4))
    ]
    normal, right = np.zeros((2, 2)), np.zeros(2)
    for _, response in pairs:
        for line, omega in enumerate(2.0 * np.pi * response.frequency_hz):
            design = np.array([[1.0, 0.0], [0.0, -1.0 / omega]])
            inverse = np.linalg.inv(response.covariance[line])
            value = response.response[0, 0, line]
            normal += design.T @ inverse @ design
            right += design.T @ inverse @ [value.real, value.imag]
    found = identify_jointly(pairs, rng=rng())
    np.testing.assert_allclose(found.values, np.linalg.solve(normal, right), rtol=1e-8)
    np.testing.assert_allclose(found.covariance, np.linalg.inv(normal), rtol=1e-9)


# ---- parameters that only some responses have ----


def governor(k_p="K_p", *, delay=None):
    """PI governor with a gain of its own name, and perhaps a delay."""
    expression = PIGovernor(
        Parameter(k_p, "-", 0.0, 10.0, 2.0, "gain"), Parameter("K_i", "1/s", 0.0, 10.0, 4.0, "integral gain")
    )
    if delay:
        expression = expression * Delay(Parameter(delay, "s", 0.0, 0.3, 0.1, "delay"))
    return Structure(name=f"PI {k_p}", title="", input="e", outputs={"M_s": expression})


def test_parameters_of_other_names_stay_apart_and_those_of_one_name_are_one(make_response):
    """Two working points: each its own ``K_p``, one its delay, ``K_i`` in common."""
    one, two = governor("K_p1"), governor("K_p2", delay="t_2")
    truths = [{"K_p1": 1.5, "K_i": 4.2}, {"K_p2": 2.5, "K_i": 4.2, "t_2": 0.13}]
    pairs = [(s, make_response(s, t, noise=0.01)) for s, t in zip((one, two), truths, strict=True)]
    found = identify_jointly(pairs, rng=rng())
    assert [p.name for p in found.parameters] == ["K_p1", "K_i", "K_p2", "t_2"]
    assert found.values == pytest.approx([1.5, 4.2, 2.5, 0.13], rel=1e-6)
    assert found.value("K_p2") == pytest.approx(2.5, rel=1e-6)
    assert found.structure_values(1) == pytest.approx([2.5, 4.2, 0.13], rel=1e-6)
    assert [part.structure.name for part in found.experiments] == ["PI K_p1", "PI K_p2"]
    assert found.fit_percent == found.experiments[0].fit_percent
    assert found.experiments[1].fit_percent["M_s"] == pytest.approx(100.0, abs=1e-4)
    # K_p1 hangs on the first response alone, but for the help that K_i gives
    alone = identify(one, pairs[0][1], rng=rng())
    assert found.parameters[0].std <= alone.parameters[0].std * (1.0 + 1e-9)
    assert found.parameters[1].std < alone.parameters[1].std


def test_jacobian_of_the_union_equals_central_differences(make_response):
    one, two = governor("K_p1"), governor("K_p2", delay="t_2")
    truths = [{"K_p1": 1.5, "K_i": 4.2}, {"K_p2": 2.5, "K_i": 4.2, "t_2": 0.13}]
    pairs = [(s, make_response(s, t, noise=0.05, rng=rng())) for s, t in zip((two, one), truths[::-1], strict=True)]
    objective = build_joint_objective(
        pairs, weighting=MaximumLikelihood(), priors={"K_p1": Prior(1.0, 0.3)}, regularisation={}
    )
    theta = np.array([2.0, 4.0, 0.1, 1.0])
    _, jacobian = objective.residuals(theta[None])
    assert jacobian.shape == (1, 4, 53)
    for i in range(4):
        pair = np.array([theta, theta])
        pair[:, i] += [1e-6, -1e-6]
        residuals, _ = objective.residuals(pair)
        np.testing.assert_allclose(jacobian[0, i], (residuals[0] - residuals[1]) / 2e-6, rtol=1e-5, atol=1e-5)


def test_two_responses_find_what_neither_finds_alone(make_response):
    """``v K_p`` from one, ``K_p`` from the other: only together ``v``."""
    v = Parameter("v", "-", 0.2, 5.0, 1.0, "demand over rack")
    k_p = Parameter("K_p", "-", 0.2, 10.0, 2.0, "gain")
    product = Structure(name="product", title="", input="e", outputs={"M_s": Gain(v) * Gain(k_p)})
    factor = Structure(name="factor", title="", input="e", outputs={"M_s": Gain(k_p)})
    pairs = [
        (product, make_response(product, {"v": 1.5, "K_p": 3.0}, noise=0.01)),
        (factor, make_response(factor, {"K_p": 3.0}, noise=0.01)),
    ]
    alone = identify(product, pairs[0][1], rng=rng())
    assert all(np.isinf(p.std) for p in alone.parameters)
    found = identify_jointly(pairs, rng=rng())
    assert found.values == pytest.approx([1.5, 3.0], rel=1e-6)
    # 13 lines of 1 % each: K_p to 0.01 / sqrt(13) of itself, v to sqrt(2) times that
    assert found.parameters[1].std == pytest.approx(3.0 * 0.01 / 13**0.5, rel=1e-6)
    assert found.parameters[0].std == pytest.approx(1.5 * 0.01 * (2.0 / 13.0) ** 0.5, rel=1e-6)


def test_another_working_point_is_the_structure_scaled(make_response):
    """At a speed 0.8 times the first one ``tau_n``, ``K_p`` and ``K_i`` are 1.25 times as large."""
    first = structure("CL1")
    second = first.scaled(tau_n=1.25, K_p=1.25, K_i=1.25)
    truth = {"tau_n": 0.39, "K_p": 1.2, "K_i": 4.0}
    moved = {name: 1.25 * value for name, value in truth.items()}
    pairs = [(first, make_response(first, truth)), (second, make_response(structure("CL1"), moved))]
    found = identify_jointly(pairs, rng=rng())
    assert found.values == pytest.approx(first.vector(truth), rel=1e-6)


def test_tied_parameters_and_combinations_of_all_structures_are_reported(make_response):
    integral_time = Parameter("T_i", "s", 0.05, 2.0, 0.4, "integral time")
    tied = governor().tied("K_i", lambda K_p, T_i: K_p / T_i, integral_time)
    truth = {"K_p": 2.0, "T_i": 0.5}
    pairs = [(tied, make_response(tied, truth, noise=noise)) for noise in (0.01, 0.02)]
    found = identify_jointly(pairs, rng=rng())
    assert [p.name for p in found.parameters] == ["K_p", "T_i"]
    assert found.value("K_i") == pytest.approx(4.0, rel=1e-6)
    assert {c.name: c.value for c in found.combinations} == {"K_i": pytest.approx(4.0, rel=1e-6)}
    assert set(profile_intervals(found)) == {"K_p", "T_i", "K_i"}


def test_pick_ups_of_each_response_are_held_in_its_own_structure(make_response):
    core = structure("GAUGE-CORE").held_at(k_q=2.0, t_gauge=0.0)
    pairs = []
    for period in (0.05, 0.08):
        truth = {"tau_dn": 0.236, "T_average": period, "t_pickup": period}
        pairs.append((core, make_response(core, truth, averaging_s=period, pick_up_delay_s=period)))
    found = identify_jointly(pairs, rng=rng())
    assert found.value("tau_dn") == pytest.approx(0.236, rel=1e-8)
    places = [core.names.index(name) for name in ("T_average", "t_pickup")]
    assert found.structure_values(0)[places] == pytest.approx([0.05, 0.05])
    assert found.structure_values(1)[places] == pytest.approx([0.08, 0.08])


# ---- channels ----


def test_a_response_of_more_outputs_gives_those_of_the_structure(noisy):
    """A structure of the torque alone takes the torque's rows of response and covariance."""
    torque = structure("CL4").of_outputs("M_s")
    found = identify(torque, noisy, rng=rng())
    assert found.response.outputs == ("M_s",)
    assert found.data_count == 26
    np.testing.assert_array_equal(found.response.response[0], noisy.response[1])
    np.testing.assert_array_equal(found.response.covariance, noisy.covariance[:, [1, 3]][:, :, [1, 3]])


def test_outputs_in_another_order_are_put_in_that_of_the_structure(noisy):
    turned = noisy.of_outputs("M_s", "n")
    one, two = (identify(structure("CL4"), r, rng=rng()) for r in (noisy, turned))
    np.testing.assert_allclose(two.values, one.values, rtol=1e-9)


def test_several_inputs_are_fitted_in_c_order():
    """Two inputs, two outputs, each channel a constant of its own: each is its own weighted mean."""
    names = ("a", "b", "c", "d")
    gains = [Gain(Parameter(name, "-", -9.0, 9.0, 1.0, "gain")) for name in names]
    plant = Structure(
        name="plant",
        title="",
        inputs=("u", "v"),
        outputs={"x": {"u": gains[0], "v": gains[1]}, "y": {"u": gains[2], "v": gains[3]}},
    )
    truth = np.array([1.0, -2.0, 3.0, 4.0])
    draw = rng()
    noise = 0.1 * (draw.standard_normal((4, 5)) + 1j * draw.standard_normal((4, 5)))
    response = FrequencyResponse(
        frequency_hz=np.arange(1.0, 6.0),
        response=(truth[:, None] + noise).reshape(2, 2, 5),
        covariance=np.broadcast_to(0.01 * np.eye(8), (5, 8, 8)),
        inputs=("u", "v"),
        outputs=("x", "y"),
    )
    found = identify(plant, response, rng=rng())
    assert [found.value(n) for n in names] == pytest.approx(truth + noise.real.mean(axis=1), rel=1e-8)
    assert found.parameters[0].std == pytest.approx(0.1 / 5**0.5, rel=1e-8)
    assert list(found.fit_percent) == ["x from u", "x from v", "y from u", "y from v"]
    weighted = identify(plant, response, rng=rng(), settings=Settings(weighting=Unweighted({"y": 4.0})))
    assert weighted.cost == pytest.approx(
        0.5 * np.sum((noise.imag**2 + (noise.real - noise.real.mean(axis=1)[:, None]) ** 2) * [[1], [1], [4], [4]]),
        rel=1e-9,
    )


def test_output_weights_may_name_an_output_of_any_response(noisy):
    pairs = [(structure("CL4"), noisy), (structure("CL4").of_outputs("n"), noisy)]
    found = identify_jointly(pairs, rng=rng(), settings=Settings(weighting=Unweighted({"M_s": 2.0})))
    assert found.data_count == 78
    with pytest.raises(
        IdentificationError, match=r"output weight M = 2\.0: expected a positive weight of one of n, M_s\."
    ):
        identify_jointly(pairs, rng=rng(), settings=Settings(weighting=Unweighted({"M": 2.0})))


# ---- stability ----


def test_a_model_that_is_unstable_in_one_experiment_does_not_win(make_response):
    """Ten times the gain at the second working point: the loop of the optimum is unstable there."""
    tau = Parameter("tau_n", "s", 0.1, 1.0, 0.4, "inertia time")
    slope = Parameter("k_q", "-", 1.0, 3.0, 2.0, "slope", held=True)
    engine = PIGovernor(
        Parameter("K_p", "-", 0.0, 10.0, 1.0, "gain"), Parameter("K_i", "1/s", 0.0, 10.0, 1.0, "gain")
    ) * Delay(Parameter("t_d", "s", 0.05, 0.5, 0.2, "delay"))
    core = Shaft((tau,), slope)
    torque = engine * Sensitivity(engine * core)
    own = Structure(name="loop", title="", input="n_set", outputs={"n": core * torque, "M_s": torque})
    truth = {"tau_n": 0.4, "K_p": 1.0, "K_i": 1.0, "t_d": 0.2}
    loud = own.scaled(K_p=10.0, K_i=10.0)
    first, second = make_response(own, truth), make_response(loud, truth, noise=0.5)
    with pytest.raises(IdentificationError, match="structure loop: none of 50 starts reached a stable model"):
        identify_jointly([(own, first), (loud, second)], rng=rng())
    assert identify_jointly([(own, first)], rng=rng()).values == pytest.approx(own.vector(truth), rel=1e-6)
    free = identify_jointly([(own, first), (loud, second)], rng=rng(), settings=Settings(stability="ignored"))
    assert free.values == pytest.approx(own.vector(truth), rel=1e-3)


# ---- refit ----


def test_repeats_of_all_experiments_are_fitted_together(make_response):
    one, two = governor("K_p1"), governor("K_p2", delay="t_2")
    truths = [{"K_p1": 1.5, "K_i": 4.2}, {"K_p2": 2.5, "K_i": 4.2, "t_2": 0.13}]
    pairs = [
        (s, make_response(s, t, noise=0.01, rng=np.random.default_rng(k)))
        for k, (s, t) in enumerate(zip((one, two), truths, strict=True))
    ]
    found = identify_jointly(pairs, rng=rng())
    own = [part.response.response[:, 0] for part in found.experiments]
    again = refit(found, [np.stack([r, 1.001 * r]) for r in own])
    assert again.names == ("K_p1", "K_i", "K_p2", "t_2")
    assert again.values[0] == pytest.approx(found.values, rel=1e-5)
    assert again.cost[0] == pytest.approx(found.cost, rel=1e-7)
    louder = [
        (part.structure, replace(part.response, response=1.001 * part.response.response)) for part in found.experiments
    ]
    assert again.values[1] == pytest.approx(identify_jointly(louder, rng=rng()).values, rel=1e-4)
    with pytest.raises(IdentificationError, match="responses: expected 2 arrays, one an experiment, found 1"):
        refit(found, [own[0][None]])
    with pytest.raises(IdentificationError, match="same number of repeats of every experiment, found 1, 2"):
        refit(found, [own[0][None], np.stack([own[1]] * 2)])


# ---- refusals ----


def changed(of, **fields):
    """The governor with one parameter described otherwise."""
    plain = governor()
    parameters = tuple(replace(p, **fields) if p.name == of else p for p in plain.parameters)
    return replace(plain, name="other", parameters=parameters)


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"upper": 5.0}, r"free from 0\.0 to 10\.0 - in structure PI K_p and free from 0\.0 to 5\.0 - in other"),
        ({"unit": "Nm"}, r"free from 0\.0 to 10\.0 - in structure PI K_p and free from 0\.0 to 10\.0 Nm in other"),
        ({"held": True}, r"free from 0\.0 to 10\.0 - in structure PI K_p and held at 2\.0 - in other"),
    ],
)
def test_one_name_for_two_things_is_refused(make_response, fields, words):
    response = make_response(governor(), {"K_p": 1.0, "K_i": 4.0})
    with pytest.raises(IdentificationError, match=f"joint fit: parameter K_p is {words}; describe it alike, or give"):
        identify_jointly([(governor(), response), (changed("K_p", **fields), response)], rng=rng())


def test_values_held_apart_are_refused(make_response):
    response = make_response(governor(), {"K_p": 1.0, "K_i": 4.0})
    pairs = [(governor().held_at(K_p=value), response) for value in (1.0, 1.1)]
    with pytest.raises(IdentificationError, match=r"held at 1\.0 - in structure PI K_p and held at 1\.1 - in PI K_p"):
        identify_jointly(pairs, rng=rng())


def test_a_parameter_tied_in_one_and_free_in_the_other_is_refused(make_response):
    response = make_response(governor(), {"K_p": 1.0, "K_i": 4.0})
    tied = governor().tied("K_i", lambda K_p: 4.0 * K_p)
    with pytest.raises(IdentificationError, match="K_i is tied to others in structure PI K_p and a parameter of"):
        identify_jointly([(governor(), response), (tied, response)], rng=rng())


def test_nothing_to_fit_is_refused():
    with pytest.raises(IdentificationError, match="expected at least one pair of structure and response, found none"):
        identify_jointly([], rng=rng())


def test_a_response_none_of_whose_lines_can_be_used_is_refused_with_its_lines(noisy):
    silent = replace(
        noisy,
        lines=tuple(f"M2/{k}" for k in range(1, 14)),
        used=np.zeros(13, dtype=bool),
        remarks={"M2/1": "set point does not move"},
    )
    with pytest.raises(IdentificationError, match=r"none among M2/1 to M2/13; .* M2/1 set point does not move"):
        identify_jointly([(structure("CL4"), noisy), (structure("CL4"), silent)], rng=rng())


def test_structures_of_the_same_parameters_may_be_composed_otherwise(make_response):
    truth = {"K_p": 1.0, "K_i": 4.0}
    double = Structure(name="double", title="", input="e", outputs={"M_s": Constant(2.0) * governor().paths[0]})
    pairs = [(s, make_response(s, truth)) for s in (double, governor())]
    assert identify_jointly(pairs, rng=rng()).values == pytest.approx([1.0, 4.0], rel=1e-6)
