"""The page on the history of a line: whether it drifts, since when, and each cause over time."""

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from shaftprint.drift._causes import ALL_CAUSES
from shaftprint.drift._differ import differ
from shaftprint.drift._finding import SizedCause
from shaftprint.drift._words import drift_sentence, noted_sentences, open_sentences, watch_sentences
from shaftprint.report._page import Page, write_page
from shaftprint.report.comparison._history_tables import course_table, history_table, other_course_table
from shaftprint.report.comparison._tables import source_table
from shaftprint.report.figures._history import history_chart
from shaftprint.report.sections._cover import Card, Cover, State
from shaftprint.report.sections._sections import Picture, Section

if TYPE_CHECKING:
    from datetime import datetime

    from shaftprint.drift._drift_finding import Outcome, WatchFinding
    from shaftprint.drift._history import History


HEADLINES: Mapping[State, str] = {
    "look": "The {noun} has changed by more than chance",
    "worn": "Worn as expected; nothing else is seen",
    "fine": "No change is seen",
    "open": "It cannot be told",
}
_STATES: "Mapping[Outcome, State]" = {
    "changed": "look",
    "worn as expected": "worn",
    "unchanged": "fine",
    "cannot be told": "open",
}


def render_history(
    directory: str | Path,
    title: str,
    history: "History",
    finding: "WatchFinding",
    *,
    now: "datetime",
    load_repeatability: float,
) -> Path:
    """Write a page on the history of a line, ``index.html`` with its figure; return its path.

    ``directory``: where the page goes; made if it does not exist. ``title``: what the line is called. ``history``,
    ``finding``: the tests, and what ``watch`` has found in them. ``now``: time of making, with time zone.
    ``load_repeatability``: as in ``watch``. Raises FileExistsError if there is a page already.
    """
    sizes = sizes_of_tests(history, load_repeatability=load_repeatability)
    noun = history.tests[0].fingerprint.noun if history.tests else "ship"
    state = _STATES[finding.outcome]
    days = f"{history.tests[0].at:%Y-%m-%d} to {history.tests[-1].at:%Y-%m-%d}" if history.tests else ""
    page = Page(
        title=f"History of {title}",
        subtitle=f"{len(history.tests)} tests, {days}",
        created=now,
        version=history.tests[-1].fingerprint.shaftprint_version if history.tests else "",
        cover=Cover(
            headline=HEADLINES[state].format(noun=noun),
            state=state,
            opening="Every cause is judged in all tests together, against an unchanged ship that is tested for years.",
            cards=_cards(finding, history, state, noun=noun),
        ),
        sections=_sections(history, finding, sizes),
        files=source_table({test.name: test.fingerprint for test in history.tests}),
        ending="± is one standard deviation throughout; intervals hold 95 %.",
    )
    return write_page(directory, page)


def _cards(finding: "WatchFinding", history: "History", state: State, *, noun: str) -> list[Card]:
    """Return a card for each change with what to do, wear that is expected after the others, then what was noted."""
    if not finding.drifts:
        sentences = watch_sentences(finding, history)
        return [Card(question=f"Has the {noun} changed?", state=state, sentence=" ".join(sentences))]
    cards = []
    for drift in finding.by_urgency:
        best, sentence = drift.best, drift_sentence(drift, finding, history)
        question = f"{'Expected wear' if best.is_expected else 'Changed'}: {best.cause.name}"
        action = f"{best.to_do[:1].upper()}{best.to_do[1:]}."
        mark: State = "worn" if best.is_expected else "look"
        cards.append(Card(question=question, state=mark, sentence=sentence, action=action))
    cards += [
        Card(question="What did the work that was noted?", state="fine", sentence=sentence)
        for sentence in noted_sentences(finding)
    ]
    if finding.not_judged:
        sentence = " ".join(open_sentences(finding.not_judged))
        cards.append(Card(question="What is not excluded?", state="open", sentence=sentence))
    return cards


def sizes_of_tests(history: "History", *, load_repeatability: float) -> dict[str, list[SizedCause | None]]:
    """Return the size of each cause of every test against the first one, by the name of the cause."""
    if not history.tests:
        return {}
    first = history.tests[0].fingerprint
    rows: list[Mapping[str, SizedCause]] = []
    for test in history.tests[1:]:
        finding = differ(first, test.fingerprint, load_repeatability=load_repeatability)
        change = finding.changes[0] if finding.changes else finding.nearest
        rows.append({one.cause.name: one for one in (() if change is None else change.candidates)})
    names = dict.fromkeys([cause.name for cause in ALL_CAUSES] + [name for row in rows for name in row])
    return {name: [None, *(row.get(name) for row in rows)] for name in names if any(name in row for row in rows)}


def _sections(
    history: "History", finding: "WatchFinding", sizes: Mapping[str, Sequence[SizedCause | None]]
) -> list[Section]:
    pictures = (
        [
            Picture(
                name="history",
                caption="How far each test is from the first one, if it is this cause alone.",
                alt="A strip for each cause: points with intervals over the years, upright lines where work was done.",
                chart=partial(history_chart, history, sizes),
            )
        ]
        if sizes
        else []
    )
    left_out = [f"Left out: {name}, {why}." for name, why in (history.left_out | finding.left_out).items()]
    return [
        Section(
            key="courses",
            title="What may have changed",
            paragraphs=(
                "A step stays, a ramp grows. The probability is that of an unchanged ship in all its tests up to "
                "twenty, so that five years of quarterly tests give one false alarm in twenty ships.",
            ),
            tables=(course_table(finding, history),) if not finding.because else (),
        ),
        *(
            [Section(key="others", title="Other explanations", tables=(others,), folded=True)]
            if (others := other_course_table(finding, history)).rows
            else []
        ),
        Section(
            key="history",
            title="Test by test",
            points=left_out,
            tables=(history_table(history, sizes),),
            pictures=pictures,
        ),
    ]
