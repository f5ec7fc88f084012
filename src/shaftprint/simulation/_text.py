"""Formulas as source text: each sub-formula once, in an order in which it can be computed."""

from collections.abc import Mapping, Sequence

from shaftprint.models.equations._calculus import postorder
from shaftprint.models.equations._formula import Formula

_SIGNS = {"add": "({} + {})", "multiply": "({} * {})", "divide": "({} / {})"}


def statements(
    formulas: Sequence[Formula], leaves: Mapping[str, str], prefix: str = "t"
) -> tuple[list[str], list[str]]:
    """Return assignments and the names or numbers that hold the formulas.

    ``leaves``: what to write for a leaf by its kind, with ``{}`` for its place, such as ``{"state": "x{}"}``.
    ``prefix``: first letters of the names of intermediate values.
    """
    lines: list[str] = []
    by_text: dict[str, str] = {}
    names: dict[int, str] = {}
    for node in postorder(formulas):
        if node.operation == "number":
            names[id(node)] = repr(node.value) if node.value >= 0.0 else f"({node.value!r})"
        elif not node.of:
            names[id(node)] = leaves[node.operation].format(node.place)
        else:
            text = _expression(node, [names[id(part)] for part in node.of])
            if text not in by_text:
                by_text[text] = f"{prefix}{len(by_text)}"
                lines.append(f"{by_text[text]} = {text}")
            names[id(node)] = by_text[text]
    return lines, [names[id(formula)] for formula in formulas]


def _expression(node: Formula, parts: list[str]) -> str:
    if node.operation in _SIGNS:
        return _SIGNS[node.operation].format(*parts)
    if node.operation == "power":
        return f"({parts[0]} ** {node.value!r})"
    if node.operation in ("table", "table slope"):
        function = "table" if node.operation == "table" else "table_slope"
        places, values = zip(*node.points, strict=True)
        return f"{function}({parts[0]}, {places!r}, {values!r})"
    return f"{node.operation}({', '.join(parts)})"
