"""Formulas as expressions of Modelica (Modelica Language Specification 3.6, sections 3.6 and 3.7)."""

import math
import re
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Final

from shaftprint.errors import ExportError
from shaftprint.escape import modelica_identifier
from shaftprint.models.equations._calculus import postorder
from shaftprint.models.equations._dialect import Dialect
from shaftprint.models.equations._formula import Formula

_WORDS: Final = """
algorithm and annotation block break class connect connector constant constrainedby der discrete each else elseif
elsewhen encapsulated end enumeration equation expandable extends external false final flow for function if import
impure in initial inner input loop model not operator or outer output package parameter partial protected public pure
record redeclare replaceable return stream then true type when while within
Real Integer Boolean String time delay sample pre abs sign sqrt min max sin cos tanh exp log smooth noEvent edge change
terminal assert
"""
RESERVED: Final = frozenset(_WORDS.split())
_CHOICES: Final = frozenset({"minimum", "maximum", "choose", "table", "table slope"})
_KNOWN: Final = frozenset(
    {"add", "multiply", "divide", "power", "absolute", "sqrt", "exp", "log", "sin", "cos", "tanh"} | _CHOICES
)


def modelica_name(text: str) -> str:
    """Return a text as an identifier of Modelica, in single quotes where it must be."""
    if re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", text) and text not in RESERVED:
        return text
    return modelica_identifier(text)


def modelica_number(value: float) -> str:
    """Return a number of Modelica, exact to the last bit, in brackets where it is negative.

    Raises ExportError if it is infinite or not a number: such a value must never become a limit.
    """
    if not math.isfinite(value):
        raise ExportError(f"export: expected finite numbers in the equations, found {value}; give the limit a value.")
    return repr(float(value)) if value >= 0.0 else f"({float(value)!r})"


class ModelicaText:
    """Expressions of formulas, with a variable for each part that is used more than once."""

    def __init__(self, formulas: Sequence[Formula], leaf: Callable[[Formula], str], name: Callable[[str], str]) -> None:
        self.shared: list[tuple[str, str, bool]] = []
        """Name and expression of each shared part, and whether it is made of parameters only."""
        self._leaf = leaf
        self._name = name
        self._texts: dict[int, str] = {}
        self._of_parameters: dict[int, bool] = {}
        self._opposites: dict[int, str] = {}
        self._kept = list(formulas)
        uses = Counter(id(formula) for formula in formulas)
        for node in postorder(formulas):
            # what a choice compares stands in its text twice
            twice = 2 if node.operation in _CHOICES else 1
            uses.update({id(part): twice for part in node.of})
        for node in postorder(formulas):
            self._add(node, uses[id(node)] > 1)

    def __getitem__(self, formula: Formula) -> str:
        """Return the expression of a formula."""
        return unbracketed(self._texts[id(formula)])

    def _add(self, node: Formula, shared: bool) -> None:
        constant = all(self._of_parameters[id(part)] for part in node.of)
        constant = constant and (bool(node.of) or node.operation in ("number", "parameter"))
        self._of_parameters[id(node)] = constant
        if node.operation == "number":
            self._texts[id(node)] = modelica_number(node.value)
            return
        if not node.of:
            self._texts[id(node)] = self._leaf(node)
            return
        text = self._sum(node) or self._expression(node, constant)
        if shared:
            name = self._name(f"part_{len(self.shared) + 1}")
            self.shared.append((name, unbracketed(text), constant))
            text = name
        elif node.operation == "multiply" and node.of[0].equals(-1.0):
            self._opposites[id(node)] = self._texts[id(node.of[1])]
        self._texts[id(node)] = text

    def _expression(self, node: Formula, constant: bool) -> str:
        """Return an operation on expressions."""
        if node.operation not in _KNOWN:
            raise ExportError(f"export: the operation {node.operation} is not known in Modelica.")
        dialect = OF_PARAMETERS if constant else OF_SIGNALS
        return dialect.expression(node, [self._texts[id(part)] for part in node.of])[1]

    def _sum(self, node: Formula) -> str:
        """Return a sum as a difference where one of its parts is the opposite of something; else nothing."""
        if node.operation != "add":
            return ""
        for left, right in (node.of, node.of[::-1]):
            if id(right) in self._opposites:
                return f"({self._texts[id(left)]} - {self._opposites[id(right)]})"
        return ""


def unbracketed(text: str) -> str:
    """Return an expression without a pair of brackets around the whole of it."""
    depth = 0
    for position, letter in enumerate(text):
        depth += (letter == "(") - (letter == ")")
        if depth == 0:
            is_enclosed = text[0] == "(" and position == len(text) - 1 and not text.startswith("(-")
            return text[1:-1] if is_enclosed else text
    return text


def _table(node: Formula, x: str, free: int) -> tuple[tuple[str, ...], str]:
    """Return a piecewise linear function, constant beyond its ends, or its slope."""
    points, slope = node.points, node.operation == "table slope"
    (first, at_first), (_, at_last) = points[0], points[-1]
    text = modelica_number(0.0 if slope else at_last)
    for (x0, y0), (x1, y1) in reversed(list(pairwise(points))):
        rise = modelica_number((y1 - y0) / (x1 - x0))
        inside = rise if slope else f"{modelica_number(y0)} + {rise} * ({x} - {modelica_number(x0)})"
        text = f"if {x} <= {modelica_number(x1)} then {inside} else {text}"
    text = f"if {x} <= {modelica_number(first)} then {modelica_number(0.0 if slope else at_first)} else {text}"
    return (), f"({text})" if slope else f"smooth(0, {text})"


_FORMS: Final = {"power": "({}) ^ {}", "absolute": "abs({})", "choose": "(if {} <= {} then {} else {})"}
# A choice between signals is one of ``if``, so that the moment at which a limit begins to act is found; where both
# sides meet, it is told to be continuous. One between parameters is a function.
OF_PARAMETERS: Final = Dialect(
    number=modelica_number,
    exponent=modelica_number,
    forms=_FORMS | {"minimum": "min({}, {})", "maximum": "max({}, {})"},
    table=_table,
)
OF_SIGNALS: Final = replace(
    OF_PARAMETERS,
    forms=_FORMS
    | {
        "minimum": "smooth(0, if {0} <= {1} then {0} else {1})",
        "maximum": "smooth(0, if {1} <= {0} then {0} else {1})",
    },
)
