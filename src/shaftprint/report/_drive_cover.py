"""The first page of a drive's report: may the numbers be used, what they are, and what to do next."""

from typing import TYPE_CHECKING

from shaftprint.plain_table import Table, numbers, texts
from shaftprint.report.sections._cover import Card, Cover, overall
from shaftprint.report.sections.first_page._number_table import shown
from shaftprint.tables._conditions import tested_text

if TYPE_CHECKING:
    from collections.abc import Sequence

    from shaftprint.fingerprint._drive_fingerprint import DriveFingerprint, DriveRecord, DriveResponse
    from shaftprint.reasons import ReasonKind

_OPENING = "± is one standard deviation; where a range is given, the true value lies in it in 95 of 100 records."
# Reasons that say what the model leaves, and no way to mend it.
_WITHOUT_ADVICE: "Sequence[ReasonKind]" = ("misfit", "suspect", "unstable")
_COMPARE = "Hold other structures against the records: `shaftprint compare-structures`."


def drive_cover(fingerprint: "DriveFingerprint") -> Cover:
    """Return the first page of a drive's report."""
    verdict = fingerprint.verdict
    cards = [_usable(fingerprint), _explained(fingerprint), _predicts()]
    state, headline = overall(cards, usable=verdict.trustworthy, partly=bool(verdict.reasons))
    known = len(verdict.trusted) if verdict.trustworthy else 0
    return Cover(
        headline=headline,
        state=state,
        opening=_OPENING,
        known=f"{known} of {len(verdict.trusted) + len(verdict.not_trusted)} numbers are known",
        cards=cards,
        facts=_facts(fingerprint),
        tables=(_number_table(fingerprint),),
    )


def _usable(fingerprint: "DriveFingerprint") -> Card:
    """Return whether the numbers may be used; what speaks against them is the first reason of the verdict."""
    question, verdict = "Can the result be used?", fingerprint.verdict
    trusted, others = len(verdict.trusted), len(verdict.not_trusted)
    count = f"{trusted} of {trusted + others} numbers are known well enough to be used."
    if not verdict.reasons:
        if verdict.trustworthy:
            return Card(
                question=question, state="fine" if not others else "look", sentence=count, action=_marked(others)
            )
        return Card(
            question=question,
            state="bad",
            sentence="No number is known well enough.",
            action="Record larger and longer moves of the input; `shaftprint plan --drive` makes one.",
        )
    first = verdict.reasons[0]
    sentence, action = first.sentence, _COMPARE
    if first.kind not in _WITHOUT_ADVICE and "; " in sentence:
        # what to do stands behind what is wrong
        words, _, advice = sentence.rpartition("; ")
        sentence, action = f"{words}.", f"{advice[0].upper()}{advice[1:]}"
    if not verdict.trustworthy:
        return Card(question=question, state="bad", sentence=sentence, action=action)
    return Card(question=question, state="look", sentence=f"Only in part. {sentence} {count}", action=action)


def _marked(others: int) -> str:
    return "Use only the numbers that are not marked; longer or larger moves make more of them known." if others else ""


def _explained(fingerprint: "DriveFingerprint") -> Card:
    """Return how much of each output the model explains, beside what noise allows."""
    parts: list[DriveRecord | DriveResponse] = [*fingerprint.records, *fingerprint.responses]
    words = []
    for output in fingerprint.outputs:
        found = [(one.fit_percent[output], one.fit_ceiling[output]) for one in parts if output in one.fit_percent]
        if found:
            percent, ceiling = min(found)
            words.append(f"{percent:.1f} % of {output} where its noise allows {ceiling:.1f} %")
    is_explained = not any(reason.kind in ("misfit", "contradicting data") for reason in fingerprint.verdict.reasons)
    return Card(
        question="Does the model explain the records?",
        state="fine" if is_explained else "bad",
        sentence=f"{'Within their noise' if is_explained else 'Not within their noise'}: of the worst "
        f"{'record' if fingerprint.records else 'response'} FitPercent is {', '.join(words)}.",
        action="" if is_explained else "See below what it leaves, and compare structures.",
    )


def _predicts() -> Card:
    return Card(
        question="Does the model predict what it has not seen?",
        state="open",
        sentence="It was not held against another record of the drive.",
        action="Record one that moves otherwise: `shaftprint validate OTHER --drive FILE --fingerprint RESULT`.",
    )


def _facts(fingerprint: "DriveFingerprint") -> list[tuple[str, str]]:
    tested = tested_text(fingerprint.tested_at)
    seconds = sum(record.seconds for record in fingerprint.records)
    counted = f"{len(fingerprint.records)}, {seconds:.4g} s in all"
    return [
        ("Drive", fingerprint.drive),
        ("Structure", fingerprint.structure),
        *([("Tested", tested)] if tested else []),
        ("Records", counted) if fingerprint.records else ("Frequency responses", str(len(fingerprint.responses))),
    ]


def _number_table(fingerprint: "DriveFingerprint") -> Table:
    doubts = fingerprint.verdict.not_trusted
    rows = []
    for one in fingerprint.parameters:
        words = one.meaning or one.name
        is_marked = not fingerprint.verdict.trustworthy or one.name in doubts
        rows.append((f"{words[:1].upper()}{words[1:]}{' (not to be used)' * is_marked}", *shown(one)))
    columns = (*texts("what"), *numbers("found", "95 % interval"))
    return Table(title="What was found", columns=columns, rows=tuple(rows))
