"""The search as a whole: which optimum wins, bounds, reproducibility, invariances, the many optima of a pure delay."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.optimize

from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import Draw, MaximumLikelihood, Prior, Settings, Unweighted, identify
from shaftprint.identify.search._starts import LatinHypercube
from shaftprint.models import Delay, Parameter, PIGovernor, Sensitivity, Shaft, Structure
from shaftprint.models._nyquist import unstable_poles

S1_TO_S16_HZ = np.array(
    [
        *(0.0044, 0.0092, 0.0193, 0.0275, 0.0405, 0.06, 0.0848, 0.11),
        *(0.1778, 0.3728, 0.7814, 1.637, 3.433, 7.19, 15.01, 31.644),
    ]
)
SIXTEEN = {"frequency_hz": S1_TO_S16_HZ, "names": tuple(f"S{i}" for i in range(1, 17))}


# ---- bounds ----


def test_an_optimum_at_a_bound_is_reported(make_response):
    """Data of a governor with ``K_p`` -0.3: the search stops at its bound 0, the rest is the best there."""
    shipped = structure("OL2")
    response = make_response(shipped, {"K_p": -0.3, "K_i": 4.0})
    found = identify(shipped, response, rng=np.random.default_rng(1))
    at_bound = {p.name: p.at_bound for p in found.parameters}
    assert at_bound == {"K_p": True, "K_i": False}
    assert found.value("K_p") == 0.0
    weight = np.array([np.linalg.inv(c)[1, 1] for c in response.covariance])
    slope = -1.0 / (2.0 * np.pi * response.frequency_hz)
    data = response.response[0, 0].imag
    assert found.value("K_i") == pytest.approx(np.sum(weight * slope * data) / np.sum(weight * slope**2), rel=1e-6)


def test_the_damping_of_the_thesis_sets_lies_inside_the_bounds_of_table_5_1(make_response):
    """0.4 is called "the lowest bound" in section 5.4, but table 5.1 prints 0.3."""
    found = identify(structure("CL4"), make_response("CL4", noise=0.001), rng=np.random.default_rng(1))
    assert not any(p.at_bound for p in found.parameters)


# ---- stability ----


def delayed_loop(k_p=(0.0, 10.0)):
    """OL1 and OL3 in one loop: PI governor, delay, shaft; no lag."""
    fields = {"tau_n": (0.0, 5.0), "K_p": k_p, "K_i": (0.0, 10.0), "t_d": (0.0, 0.5)}
    tau, p, i, t = (Parameter(n, "-", *bounds, sum(bounds) / 2.0, "test") for n, bounds in fields.items())
    slope = Parameter("k_q", "-", 1.0, 3.0, 2.0, "test", held=True)
    engine = PIGovernor(p, i) * Delay(t)
    core = Shaft((tau,), slope)
    torque = engine * Sensitivity(engine * core)
    return Structure(name="OL1+OL3", title="", input="n_set", outputs={"n": core * torque, "M_s": torque})


UNSTABLE = {"tau_n": 0.3897, "K_p": 3.4363, "K_i": 4.2639, "t_d": 0.4022}


def test_the_lowest_stable_optimum_wins_over_a_lower_unstable_one(make_response):
    """The thesis' rule (section 5.1), on data of its own OL1 and OL3, which are unstable together."""
    own = delayed_loop()
    response = make_response(own, UNSTABLE, noise=0.05)
    found = identify(own, response, rng=np.random.default_rng(3))
    first, *others = found.clusters
    assert first.stable is False
    assert first.values == pytest.approx(own.vector(UNSTABLE), rel=1e-6)
    assert first.cost < 1e-6 < found.cost
    assert found.margins.stable
    winner = next(c for c in others if np.array_equal(c.values, found.values))
    assert winner.stable is True
    before = others[: others.index(winner)]
    assert all(c.stable is False for c in before)
    assert all(c.cost >= winner.cost * (1.0 - 1e-3) and c.stable is None for c in others[len(before) + 1 :])
    assert found.reached == winner.starts


