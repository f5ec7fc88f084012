"""A program made ready for compiled code: constants apart, derivatives found."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice

from shaftprint.models._program import Program
from shaftprint.models.equations._calculus import derivatives, postorder, rebuilt, replaced
from shaftprint.models.equations._formula import Formula


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Hoisted:
    """A program whose formulas of parameters alone are constants, to be found once a simulation."""

    constants: tuple[Formula, ...]
    """The formulas of parameters."""
    rates: tuple[Formula, ...]
    """How fast states change."""
    lates: tuple[Formula, ...]
    """Signals that are asked for late."""
    values: tuple[Formula, ...]
    """What a computer takes."""
    signals: tuple[Formula, ...]
    """The outputs."""
    varying: tuple[int, ...]
    """Places of the pasts whose delay is not a formula of parameters alone."""
    delays: tuple[Formula, ...]
    """Their delays [s]."""


def hoisted(program: Program) -> Hoisted:
    """Return the program with constants in the place of formulas of parameters alone."""
    constants: list[Formula] = []
    leaves: list[Formula] = []
    indices: dict[int, int] = {}
    varying = tuple(i for i, late in enumerate(program.pasts) if late.varies)
    delays = [program.pasts[i].delay for i in varying]
    roots = [
        *program.rates,
        *(late.signal for late in program.pasts),
        *(sample.value for sample in program.samples),
        *program.signals,
        *delays,
    ]
    roots = _without_division(roots)
    fixed = _fixed(roots)

    def constant(node: Formula) -> Formula | None:
        if node.operation == "number" or not fixed[id(node)]:
            return None
        if id(node) not in indices:
            indices[id(node)] = len(constants)
            leaves.append(Formula("constant", name="constant", place=len(constants)))
            constants.append(node)
        return leaves[indices[id(node)]]

    # the walk goes parts first: only what stands directly below something that is not fixed becomes a constant
    outer = {id(part) for node in postorder(roots) if not fixed[id(node)] for part in node.of if fixed[id(part)]}
    outer |= {id(root) for root in roots if fixed[id(root)]}
    replacements = replaced(roots, lambda node: constant(node) if id(node) in outer else None)
    parts = iter(replacements)
    return Hoisted(
        constants=tuple(constants),
        rates=tuple(islice(parts, len(program.rates))),
        lates=tuple(islice(parts, len(program.pasts))),
        values=tuple(islice(parts, len(program.samples))),
        signals=tuple(islice(parts, len(program.signals))),
        varying=varying,
        delays=tuple(parts),
    )


def _fixed(roots: Sequence[Formula]) -> dict[int, bool]:
    """Return for every part whether it is a formula of parameters alone."""
    fixed: dict[int, bool] = {}
    for node in postorder(roots):
        alone = node.operation in ("parameter", "number", "step")
        fixed[id(node)] = all(fixed[id(part)] for part in node.of) if node.of else alone
    return fixed


def _without_division(roots: Sequence[Formula]) -> list[Formula]:
    """Return formulas that multiply by the inverse of a formula of parameters instead: that is found once."""
    fixed = _fixed(roots)
    formulas: dict[int, Formula] = {}
    for node in postorder(roots):
        parts = tuple(formulas[id(part)] for part in node.of)
        if node.operation == "divide" and fixed[id(node.of[1])] and not fixed[id(node)]:
            formulas[id(node)] = parts[0] * (1.0 / parts[1])
        else:
            formulas[id(node)] = rebuilt(node, parts)
    return [formulas[id(root)] for root in roots]


class FormulaSlopes:
    """Derivatives of formulas to the leaves they contain, those that are not zero."""

    def __init__(self, formulas: Sequence[Formula]) -> None:
        self.entries: list[tuple[int, Formula]] = []
        """Number of the formula and leaf of each derivative."""
        self.formulas: list[Formula] = []
        """The derivatives."""
        leaves: dict[tuple[str, int], Formula] = {}
        for node in postorder(formulas):
            if not node.of and node.operation not in ("number", "input", "input rate", "step"):
                leaves.setdefault((node.operation, node.place), node)
        for leaf in leaves.values():
            for i, slope in enumerate(derivatives(formulas, leaf)):
                if not slope.equals(0.0):
                    self.entries.append((i, leaf))
                    self.formulas.append(slope)
