"""Names for what can be found where single parameters cannot: combinations that no lost direction changes.

A combination can be found where its gradient is perpendicular to every lost direction, at every point. For a product
of powers the gradient of its logarithm is the sum of those of its factors, so that with the projections ``u`` of the
factors on the lost directions, ``t_1^a t_2^b`` can be found where ``a u_1 + b u_2 = 0``. Factors are single parameters,
sums and differences of two of one unit, and a known number minus or plus a parameter; they are tried in the order of
how much there is to read, and combinations are taken until they are as many as the rank allows.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify.prediction._formulas import (
    FormulaTerm,
    ParameterFormula,
    Value,
    number,
    product_of,
    single,
    sum_of,
    unit_of,
)
from shaftprint.identify.prediction._null_space import NullSpace
from shaftprint.models._combination import Combination

# A projection below this share of the gradient is none.
TOLERANCE = 1e-6
# Share of a parameter's range over which slopes are taken.
STEP = 1e-5
POWERS = ((1, 1), (1, -1), (1, 2), (1, -2), (2, 1), (2, -1))
MEANING = "known although its parts are not"
# With more lost parameters than this, sums of products are too many to try.
MOST_FOR_SUMS_OF_PRODUCTS = 9


@dataclass(frozen=True, slots=True, eq=False)
class CombinationSlopes:
    """Gradients of logarithms at the points of a null space, and their projections on it."""

    null: NullSpace
    values: dict[str, FloatArray]
    """Parameters by name at each point, then moved ahead and behind, shape (points, 1 + 2 free)."""
    width: FloatArray
    """Distance between ahead and behind in scaled coordinates, shape (points, free)."""

    @classmethod
    def of(cls, null: NullSpace) -> "CombinationSlopes":
        """Return the slopes of a null space."""
        structure = null.structure
        free = [structure.names.index(p.name) for p in structure.free]
        step = STEP * np.array([p.upper - p.lower for p in structure.free])
        table = np.repeat(null.table[:, None, :], 1 + 2 * len(free), axis=1)
        for row, (column, width) in enumerate(zip(free, step, strict=True)):
            table[:, 1 + row, column] += width
            table[:, 1 + len(free) + row, column] -= width
        return cls(null, structure.named(table), 2.0 * step / null.scale)

    def gradient(self, of: Value) -> FloatArray:
        """Return the gradient of the logarithm in scaled coordinates, shape (points, free); nan where there is none."""
        count = self.width.shape[1]
        with np.errstate(all="ignore"):
            value = np.broadcast_to(np.asarray(of(self.values), dtype=np.float64), self.values_shape)
            slope = (value[:, 1 : 1 + count] - value[:, 1 + count :]) / self.width
            return np.asarray(slope / value[:, :1])

    @property
    def values_shape(self) -> tuple[int, int]:
        """Shape of a value: points, and places about each."""
        points, count = self.width.shape
        return points, 1 + 2 * count

    def projected(self, gradient: FloatArray) -> FloatArray:
        """Return a gradient's projection on the lost directions over its length, at all points in a row."""
        parts: FloatArray = np.einsum("kf,kfd->kd", gradient, self.null.basis)
        return parts.ravel()

    def is_found(self, of: Value) -> bool:
        """Return whether a function can be found: its gradient has nothing in the lost directions."""
        gradient = self.gradient(of)
        length = float(np.linalg.norm(gradient))
        return length > 0.0 and bool(np.linalg.norm(self.projected(gradient)) < TOLERANCE * length)


class _Chosen:
    """Combinations taken so far, and whether one more adds anything to them."""

    def __init__(self, slopes: CombinationSlopes, singles: Sequence[str]) -> None:
        self.slopes = slopes
        self.taken: list[Combination] = []
        self.base = np.empty((slopes.width.shape[1], 0))
        for name in singles:
            self._add(lambda values, name=name: values[name])  # type: ignore[misc]

    def offer(self, combination: Combination) -> None:
        """Take a combination if it does not follow from those before."""
        if not self.is_complete and self._add(combination.of):
            self.taken.append(combination)

    def _add(self, of: Value) -> bool:
        gradient = self.slopes.gradient(of)[0]
        gradient = gradient / np.linalg.norm(gradient)
        remainder = gradient - self.base @ (self.base.T @ gradient)
        remainder -= self.base @ (self.base.T @ remainder)
        length = float(np.linalg.norm(remainder))
        if not length > TOLERANCE:
            return False
        self.base = np.column_stack([self.base, remainder / length])
        return True

    @property
    def is_complete(self) -> bool:
        """Whether there are as many as the rank allows."""
        return self.base.shape[1] >= self.slopes.null.rank


