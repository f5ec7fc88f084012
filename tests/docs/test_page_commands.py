"""Every command in a block of a page is run as it stands there, and leaves behind what it says.

What is not as it stands is in ``pages.as_run``. A command that several pages show is run once. What takes long and is
run by tests of its own in ``tests/cli`` is run until it begins to calculate.
"""

import importlib.util
import shlex
import sys

import click
import pytest
from click.testing import CliRunner
from expected import EXPECTED
from pages import berth, commands

from shaftprint.cli import shaftprint

pytestmark = pytest.mark.slow
WINDOWS = ("cp850", "cp1252")
# Ships beside the tug at the quay, the channels of its other shaft, and a structure of one's own: each has tests in
# tests/cli that run the same commands to their end.
RUN_ELSEWHERE = {
    "e-ferry-ellen",
    "foss-carolyn-dorothy",
    "nifs-research-vessel",
    "nifs-research-vessel-combinator",
    "pt-may",
    "pt-may-underway",
    "stan-tug-1205-astern",
    "stan-tug-1205-underway",
    "--starboard",
    "--service",
    "my_ship.py:my_loop",
    "fan.toml",
    "set-point=60rpm",
}
# The work is done, and the answer is no: the demo's model fails its large steps.
ANSWERED_NO = {"validate recording.nc --vessel stan-tug-1205 --campaign short --fingerprint result -o figures"}
# What a command calls when it begins to calculate.
BEGINS = {
    "identify": ("run", "identify_both_lines"),
    "inspect": ("read_recording",),
    "limits": ("identify_limits",),
    "plan": ("plan_test", "plan_on_the_bench"),
    "sail": ("sail_as", "sail_both_lines", "sail_service"),
    "service": ("scan", "fit_service", "watch_folders"),
    "sensitivity": ("save_chart",),
    "simulate": ("simulated_ship", "crash_stop"),
}


class Begun(Exception):
    """A command was understood, with the files that it names, and has begun to calculate."""


def key(words):
    """Return the name of a command, with the format of an export."""
    return " ".join(words[: 2 if words[0] == "export" else 1])


@pytest.fixture
def ashore(harbour, tmp_path, monkeypatch):
    """A folder of its own for a command, with what is in the harbour, but for what the command writes itself."""

    def arrive(words):
        written = {words[at + 1] for at, word in enumerate(words) if word == "-o"}
        written |= {words[-1]} if words[0] == "new" else set()
        for path in harbour.iterdir():
            if path.name not in written:
                berth(path, tmp_path / path.name)
        monkeypatch.chdir(tmp_path)
        return tmp_path

    return arrive


@pytest.fixture
def without_zig(monkeypatch):
    """The user of the pages has not installed the extra for other systems; ``tests/export`` compiles for them."""
    find = importlib.util.find_spec

    def found(name, *more):
        return None if name == "ziglang" else find(name, *more)

    monkeypatch.setattr(importlib.util, "find_spec", found)


def is_run_elsewhere(line):
    """Say whether tests in ``tests/cli`` run a command to its end: those of other ships, and the longest."""
    name, *words = shlex.split(line)
    of_its_own = not RUN_ELSEWHERE.isdisjoint(words)
    longest = ("identify", "inspect", "plan", "sail", "simulate")
    return name in ("limits", "sensitivity", "service") or (name in longest and of_its_own)


@pytest.mark.parametrize("line", [line for line in commands() if is_run_elsewhere(line)])
def test_a_command_that_is_run_elsewhere_is_understood(line, ashore, without_zig, monkeypatch):
    words = shlex.split(line)
    folder = ashore(words)
    if not words[1].startswith("-") and words[0] not in ("sail", "service") and not (folder / words[1]).exists():
        # what another line of the page sails
        berth(folder / "recording.nc", folder / words[1])

    def begin(*_, **__):
        raise Begun

    command = shaftprint.get_command(click.Context(shaftprint), words[0])
    if isinstance(command, click.Group):
        command = command.get_command(click.Context(command), words[1])
    module = sys.modules[command.callback.__module__]
    for name in BEGINS[words[0]]:
        monkeypatch.setattr(module, name, begin, raising=words[0] != "service")
    with pytest.raises(Begun):
        CliRunner().invoke(shaftprint, words, catch_exceptions=False)


@pytest.mark.parametrize("line", [line for line in commands() if not is_run_elsewhere(line)])
def test_a_command_does_what_its_page_says(line, harbour, printed, ashore, without_zig):
    words = shlex.split(line)
    if line in printed:
        folder, result = harbour, printed[line]
    else:
        folder = ashore(words)
        result = CliRunner().invoke(shaftprint, words, catch_exceptions=False)
    assert result.exit_code == (3 if line in ANSWERED_NO else 0), result.output
    assert result.stderr == ""
    for code_page in WINDOWS:
        # its tables have other rules there: tests/cli/test_code_pages.py
        result.stdout.replace("─", "-").encode(code_page)
    assert key(words) in EXPECTED, f"nobody says what {key(words)} leaves behind"
    EXPECTED[key(words)](folder, result.stdout, words)
