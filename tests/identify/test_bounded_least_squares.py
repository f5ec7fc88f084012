"""Many small least-squares problems with bounds, against scipy's solver of one."""

import numpy as np
import pytest
import scipy.optimize

from shaftprint.identify.search._bounded_least_squares import bounded_least_squares


@pytest.mark.parametrize("unknowns", [1, 2, 4, 7])
def test_every_problem_of_a_batch_equals_scipys_solution(unknowns):
    rng = np.random.default_rng(unknowns)
    columns = rng.normal(size=(200, unknowns, 20)) * 10.0 ** rng.uniform(-3, 3, (1, unknowns, 1))
    aim = rng.normal(size=(200, 20)) * 5.0
    lower, upper = -rng.uniform(0.0, 1.0, unknowns), rng.uniform(0.0, 1.0, unknowns)
    found = bounded_least_squares(columns, aim, lower, upper)
    assert np.all((found >= lower) & (found <= upper))
    at_bound = 0
    for own, x, y in zip(found, columns, aim, strict=True):
        one = scipy.optimize.lsq_linear(x.T, y, (lower, upper), method="bvls", tol=1e-15, max_iter=1000)
        assert 0.5 * np.sum((y - own @ x) ** 2) == pytest.approx(one.cost, rel=1e-10)
        at_bound += np.sum(one.active_mask != 0)
    assert at_bound > 100


def test_without_active_bounds_it_is_plain_least_squares():
    rng = np.random.default_rng(1)
    columns, aim = rng.normal(size=(5, 3, 9)), rng.normal(size=(5, 9))
    found = bounded_least_squares(columns, aim, np.full(3, -1e9), np.full(3, 1e9))
    for own, x, y in zip(found, columns, aim, strict=True):
        assert own == pytest.approx(np.linalg.lstsq(x.T, y, rcond=None)[0], rel=1e-9)


def test_a_solution_at_a_bound_is_the_bound_itself():
    columns = np.full((1, 1, 3), 0.1)
    found = bounded_least_squares(columns, np.full((1, 3), 7.0), np.array([0.1]), np.array([0.7]))
    assert found[0, 0] == 0.7
    found = bounded_least_squares(columns, np.full((1, 3), -7.0), np.array([0.1]), np.array([0.7]))
    assert found[0, 0] == 0.1


def test_an_unknown_without_influence_stays_in_its_bounds():
    columns = np.zeros((1, 2, 4))
    columns[0, 0] = 1.0
    found = bounded_least_squares(columns, np.full((1, 4), 0.5), np.array([0.0, 2.0]), np.array([1.0, 3.0]))
    assert found[0, 0] == pytest.approx(0.5)
    assert 2.0 <= found[0, 1] <= 3.0


def test_two_unknowns_with_the_same_column_share_what_one_would_do():
    columns = np.ones((1, 2, 4))
    found = bounded_least_squares(columns, np.full((1, 4), 0.5), np.zeros(2), np.ones(2))
    assert found.sum() == pytest.approx(0.5, rel=1e-6)