def found_combinations(null: NullSpace) -> tuple[tuple[Combination, ...], tuple[Combination, ...]]:
    """Return combinations that complete what can be found, and others that follow from them.

    The structure's own combinations are taken where they are enough; else quotients by one common parameter where these
    are, as the coefficients of a transfer function; else whatever is short.
    """
    slopes = CombinationSlopes.of(null)
    lost = null.of_lost()
    singles = [p.name for p, is_lost in zip(null.structure.free, lost, strict=True) if not is_lost]
    named = [c for c in null.structure.combinations if slopes.is_found(c.of) and not _is_of_singles(slopes, c, singles)]
    chosen = _greedy(slopes, singles, named)
    if chosen.is_complete:
        return tuple(chosen.taken), tuple(c for c in named if c not in chosen.taken)
    formulas = [*_short_formulas(slopes)]
    combinations = [_combination(formula) for formula in formulas]
    for divisor in (p.name for p, is_lost in zip(null.structure.free, lost, strict=True) if is_lost):
        quotients = [_combination(f) for f in (_over(formula, divisor) for formula in formulas) if f is not None]
        chosen = _greedy(slopes, singles, quotients)
        if chosen.is_complete:
            break
    else:
        chosen = _greedy(slopes, singles, [*named, *combinations])
        if not chosen.is_complete:
            chosen = _greedy(slopes, singles, [*named, *combinations, *map(_combination, _sums_of_products(slopes))])
    names = {c.name for c in chosen.taken}
    pairs = [c for c, formula in zip(combinations, formulas, strict=True) if formula.cost[:3] == (2, 0, 0)]
    others = {c.name: c for c in (*named, *pairs) if c.name not in names}
    return tuple(chosen.taken), tuple(others.values())


def _greedy(slopes: CombinationSlopes, singles: Sequence[str], offered: Sequence[Combination]) -> _Chosen:
    chosen = _Chosen(slopes, singles)
    for combination in offered:
        chosen.offer(combination)
    return chosen


def _is_of_singles(slopes: CombinationSlopes, combination: Combination, singles: Sequence[str]) -> bool:
    """Return whether a combination is made of parameters only that are found on their own."""
    slope = np.abs(slopes.gradient(combination.of)).max(axis=0)
    names = [p.name for p in slopes.null.structure.free]
    return all(name in singles for name, part in zip(names, slope, strict=True) if part > TOLERANCE * slope.max())


def _combination(formula: ParameterFormula) -> Combination:
    return Combination(name=formula.name, unit=formula.unit, of=formula.of, meaning=MEANING)


def _over(formula: ParameterFormula, divisor: str) -> ParameterFormula | None:
    """Return the formula turned so that the divisor alone stands below the line; sums alone are let through."""
    if len(formula.factors) == 1:
        return formula
    for turned in (formula, ParameterFormula(factors=tuple((term, -power) for term, power in formula.factors))):
        if [(term.name, power) for term, power in turned.factors if power < 0] == [(divisor, -1)]:
            return turned
    return None


def lost_terms(null: NullSpace) -> list[FormulaTerm]:
    """Return the terms that formulas are made of: lost parameters, and sums and differences with a lost one."""
    structure = null.structure
    lost = [p for p, is_lost in zip(structure.free, null.of_lost(), strict=True) if is_lost]
    terms = {p.name: single(p.name, p.unit, order=order) for order, p in enumerate(structure.free)}
    lost_names = [terms[p.name] for p in lost]
    start = {p.name: np.asarray(p.value) for p in structure.parameters}

    def add(first: FormulaTerm, second: FormulaTerm) -> None:
        for sign in (1, -1):
            term = sum_of(first, second, sign, order=len(structure.free) + len(lost_names))
            if sign < 0 and float(term.of(start)) < 0.0:
                term = sum_of(second, first, sign, order=term.order)
            lost_names.append(term)

    for one, other in combinations(structure.free, 2):
        if (one in lost or other in lost) and unit_of((one.unit, 1), ("-", 1)) == unit_of((other.unit, 1), ("-", 1)):
            add(terms[one.name], terms[other.name])
    for p in lost:
        held = [q.value for q in structure.parameters if q.held and q.unit == p.unit and q.value != 0.0]
        for value in dict.fromkeys([*held, *([1.0] if p.unit == "-" else [])]):
            add(number(value, p.unit), terms[p.name])
    return lost_names


