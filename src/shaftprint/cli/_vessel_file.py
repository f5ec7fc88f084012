"""What is said of a vessel file before anything is made of it: whether it agrees with itself."""

from __future__ import annotations

from pathlib import Path

from shaftprint.cli._terminal import answer, print_findings
from shaftprint.late import late

with late():
    from shaftprint.card._card import Card
    from shaftprint.card._disagreements import disagreements
    from shaftprint.card._write import write_vessel
    from shaftprint.vessel._vessel import Vessel, load_vessel


def print_disagreements(vessel: Vessel, file: str, *, is_recorded: bool = False) -> None:
    """Print what in a vessel file contradicts itself, as part of the answer, and what is strange; nothing else.

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


def checked_vessel(file: str) -> Vessel:
    """Return the vessel of a file, or of a shipped name; whether the file agrees with itself is said."""
    vessel = load_vessel(file)
    print_disagreements(vessel, file)
    return vessel


def write_from_card(card: Card, path: Path) -> None:
    """Write the vessel file that follows from a card; whether it agrees with itself is said."""
    print_disagreements(write_vessel(card, path), str(path))
    answer(
        f"{path}: a vessel file from the main particulars; its comments say what was derived and what is usual only."
    )
