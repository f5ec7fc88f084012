"""The last lines of a command: the next sensible ones, with the names of the files that were just used or made."""

from __future__ import annotations

import os
import shlex
import subprocess
from collections.abc import Sequence
from pathlib import Path

from shaftprint.cli._terminal import echo
from shaftprint.cli.output._json import give
from shaftprint.late import late

with late():
    from shaftprint.file_kinds import kind_of_file
    from shaftprint.vessel._vessel import Vessel

VESSEL_FILE = "vessel.toml"
"""What a vessel file is called where nobody has said it."""
FIRST_LENGTH = "12min"
"""Length of a test that is proposed where nobody has said one."""


def command_line(*words: object) -> str:
    """Return a command of this program as it is typed into the shell of this computer."""
    typed = ["shaftprint", *map(str, words)]
    return subprocess.list2cmdline(typed) if os.name == "nt" else shlex.join(typed)


def print_next(*words: object, label: str = "Next:") -> None:
    """Print the next command.

    ``words``: the command with its options. ``label``: what stands before it.
    """
    line = command_line(*words)
    give("next", line)
    echo(f"{label:<12} {line}")


def print_steps(*commands: Sequence[object]) -> None:
    """Print the next commands, the first to be done first; nothing where there are none."""
    for words in commands[:1]:
        print_next(*words)
    lines = [command_line(*words) for words in commands[1:]]
    if lines:
        give("then", lines)
    for line in lines:
        echo(f"{'then:':<12} {line}")


def read_by_all(recording: object, reading: Sequence[object]) -> tuple[object, list[tuple[object, ...]]]:
    """Return a recording as commands take it that have no options for what its file does not say, and what makes it so.

    ``reading``: such options, as they were given to ``inspect`` or ``identify``.
    """
    if not reading:
        return recording, []
    target = free(f"{Path(str(recording)).stem}.nc")
    return target, [("convert", recording, *reading, "-o", target)]


def vessel_file_near(recording: Path) -> Path | None:
    """Return the vessel file of this folder, or of that of a recording; None where there is none, or which is not told.

    Of several it is ``vessel.toml``.
    """
    for folder in dict.fromkeys((Path(), recording.parent)):
        files = [path for path in sorted(folder.glob("*.toml")) if kind_of_file(path) == "vessel"]
        named = [path for path in files if path.name == VESSEL_FILE]
        if len(files) == 1 or named:
            return (named or files)[0]
    return None


def free(name: str) -> Path:
    """Return a file or folder of a name, with a number where there is one already."""
    path, number = Path(name), 2
    while path.exists():
        path, number = Path(name).with_name(f"{Path(name).stem}-{number}{Path(name).suffix}"), number + 1
    return path


def plan_words(vessel: object, *, has_lever: bool, rated_rpm: float | None, reach: str = "") -> tuple[object, ...]:
    """Return the words of ``plan`` for the first test of a ship.

    ``vessel``: its vessel file. ``has_lever``: whether the file says which speed the lever asks for; otherwise the
    command leaves room for it. ``rated_rpm``: rated speed of the engine [rpm]; None where there is none. ``reach``: as
    of ``plan_after``.
    """
    lever = () if has_lever else ("--rpm-per-volt", "RPM", "--offset", "VOLT")
    return ("plan", "--vessel", vessel, *_size(rated_rpm, reach), *lever, "-o", free("plan"))


def first_plan(vessel: object, ship: Vessel, reach: str = "") -> tuple[object, ...]:
    """Return the words of ``plan`` for the first test of a ship, by its vessel file and what is in it.

    ``reach``: as of ``plan_after``.
    """
    has_lever = ship.sensors.set_point.volts_for(ship.working_point.engine_speed_rpm) is not None
    return plan_words(vessel, has_lever=has_lever, rated_rpm=rated_rpm_of(ship), reach=reach)


def plan_after(result: object, vessel: object, ship: Vessel, reach: str = "") -> tuple[object, ...]:
    """Return the words of ``plan`` for the next test of a ship.

    ``result``: what its last test gave. ``vessel``, ``ship``: its vessel file, and what is in it. ``reach``: how far
    its set point may go from a level, such as ``60rpm``; a usual one where it is not known.
    """
    size = _size(rated_rpm_of(ship), reach)
    return ("plan", "--vessel", vessel, "--after", result, *size, "-o", free("next-plan"))


def after_drive(drive: object, result: object) -> tuple[object, ...]:
    """Return the words that hold what was found of a drive against another record of it, which the user names.

    ``drive``: the drive file. ``result``: what its records gave.
    """
    return ("validate", "OTHER", "--drive", drive, "--fingerprint", result)


def rated_rpm_of(ship: Vessel) -> float:
    """Return the rated speed of what drives a ship, its engine or its motor [rpm]."""
    return ship.machine.rated_speed_rpm


def _size(rated_rpm: float | None, reach: str = "") -> tuple[object, ...]:
    # small beside the speed, so that the line stays linear, and large beside its noise
    usual = "100rpm" if rated_rpm is None else f"{round(0.06 * rated_rpm, -1):.0f}rpm"
    return ("--within", FIRST_LENGTH, "--limit", f"set-point={reach or usual}")