def _short_formulas(slopes: CombinationSlopes) -> list[ParameterFormula]:
    """Return all products of up to three terms that can be found and whose parts cannot, the shortest first."""
    terms = lost_terms(slopes.null)
    gradients = [slopes.gradient(term.of) for term in terms]
    at = [(slopes.projected(g), float(np.linalg.norm(g))) for g in gradients]
    usable = [i for i, (u, size) in enumerate(at) if np.isfinite(size) and size > 0.0 and np.isfinite(u).all()]
    constant = [i for i in usable if np.linalg.norm(at[i][0]) < TOLERANCE * at[i][1]]
    varying = [i for i in usable if i not in constant]
    formulas = [ParameterFormula(factors=((terms[i], 1),)) for i in constant]
    if varying:
        kept = [terms[i] for i in varying]
        table, size = np.stack([at[i][0] for i in varying]), np.array([at[i][1] for i in varying])
        formulas += [*_pairs(kept, table, size), *_triples(kept, table, size)]
    return sorted(formulas, key=lambda formula: formula.cost)


def _pairs(terms: Sequence[FormulaTerm], table: FloatArray, size: FloatArray) -> Iterator[ParameterFormula]:
    for (i, j), (a, b) in product(combinations(range(len(terms)), 2), POWERS):
        if np.linalg.norm(a * table[i] + b * table[j]) < TOLERANCE * (size[i] + size[j]):
            yield ParameterFormula(factors=((terms[i], a), (terms[j], b)))


def _triples(terms: Sequence[FormulaTerm], table: FloatArray, size: FloatArray) -> Iterator[ParameterFormula]:
    """Yield products of two single parameters and a third term that can be found and of which no pair can."""
    singles = [i for i, term in enumerate(terms) if term.parts == 1]
    for (j, k), (b, c) in product(combinations(singles, 2), ((1, 1), (1, -1), (-1, 1), (-1, -1))):
        pair = b * table[j] + c * table[k]
        if np.linalg.norm(pair) < TOLERANCE * (size[j] + size[k]):
            continue
        closed = np.linalg.norm(table + pair, axis=1) < TOLERANCE * (size + size[j] + size[k])
        for i in np.flatnonzero(closed).tolist():
            if i > k or (terms[i].parts > 1 and i not in (j, k)):
                factors = ((terms[j], b), (terms[k], c), (terms[i], 1))
                flipped = sum(power for _, power in factors) < 0
                yield ParameterFormula(factors=tuple((term, -power if flipped else power) for term, power in factors))


def _sums_of_products(slopes: CombinationSlopes) -> list[ParameterFormula]:
    """Return sums of two products of lost parameters, times up to two powers of others, that can be found."""
    singles = [term for term in lost_terms(slopes.null) if term.parts == 1]
    if len(singles) > MOST_FOR_SUMS_OF_PRODUCTS:
        return []
    products = [product_of(*pair) for pair in combinations([*singles, *singles], 2)]
    products = list({term.name: term for term in products}.values())
    rests = [(), *(((t, e),) for t in singles for e in (-1, 1))]
    rests += [((t, a), (o, b)) for t, o in combinations(singles, 2) for a, b in product((-1, 1), repeat=2)]
    alone = {term.name: slopes.projected(slopes.gradient(term.of)) for term in singles}
    none = np.zeros_like(next(iter(alone.values())))
    table = np.stack([sum((power * alone[term.name] for term, power in factors), none) for factors in rests])
    formulas = []
    for (first, second), sign in product(combinations(products, 2), (1, -1)):
        term = sum_of(first, second, sign, order=first.order)
        slope = slopes.gradient(term.of)
        near = np.linalg.norm(table + slopes.projected(slope), axis=1) < TOLERANCE * np.linalg.norm(slope)
        formulas += [ParameterFormula(factors=((term, 1), *rests[index])) for index in np.flatnonzero(near)]
    return sorted(formulas, key=lambda formula: formula.cost)
