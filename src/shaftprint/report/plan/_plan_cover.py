"""The first page of a plan: the card for the bridge, are the wishes met, are the limits kept, was it rehearsed."""

from typing import TYPE_CHECKING

from shaftprint.design.plan._plan import length_words
from shaftprint.design.views._abort_card import abort_card
from shaftprint.digits import plain
from shaftprint.identify.judgement._requirements import Requirements
from shaftprint.report.sections._cover import Card, Cover
from shaftprint.tables._plan import abort_table, swing_words, wish_table
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.design.planned_test._planned_test import PlannedTest


def plan_cover(test: "PlannedTest") -> Cover:
    """Return the first page of a plan."""
    plan = test.plan
    cards = [_wishes(test), _limits(test), _rehearsed(test), *_remarked(test)]
    is_enough = not plan.wish.names or plan.is_enough
    # that it was not rehearsed is no fault of the plan
    has_doubts = any(card.state == "look" for card in cards)
    return Cover(
        headline=test.sentences[0].removesuffix("."),
        state="bad" if not is_enough else "look" if has_doubts else "fine",
        opening=(
            "Predicted, not measured: standard deviations to first order, for the assumed ship and noise. Planned with "
            f"the {test.noise_source}."
        ),
        leading=(abort_table(abort_card(test)),),
        cards=cards,
        facts=_facts(test),
        tables=(wish_table(test),) if test.plan.wish.names else (),
    )


def _facts(test: "PlannedTest") -> list[tuple[str, str]]:
    plan = test.plan
    largest = max(leg.peak_rpm for leg in plan.legs)
    moved = swing_words(test.line, largest)
    return [
        ("Length", f"{length_words(plan.duration_s)}, the way back and the staircase included"),
        ("Speeds", ", ".join(f"{plain(leg.level_rpm, 0)} rpm" for leg in plan.legs)),
        ("Set point", f"± {plain(largest, 0)} rpm, ± {moved} at most, about each speed"),
    ]


def _wishes(test: "PlannedTest") -> Card:
    plan, question = test.plan, "Does it meet the wishes?"
    if not plan.wish.names:
        return _told(test)
    ratios = plan.ratios
    missed = sorted((name for name, ratio in ratios.items() if not ratio <= 1.0), key=lambda name: -ratios[name])
    if not missed:
        worst = max(ratios, key=lambda name: ratios[name])
        words = f"All of them, as predicted; nearest to its wish is {worst}, {ratios[worst]:.2g} times it."
        return Card(question=question, state="fine", sentence=words)
    words = ", ".join(f"{name} {ratios[name]:.3g} times" for name in missed)
    action = test.remedies[0].sentence if test.remedies else "Allow more time or a larger set point."
    return Card(question=question, state="bad", sentence=f"Not all; predicted over the wish: {words}.", action=action)


def _told(test: "PlannedTest") -> Card:
    """Return what the test would tell where nothing is wished, by what the verdict on it will ask."""
    least = PERCENT * Requirements().largest_std
    shares = {
        one.name: PERCENT * one.std / abs(one.value) for one in test.plan.promised.values() if one.value and one.std
    }
    order = sorted(shares, key=lambda name: shares[name])
    known, others = (
        [f"{name} {shares[name]:.2g} %" for name in order if (shares[name] <= least) is side] for side in (True, False)
    )
    words = f"In one standard deviation: {', '.join(known)}." if known else ""
    words += f" Beyond that: {', '.join(others)}." if others else ""
    answer = f"{len(known)} of {len(order)} numbers to {least:g} % or better"
    return Card(question="What would it tell?", state="open", answer=answer, sentence=words.strip())


def _limits(test: "PlannedTest") -> Card:
    names = list(dict.fromkeys(name for peaks in test.plan.peaks for name in peaks.binding))
    limits = test.plan.limits
    noise = (
        f"which noise passes for at most {PERCENT * limits.share_over:g} % of the time"
        if limits.noise_sigmas is None
        else f"with {limits.noise_sigmas:g} standard deviations of noise left free"
    )
    words = f"Planned for 98 of 100 ships that are possible within what is assumed, {noise}."
    bound = f" It is bound by {', '.join(names)}." if names else ""
    return Card(question="Does it keep the limits of ship and engine?", state="fine", sentence=words + bound)


def _rehearsed(test: "PlannedTest") -> Card:
    question, rehearsal = "Was it rehearsed?", test.rehearsal
    if rehearsal is None:
        return Card(
            question=question,
            state="open",
            answer="No",
            sentence="Its numbers are predictions that nobody has tried.",
            action="Plan it again with --rehearse 20, which sails it on the simulated ship.",
        )
    sentences = rehearsal.sentences
    return Card(question=question, state="fine" if len(sentences) == 1 else "look", sentence=" ".join(sentences))


def _remarked(test: "PlannedTest") -> list[Card]:
    """Return what is to be known before the test is sailed, such as a noise that nobody has measured."""
    if not test.remarks:
        return []
    return [Card(question="What should you know before you sail it?", state="look", sentence=" ".join(test.remarks))]
