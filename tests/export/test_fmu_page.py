"""The page about export: its Python runs, its commands are those of the program, its tables are complete."""

import re
import shlex
from pathlib import Path

import pytest

from shaftprint.cli import shaftprint
from shaftprint.export._fmu_build import PLATFORMS

PAGE = Path(__file__).parents[2].joinpath("docs", "export.md").read_text(encoding="utf-8")


def test_python_of_the_page_runs(capsys):
    code = "\n".join(
        block for block in re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL) if "write_fmu" in block
    )
    exec(compile(code, "docs/export.md", "exec"), {})  # noqa: S102
    assert capsys.readouterr().out == "my_ship.fmu 0.001\n"


@pytest.mark.parametrize(
    "line", re.findall(r"^shaftprint export fmu (.*)$", PAGE.replace("\\\n", ""), flags=re.MULTILINE)
)
def test_commands_of_the_page_are_understood(line):
    command = shaftprint.get_command(None, "export").get_command(None, "fmu")
    context = command.make_context("fmu", shlex.split(line))
    assert str(context.params["fingerprint"]) == "result"


def test_every_system_is_in_the_table():
    rows = dict(re.findall(r"^\| `([\w-]+)` \| `[\w-]+` \| `([\w-]+)` \|$", PAGE, flags=re.MULTILINE))
    assert rows == {name: chosen.folder_3 for name, chosen in PLATFORMS.items()}
