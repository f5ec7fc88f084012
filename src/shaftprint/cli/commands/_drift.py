"""``shaftprint drift``: the tests of one line over the years."""

from datetime import UTC, datetime, tzinfo
from pathlib import Path

import click
import numpy as np

from shaftprint.cli._report_options import DATE_FORMATS
from shaftprint.cli._terminal import answer, echo, say
from shaftprint.cli.output import REPORT, fingerprint_at, force_option, give, output_folder, print_tables
from shaftprint.drift import EVENTS, LOAD_REPEATABILITY, Event, history_of, watch, watch_sentences
from shaftprint.report import course_table, history_table, render_history, sizes_of_tests
from shaftprint.zones import in_zone, time_zone

FEWEST = 2
PERCENT = 100.0
SEED = 1


class EventAt(click.ParamType):  # type: ignore[type-arg]
    """What was done to the ship and when, such as ``docking=2026-05-01``."""

    name = "event"

    def convert(self, value: object, param: click.Parameter | None, ctx: click.Context | None) -> tuple[str, datetime]:
        """Return kind and time of an event."""
        kind, _, moment = str(value).partition("=")
        if kind not in EVENTS:
            self.fail(f"expected KIND=DATE with one of {', '.join(EVENTS)}, such as docking=2026-05-01.", param, ctx)
        at: datetime = click.DateTime(DATE_FORMATS).convert(moment, param, ctx)
        return kind, at


def _zone(_: click.Context, option: click.Parameter, value: str) -> tzinfo:
    try:
        return time_zone(value)
    except ValueError as error:
        raise click.BadParameter(f"{error}.", param=option) from None


@click.command("drift")
@click.argument("fingerprints", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option(
    "--event",
    "events",
    multiple=True,
    type=EventAt(),
    metavar="KIND=DATE",
    help=f"What was done to the ship: {', '.join(EVENTS)}; numbers that it concerns begin anew. May be repeated.",
)
@click.option(
    "--time-zone",
    "zone",
    default="UTC",
    callback=_zone,
    show_default=True,
    metavar="ZONE",
    help="Zone of dates of events without an offset, such as Europe/Amsterdam.",
)
@click.option(
    "--load-repeatability",
    "load_percent",
    type=click.FloatRange(min=0.0),
    default=PERCENT * LOAD_REPEATABILITY,
    show_default=True,
    metavar="PERCENT",
    help="Standard deviation of the propeller's torque at one speed from day to day.",
)
@click.option("-o", "--output", type=click.Path(path_type=Path), help="Folder for a page with a chart over the years.")
@force_option
def command(
    fingerprints: tuple[Path, ...],
    events: tuple[tuple[str, datetime], ...],
    zone: tzinfo,
    load_percent: float,
    output: Path | None,
    force: bool,
) -> None:
    """Watch a line over the years: what has changed, since when, and how fast.

    FINGERPRINTS are the JSON files of all tests of one line, or the folders in which identify has put them, in any
    order: each says when its test was made. Steps and ramps are looked for in all of them together.
    """
    if len(fingerprints) < FEWEST:
        raise click.UsageError(f"expected two or more fingerprints, found {len(fingerprints)}; name another one.")
    named = {_called(path): fingerprint_at(path) for path in fingerprints}
    if len(named) < len(fingerprints):
        raise click.UsageError("expected fingerprints in folders or files of different names, found two alike.")
    done = [_event(kind, moment, zone) for kind, moment in events]
    history, load = history_of(named, done), load_percent / PERCENT
    finding = watch(history, rng=np.random.default_rng(SEED), load_repeatability=load)
    ship = next((one.conditions.vessel for one in named.values()), "")
    if output is not None:
        with output_folder(output, of="drift", force=force) as folder:
            render_history(folder, ship, history, finding, now=datetime.now(UTC), load_repeatability=load)
    answer(f"Has the ship changed? {' '.join(watch_sentences(finding, history))}")
    for name, why in history.left_out.items():
        say(f"Left out: {name}, {why}.")
    give("finding", finding)
    give("tests", [{"name": test.name, "at": test.at.isoformat()} for test in history.tests])
    give("left_out", history.left_out)
    sizes = sizes_of_tests(history, load_repeatability=load)
    print_tables([history_table(history, sizes), *([] if finding.because else [course_table(finding, history)])])
    if output is not None:
        echo(f"Report: {output / REPORT}")


def _event(kind: str, moment: datetime, zone: tzinfo) -> Event:
    try:
        return Event(kind=kind, at=in_zone(moment, zone))
    except ValueError as error:
        raise click.UsageError(f"--event {kind}: {error}.") from None


def _called(path: Path) -> str:
    place = path.resolve()
    return place.parent.name if place.name == "fingerprint.json" else place.name.removesuffix(".json")
