"""How many poles a feedback loop has in the right half plane, with exact delays: the Nyquist count.

The closed loop is stable when ``f(s) = 1 + L(s)`` has no zero with positive real part. By the argument principle
the number of such zeros is the number of unstable open-loop poles minus the turns of ``f`` about the origin along
the imaginary axis, indented to the right of a pole at the origin. The delay is exact, so nothing is lost to a Pade
approximation. A loop inside the loop is counted the same way: its unstable poles are unstable open-loop poles of the
outer one.
"""

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._block import Block
from shaftprint.models._delays import Delay
from shaftprint.models._expression import Expression, Inverse, Sensitivity, Series, Walk
from shaftprint.models._structure import Structure

LOWEST_RAD_S = 1e-5
HIGHEST_RAD_S = 1e5
INDENTATION = np.exp(1j * np.linspace(0.0, np.pi / 2.0, 33))
PHASE_STEP_RAD = 0.05
SHARP_TURN_RAD = 0.5
BISECTIONS = 60
# Frequencies of the count for many parameter sets at once; sets whose path turns sharply between two are counted alone.
COMMON_SWEEP = np.geomspace(LOWEST_RAD_S, HIGHEST_RAD_S, 1501)


def unstable_poles(structure: Structure, values: ArrayLike) -> int:
    """Return the number of poles with positive real part, delays exact (Nyquist count); 0 for a stable structure.

    A structure without feedback is counted by the poles of its blocks and inverses.

    Raises StructureError if the loop holds the inverse of something with a delay.
    """
    table = np.asarray(values, dtype=np.float64)
    if structure.loop is None:
        return sum(_unstable_open(node, structure, table) for node in with_poles(structure))
    return _unstable_closed(structure.loop, structure, table)


def is_stable(structure: Structure, values: ArrayLike) -> bool:
    """Return whether the structure has no pole with positive real part at the given values."""
    return unstable_poles(structure, values) == 0


def stable_rows(structure: Structure, values: ArrayLike) -> BoolArray:
    """Return for many parameter sets whether the structure is stable, shape (rows,).

    The same count as :func:`is_stable`, for all sets in one sweep; a set whose path is too sharp for the sweep is
    counted alone.

    ``values``: parameter values, shape (rows, parameters).
    """
    table = np.asarray(values, dtype=np.float64)
    loop = structure.loop
    if loop is None or any(isinstance(node, Sensitivity) for node in loop.nodes()):
        return np.array([is_stable(structure, row) for row in table], dtype=np.bool_)
    path = np.concatenate([LOWEST_RAD_S * INDENTATION, 1j * COMMON_SWEEP])
    with np.errstate(all="ignore"):
        curve = 1.0 + evaluate(loop, structure, table, path)
        step = np.angle(curve[:, 1:] / curve[:, :-1])
    turns = np.rint(-(step.sum(axis=1) - np.angle(curve[:, -1])) / np.pi)
    sharp = ~np.all(np.abs(step) < SHARP_TURN_RAD, axis=1)
    opened = np.array([_unstable_in(loop, structure, row) for row in table])
    stable: BoolArray = turns + opened == 0
    for row in np.flatnonzero(sharp):
        stable[row] = is_stable(structure, table[row])
    return stable


def loop_gain(structure: Structure, values: ArrayLike, s: ArrayLike) -> ComplexArray:
    """Return the loop gain ``L`` of a structure, shape (frequencies,).

    Raises StructureError if the structure has no feedback loop.
    """
    table = np.asarray(values, dtype=np.float64)
    return evaluate(loop_of(structure), structure, table, np.atleast_1d(s))


def loop_of(structure: Structure) -> Expression:
    """Return the loop gain as an expression.

    Raises StructureError if the structure has no feedback loop.
    """
    loop = structure.loop
    if loop is None:
        raise StructureError(
            f"structure {structure.name} has no feedback loop, so it has no margins; put it into a closed loop first."
        )
    return loop


def evaluate(expression: Expression, structure: Structure, table: FloatArray, s: ArrayLike) -> ComplexArray:
    """Return the value of an expression of a structure, shape (..., frequencies), for a table (..., parameters)."""
    response, _ = Walk(np.asarray(s, dtype=np.complex128), structure.columns(table), frozenset()).dual(expression)
    return response


def plain_values(structure: Structure, table: FloatArray) -> Mapping[str, float]:
    """Return every parameter as the blocks take it, by name, as a number."""
    return {name: float(value[0]) for name, value in structure.columns(table).items()}


