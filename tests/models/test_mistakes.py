"""What a newcomer writes wrong is said in a sentence that shows how it is right."""

import numpy as np
import pytest

from shaftprint.errors import StructureError
from shaftprint.models import (
    Combination,
    FirstOrderLag,
    FunctionBlock,
    Gain,
    Parameter,
    PIGovernor,
    RationalBlock,
    Structure,
    check_structure,
)

K = Parameter("K", "-", 0.1, 10.0, 1.0, "gain")
T = Parameter("T", "s", 0.01, 10.0, 1.0, "time")
S = 1j * np.array([0.3, 2.0])


def structure(outputs=None, **others):
    return Structure(**({"name": "S", "title": "s", "input": "u"} | {"outputs": outputs or {"y": lag()}} | others))


def lag():
    return Gain(K) * FirstOrderLag(T)


@pytest.mark.parametrize(
    ("mistake", "message"),
    [
        (
            lambda: structure({"y": Gain(2.0)}),
            r"block Gain: expected a Parameter, found 2\.0; a number multiplies a bl",
        ),
        (lambda: structure({"y": PIGovernor("K_p", K)}), r"block PIGovernor: expected a Parameter, found 'K_p'"),
        (lambda: FunctionBlock(lambda s, k: k / s, K), r"block of K: expected a tuple of parameters, such as \(K,\)"),
        (
            lambda: RationalBlock(lambda k: ([k], [1.0]), K),
            r"block of K: expected a tuple of parameters, such as \(K,\)",
        ),
        (lambda: FunctionBlock(lambda k: k, (K,)), r"block of K: expected a function of s, K, found one of k"),
        (
            lambda: RationalBlock(lambda k, t: ([k], [t]), (K,)),
            r"block of K: expected a function of K, found one of k, t",
        ),
        (lambda: FunctionBlock(3.0, ()), r"block without parameters: expected a function, found 3\.0"),
        (
            lambda: structure(inputs="uv"),
            r"structure S: expected a tuple of inputs such as \(\"uv\",\), found the text",
        ),
        (lambda: structure([lag()]), r"structure S: expected outputs by name such as \{\"y\": \.\.\.\}, found \["),
        (lambda: structure(lag()), r"structure S: expected outputs by name such as \{\"y\": \.\.\.\}, found "),
        (
            lambda: structure().tied("T", 3.0),
            r"tied parameter T: expected a formula such as lambda K: .*, found 3\.0; hold",
        ),
        (lambda: structure().tied("T", lambda x: x, [T]), r"tied parameter T: expected new parameters, found \[Param"),
        (
            lambda: structure().tied("T", lambda K: K).tied("K", lambda T: T),
            r"structure S: K cannot be tied, since T follows from it; write both formulas in other parameters",
        ),
        (
            lambda: structure().tied("T", lambda K: K).tied("K", lambda x: x, Parameter("x", "-", 0.0, 1.0, 0.5, "x")),
            r"structure S: K cannot be tied, since T follows from it",
        ),
        (
            lambda: structure(combinations=(Combination(name="q", unit="-", of=lambda p: p["Q"], meaning="q"),)),
            r"structure S, combination q: it names a parameter 'Q'; the structure has K, T\.",
        ),
        (
            lambda: structure(combinations=Combination(name="q", unit="-", of=lambda p: p["K"], meaning="q")),
            r"structure S: expected a tuple of combinations such as \(q,\)",
        ),
        (
            lambda: Parameter("K", 0.1, 10.0, 1.0, "gain", "-"),
            "parameter K: expected name, unit, lower bound, upper bound",
        ),
        (
            lambda: Parameter("K", "-", "0", 10.0, 1.0, "gain"),
            "parameter K: expected name, unit, lower bound, upper bound",
        ),
        (lambda: Parameter("K", "-", 0.0, 1.0, 5.0, "gain"), r"expected a value from 0\.0 to 1\.0, found 5\.0"),
        (lambda: Parameter("K", "V", 0.0, 1.0, 5.0, "gain"), r"expected a value from 0\.0 to 1\.0 V, found 5\.0"),
    ],
)
def test_on_the_spot(mistake, message):
    with pytest.raises(StructureError, match=message):
        mistake()


@pytest.mark.parametrize(
    "coefficients", [lambda k: [k, 1.0], lambda k: (k, [1.0, 2.0]), lambda k: [[k]], lambda k: ([k], 2.0), lambda k: k]
)
def test_coefficients_are_two_lists(coefficients):
    odd = structure({"y": RationalBlock(coefficients, (K,))})
    for use in (lambda: odd.response([2.0], S), lambda: odd.gradient([[2.0], [3.0]], S), lambda: check_structure(odd)):
        with pytest.raises(
            StructureError, match=r"block of K: expected two lists, numerator and denominator, highest po"
        ):
            use()


def test_functions_that_take_anything_are_believed():
    block = RationalBlock(lambda *values: ([values[0]], [values[1], 1.0]), (K, T))
    np.testing.assert_allclose(structure({"y": block}).response([2.0, 0.5], S)[0], 2.0 / (0.5 * S + 1.0))
    also = FunctionBlock(np.multiply, (K,))
    np.testing.assert_allclose(structure({"y": also}).response([2.0], S)[0], 2.0 * S)
    with_default = FunctionBlock(lambda s, k, power=2: k * s**power, (K,))
    np.testing.assert_allclose(structure({"y": with_default}).response([2.0], S)[0], 2.0 * S**2)


def test_a_combination_may_name_a_tied_parameter():
    number = Combination(name="K T", unit="s", of=lambda p: p["K"] * p["T"], meaning="both")
    tied = structure(combinations=(number,)).tied("T", lambda K: 2.0 * K)
    assert [c.name for c in tied.combinations] == ["T", "K T"]
    assert tied.combinations[1].of(tied.named([3.0])) == 18.0