def test_an_unstable_model_may_win_when_it_is_allowed(make_response):
    own = delayed_loop()
    settings = Settings(stability="ignored")
    found = identify(own, make_response(own, UNSTABLE, noise=0.05), rng=np.random.default_rng(3), settings=settings)
    assert found.values == pytest.approx(own.vector(UNSTABLE), rel=1e-6)
    assert found.margins.unstable_poles == unstable_poles(own, own.vector(UNSTABLE)) == 2
    assert found.clusters[0].stable is False


def test_no_stable_model_is_an_error(make_response):
    """With ``K_p`` above 9, a crossover near 23 rad/s and a delay of 0.4 s no set is stable."""
    own = delayed_loop(k_p=(9.0, 10.0)).held_at(t_d=0.4022, tau_n=0.3897)
    response = make_response(own, UNSTABLE | {"K_p": 9.5}, noise=0.05)
    with pytest.raises(
        IdentificationError,
        match=r"structure OL1\+OL3: none of 8 starts reached a stable model; the lowest cost is .* allow unstable",
    ):
        identify(own, response, rng=np.random.default_rng(3), settings=Settings(starts=8))


# ---- the pick-up of the response ----


def test_pick_up_of_the_response_is_held_in_the_model(make_response):
    """One pulse a revolution at 1183.8 rpm, stamped at its end: ``tau_dn`` comes back as 0.236 s."""
    period = 60.0 / 1183.8
    core = structure("GAUGE-CORE").held_at(k_q=2.0, t_gauge=0.0)
    truth = {"tau_dn": 0.236, "T_average": period, "t_pickup": period}
    fields = {"averaging_s": period, "pick_up_delay_s": period}
    response = make_response(core, truth, **SIXTEEN, **fields)
    found = identify(core, response, rng=np.random.default_rng(1))
    assert found.value("tau_dn") == pytest.approx(0.236, rel=1e-8)
    assert (found.value("T_average"), found.value("T_hold"), found.value("t_pickup")) == (period, 0.0, period)


def test_pick_up_that_is_left_out_of_the_model_looks_like_inertia(make_response):
    """The same data as the thesis fits them, unweighted and without the pick-up: 0.369 s instead of 0.236 s."""
    period = 60.0 / 1183.8
    core = structure("GAUGE-CORE").held_at(k_q=2.0, t_gauge=0.0)
    response = make_response(core, {"tau_dn": 0.236, "T_average": period, "t_pickup": period}, **SIXTEEN)
    settings = Settings(weighting=Unweighted())
    found = identify(structure("OL1"), response, rng=np.random.default_rng(1), settings=settings)
    assert found.value("tau_n") == pytest.approx(0.369, abs=0.0005)


def test_a_free_pick_up_parameter_is_fitted(make_response):
    core = structure("GAUGE-CORE").held_at(k_q=2.0, t_gauge=0.0).free_between(t_pickup=(0.0, 0.2))
    response = make_response(core, {"tau_dn": 0.3, "t_pickup": 0.05}, pick_up_delay_s=0.1)
    found = identify(core, response, rng=np.random.default_rng(1))
    assert found.value("t_pickup") == pytest.approx(0.05, rel=1e-6)


# ---- lines ----


def test_lines_marked_unused_are_left_out_and_named_lines_are_taken(make_response):
    response = make_response("OL1", {"tau_n": 0.39})
    spoiled = response.response.copy()
    spoiled[0, 0, -1] *= -3.0
    used = np.arange(13) < 12
    marked = replace(response, response=spoiled, used=used)
    assert identify(structure("OL1"), marked, rng=np.random.default_rng(1)).value("tau_n") == pytest.approx(0.39)
    everything = identify(structure("OL1"), marked, rng=np.random.default_rng(1), lines=response.lines)
    assert abs(everything.value("tau_n") - 0.39) > 0.01
    assert everything.fitted.all()
    few = identify(structure("OL1"), marked, rng=np.random.default_rng(1), lines=["S9", "S3"])
    assert np.flatnonzero(few.fitted).tolist() == [2, 8]
    assert (few.data_count, few.degrees_of_freedom) == (4, 3)


