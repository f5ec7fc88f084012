"""A plan in sentences: what is met, what is not, by how much, and what binds."""

import math
from collections.abc import Sequence

import numpy as np

from shaftprint.design.inputs._wish import numbers_of_line
from shaftprint.design.plan._band import HELD
from shaftprint.design.plan._plan import Plan, length_words
from shaftprint.design.planned_test._hidden import stairs_sentences
from shaftprint.design.planned_test._rehearsal import Rehearsal
from shaftprint.design.planned_test._remedies import Remedy
from shaftprint.digits import stated

NOT_REHEARSED = ("The plan was not rehearsed.",)


def plan_sentences(plan: Plan, remedies: Sequence[Remedy] = (), rehearsal: Rehearsal | None = None) -> tuple[str, ...]:
    """Return what a plan reaches, the answer first, and at the end what a rehearsal says of it."""
    missed = {name: ratio for name, ratio in plan.ratios.items() if not ratio <= 1.0}
    length = f"{length_words(plan.duration_s)} at {_speeds(plan)}"
    if not plan.wish.names:
        answer = f"{length} make the numbers of the line known as well as its limits allow."
    elif missed:
        answer = f"{length} do not meet {'the wish' if len(missed) == 1 else 'the wishes'} for {', '.join(missed)}."
    else:
        answer = f"{length} meet every wish, as predicted."
    return (
        answer,
        *_reach(plan),
        *(_miss(plan, name) for name in sorted(missed, key=lambda name: -missed[name])),
        *_binding(plan),
        *stairs_sentences(plan),
        *(remedy.sentence for remedy in remedies if missed),
        *(NOT_REHEARSED if rehearsal is None else rehearsal.sentences),
    )


def _reach(plan: Plan) -> list[str]:
    """Return how far the promise of a plan reaches where ship or noise are not known."""
    band = plan.band
    if band is None:
        return []
    share = f"{HELD * 10.0:.0f} of 10 ships that are possible"
    if band.seconds is not None:
        return [f"On {share} such a test meets the wishes in {_span(*band.seconds)}."]
    reaches = [
        (name, *band.deviations[name]) for name in numbers_of_line(plan.ship.structure) if name in band.deviations
    ]
    low, high = (float(np.median([one[end] for one in reaches])) for end in (1, 2))
    name, least, most = max(reaches, key=lambda one: one[2] / one[1])
    return [
        f"On {share} the numbers become known {low:.2g} to {high:.2g} times as far as predicted, in the median; least "
        f"sure is {name}, {least:.2g} to {most:.2g} times."
    ]


def _span(low_s: float, high_s: float) -> str:
    low, high = length_words(low_s), length_words(high_s)
    return f"{low.removesuffix(' min')} to {high}" if high.endswith(" min") else f"{low} to {high}"


def _speeds(plan: Plan) -> str:
    return " and ".join(f"{leg.level_rpm:.0f} rpm" for leg in plan.legs)


def _miss(plan: Plan, name: str) -> str:
    number, target = plan.promised[name], plan.targets[name]
    if not math.isfinite(number.std):
        return f"{name}: such a test does not show it, however long."
    best = stated(number.value, number.std, number.unit)
    return (
        f"{name}: the best that can be reached is {best}, {number.std / target:.3g} times the wish; such a test of "
        f"{length_words(plan.seconds_per_wish[name])} would reach it."
    )


def _binding(plan: Plan) -> list[str]:
    sentences = []
    for leg, peaks in zip(plan.legs, plan.peaks, strict=True):
        if not peaks.binding:
            continue
        *others, last = peaks.binding
        names = f"{', '.join(others)} and {last} keep" if others else f"{last} keeps"
        sentences.append(f"At {leg.level_rpm:.0f} rpm {names} the lines from being stronger.")
    return sentences
