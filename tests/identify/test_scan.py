"""Cost along one parameter: against brute force, against hand-derived optima, and the many optima of a pure delay."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
import scipy.optimize

from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import MaximumLikelihood, Prior, Settings, Unweighted, identify, scan
from shaftprint.identify.likelihood._objective import Objective
from shaftprint.identify.search._starts import Draw
from shaftprint.models import Delay, Gain, Parameter, PIGovernor, Structure
from shaftprint.spectra import FrequencyResponse

S1_TO_S16_HZ = np.array(
    [
        *(0.0044, 0.0092, 0.0193, 0.0275, 0.0405, 0.06, 0.0848, 0.11),
        *(0.1778, 0.3728, 0.7814, 1.637, 3.433, 7.19, 15.01, 31.644),
    ]
)
SIXTEEN = {"frequency_hz": S1_TO_S16_HZ, "names": tuple(f"S{i}" for i in range(1, 17))}
# Ratios of noise to signal of M_s and n, from thesis table 3.7 [dB].
SNR_DB = np.array(
    [
        [18.4, 25.3, 20.7, 22.7, 23.5, 24.2, 23.6, 27.2, 34.9, 34.3, 31.9, 17.2, 9.0, 4.6, -23.9, -23.0],
        [40.6, 40.4, 44.9, 45.3, 45.7, 25.6, 38.0, 41.3, 38.5, 35.9, 31.9, 17.0, 7.8, -11.6, -18.3, -22.4],
    ]
)
LAGGED = {"K_p": 1.8, "K_i": 4.3, "t_d": 0.12, "omega_n": 9.0, "zeta": 1.2}


class Middle(Draw):
    """The middle of the box as the only start."""

    __slots__ = ()

    def starts(self, lower, upper, count, rng):
        return np.tile(0.5 * (lower + upper), (count, 1))


def scan_response(structure, response, parameter, *, settings=None, grid=None):
    """The lowest cost along a parameter of a structure before any fit: nothing is drawn."""
    once = replace(settings or Settings(), starts=1, draw=Middle(), stability="ignored")
    return scan(identify(structure, response, rng=np.random.default_rng(0), settings=once), parameter, grid=grid)


def lowest_of_ol3(response, weights):
    """Lowest cost of OL3: fine profile over ``t_d`` with bounded gains, then a one-dimensional minimiser."""
    omega = 2.0 * np.pi * response.frequency_hz
    data = response.response[0, 0]
    aim = np.concatenate([data.real * weights, data.imag * weights])

    def profile(delay):
        late = np.exp(-1j * omega * delay)
        columns = np.stack([late, late / (1j * omega)])
        stacked = np.concatenate([columns.real * weights, columns.imag * weights], axis=1).T
        return scipy.optimize.lsq_linear(stacked, aim, (0.0, 10.0), method="bvls", tol=1e-15).cost

    grid = np.arange(0.0, 0.5 + 1e-9, 0.001)
    cost = np.array([profile(delay) for delay in grid])
    found = [cost[0], cost[-1]]
    for place in np.argsort(cost)[:4]:
        between = (max(grid[place] - 0.001, 0.0), min(grid[place] + 0.001, 0.5))
        found.append(
            scipy.optimize.minimize_scalar(profile, bounds=between, method="bounded", options={"xatol": 1e-12}).fun
        )
    return min(found)


@pytest.mark.long
@pytest.mark.parametrize("weighting", [MaximumLikelihood(), Unweighted()], ids=["covariance", "unweighted"])
def test_lowest_point_is_the_best_optimum_of_ol3_in_40_of_40_noise_draws(make_response, weighting):
    noise = np.sqrt(np.sum(10.0 ** (-SNR_DB / 10.0), axis=0) / 2.0)
    for seed in range(40):
        response = make_response("OL5", LAGGED, noise=noise, rng=np.random.default_rng(seed), **SIXTEEN)
        found = scan_response(structure("OL3"), response, "t_d", settings=Settings(weighting=weighting))
        std = np.sqrt(response.covariance[:, 0, 0])
        weights = 1.0 / std if isinstance(weighting, MaximumLikelihood) else np.ones_like(std)
        assert found.best.cost == pytest.approx(lowest_of_ol3(response, weights), rel=1e-8)


# ---- against brute force ----


def brute_force(identification, parameter, value, rng):
    """Lowest cost with one parameter held, from random starts and corners of scipy's bounded least squares."""
    objective = identification.objective
    free = [p.name for p in identification.structure.free]
    place = free.index(parameter)
    rest = [i for i in range(len(free)) if i != place]

    def residuals(others):
        theta = np.empty((1, len(free)))
        theta[0, place], theta[0, rest] = value, others
        return objective.residuals(theta)

    bounds = objective.lower[rest], objective.upper[rest]
    corners = np.array(list(itertools.product((0.02, 0.98), repeat=len(rest))))
    shares = np.concatenate([corners if len(rest) < 5 else corners[::4], rng.uniform(0.02, 0.98, (6, len(rest)))])
    return min(
        scipy.optimize.least_squares(
            lambda x: residuals(x)[0][0],
            bounds[0] + share * (bounds[1] - bounds[0]),
            jac=lambda x: residuals(x)[1][0][rest].T,
            bounds=bounds,
            x_scale="jac",
            xtol=1e-15,
            ftol=1e-15,
            gtol=1e-15,
            max_nfev=500,
        ).cost
        for share in shares
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "parameter", "closed"),
    [
        ("OL3", "t_d", ("K_p", "K_i")),
        ("OL3", "K_i", ("K_p",)),
        ("OL5", "t_d", ("K_p", "K_i")),
        ("CL4", "t_d", ()),
        ("CL4", "K_p", ()),
    ],
)
def test_cost_along_a_parameter_equals_brute_force(make_response, name, parameter, closed):
    rng = np.random.default_rng(5)
    found = identify(structure(name), make_response(name, noise=0.03, rng=rng), rng=rng)
    chosen = next(p for p in found.structure.free if p.name == parameter)
    grid = np.linspace(chosen.lower, chosen.upper, 4)
    scanned = scan(found, parameter, grid=grid)
    assert scanned.closed_form == closed
    expected = [brute_force(found, parameter, value, rng) for value in grid]
    # a start of scipy's near a bound creeps: it may stop above the optimum, never below it
    assert np.all(scanned.cost <= np.array(expected) * (1.0 + 1e-8))
    assert scanned.cost == pytest.approx(expected, rel=1e-6)
    own, _ = found.objective.residuals(scanned.values[:, list(found.objective.free)])
    assert 0.5 * np.sum(own**2, axis=1) == pytest.approx(scanned.cost, rel=1e-12)
    assert scanned.values[:, found.structure.names.index(parameter)] == pytest.approx(grid, abs=1e-15)
    assert scanned.best.cost == pytest.approx(found.cost, rel=1e-9)
    assert scanned.best.values == pytest.approx(found.values, rel=1e-4)


