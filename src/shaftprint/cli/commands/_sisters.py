"""``shaftprint sisters``: the ships of a class against each other."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import click

from shaftprint.choices import NEWEST_TESTS
from shaftprint.cli._cause_size import CauseSize
from shaftprint.cli._load_option import load_repeatability_option
from shaftprint.cli._store_options import opened_store, store_option
from shaftprint.cli._terminal import answer, echo, say
from shaftprint.cli.output._fingerprint_file import REPORT
from shaftprint.cli.output._json import give
from shaftprint.cli.output._output_folder import force_option, output_folder
from shaftprint.cli.output._tables import print_tables
from shaftprint.late import late

with late():
    from shaftprint.drift._causes import Cause
    from shaftprint.drift._sister_words import sister_sentences
    from shaftprint.drift._sisters import judge_sisters
    from shaftprint.report._class_page import render_class
    from shaftprint.report.comparison._sister_tables import cause_spread_table, number_spread_table, sister_table
    from shaftprint.store._class_histories import class_histories
    from shaftprint.store._sisters import sisters_of


PERCENT = 100.0


@click.command("sisters")
@click.argument("class_name", metavar="CLASS")
@store_option
@click.option("--line", metavar="NAME", help="Shaft line of the ships, such as port; all of them by default.")
@click.option(
    "--newest", type=click.IntRange(min=1), default=NEWEST_TESTS, show_default=True, metavar="COUNT",
    help="Tests that stand for a ship, the newest ones since the last thing that was done to it.",
)  # fmt: skip
@click.option(
    "--tolerance",
    "tolerances",
    multiple=True,
    type=CauseSize(),
    metavar="CAUSE=SIZE",
    help="Standard deviation between sisters as built that the yard knows, such as injection=1% or delay=1ms. With one "
    "or more the usual ones of other causes are taken as known too, not told from the ships.",
)
@load_repeatability_option
@click.option("-o", "--output", type=click.Path(path_type=Path), help="Folder for a page with a chart of the ships.")
@force_option
def command(
    class_name: str,
    url: str,
    *,
    line: str | None,
    newest: int,
    tolerances: tuple[tuple[tuple[Cause, ...], float], ...],
    load_percent: float,
    output: Path | None,
    force: bool,
) -> None:
    """Compare the ships of a class: which one differs, and in what.

    Takes the CLASS that ships of the store have in common. Each ship is held against what the others tell, along the
    causes of drift, with how much sisters differ as they are built.
    """
    with opened_store(url) as store:
        lines = class_histories(store, class_name, line=line, newest=newest)
    ships, left_out = sisters_of(lines, newest=newest)
    for name in left_out:
        say(f"Left out: {name}, none of its tests can be judged.")
    known = {cause: size for causes, size in tolerances for cause in causes}
    finding = judge_sisters(ships, load_repeatability=load_percent / PERCENT, tolerances=known or None)
    if output is not None:
        with output_folder(output, of="sisters", force=force) as folder:
            render_class(folder, class_name, ships, finding, now=datetime.now(UTC))
    answer(f"Is a ship other than its sisters? {' '.join(sister_sentences(finding))}")
    give("finding", finding)
    if not finding.because:
        print_tables([sister_table(finding), cause_spread_table(finding), number_spread_table(finding)])
    if output is not None:
        echo(f"Report: {output / REPORT}")
