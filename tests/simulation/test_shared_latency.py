"""A latency that ends the paths of all inputs to an output only shifts it, also where it was corrected by too much."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.simulation import simulate_exactly

TIME = np.arange(0.0, 3.0, 0.01)


@pytest.mark.parametrize("latency_s", [0.0, 0.01, -0.01])
def test_torque_of_two_inputs_is_the_sum_of_both_shifted(latency_s):
    model = structure("GAUGE-HYBRID")
    values = model.vector({"t_gauge": latency_s, "s_m": 0.3})
    asked = {"n_set": np.where(TIME >= 1.0, 0.04, 0.0), "M_m": np.where(TIME >= 1.5, -0.08, 0.0)}
    both = simulate_exactly(model, values, TIME, asked, hold=True).outputs["M_s"]
    total = np.zeros(TIME.size)
    for name, moved in asked.items():
        alone = model.of_input(name)
        total += simulate_exactly(alone, values, TIME, {name: moved}, hold=True).outputs["M_s"]
    assert np.abs(both).max() > 0.05
    np.testing.assert_allclose(both, total, atol=2e-6)
