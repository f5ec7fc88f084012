"""Formulas of the equations as functions in C."""

import math
import re
from collections.abc import Mapping, Sequence

from shaftprint.errors import ExportError
from shaftprint.models.equations._calculus import postorder
from shaftprint.models.equations._formula import Formula

_SIGNS = {"add": "({} + {})", "multiply": "({} * {})", "divide": "({} / {})"}
_FUNCTIONS = {"absolute": "fabs", "minimum": "least", "maximum": "most"}


def identifier(text: str) -> str:
    """Return a text as a name in C: letters, digits and underscores, not a digit first."""
    letters = re.sub(r"[^A-Za-z0-9_]", "_", text) or "_"
    return f"_{letters}" if letters[0].isdigit() else letters


def c_number(value: float) -> str:
    """Return a number as C writes it, exact to the last bit.

    Raises ExportError if it is infinite or not a number: such a value must never become a limit.
    """
    if not math.isfinite(value):
        raise ExportError(f"export: expected finite numbers in the equations, found {value}; give the limit a value.")
    return repr(float(value))


def c_array(values: Sequence[float]) -> str:
    """Return the initial values of an array; a zero stands behind them, so that no array is empty."""
    return "{" + ", ".join([*(c_number(value) for value in values), "0"]) + "}"


def c_integers(values: Sequence[int]) -> str:
    """Return the same for integers."""
    return "{" + ", ".join(str(value) for value in [*values, 0]) + "}"


def c_function(name: str, formulas: Sequence[Formula], leaves: Mapping[str, Sequence[str]]) -> str:
    """Return a function that fills ``out`` with the values of formulas, each part computed once.

    ``leaves``: for each kind of leaf the member of ``Values`` it stands in, and the names of its places.
    """
    used: dict[str, str] = {}
    lines: list[str] = []
    by_text: dict[str, str] = {}
    names: dict[int, str] = {}
    for node in postorder(formulas):
        if node.operation == "number":
            names[id(node)] = c_number(node.value) if node.value >= 0.0 else f"({c_number(node.value)})"
        elif not node.of:
            names[id(node)] = _leaf(node, leaves, used)
        else:
            text = _operation(node, [names[id(part)] for part in node.of], lines, len(by_text))
            if text not in by_text:
                by_text[text] = f"t{len(by_text)}"
                lines.append(f"const double {by_text[text]} = {text};")
            names[id(node)] = by_text[text]
    results = [f"out[{index}] = {names[id(formula)]};" for index, formula in enumerate(formulas)]
    body = [*used.values(), *lines, *results]
    if not used:
        body.insert(0, "(void)v;")
    if not results:
        body.append("(void)out;")
    text = "".join(f"    {line}\n" for line in body)
    return f"void {name}(const Values *v, double *out) {{\n{text}}}\n"


def _leaf(node: Formula, leaves: Mapping[str, Sequence[str]], used: dict[str, str]) -> str:
    """Return the name of a leaf, and note the line that gives it its value."""
    member, *prefixes = leaves[node.operation]
    name = prefixes[node.place] if prefixes else member
    member_text = f"v->{member}[{node.place}]" if prefixes else f"v->{member}"
    used.setdefault(name, f"const double {name} = {member_text};")
    return name


def _operation(node: Formula, parts: list[str], lines: list[str], number: int) -> str:
    if node.operation in _SIGNS:
        return _SIGNS[node.operation].format(*parts)
    if node.operation == "power":
        return f"pow({parts[0]}, {c_number(node.value)})"
    if node.operation in ("table", "table slope"):
        places, values = zip(*node.points, strict=True)
        for letter, column in (("x", places), ("y", values)):
            lines.append(f"static const double {letter}{number}[] = {c_array(column)};")
        function = node.operation.replace(" ", "_")
        return f"{function}({parts[0]}, {len(places)}, x{number}, y{number})"
    return f"{_FUNCTIONS.get(node.operation, node.operation)}({', '.join(parts)})"
