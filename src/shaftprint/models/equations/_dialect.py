"""Formulas as source text in any language: one walk over them, and a table of how a language writes each operation."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from shaftprint.models.equations._calculus import postorder
from shaftprint.models.equations._formula import Formula

_SIGNS = {"add": "({} + {})", "multiply": "({} * {})", "divide": "({} / {})"}


@dataclass(frozen=True, kw_only=True, slots=True)
class Dialect:
    """How a language writes formulas; what has no form of its own is a function of its name."""

    number: Callable[[float], str]
    """A number that is not negative; what is to be refused raises an error."""
    exponent: Callable[[float], str]
    """The number of a power."""
    forms: Mapping[str, str]
    """Other forms than ``name(part, part)``, by the operation; the second part of ``power`` is its exponent."""
    table: Callable[[Formula, str, int], tuple[Sequence[str], str]]
    """Of a piecewise linear function or its slope, of its argument and a number that no other table has: what stands
    before it, and its text."""
    assignment: str = "{} = {}"
    """A name is given a value."""

    def of_number(self, value: float) -> str:
        """Return a number."""
        return self.number(value) if value >= 0.0 else f"({self.number(value)})"

    def expression(self, node: Formula, parts: Sequence[str], free: int = 0) -> tuple[Sequence[str], str]:
        """Return what stands before an operation on parts, and its text."""
        if node.operation in ("table", "table slope"):
            return self.table(node, parts[0], free)
        form = _SIGNS.get(node.operation) or self.forms.get(node.operation)
        if node.operation == "power":
            return (), self.forms["power"].format(parts[0], self.exponent(node.value))
        return (), f"{node.operation}({', '.join(parts)})" if form is None else form.format(*parts)


def statements(
    formulas: Sequence[Formula], leaf: Callable[[Formula], str], dialect: Dialect, prefix: str = "t"
) -> tuple[list[str], list[str]]:
    """Return assignments, each sub-formula once, and the names or numbers that hold the formulas.

    ``leaf``: what is written for a leaf. ``dialect``: how the language writes the rest. ``prefix``: first letters of
    the names of intermediate values.
    """
    lines: list[str] = []
    by_text: dict[str, str] = {}
    names: dict[int, str] = {}
    for node in postorder(formulas):
        if node.operation == "number":
            names[id(node)] = dialect.of_number(node.value)
        elif not node.of:
            names[id(node)] = leaf(node)
        else:
            before, text = dialect.expression(node, [names[id(part)] for part in node.of], len(by_text))
            lines += before
            if text not in by_text:
                by_text[text] = f"{prefix}{len(by_text)}"
                lines.append(dialect.assignment.format(by_text[text], text))
            names[id(node)] = by_text[text]
    return lines, [names[id(formula)] for formula in formulas]
