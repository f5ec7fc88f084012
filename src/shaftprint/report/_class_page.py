"""The page on a class of sister ships: who is other than the others, and how much they differ."""

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from shaftprint.drift._sister_words import sister_sentences
from shaftprint.report._page import Page, write_page
from shaftprint.report.comparison._sister_tables import cause_spread_table, number_spread_table, sister_table
from shaftprint.report.comparison._tables import source_table
from shaftprint.report.figures._sisters import sister_chart
from shaftprint.report.sections._cover import Card, Cover, State
from shaftprint.report.sections._sections import Picture, Section

if TYPE_CHECKING:
    from collections.abc import Sequence
    from datetime import datetime

    from shaftprint.drift._class_finding import ClassFinding
    from shaftprint.drift._class_numbers import Sister

HEADLINES: Mapping[State, str] = {
    "look": "Not all ships are as their sisters are",
    "fine": "No ship is other than its sisters",
    "open": "It cannot be told",
}


def render_class(
    directory: str | Path,
    class_name: str,
    ships: "Sequence[Sister]",
    finding: "ClassFinding",
    *,
    now: "datetime",
) -> Path:
    """Write a page on a class of ships, ``index.html`` with its figure; return its path.

    ``directory``: where the page goes; made if it does not exist. ``class_name``: what the ships have in common.
    ``ships``, ``finding``: the ships, and what ``judge_sisters`` has found. ``now``: time of making, with time zone.
    Raises FileExistsError if there is a page already.
    """
    state: State = "look" if finding.odd else "open" if finding.because else "fine"
    tests = [test for ship in ships for test in ship.tests]
    page = Page(
        title=f"Class {class_name}",
        subtitle=f"{len(ships)} ships, {len(tests)} tests",
        created=now,
        version=tests[-1].fingerprint.shaftprint_version if tests else "",
        cover=Cover(
            headline=HEADLINES[state],
            state=state,
            opening="Each ship is held against what the others tell, with how much sisters differ as they are built.",
            cards=[
                Card(
                    question="Is a ship other than its sisters?",
                    state=state,
                    sentence=" ".join(sister_sentences(finding)),
                )
            ],
        ),
        sections=_sections(finding),
        files=source_table({f"{ship.name}, {test.name}": test.fingerprint for ship in ships for test in ship.tests}),
        ending="± is one standard deviation throughout; intervals hold 95 %.",
    )
    return write_page(directory, page)


def _sections(finding: "ClassFinding") -> list[Section]:
    if finding.because:
        return []
    left_out = [f"Left out: {name}, {why}." for name, why in finding.left_out.items()]
    picture = Picture(
        name="sisters",
        caption="Where each ship stands along each cause, as if it were this cause alone.",
        alt="A panel for each cause: ships from low to high with intervals, over the band that holds 95 % of sisters.",
        chart=partial(sister_chart, finding),
    )
    return [
        Section(
            key="ships", title="Ship by ship", points=left_out, tables=(sister_table(finding),), pictures=[picture]
        ),
        Section(
            key="spread",
            title="How much sisters differ",
            tables=(cause_spread_table(finding), number_spread_table(finding)),
        ),
    ]
