"""Numbers of blocks found in made-up records: an inertia, a force that is always there, a drag with the square."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.bench.drawn_lags import identified, levels, written
from tests.bench.test_blocks import text_of

INTERVAL = 0.02
TRUTH = {"F_0": -1.5, "c": 0.8, "J": 3.0}
BLOCKS = (
    ("offset", "constant", 'parameters = { value = "F_0" }'),
    ("square", "power", 'inputs = ["w"]\nexponent = 2\nkeeps_sign = true'),
    ("drag", "gain", 'inputs = ["square"]\nparameters = { gain = "c" }'),
    ("w", "inertia", 'inputs = ["u", "v", "offset", "-drag"]\nparameters = { inertia = "J" }'),
)
PARAMETERS = (("F_0", "N", -20.0, 20.0, 0.0), ("c", "N s2/m2", 0.01, 100.0, 2.0), ("J", "kg", 0.1, 100.0, 1.0))
FIT = '[[start]]\nname = "w"\nvalue = 0.5\n\n[fit]\nstart = "known"\noffset = "none"\ninputs_hold = true\n'


@pytest.mark.slow
def test_an_inertia_a_constant_force_and_a_drag_with_the_square_are_found(tmp_path):
    rng = np.random.default_rng(5)
    force = 12.0 * levels(rng, 600, 25)

    def rate(_, w, u):
        return (u + TRUTH["F_0"] - TRUTH["c"] * w * np.abs(w)) / TRUTH["J"]

    speed = [0.5]
    for u in force[:-1]:
        moved = solve_ivp(rate, (0.0, INTERVAL), [speed[-1]], args=(u,), rtol=1e-9, atol=1e-11)
        speed.append(float(moved.y[0, -1]))
    columns = {"u": force, "v": np.zeros(force.size), "w": np.array(speed) + 0.01 * rng.standard_normal(force.size)}
    path = written(tmp_path, "run", columns, INTERVAL)
    found = identified(tmp_path, path, text=text_of(["w"], BLOCKS, PARAMETERS, FIT))
    for parameter in found.identification.parameters:
        assert abs(parameter.value - TRUTH[parameter.name]) < 4.0 * parameter.std, parameter.name
        assert parameter.std < 0.02 * abs(TRUTH[parameter.name]), parameter.name
    assert found.verdict.trustworthy
