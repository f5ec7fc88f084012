"""The page on a scan of service: every move of the lever in its place in the logs, and why it is not used."""

from collections import Counter
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import shaftprint
from shaftprint.plain_table import Column, Table, texts
from shaftprint.report._page import Page, write_page
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Mark, Points
from shaftprint.report.sections._cover import Card, Cover, State
from shaftprint.report.sections._sections import Picture, Section
from shaftprint.tables._service import asked_table
from shaftprint.units import SECONDS_PER_MINUTE

if TYPE_CHECKING:
    from datetime import datetime

    from shaftprint.service._scan import Scan
    from shaftprint.service._segment import Segment

USED, OTHER = "used", "another reason"
# A row of the strip, and the least height of it [px].
_ROW_PX, _LEAST_PX = 18, 60
# Reasons that have a colour of their own; the others share one.
_MOST_REASONS = 4


def render_service(directory: str | Path, found: "Scan", *, vessel: str, now: "datetime") -> Path:
    """Write a page on a scan, ``index.html`` with its strip; return its path.

    ``directory``: where the page goes; made if it does not exist. ``found``: what the scan saw. ``vessel``: name of the
    ship. ``now``: time of making, with time zone. Raises FileExistsError if there is a page already.
    """
    state: State = "bad" if found.refused else "fine" if found.used else "open"
    page = Page(
        title=f"Service of {vessel}",
        subtitle=f"{len(found.spans_s)} logs, {len(found.segments)} moves of the lever, {len(found.used)} of them used",
        created=now,
        version=shaftprint.__version__,
        cover=Cover(
            headline="Nothing may be fitted to these logs"
            if found.refused
            else "Moves of the lever in ordinary service",
            state=state,
            opening="Each move of the lever is a small test that nobody had to make.",
            cards=[Card(question="What did the logger see?", state=state, sentence=found.headline)],
        ),
        sections=_sections(found),
        files=Table(
            title="Logs",
            columns=(*texts("log"), Column("from [s]", number=True), Column("to [s]", number=True)),
            rows=tuple((Path(log).name, f"{a:.1f}", f"{b:.1f}") for log, (a, b) in found.spans_s.items()),
        ),
        ending="To take a segment out write no into the column used of its line in the table of segments.",
    )
    return write_page(directory, page)


def _sections(found: "Scan") -> list[Section]:
    strip = Picture(
        name="strip",
        caption="A row for each log, a mark for each move at the time of its beginning.",
        alt="Rows of marks over the minutes of each log, by whether a move is used and why it is not.",
        chart=partial(strip_chart, found),
    )
    columns = ("log", "move_s", "swing_rpm", "from_rpm", "to_rpm", "state", "used", "reason")
    moves = Table(
        title="Moves of the lever",
        columns=tuple(Column(name.replace("_", " "), number=name.endswith(("_s", "_rpm"))) for name in columns),
        rows=tuple(tuple(row[name] for name in columns) for row in found.rows),
    )
    doing = [f"{name}: {seconds / SECONDS_PER_MINUTE:.0f} min" for name, seconds in found.seconds.items()]
    return [
        Section(
            key="strip",
            title="Where the moves are",
            pictures=(strip,) if found.segments else (),
            points=(*doing, *(f"Could not be read: {one}" for one in found.left_out)),
        ),
        Section(key="asked", title="What was asked of the logs", tables=(asked_table(found),) if found.found else ()),
        Section(key="moves", title="Move by move", tables=(moves,) if found.rows else (), folded=True),
    ]


def strip_chart(found: "Scan") -> Chart:
    """Return the moves of each log over its minutes, those that are used apart from those that are not."""
    logs = list(found.spans_s)
    reasons = Counter(one.reason for one in found.segments if one.reason)
    usual = [reason for reason, _ in reasons.most_common(_MOST_REASONS)]
    marks: list[Mark] = []
    for shade, name in enumerate([USED, *usual, OTHER]):
        some = [one for one in found.segments if _kind(one, usual) == name]
        if some:
            marks.append(_points(found, some, logs, name, shade))
    return Chart(
        panels=[
            Panel(
                marks=marks,
                x=Scale(title="time in the log [min]"),
                y=Scale(names=[Path(log).name for log in logs], span=(len(logs) - 0.5, -0.5)),
            )
        ],
        heights_px=(max(_ROW_PX * len(logs), _LEAST_PX),),
    )


def _kind(segment: "Segment", usual: Sequence[str]) -> str:
    if not segment.reason:
        return USED
    return segment.reason if segment.reason in usual else OTHER


def _points(found: "Scan", some: "Sequence[Segment]", logs: Sequence[str], name: str, shade: int) -> Points:
    return Points(
        x=np.array([(one.move_s - found.spans_s[one.log][0]) / SECONDS_PER_MINUTE for one in some]),
        y=np.array([float(logs.index(one.log)) for one in some]),
        name=name,
        shade=shade,
        filled=name == USED,
        words=[f"{one.move_s:.1f} s: {one.reason or USED}" for one in some],
    )
