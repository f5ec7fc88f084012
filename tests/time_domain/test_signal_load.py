"""The mean load of a record that ends faster than it began: torque that accelerates the propeller is no load."""

import numpy as np
import pytest

from shaftprint.time_domain._initial_states import best_states
from shaftprint.time_domain._signal_records import load_of


@pytest.mark.parametrize("ends", [-0.3, 0.0, 0.5])
def test_torque_that_accelerates_the_propeller_is_no_load(ends):
    time = np.arange(2400) / 20.0
    n = ends * (1.0 - np.exp(-np.maximum(time - 2.0, 0.0) / 0.6))
    torque = 1.07 * (1.0 + n) ** 2 - 1.0 + 0.32 * np.gradient(n) * 20.0
    used = np.ones(time.size, dtype=bool)
    assert load_of(n, torque, used, 20.0) == pytest.approx(1.07, rel=1e-9)


def test_states_of_a_loop_that_bends_do_not_run_away():
    """An arc tangent answers less and less: whole steps from far away fly off, each farther than the last."""
    time, truth = np.linspace(0.5, 1.5, 40), 0.3

    def simulated(states):
        bent = 4.0 * states[0] * time
        return np.array([np.arctan(bent), 4.0 * time / (1.0 + bent**2)])[:, :, None]

    data = simulated(np.array([truth]))[0].ravel() + 1e-3 * np.cos(40.0 * time)
    states, _ = best_states(simulated, lambda rows: rows[:, :, 0], data=data, first=np.array([1.5]))
    assert states == pytest.approx([truth], abs=0.02)
