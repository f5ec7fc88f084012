"""The lost directions in words: which parameters may move together so that every response stays as it is."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify.prediction._combinations import CombinationSlopes, lost_terms
from shaftprint.identify.prediction._formulas import FormulaTerm
from shaftprint.identify.prediction._null_space import NullSpace, null_directions
from shaftprint.spelling import listed

# A component below this share of the largest is none.
TOLERANCE = 1e-6


@dataclass(frozen=True, kw_only=True, slots=True)
class Direction:
    """Parameters that may move together, as few of them as can be, without changing a response."""

    parameters: tuple[str, ...]
    """Names of the parameters that move."""
    sentence: str
    """How they move, in words."""
    at_default: Mapping[str, float]
    """How they move at the structure's default values, each in its own unit; the largest moves by its range."""


def directions_of(null: NullSpace, outputs: Sequence[str]) -> tuple[Direction, ...]:
    """Return a basis of the lost directions, each of as few parameters as can be."""
    names = [p.name for p in null.structure.free]
    defaults = null_directions(null.structure, outputs, null.structure.vector({}))
    slopes = CombinationSlopes.of(null)
    terms = lost_terms(null)
    directions = []
    for support in _supports(null):
        along = _along(null.basis, null.scale, support)
        first = _along(defaults[1][None], defaults[0][None], support)[0]
        moving = [names[column] for column in support]
        directions.append(
            Direction(
                parameters=tuple(moving),
                sentence=_sentence(slopes, terms, moving, along, outputs),
                at_default=dict(zip(moving, first[list(support)].tolist(), strict=True)),
            )
        )
    return tuple(directions)


def _supports(null: NullSpace) -> list[tuple[int, ...]]:
    """Return the places of the parameters of each direction, directions of few parameters first."""
    count, basis = null.basis.shape[2], null.basis[0]
    lost = np.flatnonzero(null.of_lost()).tolist()
    chosen: list[tuple[int, ...]] = []
    chosen_rows = np.empty((count, 0))
    for size in range(1, len(lost) + 1):
        for support in combinations(lost, size):
            if len(chosen) == count:
                return chosen
            if any(set(smaller) <= set(support) for smaller in chosen):
                continue
            outside = np.delete(basis, support, axis=0)
            _, singular, right = np.linalg.svd(np.vstack([outside, np.zeros((count, count))]))
            if singular[-1] > TOLERANCE:
                continue
            if np.linalg.matrix_rank(np.column_stack([chosen_rows, right[-1]]), tol=TOLERANCE) > chosen_rows.shape[1]:
                chosen_rows = np.column_stack([chosen_rows, right[-1]])
                chosen.append(support)
    return chosen


def _along(basis: FloatArray, scale: FloatArray, support: tuple[int, ...]) -> FloatArray:
    """Return the direction on a support at each point, in the parameters' units, shape (points, free)."""
    moves = []
    for directions, unit in zip(basis, scale, strict=True):
        outside = np.delete(directions, support, axis=0)
        _, _, right = np.linalg.svd(np.vstack([outside, np.zeros((directions.shape[1],) * 2)]))
        moves.append(directions @ right[-1] * unit)
    reduced = np.array(moves)
    reduced[:, [column for column in range(reduced.shape[1]) if column not in support]] = 0.0
    return reduced


def _sentence(
    slopes: CombinationSlopes,
    terms: Sequence[FormulaTerm],
    moving: Sequence[str],
    along: FloatArray,
    outputs: Sequence[str],
) -> str:
    structure = slopes.null.structure
    if len(moving) == 1:
        return f"{moving[0]} does not show in {listed(outputs)}"
    singles = {p.name: column for column, p in enumerate(structure.free)}
    amounts = along[:, [singles[name] for name in moving]]
    if len({structure.free[singles[name]].unit for name in moving}) == 1 and _is_steady(amounts / amounts[:, :1]):
        share = amounts[0] / amounts[0, 0]
        if np.allclose(np.abs(share), 1.0, atol=TOLERANCE):
            return f"{_up_and_down(moving, share)} by the same amount leave every response unchanged"
    scaled = _as_factors(slopes, terms, moving, along)
    if scaled is not None:
        moved, kept = scaled
        words = _up_and_down(list(moved), np.array(list(moved.values())))
        with_kept = f", with {listed(kept)} kept," if kept else ""
        return f"{words} by the same factor{with_kept} leave every response unchanged"
    return f"{_up_and_down(moving, amounts[0] * np.sign(amounts[0, 0]))} together leave every response unchanged"


def _as_factors(
    slopes: CombinationSlopes, terms: Sequence[FormulaTerm], moving: Sequence[str], along: FloatArray
) -> tuple[dict[str, float], list[str]] | None:
    """Return what grows by one factor (1) or shrinks by it (-1), and what is kept; None where it is no such thing."""
    scaled = along / slopes.null.scale
    changes = {term.name: np.einsum("kf,kf->k", slopes.gradient(term.of), scaled) for term in terms}
    for reference in moving:
        moved: dict[str, float] = {}
        kept: list[str] = []
        for name in moving:
            steady = _steady_term(terms, changes, name, changes[reference])
            if steady is None:
                break
            term, factor = steady
            if factor:
                moved[term] = factor
            elif term not in kept:
                kept.append(term)
        else:
            return moved, kept
    return None


def _steady_term(
    terms: Sequence[FormulaTerm], changes: Mapping[str, FloatArray], name: str, reference: FloatArray
) -> tuple[str, float] | None:
    """Return the simplest term with a parameter in it that moves by the reference's factor, its inverse, or not."""
    for term in terms:
        if name != term.name and name not in term.name.split(" "):
            continue
        with np.errstate(all="ignore"):
            power = changes[term.name] / reference
        for exponent in (1.0, -1.0, 0.0):
            if np.all(np.abs(power - exponent) < TOLERANCE):
                return term.name, exponent
    return None


def _is_steady(share: FloatArray) -> bool:
    return bool(np.all(np.abs(share - share[:1]) < TOLERANCE * np.abs(share[:1])))


def _up_and_down(names: Sequence[str], signs: FloatArray) -> str:
    turned = signs * np.sign(signs[0])
    up = [name for name, sign in zip(names, turned, strict=True) if sign > 0]
    down = [name for name, sign in zip(names, turned, strict=True) if sign < 0]
    return f"{listed(up)} up and {listed(down)} down" if down else f"{listed(up)} up"
