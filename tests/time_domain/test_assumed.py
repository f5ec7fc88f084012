"""What a record says less of where a number is assumed."""

import numpy as np
import pytest

from shaftprint.time_domain._assumed import shortened
from shaftprint.time_domain._initial_states import best_states


def test_what_an_assumed_number_looks_like_is_known_as_little_as_the_number():
    """One observation of k + q with unit noise, q assumed to 3: k is known to sqrt(1 + 9)."""
    column = np.array([[0.0, 3.0]])
    rows = np.array([[0.0, 1.0], [1.0, 0.0]])
    along, across = shortened(rows, column)
    assert 1.0 / np.linalg.norm(along) == pytest.approx(np.sqrt(10.0))
    assert across == pytest.approx([1.0, 0.0])


def test_residuals_beside_assumed_numbers_are_white():
    rng = np.random.default_rng(4)
    columns = rng.standard_normal((2, 5)) * np.array([[0.3], [4.0]])
    root = shortened(np.eye(5), columns)
    assert root @ (np.eye(5) + columns.T @ columns) @ root.T == pytest.approx(np.eye(5))


def test_states_near_their_end_cost_one_simulation_a_step():
    """Of two states whose outputs bend a little: each simulation tells its slopes."""
    time, truth, runs = np.linspace(0.0, 1.0, 40), np.array([2.0, 0.5]), []

    def simulated(states):
        runs.append(states)
        output = states[0] * np.exp(-time) + states[1] ** 2 * time
        return np.array([output, np.exp(-time), 2.0 * states[1] * time])[:, :, None]

    data = simulated(truth)[0].ravel() + 1e-3 * np.cos(40.0 * time)
    runs.clear()
    states, _ = best_states(simulated, lambda rows: rows[:, :, 0], data=data, first=np.array([1.0, 0.7]))
    assert states == pytest.approx(truth, abs=2e-3)
    assert len(runs) <= 5
