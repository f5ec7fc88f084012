"""Stability kept during the search: against a brute-force search over the border of stability."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import Draw, Settings, identify, identify_jointly
from shaftprint.identify.search._levenberg_marquardt import Descent, descend
from shaftprint.identify.search._stability_border import border_minimum, stable_models
from shaftprint.models import Delay, Parameter, PIGovernor, Sensitivity, Shaft, Structure, is_stable

DURING = Settings(stability="during")
UNSTABLE = {"tau_n": 0.3897, "K_p": 3.4363, "K_i": 4.2639, "t_d": 0.4022}


def delayed_loop(k_p=(0.0, 10.0)):
    """OL1 and OL3 of the thesis in one loop, which they make unstable: PI governor, delay, shaft."""
    fields = {"tau_n": (0.0, 5.0), "K_p": k_p, "K_i": (0.0, 10.0), "t_d": (0.0, 0.5)}
    tau, p, i, t = (Parameter(n, "-", *bounds, sum(bounds) / 2.0, "test") for n, bounds in fields.items())
    slope = Parameter("k_q", "-", 1.0, 3.0, 2.0, "test", held=True)
    engine = PIGovernor(p, i) * Delay(t)
    core = Shaft((tau,), slope)
    torque = engine * Sensitivity(engine * core)
    return Structure(name="OL1+OL3", title="", input="n_set", outputs={"n": core * torque, "M_s": torque})


def cost(response, tau, k_p, k_i, delay):
    """Half the chi-square by hand, for many parameter sets; noise of 5 % in every part."""
    s = 2j * np.pi * response.frequency_hz
    tau, k_p, k_i, delay = (np.ravel(x)[:, None] for x in np.broadcast_arrays(tau, k_p, k_i, delay))
    engine = (k_p + k_i / s) * np.exp(-s * delay)
    core = 1.0 / (tau * s + 2.0)
    torque = engine / (1.0 + engine * core)
    total = 0.0
    for model, measured in zip((core * torque, torque), response.response[:, 0], strict=True):
        total = total + 0.5 * np.sum(np.abs((model - measured) / (0.05 * np.abs(measured))) ** 2, axis=1)
    return total


def best_on_the_border(response):
    """Lowest cost where ``1 + L(j omega) = 0``: for each frequency, inertia time and delay the gains follow.

    ``K_p - j K_i / omega = -(2 + j omega tau) exp(j omega t_d)``. A grid that closes in on its best point.
    """
    lower, upper = np.array([1.0, 0.01, 0.3]), np.array([15.0, 2.0, 0.5])
    middle, width, best = 0.5 * (lower + upper), upper - lower, np.inf
    for _ in range(24):
        edges = zip(middle, width, lower, upper, strict=True)
        axes = [np.clip(m + w * np.linspace(-0.5, 0.5, 15), a, b) for m, w, a, b in edges]
        omega, tau, delay = (x.ravel() for x in np.meshgrid(*axes, indexing="ij"))
        needed = -(2.0 + 1j * omega * tau) * np.exp(1j * omega * delay)
        k_p, k_i = needed.real, -omega * needed.imag
        inside = (k_p >= 0.0) & (k_p <= 10.0) & (k_i >= 0.0) & (k_i <= 10.0)
        found = np.where(inside, cost(response, tau, k_p, k_i, delay), np.inf)
        place = int(np.argmin(found))
        if found[place] < best:
            best, middle = float(found[place]), np.array([omega[place], tau[place], delay[place]])
        width = 0.65 * width
    return best


@pytest.mark.slow
def test_the_best_stable_model_is_found_beside_the_border(make_response):
    """The lowest cost of all is unstable; sorting afterwards leaves a stable optimum of four times the cost."""
    own = delayed_loop()
    response = make_response(own, UNSTABLE, noise=0.05)
    expected = best_on_the_border(response)
    after = identify(own, response, rng=np.random.default_rng(3))
    assert after.clusters[0].stable is False
    assert after.cost > 3.0 * expected
    found = identify(own, response, rng=np.random.default_rng(3), settings=DURING)
    assert found.cost == pytest.approx(expected, rel=1e-4)
    assert found.margins.stable
    assert found.margins.gain_margin == pytest.approx(1.0, abs=1e-4)
    assert found.reached >= 5
    assert sum(c.starts for c in found.clusters) == 50
    assert all(is_stable(own, c.values) for c in found.clusters)


def test_a_stable_optimum_is_found_as_without_the_rule(make_response):
    response = make_response("CL4", noise=0.02, rng=np.random.default_rng(11))
    one, two = (
        identify(structure("CL4"), response, rng=np.random.default_rng(6), settings=s) for s in (Settings(), DURING)
    )
    np.testing.assert_allclose(two.values, one.values, rtol=1e-6)
    assert two.cost == pytest.approx(one.cost, rel=1e-9)


def test_a_structure_without_feedback_has_no_border(make_response):
    response = make_response("OL5", noise=0.02, rng=np.random.default_rng(11))
    found, plain = (
        identify(structure("OL5"), response, rng=np.random.default_rng(6), settings=s) for s in (DURING, Settings())
    )
    assert found.cost == pytest.approx(plain.cost, rel=1e-9)


def test_no_stable_start_is_an_error(make_response):
    """With ``K_p`` above 9 and a delay of 0.4 s no set is stable."""
    own = delayed_loop(k_p=(9.0, 10.0)).held_at(t_d=0.4022, tau_n=0.3897)
    response = make_response(own, UNSTABLE | {"K_p": 9.5}, noise=0.05)
    settings = Settings(starts=3, stability="during")
    with pytest.raises(IdentificationError, match=r"OL1\+OL3: none of 150 drawn starts is a stable model; check the"):
        identify(own, response, rng=np.random.default_rng(3), settings=settings)


class Stubborn(Draw):
    """One stable start, all others unstable however often they are drawn."""

    __slots__ = ()

    def starts(self, lower, upper, count, rng):
        unstable = np.array([0.4, 9.0, 1.0, 0.4])
        return np.where(np.arange(count)[:, None] == (0 if count == 6 else -1), [0.4, 0.5, 0.5, 0.1], unstable)


def test_starts_that_stay_unstable_are_left_out(make_response):
    own = delayed_loop()
    response = make_response(own, {"tau_n": 0.4, "K_p": 0.8, "K_i": 1.0, "t_d": 0.1}, noise=0.05)
    settings = Settings(starts=6, draw=Stubborn(), stability="during")
    found = identify(own, response, rng=np.random.default_rng(3), settings=settings)
    assert found.values == pytest.approx(own.vector({"tau_n": 0.4, "K_p": 0.8, "K_i": 1.0, "t_d": 0.1}), rel=1e-4)
    assert found.reached == 6


@pytest.mark.slow
def test_a_joint_fit_is_stable_in_every_experiment(make_response):
    """Seven times the gain at the second working point: the true model is unstable there."""
    own = delayed_loop()
    loud = own.scaled(K_p=7.0, K_i=7.0)
    truth = {"tau_n": 0.4, "K_p": 1.0, "K_i": 1.0, "t_d": 0.2}
    pairs = [(own, make_response(own, truth, noise=0.2)), (loud, make_response(loud, truth, noise=0.5))]
    settings = Settings(starts=8, stability="during")
    found = identify_jointly(pairs, rng=np.random.default_rng(3), settings=settings)
    assert all(is_stable(part.structure, found.structure_values(i)) for i, part in enumerate(found.experiments))
    free = identify_jointly(pairs, rng=np.random.default_rng(3), settings=Settings(starts=8, stability="ignored"))
    assert free.cost < 1e-9 < found.cost
    assert not is_stable(loud, free.structure_values(1))


def test_stable_models_are_told_for_many_rows(make_response):
    own = delayed_loop()
    fit = identify(own, make_response(own, UNSTABLE, noise=0.05), rng=np.random.default_rng(3))
    truth = [UNSTABLE[p.name] for p in own.free]
    assert stable_models(fit.objective)(np.array([truth, [0.4, 0.5, 0.5, 0.1]])).tolist() == [False, True]


def test_a_step_to_where_parameters_may_not_be_is_refused():
    """The square of the distance to (2, 0), inside the unit disc: no accepted point is outside, the start is told."""
    seen = []

    def residuals(theta, starts):
        jacobian = np.broadcast_to(np.eye(2), (theta.shape[0], 2, 2))
        return theta - [2.0, 0.0], jacobian

    def allowed(theta):
        inside = np.sum(theta**2, axis=1) <= 1.0
        seen.append(inside.all())
        return inside

    box = np.full(2, 5.0)
    start = np.array([[0.0, 0.0], [0.9, 0.0]])
    found = descend(residuals, start, -box, box, tolerance=1e-9, max_iterations=100, allowed=allowed)
    assert not all(seen)
    assert np.all(np.sum(found.theta**2, axis=1) <= 1.0)
    assert found.theta == pytest.approx(np.array([[1.0, 0.0], [1.0, 0.0]]), abs=1e-3)
    assert found.refused.all()
    free = descend(residuals, start, -box, box, tolerance=1e-9, max_iterations=100)
    assert free.theta == pytest.approx(np.array([[2.0, 0.0], [2.0, 0.0]]))
    assert not free.refused.any()


def test_an_unknown_rule_is_refused():
    with pytest.raises(IdentificationError, match="expected stability after, during, ignored, found 'never'"):
        Settings(stability="never")


def test_a_border_is_looked_for_only_where_there_is_feedback(make_response):
    """Starts of a structure without a loop that claim to have been refused stay where they are."""
    fit = identify(structure("OL5"), make_response("OL5", noise=0.02), rng=np.random.default_rng(6))
    theta = fit.values[None, :]
    stopped = Descent(
        theta=theta,
        cost=np.ones(1),
        iterations=np.ones(1, dtype=int),
        converged=np.ones(1, dtype=bool),
        refused=np.ones(1, dtype=bool),
        information=np.ones((1, theta.size, theta.size)),
    )
    found = border_minimum(fit.objective, stopped, DURING, stable_models(fit.objective))
    assert found.cost.tolist() == [np.inf]
    np.testing.assert_array_equal(found.theta, theta)


def test_a_border_without_a_stable_side_gives_nothing(make_response):
    own = delayed_loop()
    fit = identify(own, make_response(own, UNSTABLE, noise=0.05), rng=np.random.default_rng(3))
    stopped = Descent(
        theta=np.array([[0.4, 0.5, 0.5, 0.1]]),
        cost=np.ones(1),
        iterations=np.ones(1, dtype=int),
        converged=np.ones(1, dtype=bool),
        refused=np.ones(1, dtype=bool),
        information=np.ones((1, 4, 4)),
    )
    nowhere = border_minimum(fit.objective, stopped, DURING, lambda theta: np.zeros(len(theta), dtype=bool))
    assert nowhere.cost.tolist() == [np.inf]
