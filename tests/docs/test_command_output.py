"""What the page on the output of commands states of all of them."""

import importlib
import re
from pathlib import Path

import click
import pytest
from click.testing import CliRunner
from pages import PAGES

from shaftprint.cli import commands, shaftprint

COMMANDS = Path(commands.__file__).parent
PAGE = PAGES["docs/command-output.md"]


def first_cells(heading):
    """Return the code in the first cell of each row of the table below a heading."""
    part = PAGE[PAGE.index(heading) :]
    return re.findall(r"^\| ([^|]+?) \|", part[: part.find("\n## ", 1)], flags=re.MULTILINE)[1:]


def test_members_of_the_object_are_those_of_the_page():
    document = CliRunner().invoke(shaftprint, ["structures", "CL4", "--json"]).stdout
    assert set(re.findall(r'^ "(\w+)"', document, flags=re.MULTILINE)) == {
        cell.strip("`") for cell in first_cells("## JSON")
    }


@pytest.mark.parametrize(
    ("arguments", "code"),
    [(["structures", "CL4"], 0), (["show", "nothing.json"], 1), (["structures", "--no-such-option"], 2), (["sho"], 2)],
)
def test_a_command_ends_as_the_page_states(arguments, code):
    assert CliRunner().invoke(shaftprint, arguments).exit_code == code
    assert str(code) in first_cells("## How a command ends")


def told_with(code):
    """Return the commands that the row of an exit code names."""
    (row,) = re.findall(rf"^\| {code} \| (.+) \|$", PAGE, flags=re.MULTILINE)
    return {" ".join(word for word in one.split() if word[0] != "-") for one in re.findall(r"`([^`]+)`", row)}


def test_every_exit_code_of_a_command_is_in_the_table():
    """A command leaves by ``context.exit`` with a named code, or with a no; which there are is read from its file."""
    ending: dict[int, set[str]] = {}
    for path in COMMANDS.rglob("_*.py"):
        text = path.read_text(encoding="utf-8")
        names = re.findall(r"context\.exit\((\w+)", text)
        module = importlib.import_module(
            ".".join(("shaftprint.cli.commands", *path.relative_to(COMMANDS).with_suffix("").parts))
        )
        for value in [*(getattr(module, name) for name in names), *([3] if "end_with_no()" in text else [])]:
            words = (*path.relative_to(COMMANDS).parent.parts, path.stem.removeprefix("_").replace("_", "-"))
            for code in value.values() if isinstance(value, dict) else (value,):
                ending.setdefault(code, set()).add(" ".join(words))
    assert {3, 4} <= set(ending)
    told = {code: told_with(code) for code in ending}
    assert told == ending
    assert {"0", "1", "2", "130", *map(str, ending)} == set(first_cells("## How a command ends"))


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_a_shell_is_given_its_completion(shell):
    assert f"{shell}_source" in PAGE
    found = CliRunner(env={"_SHAFTPRINT_COMPLETE": f"{shell}_source"}).invoke(shaftprint, prog_name="shaftprint")
    assert found.exit_code == 0
    assert f"{shell}_complete" in found.stdout


def test_a_shell_completes_the_commands():
    completion = click.shell_completion.get_completion_class("bash")(shaftprint, {}, "shaftprint", "_X")
    assert [item.value for item in completion.get_completions([], "ide")] == ["identify"]
