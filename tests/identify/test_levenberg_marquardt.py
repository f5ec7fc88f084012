"""The batched search against SciPy's, on problems with and without active bounds."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
import scipy.optimize

from shaftprint.identify.search._levenberg_marquardt import LARGEST_DAMPING, descend

Function = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Problem:
    """Residuals of one parameter set, their derivatives (rows, parameters), bounds and one or more starts."""

    residuals: Function
    jacobian: Function
    lower: tuple[float, ...]
    upper: tuple[float, ...]
    starts: tuple[tuple[float, ...], ...]

    def batched(self, theta, starts):
        assert theta.shape[0] == starts.size
        return np.stack([self.residuals(t) for t in theta]), np.stack([self.jacobian(t).T for t in theta])

    def descended(self, **settings):
        options = {"tolerance": 1e-14, "max_iterations": 500} | settings
        starts = np.array(self.starts)
        return descend(self.batched, starts, np.array(self.lower), np.array(self.upper), **options)


def rosenbrock(lower, upper, *starts):
    return Problem(
        residuals=lambda t: np.array([10.0 * (t[1] - t[0] ** 2), 1.0 - t[0]]),
        jacobian=lambda t: np.array([[-20.0 * t[0], 10.0], [-1.0, 0.0]]),
        lower=lower,
        upper=upper,
        starts=starts,
    )


def decay(lower, upper, *starts):
    """Two exponentials, badly scaled: the second amplitude is a thousandth of the first."""
    t = np.linspace(0.0, 4.0, 30)
    data = 1000.0 * np.exp(-0.7 * t) + np.exp(-3.0 * t)
    return Problem(
        residuals=lambda p: p[0] * np.exp(-p[1] * t) + p[2] * np.exp(-3.0 * t) - data,
        jacobian=lambda p: np.stack([np.exp(-p[1] * t), -t * p[0] * np.exp(-p[1] * t), np.exp(-3.0 * t)], axis=1),
        lower=lower,
        upper=upper,
        starts=starts,
    )


def powell(lower, upper, *starts):
    """Powell's singular function: the Jacobian loses rank at the optimum."""
    return Problem(
        residuals=lambda p: np.array(
            [p[0] + 10 * p[1], 5**0.5 * (p[2] - p[3]), (p[1] - 2 * p[2]) ** 2, 10**0.5 * (p[0] - p[3]) ** 2]
        ),
        jacobian=lambda p: np.array(
            [
                [1.0, 10.0, 0.0, 0.0],
                [0.0, 0.0, 5**0.5, -(5**0.5)],
                [0.0, 2 * (p[1] - 2 * p[2]), -4 * (p[1] - 2 * p[2]), 0.0],
                [2 * 10**0.5 * (p[0] - p[3]), 0.0, 0.0, -2 * 10**0.5 * (p[0] - p[3])],
            ]
        ),
        lower=lower,
        upper=upper,
        starts=starts,
    )


PROBLEMS = {
    "Rosenbrock inside": rosenbrock((-3.0, -3.0), (3.0, 3.0), (-1.2, 1.0), (2.0, -2.0)),
    "Rosenbrock, upper bound active": rosenbrock((-3.0, -3.0), (0.5, 3.0), (-1.2, 1.0), (0.5, 3.0)),
    "Rosenbrock, lower bound active": rosenbrock((1.5, -3.0), (3.0, 3.0), (1.5, -3.0), (3.0, 3.0)),
    "Rosenbrock, both bounds active": rosenbrock((1.5, -3.0), (3.0, 2.0), (1.6, -3.0), (3.0, 2.0)),
    "decay inside": decay((0.0, 0.0, 0.0), (2e3, 5.0, 10.0), (500.0, 2.0, 5.0), (2e3, 0.1, 0.0)),
    "decay, rate at its bound": decay((0.0, 0.9, -1e3), (2e3, 5.0, 1e3), (500.0, 2.0, 5.0), (1.0, 5.0, 0.0)),
    "decay, two at their bounds": decay((0.0, 0.9, 0.0), (2e3, 5.0, 10.0), (500.0, 2.0, 5.0), (1.0, 5.0, 0.0)),
    "Powell, one bound active": powell((0.5,) * 4, (4.0,) * 4, (3.0, 1.0, 1.0, 1.0), (4.0, 4.0, 0.5, 4.0)),
}


@pytest.mark.parametrize("name", PROBLEMS)
def test_reaches_the_optimum_that_scipy_finds(name):
    problem = PROBLEMS[name]
    found = problem.descended()
    for start, theta, cost in zip(problem.starts, found.theta, found.cost, strict=True):
        inside = np.clip(start, np.array(problem.lower) + 1e-6, np.array(problem.upper) - 1e-6)
        peer = scipy.optimize.least_squares(
            problem.residuals,
            inside,
            problem.jacobian,
            (problem.lower, problem.upper),
            ftol=1e-15,
            xtol=1e-15,
            gtol=1e-15,
            max_nfev=5000,
        )
        assert theta == pytest.approx(peer.x, rel=1e-6, abs=1e-6)
        assert cost <= peer.cost * (1.0 + 1e-6) + 1e-12
    assert np.all(found.converged)