# ---- reproducibility and invariances ----


@pytest.fixture
def noisy(make_response):
    return make_response("CL4", noise=0.02, correlation=0.3, rng=np.random.default_rng(11))


def test_a_seed_reproduces_bit_for_bit(noisy):
    one, two = (identify(structure("CL4"), noisy, rng=np.random.default_rng(6)) for _ in range(2))
    assert np.array_equal(one.values, two.values)
    assert np.array_equal(one.covariance, two.covariance)
    assert [(c.cost, c.starts) for c in one.clusters] == [(c.cost, c.starts) for c in two.clusters]


def test_the_optimum_does_not_depend_on_the_seed(noisy):
    one, two = (identify(structure("CL4"), noisy, rng=np.random.default_rng(seed)) for seed in (6, 7))
    np.testing.assert_allclose(one.values, two.values, rtol=1e-6)


def test_unit_of_the_covariance_only_scales_cost_and_covariance(noisy):
    scaled = replace(noisy, covariance=9.0 * noisy.covariance)
    one = identify(structure("CL4"), noisy, rng=np.random.default_rng(6))
    two = identify(structure("CL4"), scaled, rng=np.random.default_rng(6))
    np.testing.assert_allclose(two.values, one.values, rtol=1e-6)
    np.testing.assert_allclose(two.covariance, 9.0 * one.covariance, rtol=1e-4)
    assert two.cost == pytest.approx(one.cost / 9.0, rel=1e-9)


def test_order_in_which_lines_are_named_does_not_matter(noisy):
    names = list(noisy.lines)
    one = identify(structure("CL4"), noisy, rng=np.random.default_rng(6), lines=names)
    two = identify(structure("CL4"), noisy, rng=np.random.default_rng(6), lines=names[::-1])
    assert np.array_equal(one.values, two.values)


class Given(Draw):
    """Starts in a given order."""

    __slots__ = ("order",)

    def __init__(self, order):
        self.order = order

    def starts(self, lower, upper, count, rng):
        return LatinHypercube().starts(lower, upper, count, np.random.default_rng(3))[self.order]


def test_order_of_the_starts_does_not_matter(noisy):
    order = np.random.default_rng(9).permutation(50)
    found = [
        identify(structure("CL4"), noisy, rng=np.random.default_rng(6), settings=Settings(draw=Given(o)))
        for o in (np.arange(50), order)
    ]
    np.testing.assert_allclose(found[0].values, found[1].values, rtol=1e-6)
    assert found[0].reached == found[1].reached


def test_held_parameters_are_untouched_and_cost_no_freedom(noisy):
    held = structure("CL4").held_at(t_d=0.13, zeta=0.55)
    found = identify(held, noisy, rng=np.random.default_rng(6))
    assert (found.value("t_d"), found.value("zeta"), found.value("k_q")) == (0.13, 0.55, 2.0)
    assert [p.name for p in found.parameters] == ["tau_n", "K_p", "K_i", "omega_n"]
    assert found.covariance.shape == (4, 4)
    assert found.degrees_of_freedom == 52 - 4


def test_holding_a_parameter_at_its_estimate_gives_the_same_optimum_and_smaller_deviations(noisy):
    free = identify(structure("CL4"), noisy, rng=np.random.default_rng(6))
    held = identify(structure("CL4").held_at(t_d=free.value("t_d")), noisy, rng=np.random.default_rng(6))
    assert held.cost == pytest.approx(free.cost, rel=1e-9)
    std = {p.name: p.std for p in free.parameters}
    assert all(p.std < std[p.name] * (1.0 + 1e-6) for p in held.parameters)


