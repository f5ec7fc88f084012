"""A plan in sentences: what is met, what is not, by how much, and what binds."""

from collections.abc import Sequence

from shaftprint.design._plan import Plan
from shaftprint.design._remedies import Remedy
from shaftprint.digits import stated
from shaftprint.units import SECONDS_PER_MINUTE


def plan_sentences(plan: Plan, remedies: Sequence[Remedy] = ()) -> tuple[str, ...]:
    """Return what a plan reaches, the answer first."""
    minutes = plan.duration_s / SECONDS_PER_MINUTE
    missed = {name: ratio for name, ratio in plan.ratios.items() if not ratio <= 1.0}
    length = f"{minutes:.3g} min at {_speeds(plan)}"
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
        "The plan was not rehearsed.",
    )


def _speeds(plan: Plan) -> str:
    return " and ".join(f"{leg.level_rpm:.0f} rpm" for leg in plan.legs)


def _miss(plan: Plan, name: str) -> str:
    number, target = plan.predicted.estimate(name), plan.targets[name]
    best = stated(number.value, number.std, number.unit)
    needed_s = plan.seconds_per_wish[name]
    longer = "no such test shows it"
    if needed_s < float("inf"):
        longer = f"such a test of {needed_s / SECONDS_PER_MINUTE:.3g} min would reach it"
    return f"{name}: the best that can be reached is {best}, {number.std / target:.3g} times the wish; {longer}."


def _binding(plan: Plan) -> list[str]:
    sentences = []
    for leg, peaks in zip(plan.legs, plan.peaks, strict=True):
        keeps = "keeps" if len(peaks.binding) == 1 else "keep"
        sentences.append(
            f"At {leg.level_rpm:.0f} rpm {' and '.join(peaks.binding)} {keeps} the lines from being stronger."
        )
    return sentences
