"""Formulas of the equations as functions in C."""

import math
import re
from collections.abc import Mapping, Sequence

from shaftprint.errors import ExportError
from shaftprint.models.equations._dialect import Dialect, statements
from shaftprint.models.equations._formula import Formula


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


def _table(node: Formula, x: str, free: int) -> tuple[list[str], str]:
    places, values = zip(*node.points, strict=True)
    columns = [
        f"static const double {letter}{free}[] = {c_array(of)};" for letter, of in (("x", places), ("y", values))
    ]
    return columns, f"{node.operation.replace(' ', '_')}({x}, {len(places)}, x{free}, y{free})"


C = Dialect(
    number=c_number,
    exponent=c_number,
    forms={"power": "pow({}, {})", "absolute": "fabs({})", "minimum": "least({}, {})", "maximum": "most({}, {})"},
    table=_table,
    assignment="const double {} = {};",
)


def c_function(name: str, formulas: Sequence[Formula], leaves: Mapping[str, Sequence[str]]) -> str:
    """Return a function that fills ``out`` with the values of formulas, each part computed once.

    ``leaves``: for each kind of leaf the member of ``Values`` it stands in, and the names of its places.
    """
    used: dict[str, str] = {}
    lines, names = statements(formulas, lambda node: _leaf(node, leaves, used), C)
    results = [f"out[{index}] = {result};" for index, result in enumerate(names)]
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
