"""What is said of a vessel file before anything is made of it: whether it agrees with itself."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path

import click

from shaftprint.cli._terminal import answer, print_findings
from shaftprint.late import late

with late():
    from shaftprint.card._card import ASSUMED_PULSES, Card
    from shaftprint.card._disagreements import disagreements
    from shaftprint.card._logger_rate import pulses_not_shown
    from shaftprint.card._write import write_vessel
    from shaftprint.vessel._vessel import Vessel, load_vessel

_SHOWN = 8


def print_disagreements(vessel: Vessel, file: str, *, is_recorded: bool = False) -> bool:
    """Print what in a vessel file contradicts itself, as part of the answer, and what is strange; nothing else.

    Return whether something contradicts itself.

    ``vessel``, ``file``: what was read, and the path or name of a shipped file it was read from. ``is_recorded``:
    whether it is of a recording that is there.
    """
    found = disagreements(vessel, is_recorded=is_recorded)
    contradictions = [one.sentence(file) for one in found if one.is_contradiction]
    if contradictions:
        print_findings("The vessel file contradicts itself", contradictions, is_answer=True)
    strange = [one.sentence(file) for one in found if not one.is_contradiction]
    if strange:
        print_findings("Findings on the vessel file", strange)
    return bool(contradictions)


def checked_vessel(file: str) -> Vessel:
    """Return the vessel of a file, or of a shipped name; whether the file agrees with itself is said."""
    vessel = load_vessel(file)
    print_disagreements(vessel, file)
    return vessel


def write_from_card(
    card: Card, path: Path, *, stated: Collection[str] = (), recording: Path | None = None, channels: Sequence[str] = ()
) -> None:
    """Write the vessel file that follows from a card; whether it agrees with itself, and what it assumes, is said.

    ``stated``: channels that were named for it. ``recording``, ``channels``: the recording that is there, and what it
    has; nothing where it cannot be read. Raises click.UsageError, and writes nothing, if the logger does not show the
    pulses of a pick-up and no recording says how it took them.
    """
    hidden = [] if channels else pulses_not_shown(card)
    if hidden:
        raise click.UsageError(
            f"{hidden[0]}; state its samples a second, --sample-rate. Where a counter lists the edges, state that many "
            "and leave [logger] out of the file that is written."
        )
    print_disagreements(write_vessel(card, path), str(path))
    answer(
        f"{path}: a vessel file from the main particulars; its comments say what was derived and what is usual only."
    )
    if not card.lever.pairs and card.lever.unit != "rpm":
        sentence = (
            f"{card.set_point_channel}: which engine speed it asks for is not known. Read it at two speeds and state "
            "them, sensors.set_point.table_rpm (--lever twice), or give `plan` its slope and offset."
        )
        print_findings("Lever to be filled in", [sentence], is_answer=True)
    sensors = _sensors_of(card)
    known = channels or stated
    open_ones = [f"{channel} as {use}" for channel, use in sensors if channel not in known]
    if not open_ones:
        return
    if recording is not None and channels:
        found = f"{recording} has no such channel, but {', '.join(channels[:_SHOWN])}"
        found += f" and {len(channels) - _SHOWN} more" if len(channels) > _SHOWN else ""
    else:
        found = "no recording was read that has them" if recording is None else f"{recording} was not read"
    sentence = f"{'; '.join(open_ones)}: {found}. Put the names of your logger, with their units, into {path}."
    print_findings("Sensors to be filled in", [sentence], is_answer=True)


def _sensors_of(card: Card) -> list[tuple[str, str]]:
    """Return the channel of each sensor that is written, and what it is used for."""
    speeds = [
        *(one.channel for one in (*card.engine_pulses, *card.shaft_pulses)),
        *card.engine_speeds,
        *card.shaft_speeds,
    ]
    return [
        *((channel, "speed") for channel in speeds or [ASSUMED_PULSES.channel]),
        (card.gauge.channel, "shaft torque"),
        (card.set_point_channel, "set point"),
    ]