def test_a_prior_counts_in_the_closed_form(make_response):
    """The prior of a linear gain is one more row: at the scanned optimum the cost is that of the whole fit."""
    settings = Settings(priors={"K_p": Prior(2.0, 0.01)})
    rng = np.random.default_rng(5)
    found = identify(structure("OL3"), make_response("OL3", noise=0.03, rng=rng), rng=rng, settings=settings)
    scanned = scan(found, "t_d", grid=[found.value("t_d")])
    assert scanned.closed_form == ("K_p", "K_i")
    assert scanned.cost[0] == pytest.approx(found.cost, rel=1e-9)
    assert scanned.values[0] == pytest.approx(found.values, rel=1e-6)


def test_of_two_gains_in_series_only_one_is_taken_as_linear(make_response):
    """``v (K_p + K_i / s)``: linear in ``v``, or in ``K_p`` and ``K_i``, not in all three; the larger set is taken."""
    gain = Parameter("v", "-", 0.1, 5.0, 1.0, "test")
    k_p, k_i, t_d = structure("OL3").parameters
    own = Structure(name="own", title="", input="e", outputs={"M_s": Gain(gain) * PIGovernor(k_p, k_i) * Delay(t_d)})
    rng = np.random.default_rng(2)
    response = make_response(own, {"v": 1.5, "K_p": 2.0, "K_i": 4.0, "t_d": 0.1}, rng=rng)
    scanned = scan_response(own, response, "t_d", grid=[0.0, 0.1])
    assert scanned.closed_form == ("K_p", "K_i")
    assert scan_response(own, response, "K_i", grid=[1.0]).closed_form == ("v",)


# ---- optima that can be derived by hand ----


def delay_of_unit_gain(upper):
    time = Parameter("t", "s", 0.0, upper, 0.1, "test")
    return Structure(name="late", title="", input="u", outputs={"y": Delay(time)})


