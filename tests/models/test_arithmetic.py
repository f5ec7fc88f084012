"""Blocks are composed with the signs of arithmetic, numbers among them."""

import numpy as np
import pytest

from shaftprint.errors import StructureError
from shaftprint.models import Constant, Gain, Parameter, RationalBlock, Structure, feedback, is_stable
from shaftprint.models._expression import Inverse
from shaftprint.models._margins import poles

S = 1j * np.array([0.05, 0.7, 3.0, 19.0])
A, B = (Parameter(name, "1/s", 0.1, 10.0, 1.0, name) for name in ("a", "b"))
G = RationalBlock(lambda a: ([1.0], [1.0, a]), (A,))
H = RationalBlock(lambda b: ([1.0, b], [1.0]), (B,))
g, h = 1.0 / (S + 2.0), S + 3.0
dg, dh = -1.0 / (S + 2.0) ** 2, np.ones(4)


@pytest.mark.parametrize(
    ("expression", "value", "to_a", "to_b"),
    [
        (G - H, g - h, dg, -dh),
        (G / H, g / h, dg / h, -g / h**2 * dh),
        (-G, -g, -dg, 0.0),
        (1 - G, 1.0 - g, -dg, 0.0),
        (G - 1.0, g - 1.0, dg, 0.0),
        (1 + G, 1.0 + g, dg, 0.0),
        (G + 1, g + 1.0, dg, 0.0),
        (2.5 * G, 2.5 * g, 2.5 * dg, 0.0),
        (G * np.float64(2.5), 2.5 * g, 2.5 * dg, 0.0),
        (np.float64(2.5) * G, 2.5 * g, 2.5 * dg, 0.0),
        (G / 4, g / 4.0, dg / 4.0, 0.0),
        (1 / G, 1.0 / g, -dg / g**2, 0.0),
        (3 / (1 + G * H), 3.0 / (1.0 + g * h), -3.0 * dg * h / (1.0 + g * h) ** 2, -3.0 * g / (1.0 + g * h) ** 2),
    ],
)
def test_value_and_derivatives(expression, value, to_a, to_b):
    # H stands in a structure of its own, so that both parameters are there
    pair = Structure(name="x", title="x", input="u", outputs={"y": expression, "z": G + H})
    response, slopes = pair.gradient(pair.vector({"a": 2.0, "b": 3.0}), S, ["a", "b"])
    np.testing.assert_allclose(response[0], value, rtol=1e-13)
    np.testing.assert_allclose(slopes[0, 0], np.broadcast_to(to_a, 4), rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(slopes[1, 0], np.broadcast_to(to_b, 4), rtol=1e-12, atol=1e-15)


def test_a_number_has_no_poles_and_its_place_in_a_polynomial():
    # 5 (s + 1 - 2) / ... : the loop 4 / (s + a) closed has its pole at -a - 4
    loop = Structure(name="x", title="x", input="r", outputs={"y": feedback(4 * G)})
    assert poles(loop, [2.0]) == pytest.approx([-6.0])
    assert is_stable(loop, [2.0])
    assert Constant(2.0).polynomials({}) == ([2.0], [1.0])


def test_a_parameter_is_no_block():
    for mistake in (lambda: A * G, lambda: G * A, lambda: G + A, lambda: A - G, lambda: G / A, lambda: feedback(G, A)):
        with pytest.raises(StructureError, match=r"a is a parameter, not a block: write Gain\(a\)"):
            mistake()
    with pytest.raises(
        StructureError, match="structure x, output y: expected an expression of blocks, found a paramet"
    ):
        Structure(name="x", title="x", input="u", outputs={"y": A})
    with pytest.raises(
        StructureError, match=r"structure x, output y from u: expected an expression of blocks, found .2."
    ):
        Structure(name="x", title="x", inputs=("u", "v"), outputs={"y": {"u": "2", "v": G}})


def test_anything_else_is_refused_as_python_does():
    with pytest.raises(TypeError, match="unsupported operand"):
        G + "2"
    with pytest.raises(TypeError, match="unsupported operand"):
        [1.0] - G
    with pytest.raises(TypeError, match="unsupported operand"):
        G / 1j


def test_a_gain_of_nothing_but_numbers():
    fixed = Structure(name="x", title="x", input="u", outputs={"y": Gain(A) * 0.5 + Inverse(Constant(4.0))})
    np.testing.assert_allclose(fixed.response([3.0], S)[0], np.full(4, 1.75))
