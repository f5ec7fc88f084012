"""States at the start of a record: those that show nothing cost no simulation, and do not move."""

import numpy as np
import pytest

from shaftprint.time_domain._initial_states import best_states

TIME = np.linspace(0.0, 3.0, 400)
# a decay whose size is sought; beside it bristles of a friction that slides, of which the record shows only rounding
DECAY, BRISTLES = np.exp(-TIME), 1e-9 * np.exp(-50.0 * TIME)


def found(first, size=2.0, noise=1.0):
    """Return the states that are found of data with a decay of some size, and how many simulations that took."""
    data = size * DECAY + noise * np.random.default_rng(1).standard_normal(TIME.size)
    count = 0

    def simulated(states):
        nonlocal count
        count += 1
        # nothing of the bristles beyond rounding: the slope says more than a simulation shows
        return np.stack([states[0] * DECAY, DECAY, BRISTLES])[:, :, None]

    states, _ = best_states(simulated, lambda rows: rows[:, :, 0], data=data, first=np.array(first))
    return states, count, data


@pytest.mark.parametrize("first", [[1.0, 1.0], [30.0, -0.4], [0.0, 1.0]])
def test_a_state_that_shows_nothing_stays_where_it_is(first):
    states, count, data = found(first)
    # least squares by hand: sum of y e over sum of e squared
    assert states[0] == pytest.approx(data @ DECAY / (DECAY @ DECAY), rel=1e-6)
    assert states[1] == first[1]
    # the start, and the step that is exact for what is linear
    assert count <= 2
