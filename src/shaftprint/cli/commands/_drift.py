"""``shaftprint drift``: the tests of one line over the years."""

from __future__ import annotations

from datetime import UTC, datetime, tzinfo
from pathlib import Path

import click

from shaftprint.cli._cause_size import CauseSize
from shaftprint.cli._command_group import CHANGED, NOT_REACHED
from shaftprint.cli._dates import Moment, zone_option
from shaftprint.cli._load_option import load_repeatability_option
from shaftprint.cli._store_options import instant, opened_store, store_option
from shaftprint.cli._terminal import answer, details, echo, say
from shaftprint.cli._terminal import output as spoken
from shaftprint.cli.output._fingerprint_file import REPORT, any_fingerprint_at
from shaftprint.cli.output._json import give
from shaftprint.cli.output._output_folder import force_option, output_folder
from shaftprint.cli.output._tables import print_tables
from shaftprint.errors import FingerprintError
from shaftprint.late import late
from shaftprint.spelling import listed
from shaftprint.store._nouns import KINDS

with late():
    import numpy as np

    from shaftprint.drift._causes import Cause, may_happen
    from shaftprint.drift._dated import Event
    from shaftprint.drift._history import History, history_of
    from shaftprint.drift._watch import watch
    from shaftprint.drift._words import limit_sentence, watch_sentences
    from shaftprint.fingerprint._design import another_design
    from shaftprint.fingerprint._line_fingerprint import LineFingerprint
    from shaftprint.report._history_page import render_history, sizes_of_tests
    from shaftprint.report.comparison._history_tables import course_table, history_table, other_course_table
    from shaftprint.store._line_history import line_history


FEWEST = 2
PERCENT = 100.0
SEED = 1
_EXIT_CODES = {"cannot be told": NOT_REACHED, "changed": CHANGED}


class EventAt(click.ParamType):  # type: ignore[type-arg]
    """What was done to the ship and when, such as ``docking=2026-05-01``."""

    name = "event"

    def convert(self, value: object, param: click.Parameter | None, ctx: click.Context | None) -> tuple[str, datetime]:
        """Return kind and time of an event."""
        kind, _, moment = str(value).partition("=")
        if kind not in KINDS:
            self.fail(f"expected KIND=DATE with one of {', '.join(KINDS)}, such as docking=2026-05-01.", param, ctx)
        at: datetime = Moment().convert(moment, param, ctx)
        return kind, at


@click.command("drift")
@click.argument("tests", metavar="SHIP|FINGERPRINT...", nargs=-1, required=True)
@store_option
@click.option("--line", metavar="NAME", help="Shaft line of the ship in the store, where it has several.")
@click.option(
    "--event",
    "events",
    multiple=True,
    type=EventAt(),
    metavar="KIND=DATE",
    help=f"What was done to the ship: {', '.join(KINDS)}; numbers that it concerns begin anew. May be repeated.",
)
@click.option(
    "--limit",
    "limits",
    multiple=True,
    type=CauseSize(),
    metavar="CAUSE=SIZE",
    help="When a slow change reaches a size, such as propeller=10% or delay=20ms; the first words of a cause will do.",
)
@zone_option("Zone of dates of events without an offset, such as Europe/Amsterdam; UTC by default.")
@load_repeatability_option
@click.option("-o", "--output", type=click.Path(path_type=Path), help="Folder for a page with a chart over the years.")
@force_option
@click.option(
    "--exit-code",
    "as_exit_code",
    is_flag=True,
    help=f"End with {CHANGED} where the ship has changed by more than wear that is expected, with {NOT_REACHED} where "
    "it cannot be told, for what watches by itself.",
)
@click.pass_context
def command(
    context: click.Context,
    tests: tuple[str, ...],
    url: str,
    *,
    line: str | None,
    events: tuple[tuple[str, datetime], ...],
    limits: tuple[tuple[tuple[Cause, ...], float], ...],
    zone: tzinfo | None,
    load_percent: float,
    output: Path | None,
    force: bool,
    as_exit_code: bool,
) -> None:
    """Watch a line over the years: what has changed, since when, and how fast.

    Takes the name or IMO number of a SHIP in the store, or the FINGERPRINTs of all tests of one line, in any order:
    JSON files, or the folders in which identify has put them. Each says when its test was made. Steps and ramps are
    looked for in all of them together.
    """
    done = [Event(kind=kind, at=instant(moment, zone or UTC, option="--event")) for kind, moment in events]
    title, fingerprints, kept = _of_files(tests) if _are_files(tests) else _of_ship(tests[0], url, line)
    noun = next((one.noun for one in fingerprints.values()), "ship")
    history, load = history_of(fingerprints, (*kept, *done)), load_percent / PERCENT
    finding = watch(history, rng=np.random.default_rng(SEED), load_repeatability=load)
    if output is not None:
        with output_folder(output, of="drift", force=force) as folder:
            render_history(folder, title, history, finding, now=datetime.now(UTC), load_repeatability=load)
    answer(f"Has the {noun} changed? {' '.join(watch_sentences(finding, history))}")
    for causes, size in limits:
        answer(limit_sentence(finding, _of_the_line(causes, history), size, history))
    give("finding", finding)
    _print_history(history, load)
    print_tables([] if finding.because else [course_table(finding, history)])
    with details():
        print_tables([] if finding.because else [other_course_table(finding, history)])
    if output is not None:
        echo(f"Report: {output / REPORT}")
    if as_exit_code and finding.outcome in _EXIT_CODES:
        context.exit(_EXIT_CODES[finding.outcome])


