"""What the actions of ``shaftprint live`` share: options, what is printed while a test runs, and how it ends."""

from __future__ import annotations

import contextlib
import os
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from shaftprint.cli._next import print_next
from shaftprint.cli._plan_options import seconds_of
from shaftprint.cli._terminal import answer, details, echo, print_findings, ring
from shaftprint.cli.output._fingerprint_file import fingerprint_of
from shaftprint.cli.output._json import give
from shaftprint.escape import printable
from shaftprint.late import late

with late():
    from shaftprint.live._outcome import Ask
    from shaftprint.live._page import LivePages
    from shaftprint.live._proof import prove

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.live._block import Event
    from shaftprint.live._envelope import Envelope
    from shaftprint.live._judgement import LineJudgement
    from shaftprint.live._outcome import Operator, Outcome
    from shaftprint.live._proof import Proof
    from shaftprint.live._record import Left
    from shaftprint.survey._trial import Trial

KEYS: Mapping[str, str] = {"h": "hold", "g": "go on", "s": "skip", "r": "repeat"}
"""What a key asks for while a test is played."""

slope_option = click.option(
    "--rpm-per-volt",
    "slope_rpm_per_v",
    type=float,
    help="What one volt asks for [rpm/V], where neither campaign nor fingerprint say it.",
)
fingerprint_option = click.option(
    "--fingerprint", type=click.Path(path_type=Path), help="Fingerprint of an earlier test, to predict the motion with."
)

plan_option = click.option(
    "--plan",
    "place",
    type=click.Path(path_type=Path),
    help="Folder of shaftprint plan: a leg ends early where its wishes are met, as predicted.",
)

within_option = click.option(
    "--within",
    "within_s",
    metavar="TIME",
    type=seconds_of,
    help="Longest time that legs go on and come again for the wishes of --plan; as long as the campaign without it.",
)

page_option = click.option(
    "--page", "port", type=click.IntRange(1, 65535), help="Port of this computer for the pages of bridge and engineer."
)


def recording_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the option ``--output`` of a recording that must not be there yet."""
    return click.option(
        "-o",
        "--output",
        required=True,
        type=click.Path(path_type=Path),
        help="Recording to write; campaign as played and log go beside it.",
    )(command)


def prover(
    trial: Trial, envelope: Envelope, *, fingerprint: Path | None, slope_rpm_per_v: float | None
) -> Callable[[Campaign], Proof]:
    """Return what holds a campaign of a ship against its envelope, before the test and where it is changed in it."""
    known = fingerprint_of(trial.vessel, fingerprint)

    def proof_of(campaign: Campaign) -> Proof:
        return prove(campaign, trial.vessel, envelope, fingerprint=known, slope_rpm_per_v=slope_rpm_per_v)

    return proof_of


def proved(proof: Proof) -> Proof:
    """Print what a campaign will do, and what speaks against it."""
    for one in proof.foreseen:
        bound = "" if one.bound is None else f"; allowed {one.bound.lowest:g} to {one.bound.highest:g} {one.unit}"
        echo(f"{one.quantity}: foreseen {one.lowest:.5g} to {one.highest:.5g} {one.unit}{bound}")
    echo(f"Band: {proof.band}.")
    give("foreseen", proof.foreseen)
    if proof.refusals:
        print_findings("Not to be played", proof.refusals)
    return proof


@contextlib.contextmanager
def shown_on_pages(port: int | None, operator: Operator) -> Iterator[LivePages | None]:
    """Show the test on pages of this computer, where a port is given."""
    if port is None:
        yield None
        return
    with LivePages(port, operator) as pages:
        echo(f"Bridge: {pages.url}   engineer: {pages.url_of_engineer}", err=True)
        yield pages


def tell(event: Event) -> None:
    """Print an event; an abort rings."""
    if event.kind in ("abort", "alarm"):
        ring()
    echo(f"{event.time_s:9.2f} s  {event.kind:<10} {event.sentence}", err=True)


def tell_and_listen(operator: Operator) -> Callable[[Event], None]:
    """Return what prints events, and takes keys from the terminal once something is played."""
    listens = [sys.stdin.isatty()]

    def told(event: Event) -> None:
        tell(event)
        if event.kind == "state" and event.sentence == "armed" and listens[0]:
            listens[0] = False
            keys = ", ".join(f"{key} {ask}" for key, ask in KEYS.items())
            echo(f"Keys, each with Enter: {keys}; Ctrl-C aborts.", err=True)
            threading.Thread(target=take_keys, args=(sys.stdin.fileno(), operator), daemon=True).start()

    return told


def take_keys(file: int, operator: Operator) -> None:
    """Take keys until there are none any more; read past the buffer, which would be locked when the program ends."""
    while said := os.read(file, 256):
        for key in said.decode(errors="replace").split():
            if key in KEYS:
                operator.asks.append(Ask(KEYS[key]))
            else:
                echo(f"{printable(key)}: expected one of {', '.join(KEYS)}; nothing was changed.", err=True)


def print_judged(judgements: tuple[LineJudgement, ...]) -> None:
    """Print how well each leg or sine is known, and with `-v` what is known of each test frequency."""
    of_test: dict[str, list[LineJudgement]] = {}
    for one in judgements:
        of_test.setdefault(one.line.partition("/")[0], []).append(one)
    for test, lines in of_test.items():
        words = [
            f"{name} to {_middle([_share(one, place) for one in lines]):.1%}"
            for place, name in enumerate(lines[0].outputs)
        ]
        known = f"test frequencies over {lines[0].periods} periods, each known in the middle: {', '.join(words)}"
        echo(f"{test}: {len(lines)} {known}.")
    with details():
        echo("Size of each output over the set point, in the units of the channels:")
        for one in judgements:
            sizes = ", ".join(
                f"{name} {abs(value):.4g} +/- {std:.2g}"
                for name, value, std in zip(one.outputs, one.response.tolist(), one.std.tolist(), strict=True)
            )
            echo(f"{one.line:<8} {one.frequency_hz:8.4g} Hz  {one.periods} periods  {sizes}")


def _share(judgement: LineJudgement, place: int) -> float:
    return float(judgement.std[place]) / max(abs(complex(judgement.response[place])), 1e-300)


def _middle(shares: list[float]) -> float:
    return sorted(shares)[len(shares) // 2]


def print_outcome(outcome: Outcome, left: Left, *, vessel: str) -> None:
    """Print how a test ended, what it has left and what comes next."""
    answer(f"{outcome.word}{': ' if outcome.reason else ''}{outcome.reason}")
    if not outcome.is_back:
        answer("NOTHING HAS SHOWN THAT THE LEVER RULES: take the engine to local control.")
    print_judged(outcome.judgements)
    give("word", outcome.word)
    give("reason", outcome.reason)
    give("lever_rules", outcome.is_back)
    answer(f"{left.recording}: every block that came.")
    if left.campaign is not None:
        answer(f"{left.campaign}: the campaign as it was played, for shaftprint identify.")
    answer(f"{left.log}: what happened.")
    if left.campaign is not None:
        print_next("identify", left.recording, "--vessel", vessel, "--campaign", left.campaign)
