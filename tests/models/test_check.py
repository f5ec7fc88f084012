"""A block of one's own that contradicts itself is found before a fit, with the parameter."""

from dataclasses import dataclass

import numpy as np
import pytest
from benchmarks.structure_check import between_other_bounds, changes, spoilt

from shaftprint.catalogue import STRUCTURES, structure
from shaftprint.errors import StructureError
from shaftprint.models import (
    Block,
    Delay,
    FunctionBlock,
    Gain,
    Integrator,
    Parameter,
    RationalBlock,
    Structure,
    check_structure,
)

T = Parameter("T", "s", 0.0, 2.0, 0.5, "time constant")


@dataclass(frozen=True, slots=True, eq=False)
class Lag(Block):
    """1 / (T s + 1), with the derivative and the ratio that a test gives it."""

    time: Parameter
    slope: object = None
    fraction: object = None

    @property
    def parameters(self):
        return (self.time,)

    def transfer(self, s, t):
        return 1.0 / (t * s + 1.0)

    def derivatives(self, s, response, t):
        return (-s * response**2,) if self.slope is None else self.slope(s, response, t)

    def ratio(self, t):
        return (np.array([1.0]), np.array([t, 1.0])) if self.fraction is None else self.fraction(t)


def alone(block):
    return Structure(name="MINE", title="mine", input="u", outputs={"y": block})


@pytest.mark.parametrize("name", STRUCTURES)
def test_the_shipped_structures_agree_with_themselves(name):
    check_structure(structure(name))


@pytest.mark.parametrize("name", STRUCTURES)
def test_the_shipped_structures_agree_with_themselves_between_any_bounds(name):
    """Where a response no longer feels a parameter, its numerical derivative is rounding and proves nothing."""
    rng = np.random.default_rng(0)
    for _ in range(10):
        check_structure(between_other_bounds(structure(name), rng))


@pytest.mark.parametrize("name", STRUCTURES)
def test_every_wrong_derivative_of_the_shipped_structures_is_found(name):
    """One part in a hundred is ten times what may be off; equal derivatives may be swapped."""
    shipped = structure(name)
    for block in shipped.blocks:
        for words, change in changes(len(block.parameters)):
            refused, differs = spoilt(shipped, block, change)
            assert refused == differs, f"{type(block).__name__}: {words}"


def test_a_wrong_derivative_is_found_between_any_bounds():
    rng = np.random.default_rng(0)
    wrong = alone(Lag(T, slope=lambda s, h, t: (-1.01 * s * h**2,)))
    for _ in range(30):
        with pytest.raises(StructureError, match="its derivative to T is"):
            check_structure(between_other_bounds(wrong, rng))


def test_a_ratio_that_loses_the_imaginary_step_does_not_condemn_a_right_derivative():
    """``abs`` drops the imaginary part and ``max`` refuses it: differences are taken instead."""
    for size in (abs, lambda t: max(t, 0.0)):
        check_structure(alone(Lag(T, fraction=lambda t, size=size: (np.array([1.0]), np.array([size(t), 1.0])))))


def test_right_blocks_of_every_kind_pass():
    gain, late = Parameter("k", "-", -5.0, 5.0, 0.0, "k"), Parameter("t", "s", 0.0, 50.0, 20.0, "delay")
    check_structure(alone(Lag(T) * Gain(gain) * Integrator() * Delay(late)))
    check_structure(alone(FunctionBlock(lambda s, t: np.exp(-s * t) / (s + 1.0), (late,))))
    check_structure(alone(RationalBlock(lambda t: ([t, 1.0], [1.0, 2.0, t]), (T,))))
    tied = alone(Lag(T)).tied("T", lambda log_T: np.exp(log_T), Parameter("log_T", "-", -3.0, 0.0, -1.0, "log"))
    check_structure(tied.scaled(T=3.0))
    held = Parameter("c", "-", -np.inf, np.inf, 2.0, "c", held=True)
    check_structure(alone(Gain(held)))


@pytest.mark.parametrize(
    ("block", "message"),
    [
        (
            Lag(T, slope=lambda s, h, t: (s * h**2,)),
            r"structure MINE, block Lag of T: its derivative to T is .* at .* rad/s, the numerical one .*; correct "
            r"derivatives\(\), or leave it out",
        ),
        (Lag(T, slope=lambda s, h, t: ()), r"block Lag of T: derivatives\(\) gives 0 arrays for 1 parameters"),
        (
            Lag(T, fraction=lambda t: (np.array([1.0]), np.array([1.0, t]))),
            r"block Lag of T: ratio\(\) gives .* rad/s, transfer\(\) .*: coefficients stand highest power first",
        ),
        (
            FunctionBlock(lambda s, t: 1.0 / (np.ravel(t)[0] * s + 1.0), (T,)),
            r"block FunctionBlock of T: several parameter sets at once .* one by one: let each value keep its shape",
        ),
        (FunctionBlock(lambda s, t: 1j * t * s / s, (T,)), r"block FunctionBlock of T: its response at -s is not the"),
        (FunctionBlock(lambda s, t: np.log(t - 2.0) * s, (T,)), r"block FunctionBlock of T: .* not finite .* T = 0.5"),
        (
            FunctionBlock(lambda s, t: np.ones(3), (T,)),
            r"FunctionBlock of T: expected a response of shape \(3, 21\)",
        ),
    ],
    ids=["slope", "no slope", "ratio", "shape of values", "not real", "not finite", "shape"],
)
def test_what_is_wrong_is_said(block, message):
    with np.errstate(invalid="ignore"), pytest.raises(StructureError, match=message):
        check_structure(alone(block))


def test_an_error_of_the_block_itself_comes_through():
    with pytest.raises(ZeroDivisionError):
        check_structure(alone(FunctionBlock(lambda s, t: 1 / 0, (T,))))