def _of_the_line(causes: tuple[Cause, ...], history: History) -> Cause:
    """Return the cause that may happen in what drives the line; the first where its tests do not say."""
    roles = [one.role for test in history.tests[:1] for one in test.fingerprint.parameters]
    return next((cause for cause in causes if may_happen(cause, roles)), causes[0])


def _print_history(history: History, load: float) -> None:
    for name, why in history.left_out.items():
        say(f"Left out: {name}, {why}.")
    give("tests", [{"name": test.name, "at": test.at.isoformat()} for test in history.tests])
    give("left_out", history.left_out)
    if spoken().quiet and spoken().document is None:
        # each test against the first takes as long as the answer
        return
    print_tables([history_table(history, sizes_of_tests(history, load_repeatability=load))])


def _are_files(tests: tuple[str, ...]) -> bool:
    """Return whether files are named, not a ship of the store: one that is not there is a mistyped file."""
    return len(tests) > 1 or Path(tests[0]).exists()


def _of_files(tests: tuple[str, ...]) -> tuple[str, dict[str, LineFingerprint], tuple[Event, ...]]:
    """Return what a line is called, and its fingerprints by the names of their folders or files."""
    if len(tests) < FEWEST:
        raise click.UsageError(f"expected two or more fingerprints, found {len(tests)}; name another one.")
    named = {_called(Path(path)): any_fingerprint_at(Path(path)) for path in tests}
    if len(named) < len(tests):
        raise click.UsageError("expected fingerprints in folders or files of different names, found two alike.")
    names, fingerprints = list(named), list(named.values())
    place, designs = another_design([one.stated_fields for one in fingerprints])
    title = fingerprints[0].title
    if designs:
        raise FingerprintError(
            f"{names[place]}: expected a test of {title}, as {names[0]} is, found one of {fingerprints[place].title}: "
            f"{listed([one.both for one in designs])}; leave it out."
        )
    return title, named, ()


def _of_ship(ship: str, url: str, line: str | None) -> tuple[str, dict[str, LineFingerprint], tuple[Event, ...]]:
    """Return what a line of the store is called, its fingerprints by the day of their test, and what was done to it."""
    with opened_store(url) as store:
        found = line_history(store, ship, line=line)
    return f"{found.line.ship.name}, {found.line.position}", found.fingerprints, found.events


def _called(path: Path) -> str:
    place = path.resolve()
    return place.parent.name if place.name == "fingerprint.json" else place.name.removesuffix(".json")
