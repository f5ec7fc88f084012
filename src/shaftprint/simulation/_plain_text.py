"""Formulas as plain functions of a few numbers, for what is found once a simulation."""

import math
from collections.abc import Callable, Sequence
from typing import TypeAlias

from shaftprint.models.equations._formula import Formula
from shaftprint.simulation._compile import plain_module_of
from shaftprint.simulation._text import statements

Numbers: TypeAlias = Sequence[float]
Plain: TypeAlias = Callable[[Numbers, Numbers, Numbers, Numbers, Numbers, float], list[float]]

LEAVES = {
    "parameter": "p[{}]",
    "state": "x[{}]",
    "past": "q[{}]",
    "sample": "z[{}]",
    "input": "u[{}]",
    "input rate": "0.0",
    "past rate": "0.0",
    "step": "step",
}

HEADER = '''"""Formulas of a structure; written by shaftprint, and written anew when they are missing."""

from bisect import bisect_left

from numpy import cos, exp, log, sin, sqrt, tanh


def minimum(a, b):
    return b if b.real < a.real else a


def maximum(a, b):
    return b if a.real < b.real else a


def choose(a, b, at_most, above):
    return at_most if a.real <= b.real else above


def absolute(a):
    return -a if a.real <= 0.0 else a


def table_slope(a, places, values):
    if a.real <= places[0] or a.real > places[-1]:
        return 0.0
    j = max(bisect_left(places, a.real), 1)
    return (values[j] - values[j - 1]) / (places[j] - places[j - 1])


def table(a, places, values):
    if a.real <= places[0]:
        return values[0]
    if a.real > places[-1]:
        return values[-1]
    j = max(bisect_left(places, a.real), 1)
    return values[j - 1] + (values[j] - values[j - 1]) / (places[j] - places[j - 1]) * (a - places[j - 1])
'''


def plain_function(formulas: Sequence[Formula]) -> Plain:
    """Return a function of parameters, states, pasts, samples, inputs and step that gives the formulas.

    All are not numbers where one divides by zero.
    """
    lines, results = statements(formulas, LEAVES)
    body = "".join(f"    {line}\n" for line in lines)
    text = f"{HEADER}\n\ndef formulas(p, x, q, z, u, step):\n{body}    return [{', '.join(results)}]\n"
    function: Plain = plain_module_of(text).formulas

    def guarded(p: Numbers, x: Numbers, q: Numbers, z: Numbers, u: Numbers, step: float) -> list[float]:
        try:
            return function(p, x, q, z, u, step)
        except (ZeroDivisionError, OverflowError):
            return [math.nan] * len(results)

    return guarded
