"""Groups of parameters that a test cannot separate, and what it does know of two of them together."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.likelihood._objective import Objective
from shaftprint.identify.prediction._formulas import FormulaTerm, ParameterFormula, single, sum_of
from shaftprint.models._blocks import SecondOrderLag
from shaftprint.models._combination import Combination
from shaftprint.models._delays import Delay
from shaftprint.models._parameter import Parameter
from shaftprint.spelling import listed

# Two parameters cannot be separated when they correlate more than this ...
CORRELATED = 0.9
# ... and one of them is known worse than this share of its value.
POOR = 0.05
# What is known of both together must be better known than either of them by this factor to be worth telling.
BETTER = 3.0
MEANING = "known of both together"


@dataclass(frozen=True, kw_only=True, slots=True)
class Group:
    """Parameters that a test cannot separate: what it does not know of one, it does not know of the others."""

    names: tuple[str, ...]
    """Names of the parameters."""
    correlation: float
    """Correlation of two of them, with sign, the largest in magnitude."""
    known: tuple[Estimate, ...]
    """What the test does know of two of them together, the best known first."""

    @property
    def sentence(self) -> str:
        """It in words."""
        how = f"correlation {self.correlation:.2f}" if len(self.names) == 2 else "correlations up to "
        how += "" if len(self.names) == 2 else f"{abs(self.correlation):.2f}"
        start = f"With these lines {listed(self.names)} cannot be separated ({how})"
        if not self.known:
            return f"{start}."
        known_numbers = [f"{e.name} is known to {100.0 * _share(e):.2g} %" for e in self.known]
        return f"{start}; {listed(known_numbers)}."


def inseparable_groups(
    objective: Objective,
    parameters: Sequence[Estimate],
    covariance: FloatArray,
    named: Sequence[Combination],
    estimate: Callable[[Combination], Estimate],
) -> tuple[Group, ...]:
    """Return the groups of parameters that a test cannot separate, the worst first.

    ``objective``: the structures. ``parameters``, ``covariance``: free parameters and their covariance, shape (free,
    free). ``named``: combinations with a name of their own. ``estimate``: gives a combination its standard deviation.
    """
    std = np.sqrt(np.diag(covariance))
    with np.errstate(invalid="ignore"):
        correlation = covariance / np.outer(std, std)
    share = [_share(e) for e in parameters]
    usable = [i for i, s in enumerate(std) if np.isfinite(s)]
    strong = [
        (i, j)
        for i, j in sorted(combinations(usable, 2), key=lambda pair: -abs(correlation[pair]))
        if abs(correlation[i, j]) >= CORRELATED and max(share[i], share[j]) >= POOR
    ]
    groups = []
    for members in _connected(len(parameters), strong):
        inside = [(i, j) for i, j in strong if i in members]
        offered = [
            (best, i, j)
            for i, j in combinations(members, 2)
            if (best := _best(objective, parameters[i].name, parameters[j].name, named, estimate)) is not None
            and BETTER * _share(best) < min(share[i], share[j])
        ]
        groups.append(
            Group(
                names=tuple(parameters[i].name for i in members),
                correlation=float(correlation[inside[0]]),
                known=_not_following(offered, len(parameters)),
            )
        )
    return tuple(groups)


def _connected(count: int, edges: Sequence[tuple[int, int]]) -> list[list[int]]:
    """Return the groups that edges tie together, each in ascending order, in the order of their first edge."""
    group = list(range(count))
    for i, j in edges:
        group = [group[i] if label == group[j] else label for label in group]
    labels = dict.fromkeys(group[i] for i, _ in edges)
    return [[index for index, label in enumerate(group) if label == wanted] for wanted in labels]


def _not_following(offered: Sequence[tuple[Estimate, int, int]], count: int) -> tuple[Estimate, ...]:
    """Return the best known of what is offered, without those that tie two parameters which others tie already."""
    group = list(range(count))
    estimates = []
    for estimate, i, j in sorted(offered, key=lambda offer: _share(offer[0])):
        if group[i] != group[j]:
            group = [group[i] if label == group[j] else label for label in group]
            estimates.append(estimate)
    return tuple(estimates)


def _best(
    objective: Objective,
    first: str,
    second: str,
    named: Sequence[Combination],
    estimate: Callable[[Combination], Estimate],
) -> Estimate | None:
    return min(map(estimate, _together(objective, first, second, named)), key=_share, default=None)


def _share(estimate: Estimate) -> float:
    share = estimate.std / abs(estimate.value) if estimate.value else np.inf
    return share if np.isfinite(share) else np.inf


def _together(objective: Objective, first: str, second: str, named: Sequence[Combination]) -> list[Combination]:
    """Return what might be known of two parameters together: named combinations, sums, products, quotients."""
    values = objective.named(objective.held)
    defined = [c for c in named if not any(c.is_defined_by(_without(values, name)) for name in (first, second))]
    one, other = (_term(objective, name, order) for order, name in enumerate((first, second)))
    formulas = [ParameterFormula(factors=((one, 1), (other, power))) for power in (1, -1)]
    if one.unit == other.unit:
        formulas += [ParameterFormula(factors=((sum_of(one, other, sign, order=2), 1),)) for sign in (1, -1)]
    for mine, others in combinations(_lateness(objective), 2):
        if {first, second} <= {*mine[1], *others[1]}:
            formulas.append(ParameterFormula(factors=((sum_of(mine[0], others[0], 1, order=2), 1),)))
    return [*defined, *(Combination(name=f.name, unit=f.unit, of=f.of, meaning=MEANING) for f in formulas)]


def _without(values: dict[str, FloatArray], name: str) -> dict[str, FloatArray]:
    return {key: value for key, value in values.items() if key != name}


def _term(objective: Objective, name: str, order: int) -> FormulaTerm:
    return single(name, objective.parameters[objective.names.index(name)].unit, order=order)


def _lateness(objective: Objective) -> list[tuple[FormulaTerm, tuple[str, ...]]]:
    """Return what each late block does to slow lines, as a delay, with the parameters that are in it.

    A lag ``omega_n^2 / (s^2 + 2 zeta omega_n s + omega_n^2)`` is ``1 - 2 zeta / omega_n s`` for small ``s``.
    """
    terms: dict[str, tuple[FormulaTerm, tuple[str, ...]]] = {}
    for block in (block for term in objective.terms for block in term.structure.blocks):
        if isinstance(block, Delay):
            terms.setdefault(block.time.name, (_time(block.time), (block.time.name,)))
        if isinstance(block, SecondOrderLag):
            omega_n, zeta = block.frequency.name, block.damping.name
            terms.setdefault(omega_n, (_lag_time(omega_n, zeta), (omega_n, zeta)))
    return list(terms.values())


def _time(parameter: Parameter) -> FormulaTerm:
    return single(parameter.name, parameter.unit, order=0)


def _lag_time(omega_n: str, zeta: str) -> FormulaTerm:
    return FormulaTerm(
        name=f"2 {zeta} / {omega_n}",
        unit="s",
        of=lambda values: 2.0 * values[zeta] / values[omega_n],
        parts=1,
        order=1,
    )