def swept(loop: Expression, structure: Structure, table: FloatArray) -> tuple[FloatArray, ComplexArray]:
    """Return frequencies fine enough for every turn of a loop gain while it exceeds 0.3, and the loop gain there."""
    coarse = np.geomspace(LOWEST_RAD_S, HIGHEST_RAD_S, 2001)
    magnitude = np.abs(evaluate(loop, structure, table, 1j * coarse))
    strong = np.flatnonzero(magnitude > 0.3)
    last = coarse[min(strong[-1] + 1, coarse.size - 1)] if strong.size else coarse[0]
    named = plain_values(structure, table)
    delay = sum(named[node.time.name] for node in loop.nodes() if isinstance(node, Delay))
    count = int(min(2e6, max(2.0, last * delay / PHASE_STEP_RAD)))
    omega = np.union1d(coarse, np.linspace(coarse[0], last, count))
    return omega, evaluate(loop, structure, table, 1j * omega)


def with_poles(structure: Structure) -> list[Expression]:
    """Return the blocks, inverses and loops whose poles the paths of a structure have, each once."""
    seen: set[int] = set()
    return [node for path in structure.paths for node in _poles_of(path, seen)]


def _unstable_closed(loop: Expression, structure: Structure, table: FloatArray) -> int:
    """Return the number of unstable poles of the loop closed: turns of ``1 + L``, and unstable poles of ``L``."""
    omega, gain = swept(loop, structure, table)
    path = _smooth_path(loop, structure, table, omega, 1.0 + gain)
    path = np.concatenate([1.0 + evaluate(loop, structure, table, LOWEST_RAD_S * INDENTATION), path])
    turns = np.sum(np.angle(path[1:] / path[:-1])) - np.angle(path[-1])
    return int(np.rint(-turns / np.pi)) + _unstable_in(loop, structure, table)


def _unstable_in(expression: Expression, structure: Structure, table: FloatArray) -> int:
    """Return the number of unstable poles of an expression; a block that occurs twice counts once."""
    return sum(_own_poles(node, structure, table) for node in _poles_of(expression, set()))


def _poles_of(expression: Expression, seen: set[int]) -> Iterator[Expression]:
    """Yield the blocks, inverses and inner loops whose poles an expression has, each once.

    In a product with ``1 / (1 + L)`` the poles of ``L`` cancel: they are its zeros.
    """
    if id(expression) in seen:
        return
    seen.add(id(expression))
    if isinstance(expression, Block | Inverse | Sensitivity):
        yield expression
        return
    if isinstance(expression, Series):
        closed = (factor.loop for factor in _factors(expression) if isinstance(factor, Sensitivity))
        seen.update(id(node) for loop in closed for node in loop.nodes() if isinstance(node, Block))
    for child in expression.children():
        yield from _poles_of(child, seen)


def _factors(expression: Expression) -> Iterator[Expression]:
    if isinstance(expression, Series):
        yield from _factors(expression.first)
        yield from _factors(expression.second)
    else:
        yield expression


def _own_poles(node: Expression, structure: Structure, table: FloatArray) -> int:
    if isinstance(node, Sensitivity):
        return _unstable_closed(node.loop, structure, table)
    if isinstance(node, Inverse) and node.polynomials(plain_values(structure, table)) is None:
        raise StructureError(
            f"structure {structure.name}: the poles of the inverse of an expression with a delay are not known; write "
            "the loop without that inverse."
        )
    return _unstable_open(node, structure, table)


def _unstable_open(node: Expression, structure: Structure, table: FloatArray) -> int:
    ratio = node.polynomials(plain_values(structure, table))
    return 0 if ratio is None else int(np.sum(np.roots(ratio[1]).real > 0.0))


def _smooth_path(
    loop: Expression, structure: Structure, table: FloatArray, omega: FloatArray, path: ComplexArray
) -> ComplexArray:
    """Return ``1 + L`` on frequencies so close that no step turns sharply: a chord may pass the origin wrongly."""
    for _ in range(BISECTIONS):
        sharp = np.flatnonzero(np.abs(np.angle(path[1:] / path[:-1])) > SHARP_TURN_RAD)
        if sharp.size == 0:
            break
        middle = 0.5 * (omega[sharp] + omega[sharp + 1])
        path = np.insert(path, sharp + 1, 1.0 + evaluate(loop, structure, table, 1j * middle))
        omega = np.insert(omega, sharp + 1, middle)
    return path
