"""Start values of a search."""

import numpy as np
import pytest

from shaftprint.identify import Uniform
from shaftprint.identify.search._starts import LatinHypercube

LOWER, UPPER = np.array([0.0, -3.0, 7.0]), np.array([5.0, 1.0, 13.0])


@pytest.mark.parametrize("draw", [LatinHypercube(), Uniform()])
@pytest.mark.parametrize("count", [1, 2, 50])
def test_starts_lie_within_the_bounds(draw, count):
    found = draw.starts(LOWER, UPPER, count, np.random.default_rng(1))
    assert found.shape == (count, 3)
    assert np.all((found >= LOWER) & (found <= UPPER))


@pytest.mark.parametrize("draw", [LatinHypercube(), Uniform()])
def test_a_seed_gives_the_same_starts_and_another_gives_others(draw):
    one, same, other = (draw.starts(LOWER, UPPER, 50, np.random.default_rng(seed)) for seed in (4, 4, 5))
    assert np.array_equal(one, same)
    assert not np.any(one == other)


def test_latin_hypercube_meets_every_cell_of_every_parameter_once():
    found = LatinHypercube().starts(LOWER, UPPER, 50, np.random.default_rng(2))
    cells = np.floor((found - LOWER) / (UPPER - LOWER) * 50).astype(int)
    for column in cells.T:
        assert sorted(column) == list(range(50))
    # combined at random: no parameter follows another
    assert np.all(np.abs(np.corrcoef(cells.T) - np.eye(3)) < 0.5)


def test_uniform_starts_leave_cells_empty():
    """Of 50 independent draws into 50 cells a share of ``1 / e`` stays empty."""
    found = Uniform().starts(LOWER, UPPER, 50, np.random.default_rng(2))
    cells = np.floor((found - LOWER) / (UPPER - LOWER) * 50).astype(int)
    empty = [50 - np.unique(column).size for column in cells.T]
    assert np.mean(empty) == pytest.approx(50 / np.e, abs=5.0)