def test_clusters_account_for_every_start(noisy):
    found = identify(structure("CL4"), noisy, rng=np.random.default_rng(6))
    assert sum(c.starts for c in found.clusters) == 50
    costs = [c.cost for c in found.clusters]
    assert costs == sorted(costs)
    assert found.clusters[0].stable is True
    assert found.reached == found.clusters[0].starts > 25


def test_a_strong_prior_decides(noisy):
    settings = Settings(priors={"t_d": Prior(0.2, 1e-7)})
    found = identify(structure("CL4"), noisy, rng=np.random.default_rng(6), settings=settings)
    assert found.value("t_d") == pytest.approx(0.2, abs=1e-5)


# ---- the many optima of a delay without lag ----

# Ratios of noise to signal of M_s and n, from table 3.7 [dB].
SNR_DB = np.array(
    [
        [18.4, 25.3, 20.7, 22.7, 23.5, 24.2, 23.6, 27.2, 34.9, 34.3, 31.9, 17.2, 9.0, 4.6, -23.9, -23.0],
        [40.6, 40.4, 44.9, 45.3, 45.7, 25.6, 38.0, 41.3, 38.5, 35.9, 31.9, 17.0, 7.8, -11.6, -18.3, -22.4],
    ]
)
LAGGED = {"K_p": 1.8, "K_i": 4.3, "t_d": 0.12, "omega_n": 9.0, "zeta": 1.2}


def best_of_a_fine_profile(response, weights):
    """Lowest cost of OL3 over ``t_d`` in steps of 0.5 ms; ``K_p`` and ``K_i`` are linear and not negative."""
    omega = 2.0 * np.pi * response.frequency_hz
    data = response.response[0, 0]
    aim = np.concatenate([data.real * weights, data.imag * weights])
    lowest = np.inf
    for delay in np.arange(0.0, 0.5 + 1e-9, 0.0005):
        late = np.exp(-1j * omega * delay)
        columns = np.stack([late, late / (1j * omega)])
        stacked = np.concatenate([columns.real * weights, columns.imag * weights], axis=1).T
        gains, rest = scipy.optimize.nnls(stacked, aim)
        lowest = min(lowest, 0.5 * rest**2) if np.all(gains <= 10.0) else lowest
    return lowest


@pytest.mark.slow
@pytest.mark.parametrize("weighting", [MaximumLikelihood(), Unweighted()], ids=["covariance", "unweighted"])
def test_default_search_finds_the_best_of_ol3s_optima_in_40_of_40_noise_draws(make_response, weighting):
    """Every turn of the fast lines' phase is an optimum; the data are those of a lag that OL3 does not have."""
    noise = np.sqrt(np.sum(10.0 ** (-SNR_DB / 10.0), axis=0) / 2.0)
    for seed in range(40):
        rng = np.random.default_rng(seed)
        response = make_response("OL5", LAGGED, noise=noise, rng=rng, **SIXTEEN)
        found = identify(structure("OL3"), response, rng=rng, settings=Settings(weighting=weighting))
        std = np.sqrt(response.covariance[:, 0, 0])
        weights = 1.0 / std if isinstance(weighting, MaximumLikelihood) else np.ones_like(std)
        assert found.cost <= best_of_a_fine_profile(response, weights) * (1.0 + 2e-5)


def test_the_delay_alone_has_many_optima_and_the_result_shows_them(make_response):
    """Unweighted: no delay and 0.13 s fit nearly alike, and the result tells how many starts reached which."""
    response = make_response("OL5", LAGGED, noise=0.02, rng=np.random.default_rng(2), **SIXTEEN)
    found = identify(
        structure("OL3"), response, rng=np.random.default_rng(2), settings=Settings(weighting=Unweighted())
    )
    delays = np.array([c.values[2] for c in found.clusters])
    assert len(found.clusters) >= 2
    assert np.ptp(delays) > 0.1
    assert found.reached < 50
