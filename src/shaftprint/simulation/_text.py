"""Formulas as Python, plain or compiled by numba: each sub-formula once, in an order in which it can be computed."""

from collections.abc import Mapping, Sequence

from shaftprint.models.equations import _dialect
from shaftprint.models.equations._dialect import Dialect
from shaftprint.models.equations._formula import Formula


def _table(node: Formula, x: str, _: int) -> tuple[tuple[str, ...], str]:
    places, values = zip(*node.points, strict=True)
    return (), f"{node.operation.replace(' ', '_')}({x}, {places!r}, {values!r})"


PYTHON = Dialect(number=repr, exponent=repr, forms={"power": "({} ** {})"}, table=_table)


def statements(
    formulas: Sequence[Formula], leaves: Mapping[str, str], prefix: str = "t"
) -> tuple[list[str], list[str]]:
    """Return assignments and the names or numbers that hold the formulas.

    ``leaves``: what to write for a leaf by its kind, with ``{}`` for its place, such as ``{"state": "x{}"}``.
    ``prefix``: first letters of the names of intermediate values.
    """
    return _dialect.statements(formulas, lambda node: leaves[node.operation].format(node.place), PYTHON, prefix)
