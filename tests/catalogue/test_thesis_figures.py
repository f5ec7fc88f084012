"""The sensitivity figures of the thesis: which they are, and the values at which they are drawn."""

import numpy as np
import pytest

from shaftprint.catalogue import thesis_families


@pytest.fixture(scope="module")
def families():
    return {one.figure: one for one in thesis_families()}


def test_figures_are_those_of_the_thesis_in_their_order(families):
    assert list(families) == ["4.2", "4.3", "4.4", "4.5", "4.6", "4.7", "4.8", "B.1-B.2", "B.3-B.4", "D.1"]
    assert [one.data for one in families.values()] == [None, None, "core", *["governor"] * 4, *[None] * 3]


def test_open_loop_of_the_initial_model_is_that_of_equation_4_4(families):
    drawn = families["4.3"].structure
    omega = np.array([0.1, 1.0, 10.0])
    values = {one.name: one.value for one in drawn.parameters}
    s = 1j * omega
    expected = values["v"] * (values["K_p"] + values["K_i"] / s) / (values["tau_n"] * s + values["k_q"])
    found = drawn.response([values[name] for name in drawn.names], s)
    assert np.allclose(np.ravel(found), expected, rtol=1e-12)


@pytest.mark.parametrize(
    ("figure", "values", "bounds"),
    [
        ("4.5", {"K_p": 5.0, "K_i": 3.0}, {"K_p": (0.0, 15.0), "K_i": (0.0, 10.0)}),
        ("4.6", {"K_p": 10.0, "K_i": 3.0, "K_d": 1.0, "T_f": 0.01}, {}),
        ("4.7", {"K_p": 3.0, "K_i": 4.0}, {}),
        ("4.8", {"K_p": 3.0, "K_i": 4.0, "omega_n": 10.0, "zeta": 0.5}, {"omega_n": (6.0, 18.0), "zeta": (0.0, 1.0)}),
        ("D.1", {"g": 0.0, "v": 1.0}, {}),
    ],
)
def test_values_and_bounds_are_those_of_the_figure(families, figure, values, bounds):
    parameters = {one.name: one for one in families[figure].structure.parameters}
    assert {name: parameters[name].value for name in values} == values
    assert {name: (parameters[name].lower, parameters[name].upper) for name in bounds} == bounds
    assert set(families[figure].vary) <= set(parameters)