def two_lines(weak):
    """Lines at 2 and 3 Hz of a delay of 0.1 s, the second with little weight."""
    frequency = np.array([2.0, 3.0])
    return FrequencyResponse(
        frequency_hz=frequency,
        response=np.exp(-2j * np.pi * frequency * 0.1)[None, None],
        covariance=np.stack([np.eye(2), weak * np.eye(2)]),
        inputs=("u",),
        outputs=("y",),
    )


def test_every_turn_of_a_line_is_an_optimum():
    """``|exp(-j w t) - exp(-j w t0)|^2 / 2 = 1 - cos w (t - t0)``: a turn of 2 Hz is 0.5 s, of 3 Hz a third."""
    found = scan_response(delay_of_unit_gain(1.8), two_lines(1e4), "t")
    assert [m.value for m in sorted(found.minima, key=lambda m: m.value)] == pytest.approx(
        [0.1, 0.6, 1.1, 1.6], abs=2e-4
    )
    assert found.best.value == pytest.approx(0.1, abs=1e-12) or found.best.value == pytest.approx(1.1, abs=1e-12)
    late = found.grid - 0.1
    expected = 1.0 - np.cos(4.0 * np.pi * late) + 1e-4 * (1.0 - np.cos(6.0 * np.pi * late))
    assert found.cost == pytest.approx(expected, abs=1e-12)
    cost = sorted(m.cost for m in found.minima)
    assert cost[:2] == pytest.approx([0.0, 0.0], abs=1e-20)
    # half a turn of 2 Hz later the line at 3 Hz is opposite
    assert cost[2:] == pytest.approx([2e-4, 2e-4], rel=1e-3)


def test_an_optimum_at_the_end_of_the_range_counts():
    """Between 0.2 and 0.55 s the cost falls to both ends."""
    time = Parameter("t", "s", 0.2, 0.55, 0.3, "test")
    own = Structure(name="late", title="", input="u", outputs={"y": Delay(time)})
    found = scan_response(own, two_lines(1e4), "t")
    assert sorted(m.value for m in found.minima) == [0.2, 0.55]
    assert found.best.value == 0.55


def test_the_grid_gets_finer_where_the_cost_turns_fast():
    """80 turns of a fast line need more points than the first grid has; a straight cost does not."""
    fine = scan_response(delay_of_unit_gain(39.8), two_lines(1e4), "t")
    assert len(fine.minima) == 80
    assert fine.grid.size > 400
    coarse = scan_response(delay_of_unit_gain(0.2), two_lines(1e4), "t")
    assert coarse.grid.size == 129


def test_neighbours_lead_on_so_that_few_values_are_searched_from_all_starts(make_response, monkeypatch):
    """A search of every value from every start asked for the model at 15,500 sets of parameters here."""
    rng = np.random.default_rng(5)
    found = identify(structure("CL4"), make_response("CL4", noise=0.03, rng=rng), rng=rng)
    asked, residuals = [], Objective.residuals
    monkeypatch.setattr(Objective, "residuals", lambda self, theta: asked.append(len(theta)) or residuals(self, theta))
    scanned = scan(found, "t_d", starts=4)
    assert scanned.best.cost == pytest.approx(found.cost, rel=1e-9)
    assert sum(asked) < 8000


def test_findings_name_the_optima():
    found = scan_response(delay_of_unit_gain(0.9), two_lines(1.0), "t")
    assert len(found.minima) == 3
    text = " ".join(found.sentences)
    assert "0.1 s" in text
    assert "3 optima" in text
    one = scan_response(delay_of_unit_gain(0.25), two_lines(1.0), "t")
    assert "one optimum" in one.sentences[0]


# ---- refusals ----


def test_what_cannot_be_scanned_is_refused(make_response):
    response = make_response("OL3")
    with pytest.raises(
        IdentificationError, match="scan of omega_n: structure OL3 has the free parameters K_p, K_i, t_d"
    ):
        scan_response(structure("OL3"), response, "omega_n")
    with pytest.raises(IdentificationError, match=r"scan of t_d: .*free_between"):
        scan_response(structure("OL3").held_at(t_d=0.1), response, "t_d")
    for grid in ([], [[0.1]], [np.nan], [0.1, 0.7], [0.2, 0.1]):
        with pytest.raises(IdentificationError, match=r"scan of t_d: expected ascending values from 0 to 0.5"):
            scan_response(structure("OL3"), response, "t_d", grid=grid)
