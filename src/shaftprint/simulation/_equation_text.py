"""Source text that every kernel of a program shares: its equations as functions of numbers."""

from collections.abc import Iterable, Sequence

from shaftprint.models import Quantity
from shaftprint.simulation._hoisted import Hoisted, Slopes
from shaftprint.simulation._text import statements

HEADER = '''"""Compiled equations of a structure; written by shaftprint, and written anew when they are missing."""

import numpy as np
from numba import njit
from numpy import cos, exp, log, sin, sqrt, tanh


@njit(cache=True, fastmath={"contract"})
def minimum(a, b):
    return a if a.real <= b.real else b


@njit(cache=True, fastmath={"contract"})
def maximum(a, b):
    return a if b.real <= a.real else b


@njit(cache=True, fastmath={"contract"})
def choose(a, b, at_most, above):
    return at_most if a.real <= b.real else above


@njit(cache=True, fastmath={"contract"})
def absolute(a):
    return -a if a.real <= 0.0 else a


@njit(cache=True, fastmath={"contract"})
def table_slope(a, places, values):
    x = a.real
    if x <= places[0] or x > places[-1]:
        return 0.0
    j = 1
    while places[j] < x:
        j += 1
    return (values[j] - values[j - 1]) / (places[j] - places[j - 1])


@njit(cache=True, fastmath={"contract"})
def table(a, places, values):
    x = a.real
    if x <= places[0]:
        return values[0] + 0.0 * a
    if x > places[-1]:
        return values[-1] + 0.0 * a
    j = 1
    while places[j] < x:
        j += 1
    return values[j - 1] + (values[j] - values[j - 1]) / (places[j] - places[j - 1]) * (a - places[j - 1])


@njit(cache=True, fastmath={"contract"})
def cubic(x):
    """Return Lagrange's weights of nodes 0, 1, 2, 3 at a place, and their slopes."""
    a, b, c, d = x, x - 1.0, x - 2.0, x - 3.0
    return (
        -b * c * d / 6.0,
        a * c * d / 2.0,
        -a * b * d / 2.0,
        a * b * c / 6.0,
        -(c * d + b * d + b * c) / 6.0,
        (c * d + a * d + a * c) / 2.0,
        -(b * d + a * d + a * b) / 2.0,
        (b * c + a * c + a * b) / 6.0,
    )
'''

LEAVES = {
    "state": "x{}",
    "input": "u{}",
    "input rate": "r{}",
    "past": "p{}",
    "past rate": "q{}",
    "sample": "z{}",
    "constant": "c{}",
}


class EquationText:
    """The equations of one program as functions."""

    def __init__(self, equations: Hoisted, inputs: int) -> None:
        self.equations = equations
        self.states = len(equations.rates)
        self.inputs = inputs
        self.lates = len(equations.lates)
        self.samples = len(equations.values)
        self.outputs = len(equations.signals)
        self.groups = {
            "rates": equations.rates,
            "lates": equations.lates,
            "outputs": equations.signals,
            "values": equations.values,
            "delays": equations.delays,
        }
        self.slopes = {name: Slopes(group) for name, group in self.groups.items()}
        self.uses_change = any(
            leaf.operation == "past rate" for slopes in self.slopes.values() for _, leaf in slopes.entries
        )

    def functions(self, *, slopes: bool) -> list[str]:
        """Return the functions of the formulas, and of their derivatives where they are wanted."""
        found = [self._function(name, group) for name, group in self.groups.items()]
        if slopes:
            found += [self._function(f"{name}_slopes", group.formulas) for name, group in self.slopes.items()]
        return [text for text in found if text]

    def arguments(self, stage: str) -> str:
        """Return what the functions take.

        Parameters
        ----------
        stage
            Which states, 0 for those of the node, and at which time: ``a``, ``m`` or ``b`` for the start, middle and
            end of the step.
        """
        state, time = stage[0], stage[1]
        names = [f"{'x' if state == '0' else f's{state}_'}{i}" for i in range(self.states)]
        names += [f"u{i}{time}" for i in range(self.inputs)]
        names += [f"r{i}" for i in range(self.inputs)]
        names += [f"p{i}{time}" for i in range(self.lates)]
        names += [f"q{i}{time}" for i in range(self.lates)] if self.uses_change else []
        names += [f"z{i}" for i in range(self.samples)]
        return ", ".join([*names, *self._constants])

    @property
    def _constants(self) -> list[str]:
        return [f"c{i}" for i in range(len(self.equations.constants))]

    def unpacked(self) -> list[str]:
        """Return how the constants get names: what is loaded once need not be loaded at every step."""
        return [f"{name} = c[{i}]" for i, name in enumerate(self._constants)]

    def assigned(self, letter: str, group: str, stage: str) -> list[str]:
        """Return the line that gives the formulas of a group names, none where there are no formulas."""
        count = len(self.groups[group])
        names = ", ".join(f"{letter}{i}" for i in range(count))
        return [f"({names},) = {group}({self.arguments(stage)})"] if count else []

    def _function(self, name: str, formulas: Sequence[Quantity]) -> str:
        if not formulas:
            return ""
        lines, found = statements(formulas, LEAVES)
        names = [f"x{i}" for i in range(self.states)]
        names += [f"u{i}" for i in range(self.inputs)] + [f"r{i}" for i in range(self.inputs)]
        names += [f"p{i}" for i in range(self.lates)]
        names += [f"q{i}" for i in range(self.lates)] if self.uses_change else []
        names += [f"z{i}" for i in range(self.samples)]
        body = indented([*lines, f"return ({', '.join(found)},)"])
        return (
            f"@njit(cache=True, fastmath={{'contract'}})\ndef {name}({', '.join([*names, *self._constants])}):\n{body}"
        )


def indented(lines: Iterable[str]) -> str:
    """Return lines as the body of a function."""
    return "".join(f"    {line}\n" for line in lines)
