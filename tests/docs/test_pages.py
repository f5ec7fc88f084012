"""What the pages show: their Python runs, their commands exist with the options that they are given, links lead on."""

import importlib
import re
import shlex
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from shaftprint.cli import shaftprint
from shaftprint.cli._command_group import COMMANDS

ROOT = Path(__file__).parents[2]
PAGES = {
    path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8")
    for path in (ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md")))
}
FENCE = re.compile(r"^```([^\n]*)\n(.*?)^```", flags=re.MULTILINE | re.DOTALL)
# Run by `.ci/run` or by hand: they install, or take minutes.
NOT_RUN = ("make ", "python ", "py ", "pip ", "cd ", ".venv")


def blocks(page):
    """Return kind and text of every fenced block of a page."""
    return [(kind.strip(), text) for kind, text in FENCE.findall(PAGES[page])]


def python_of(page):
    """Return the Python of a page, in order, without the lines that set up a notebook's cell."""
    found = [text for kind, text in blocks(page) if kind in ("python", "{code-cell} ipython3")]
    # options of a cell, and magic that only a notebook knows
    return [re.sub(r"^[:%]\w.*\n", "", text, flags=re.MULTILINE) for text in found]


def commands_of(page):
    """Return the arguments of every shaftprint command of a page; what stands behind a # is left out."""
    shells = [text for kind, text in blocks(page) if kind in ("", "sh", "bash", "console", "text")]
    lines = "\n".join(shells).replace("\\\n", " ").splitlines()
    found = (re.match(r"\s*(?:\$ )?(?:[\w.]*[\\/])*shaftprint ([a-z-].*)", line) for line in lines)
    return [shlex.split(line[1], comments=True) for line in found if line]


OTHER_TESTS = [path for path in (ROOT / "tests").rglob("test_*.py") if path.parent != Path(__file__).parent]
OTHER_TEXT = "\n".join(path.read_text(encoding="utf-8") for path in OTHER_TESTS)
# A page that another test opens has its own checks there, of what its Python finds.
OPENED = {page for page in PAGES if f'"{Path(page).name}"' in OTHER_TEXT}
WITH_PYTHON = [page for page in PAGES if python_of(page)]
WITH_COMMANDS = [page for page in PAGES if commands_of(page)]


# sails the whole campaign
FULL_SIZE = {"docs/thesis-figures.md"}


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(page, marks=pytest.mark.full_size) if page in FULL_SIZE else page
        for page in WITH_PYTHON
        if page not in OPENED
    ],
)
def test_python_of_a_page_runs(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    names = {"__name__": "page"}
    for text in python_of(page):
        # a page that shows an example runs it only when it is built: tests/examples runs it for the tests
        if "SHAFTPRINT_EXAMPLES" in text or "ran[" in text:
            continue
        exec(compile(text, page, "exec"), names)  # noqa: S102
    capsys.readouterr()


def test_pages_with_tests_of_their_own_are_run_there():
    for page in WITH_PYTHON:
        if page in OPENED:
            name = re.escape(Path(page).name)
            tests = [path for path in OTHER_TESTS if re.search(name, path.read_text(encoding="utf-8"))]
            assert any(re.search(r"exec\(|runpy", path.read_text(encoding="utf-8")) for path in tests), page


@pytest.mark.parametrize("page", WITH_COMMANDS)
def test_commands_of_a_page_exist_and_take_their_options(page):
    for arguments in commands_of(page):
        name, *rest = arguments
        if name.startswith("-"):
            continue
        assert name in COMMANDS, arguments
        command = importlib.import_module(f"shaftprint.cli._{name.replace('-', '_')}").command
        try:
            command.make_context(name, list(rest))
        except click.exceptions.Exit:
            pass
        except click.ClickException as error:
            pytest.fail(f"{page}: shaftprint {' '.join(arguments)}: {error.format_message()}")


@pytest.mark.parametrize("page", PAGES)
def test_nothing_but_known_programs_is_asked_of_a_shell(page):
    for kind, text in blocks(page):
        if kind in ("sh", "bash", "console"):
            for line in text.replace("\\\n", " ").splitlines():
                words = re.sub(r"^\$ ", "", line.strip())
                assert not words or words.startswith(("shaftprint ", "#", *NOT_RUN)), f"{page}: {line}"


@pytest.mark.parametrize("page", PAGES)
def test_links_of_a_page_lead_to_something(page):
    folder = (ROOT / page).parent
    text = FENCE.sub("", PAGES[page])
    for link in re.findall(r"\]\(([^)\s]+)\)", text):
        target = link.partition("#")[0]
        if target and not link.startswith(("http", "mailto")) and "reference/generated" not in link:
            assert (folder / target).exists(), link


def test_first_commands_of_a_new_user_run(tmp_path, monkeypatch):
    """The files that `new` writes are accepted as they are by the commands of the start page that need no recording."""
    monkeypatch.chdir(tmp_path)
    for arguments in commands_of("docs/start.md"):
        if arguments[0] in {"new", "predict"}:
            result = CliRunner().invoke(shaftprint, arguments, catch_exceptions=False)
            assert result.exit_code == 0, result.output
    assert (tmp_path / "mine.toml").exists()
