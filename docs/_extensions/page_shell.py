"""What a page needs to show a command with its output: the program runs as a reader would run it."""

import os
import shlex
import subprocess
import sys

WIDTH = 84


def printed(line: str) -> str:
    """Return what a line of the page prints on the standard output.

    Parameters
    ----------
    line
        Program and arguments; the program is shaftprint.

    Raises
    ------
    RuntimeError
        If it is another program, or if the command fails.
    """
    program, *arguments = shlex.split(line)
    if program != "shaftprint":
        raise RuntimeError(f"expected shaftprint, found {program}")
    environment = os.environ | {"COLUMNS": str(WIDTH), "PYTHONIOENCODING": "utf-8"}
    done = subprocess.run(  # noqa: S603 - a line of our own page
        [sys.executable, "-m", "shaftprint", *arguments], capture_output=True, encoding="utf-8", env=environment
    )
    if done.returncode:
        raise RuntimeError(f"{line}: {done.stderr}")
    return done.stdout


def run(line: str, *, most_lines: int = 60) -> None:
    """Run a line of the page and print what it prints.

    Parameters
    ----------
    line
        Program and arguments; the program is shaftprint.
    most_lines
        How many lines of its output are shown.
    """
    lines = printed(line).rstrip().splitlines()
    print("\n".join(lines[:most_lines]))  # noqa: T201
    if len(lines) > most_lines:
        print(f"... {len(lines) - most_lines} more lines")  # noqa: T201
