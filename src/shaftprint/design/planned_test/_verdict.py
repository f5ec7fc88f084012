"""A plan in sentences: what is met, what is not, by how much, and what binds."""

import math
from collections.abc import Sequence

from shaftprint.design.plan import Plan
from shaftprint.design.planned_test._rehearsal import Rehearsal
from shaftprint.design.planned_test._remedies import Remedy
from shaftprint.digits import stated
from shaftprint.units import SECONDS_PER_MINUTE

NOT_REHEARSED = ("The plan was not rehearsed.",)
# A longer test is stated in hours.
_LONGEST_IN_MINUTES = 200.0


def plan_sentences(plan: Plan, remedies: Sequence[Remedy] = (), rehearsal: Rehearsal | None = None) -> tuple[str, ...]:
    """Return what a plan reaches, the answer first, and at the end what a rehearsal says of it."""
    missed = {name: ratio for name, ratio in plan.ratios.items() if not ratio <= 1.0}
    length = f"{_length(plan.duration_s)} at {_speeds(plan)}"
    if not plan.wish.names:
        answer = f"{length} make the numbers of the line known as well as its limits allow."
    elif missed:
        answer = f"{length} do not meet {'the wish' if len(missed) == 1 else 'the wishes'} for {', '.join(missed)}."
    else:
        answer = f"{length} meet every wish, as predicted."
    return (
        answer,
        *(_miss(plan, name) for name in sorted(missed, key=lambda name: -missed[name])),
        *_binding(plan),
        *(remedy.sentence for remedy in remedies if missed),
        *(NOT_REHEARSED if rehearsal is None else rehearsal.sentences),
    )


def _speeds(plan: Plan) -> str:
    return " and ".join(f"{leg.level_rpm:.0f} rpm" for leg in plan.legs)


def _miss(plan: Plan, name: str) -> str:
    number, target = plan.predicted.estimate(name), plan.targets[name]
    if not math.isfinite(number.std):
        return f"{name}: such a test does not show it, however long."
    best = stated(number.value, number.std, number.unit)
    return (
        f"{name}: the best that can be reached is {best}, {number.std / target:.3g} times the wish; such a test of "
        f"{_length(plan.seconds_per_wish[name])} would reach it."
    )


def _length(seconds: float) -> str:
    minutes = seconds / SECONDS_PER_MINUTE
    return f"{minutes:.3g} min" if minutes < _LONGEST_IN_MINUTES else f"{minutes / 60.0:,.0f} h"


def _binding(plan: Plan) -> list[str]:
    sentences = []
    for leg, peaks in zip(plan.legs, plan.peaks, strict=True):
        if not peaks.binding:
            continue
        *others, last = peaks.binding
        names = f"{', '.join(others)} and {last} keep" if others else f"{last} keeps"
        sentences.append(f"At {leg.level_rpm:.0f} rpm {names} the lines from being stronger.")
    return sentences
