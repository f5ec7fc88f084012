"""Source text that every kernel of a program shares: its equations as functions of one list of values.

All that the equations are made of stands in one list ``v``, in the order of ``EquationText.starts``; what they make of
it is written behind. Derivatives stand in a list ``w`` of the same order with ``LANES`` numbers for each value, one for
each parameter, a block that the compiler can treat as one vector.
"""

from collections.abc import Iterable, Sequence

from shaftprint.models.equations._calculus import postorder
from shaftprint.models.equations._formula import Formula
from shaftprint.simulation._loop_invariants import FormulaSlopes, Hoisted
from shaftprint.simulation._text import statements

LANES = 16
# Once a sample a state and its derivatives below this are nothing.
FADED = 1e-200

HEADER = '''"""Compiled equations of a structure; written by shaftprint, and written anew when they are missing."""

import numpy as np
from numba import njit
from numpy import cos, exp, log, sin, sqrt, tanh

from shaftprint.kernels._compiled import compiled

HOW = {"error_model": "numpy", "fastmath": {"contract"}, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
INNER, PLACED = njit(**HOW), njit(**HOW, forceinline=True)
OUTER = compiled(fastmath={"contract"}, nogil=True)


# written so, these are one instruction of the processor each, and the first of two equal ones
@INNER
def minimum(a, b):
    return b if b.real < a.real else a


@INNER
def maximum(a, b):
    return b if a.real < b.real else a


@INNER
def choose(a, b, at_most, above):
    return at_most if a.real <= b.real else above


@INNER
def absolute(a):
    return -a if a.real <= 0.0 else a


@INNER
def table_slope(a, places, values):
    x = a.real
    if x <= places[0] or x > places[-1]:
        return 0.0
    j = 1
    while places[j] < x:
        j += 1
    return (values[j] - values[j - 1]) / (places[j] - places[j - 1])


@INNER
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
'''

LEAVES = {
    "state": "x{}",
    "past": "p{}",
    "past rate": "q{}",
    "sample": "z{}",
    "constant": "c{}",
    "input": "u{}",
    "input rate": "r{}",
}


class EquationText:
    """The equations of one program as functions."""

    def __init__(self, equations: Hoisted, inputs: int) -> None:
        self.equations = equations
        self.inputs = inputs
        self.groups: dict[str, Sequence[Formula]] = {
            "rates": equations.rates,
            "lates": equations.lates,
            "values": equations.values,
            "outputs": equations.signals,
            "delays": equations.delays,
        }
        states, lates, samples = (len(self.groups[name]) for name in ("rates", "lates", "values"))
        counts = {
            "state": states,
            "past": lates,
            "past rate": lates,
            "sample": samples,
            "constant": len(equations.constants),
            "input": inputs,
            "input rate": inputs,
            "result": max(len(group) for group in self.groups.values()),
            # what a kernel keeps: states at a stage and the sum up to it; late signals, how fast they change, and
            # delays, each at its middle and its end; delays at the last node
            "stage": states,
            "total": states,
            "late": 2 * lates,
            "late rate": 2 * lates,
            "delay": 2 * lates,
            "before": len(equations.varying),
        }
        self.counts = counts
        self.starts: dict[str, int] = {}
        self.size = 0
        for kind, count in counts.items():
            self.starts[kind] = self.size
            self.size += count

    def constants(self) -> str:
        """Return the lines that name numbers and places of all kinds of values, known when a kernel is compiled."""
        places = {f"{kind.upper().replace(' ', '_')}_0": start for kind, start in self.starts.items()}
        counts = {
            "SIZE": self.size,
            "LANES": LANES,
            "FADED": FADED,
            "STATES": self.counts["state"],
            "LATES": self.counts["past"],
            "SAMPLES": self.counts["sample"],
            "INPUTS": self.inputs,
            "OUTPUTS": len(self.equations.signals),
            "VARYING": len(self.equations.varying),
            "CHANGES": int(self._uses_changes),
        }
        return "".join(f"{name} = {value}\n" for name, value in (counts | places).items())

    def functions(self, names: Iterable[str], *, slopes: bool) -> list[str]:
        """Return a function for each group of formulas, and one that finds their derivatives too where wanted."""
        groups = {name: self.groups[name] for name in names}
        texts = [self._function(name, group) for name, group in groups.items()]
        if slopes:
            texts += [self._with_slopes(f"{name}_along", group) for name, group in groups.items()]
        return texts

    @property
    def _uses_changes(self) -> bool:
        """Return whether the equations ask how fast a late signal changes."""
        formulas = [formula for group in self.groups.values() for formula in group]
        return any(node.operation == "past rate" for node in postorder(formulas))

    def _function(self, name: str, formulas: Sequence[Formula]) -> str:
        lines, results = statements(formulas, LEAVES)
        body = [*self._leaves(formulas), *lines, *self._results(results), "return"]
        return f"@INNER\ndef {name}(v):\n{indented(body)}"

    def _with_slopes(self, name: str, formulas: Sequence[Formula]) -> str:
        slopes = FormulaSlopes(formulas)
        every = [*formulas, *slopes.formulas]
        lines, results = statements(every, LEAVES)
        body = [*self._leaves(every), *lines, *self._results(results[: len(formulas)])]
        factors = results[len(formulas) :]
        if formulas:
            body.append(f"for lane in range({LANES}):")
        for index in range(len(formulas)):
            terms = [
                f"{factor} * w[{LANES * self._place(leaf)} + lane]"
                for factor, (formula, leaf) in zip(factors, slopes.entries, strict=True)
                if formula == index
            ]
            result = LANES * (self.starts["result"] + index)
            body.append(f"    w[{result} + lane] = {' + '.join(terms) or '0.0'}")
        return f"@INNER\ndef {name}(v, w):\n{indented([*body, 'return'])}"

    def _place(self, leaf: Formula) -> int:
        return self.starts[leaf.operation] + leaf.place

    def _leaves(self, formulas: Sequence[Formula]) -> list[str]:
        """Return the lines that give names to the values that formulas are made of."""
        leaves = {
            LEAVES[node.operation].format(node.place): self._place(node)
            for node in postorder(formulas)
            if node.operation in LEAVES
        }
        return [f"{name} = v[{offset}]" for name, offset in leaves.items()]

    def _results(self, results: Sequence[str]) -> list[str]:
        return [f"v[{self.starts['result'] + index}] = {name}" for index, name in enumerate(results)]


def indented(lines: Iterable[str]) -> str:
    """Return lines as the body of a function."""
    return "".join(f"    {line}\n" for line in lines)
