"""What the pages show: their Python runs, their commands exist with the options that they are given, links lead on."""

import re
from pathlib import Path

import click
import pytest
from pages import (
    FENCE,
    PAGES,
    PROGRAMS,
    PYTHON,
    ROOT,
    SHELL,
    SHOWN,
    berth,
    blocks,
    commands_of,
    inline_lines,
    is_command,
    python_of,
    shell_lines,
    shown,
)

from shaftprint.cli import shaftprint

OTHER_TESTS = [path for path in (ROOT / "tests").rglob("test_*.py") if path.parent != Path(__file__).parent]
OTHER_TEXT = "\n".join(path.read_text(encoding="utf-8") for path in OTHER_TESTS)
# A page that another test opens has its own checks there, of what its Python finds.
OPENED = {page for page in PAGES if f'"{Path(page).name}"' in OTHER_TEXT}
WITH_PYTHON = [page for page in PAGES if python_of(page)]
WITH_COMMANDS = [page for page in PAGES if commands_of(page)]
# these sail a test and identify it; the documentation, which .ci/run builds, is built by running them too
NOTEBOOKS = ("first-fingerprint", "own-structure", "my-csv", "two-speeds", "five-tests")
LONG = {"docs/thesis-figures.md", "docs/gallery.md", "docs/command-output.md"} | {
    f"docs/tutorials/{name}.md"
    for name in (*NOTEBOOKS, "recording-to-fingerprint", "logger-file", "two-loggers", "fmu")
}
SLOW = {"docs/house.md", "docs/planning.md"}
DEAR = {"long": LONG, "slow": SLOW}
# at a window 1280 wide
LONGEST_LINE_OF_A_CELL = 88
# their first lines ask for the short demo
WITH_DEMO = {"docs/house.md", "docs/library.md"}
# Kinds of blocks, each with the file that holds them against something.
CHECKED = dict.fromkeys(PYTHON, "test_pages.py")
CHECKED |= dict.fromkeys(SHELL, "test_page_commands.py, test_page_programs.py and test_page_output.py")
CHECKED |= dict.fromkeys(("toml", "json", "xml", "modelica", "matlab"), "test_page_blocks.py")
CHECKED |= dict.fromkeys(("{toctree}", "{literalinclude}", "{csv-table}"), "test_page_blocks.py")


@pytest.mark.parametrize("page", PAGES)
def test_every_block_is_of_a_kind_that_is_checked(page):
    for kind, _ in blocks(page):
        name = kind.split()[0] if kind.startswith("{literalinclude}") else kind
        assert name in CHECKED, f"{page}: nobody checks blocks of kind {kind!r}"
    # no other way to write a block goes unseen
    assert not re.search(r"^[ \t]+```|^[ \t]*~~~|^````", PAGES[page], flags=re.MULTILINE)
    assert len(re.findall(r"^```", PAGES[page], flags=re.MULTILINE)) == 2 * len(blocks(page))


@pytest.mark.parametrize("page", SHOWN)
def test_what_is_no_line_for_a_shell_is_there(page):
    assert shown(page)


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(page, marks=[getattr(pytest.mark, kind) for kind, pages in DEAR.items() if page in pages])
        for page in WITH_PYTHON
        if page not in OPENED
    ],
)
def test_python_of_a_page_runs(page, tmp_path, monkeypatch, capsys, request):
    if page in WITH_DEMO:
        berth(request.getfixturevalue("demo")[0], tmp_path / "demo")
    monkeypatch.chdir(tmp_path)
    names = {"__name__": "page"}
    for text in python_of(page):
        exec(compile(text, page, "exec"), names)  # noqa: S102
    capsys.readouterr()


def test_a_cell_that_is_left_out_with_ones_own_files_holds_no_import():
    """The cells after it would end at a name that nobody has defined."""
    left_out = re.compile(r"leave (this cell out|out the second cell).*?(```\{code-cell\}.*?```)(.*)", re.DOTALL)
    found = {page: match for page in WITH_PYTHON if (match := left_out.search(PAGES[page]))}
    assert {Path(page).stem for page in found} == {"first-fingerprint", "my-csv", "five-tests"}
    for page, match in found.items():
        cells = match[3] if "second" in match[1] else match[2]
        (cell, *_) = re.findall(r"```\{code-cell\}[^\n]*\n(.*?)```", cells, re.DOTALL)
        assert "sp.tug.sail(" in cell, page
        assert not re.search(r"^\s*(?:import|from) ", cell, re.MULTILINE), page


def test_a_cell_that_is_shown_fits_between_the_columns_of_contents():
    cells = [text for page in PAGES for kind, text in blocks(page) if kind == "{code-cell} ipython3"]
    seen = [cell for cell in cells if "tags: [remove-" not in cell]
    assert len(seen) > 40
    assert [line for cell in seen for line in cell.splitlines() if len(line) > LONGEST_LINE_OF_A_CELL] == []


def test_pages_with_tests_of_their_own_are_run_there():
    for page in WITH_PYTHON:
        if page in OPENED:
            name = re.escape(Path(page).name)
            tests = [path for path in OTHER_TESTS if re.search(name, path.read_text(encoding="utf-8"))]
            assert any(re.search(r"exec\(|runpy", path.read_text(encoding="utf-8")) for path in tests), page


@pytest.mark.parametrize("page", PAGES)
def test_nothing_but_known_programs_is_asked_of_a_shell(page):
    for program, *rest in shell_lines(page):
        assert program in PROGRAMS, f"{page}: {program} {' '.join(rest)}"


@pytest.mark.parametrize("page", WITH_COMMANDS)
def test_commands_of_a_page_exist_and_take_their_options(page):
    for words in commands_of(page):
        expect_parsed(page, words)


@pytest.mark.parametrize("page", PAGES)
def test_commands_in_the_sentences_of_a_page_exist(page):
    for program, *words in inline_lines(page):
        if program == "shaftprint" and words != ["--help"] and words[-2:] != ["FORMAT", "FINGERPRINT"]:
            # a sentence may leave out what is needed
            expect_parsed(page, words, whole=False)


def expect_parsed(page, words, *, whole=True):
    """Expect a command that exists and takes the arguments; ``whole`` ones are all that it needs."""
    name, *rest = words
    assert is_command(words), f"{page}: {words}"
    command = shaftprint.get_command(None, name)
    try:
        context = command.make_context(name, list(rest))
        if isinstance(command, click.Group):
            inner, more = context._protected_args[0], [*context._protected_args[1:], *context.args]
            found = command.get_command(context, inner)
            assert found is not None, f"{page}: shaftprint {' '.join(words)}"
            if more:
                found.make_context(inner, more, parent=context)
    except click.exceptions.Exit:
        pass
    except click.ClickException as error:
        if whole or not isinstance(error, click.MissingParameter):
            pytest.fail(f"{page}: shaftprint {' '.join(words)}: {error.format_message()}")


@pytest.mark.parametrize("page", PAGES)
def test_links_of_a_page_lead_to_something(page):
    folder = (ROOT / page).parent
    text = FENCE.sub("", PAGES[page])
    for link in re.findall(r"\]\(([^)\s]+)\)", text):
        target = link.partition("#")[0]
        is_made = "reference/generated" in (folder / target).as_posix()
        if target and not is_made and not link.startswith(("http", "mailto")):
            assert (folder / target).exists(), link