@dataclass
class Carried:
    """Residuals of a problem with the derivatives of its first start, wherever they are asked for."""

    problem: Problem
    first: np.ndarray | None = None
    evaluated: int = 0
    found_anew: int = 0

    def __call__(self, theta, starts):
        residuals, jacobian = self.problem.batched(theta, starts)
        self.evaluated += 1
        self.first = jacobian if self.first is None else self.first
        return residuals, self.first

    def anew(self, theta, starts):
        self.found_anew += 1
        residuals, self.first = self.problem.batched(theta, starts)
        return residuals, self.first


@pytest.mark.parametrize("name", [name for name in PROBLEMS if "Powell" not in name])
def test_derivatives_of_earlier_steps_lead_to_the_same_optimum(name):
    problem = PROBLEMS[name]
    exact = problem.descended()
    for row, start in enumerate(problem.starts):
        carried = Carried(problem)
        found = descend(
            carried,
            np.array([start]),
            np.array(problem.lower),
            np.array(problem.upper),
            tolerance=1e-14,
            max_iterations=2000,
            anew=carried.anew,
        )
        assert found.theta[0] == pytest.approx(exact.theta[row], rel=1e-5, abs=1e-5)
        assert 0 < carried.found_anew < carried.evaluated


def test_parameters_stop_exactly_on_their_bounds():
    found = PROBLEMS["Rosenbrock, both bounds active"].descended()
    # on the corner (1.5, 2): residuals 10 (2 - 2.25) and -0.5, so half the sum of squares is 3.25
    assert np.array_equal(found.theta, [[1.5, 2.0], [1.5, 2.0]])
    assert found.cost == pytest.approx([3.25, 3.25], rel=1e-14)


@pytest.mark.parametrize("seed", range(60))
def test_straight_problems_in_a_box_end_at_the_one_optimum(seed):
    """Many bounds active at once, badly scaled and correlated: a set that only grows stops too early here."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 9))
    rows = count + int(rng.integers(1, 6))
    matrix = rng.normal(size=(rows, count)) * 10.0 ** rng.uniform(-1.5, 1.5, count)
    matrix[:, 0] += 5.0 * matrix[:, 1]
    aim = 10.0 * rng.normal(size=rows)
    lower, upper = rng.uniform(-1.0, 0.0, count), rng.uniform(0.0, 1.0, count)
    found = descend(
        lambda t, _: (t @ matrix.T - aim, np.broadcast_to(matrix.T, (t.shape[0], count, rows))),
        rng.uniform(lower, upper, (5, count)),
        lower,
        upper,
        tolerance=1e-14,
        max_iterations=500,
    )
    peer = scipy.optimize.lsq_linear(matrix, aim, (lower, upper), method="bvls", tol=1e-15)
    assert found.cost == pytest.approx(np.full(5, peer.cost), rel=1e-9)
    assert np.all(found.converged)


def test_a_batch_is_what_each_start_alone_gives():
    rng = np.random.default_rng(3)
    starts = tuple(map(tuple, rng.uniform(-3.0, 3.0, (20, 2))))
    together = rosenbrock((-3.0, -3.0), (3.0, 3.0), *starts).descended()
    for i, start in enumerate(starts):
        alone = rosenbrock((-3.0, -3.0), (3.0, 3.0), start).descended()
        assert together.theta[i] == pytest.approx(alone.theta[0], rel=1e-9)
        assert together.iterations[i] == alone.iterations[0]


def test_starts_outside_the_box_begin_on_its_edge():
    found = rosenbrock((0.0, 0.0), (2.0, 2.0), (-50.0, 70.0)).descended()
    assert found.theta[0] == pytest.approx([1.0, 1.0], rel=1e-9)


def test_stops_at_the_limit_of_iterations_and_says_so():
    found = rosenbrock((-3.0, -3.0), (3.0, 3.0), (-1.2, 1.0), (1.0, 1.0)).descended(max_iterations=3)
    assert found.iterations.tolist() == [3, 1]
    assert found.converged.tolist() == [False, True]


def test_a_loose_tolerance_stops_sooner():
    tight = PROBLEMS["decay, rate at its bound"].descended()
    loose = PROBLEMS["decay, rate at its bound"].descended(tolerance=1e-2)
    assert loose.iterations.sum() < tight.iterations.sum()


def test_a_start_from_which_no_step_gains_ends_where_it_began():
    """A wrong Jacobian promises a gain that never comes: the damping grows until the search gives up."""
    problem = Problem(
        residuals=lambda t: np.array([1.0 + t[0] ** 2]),
        jacobian=lambda t: np.array([[1.0]]),
        lower=(-1.0,),
        upper=(1.0,),
        starts=((0.0,),),
    )
    found = problem.descended()
    assert found.theta[0, 0] == 0.0
    assert found.converged[0]
    assert found.iterations[0] < np.log2(LARGEST_DAMPING)
