"""How commands speak: one JSON object, only the answer, each step of long work, sentences as wide as the terminal."""

import json
import re

import click
import pytest

from shaftprint.cli import shaftprint
from shaftprint.cli.output._json import table_json
from shaftprint.cli.output._progress import progress
from shaftprint.cli.output._tables import print_table
from shaftprint.tables import Table, texts

MOST_PROSE = 80


def _commands():
    for name in shaftprint.helps:
        command = shaftprint.get_command(None, name)
        if isinstance(command, click.Group):
            yield from (command.get_command(None, inner) for inner in command.helps)
        else:
            yield command


def test_every_command_has_the_three_options_once():
    for command in [*_commands(), *_commands()]:
        options = [option for parameter in command.params for option in parameter.opts]
        assert [options.count(name) for name in ("--json", "--verbose", "--quiet")] == [1, 1, 1], command.name


def test_a_fingerprint_as_json_has_all_its_digits(run, demo):
    result = run("show", demo[0], "--json")
    document = json.loads(result.stdout)
    assert result.stderr == ""
    assert document["command"] == "show"
    assert document["answer"][0].startswith("Verdict: ")
    stored = json.loads((demo[0] / "fingerprint.json").read_text(encoding="utf-8"))
    assert document["result"]["fingerprint"]["parameters"] == stored["parameters"]
    titles = [table["title"] for table in document["tables"]]
    assert titles[0] == "Identified parameters, normalised with the working point"
    assert "Uncertainty budget" in titles
    for table in document["tables"]:
        assert all(len(row) == len(table["columns"]) for row in table["rows"])


@pytest.mark.parametrize(
    ("arguments", "noun"),
    [
        (("structures", "CL4"), "parameters"),
        (("inertia", "stan-tug-1205"), "expected"),
        (("predict", "--campaign", "short"), "parameters"),
        (("compare", "{demo}", "{demo}", "--name", "a", "--name", "b"), "differences"),
    ],
)
def test_what_has_tables_has_them_as_json(run, demo, arguments, noun):
    result = run(*(argument.format(demo=demo[0]) for argument in arguments), "--json")
    document = json.loads(result.stdout)
    assert document["tables"]
    assert document["result"][noun]


def test_an_error_leaves_the_output_empty_for_json_too(run, tmp_path):
    result = run("show", tmp_path / "none.json", "--json")
    assert result.exit_code == 1
    assert result.stdout == ""
    assert result.stderr.startswith("Error: ")


def test_quiet_prints_the_answer_only(run, demo):
    loud, quiet = run("show", demo[0]).stdout, run("show", demo[0], "-q").stdout
    assert loud.startswith(quiet.rstrip("\n"))
    assert quiet.startswith("Verdict: ")
    assert "Uncertainty budget" not in quiet


def test_verbose_names_each_step_with_its_time(run, monkeypatch):
    def work(**_):
        with progress(hidden=False) as steps:
            steps.begin("Reading")
            steps.begin("Fitting")

    monkeypatch.setattr(shaftprint.get_command(None, "demo"), "callback", work)
    result = run("demo", "-v")
    words = [re.sub(r"\d+\.\d s", "# s", line) for line in result.stderr.splitlines()]
    assert words == ["Reading ...", "Reading: # s", "Fitting ...", "Fitting: # s"]
    assert run("demo").stderr == ""


def test_sentences_are_as_wide_as_the_terminal(run, demo, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(MOST_PROSE))
    lines = run("show", demo[0]).stdout.splitlines()
    assert max(len(line) for line in lines if line.startswith(("  * ", "    "))) <= MOST_PROSE
    assert any(line.startswith("    ") for line in lines)


def test_sentences_without_a_terminal_have_a_hundred_letters(monkeypatch, capsys):
    monkeypatch.delenv("COLUMNS", raising=False)
    print_table(Table(title="", columns=texts("name"), rows=(("x",),), note="word " * 60))
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith("word")]
    # 60 words of 4 letters with a blank each, 20 of them on a line of 100
    assert [line.split() for line in lines] == [["word"] * 20] * 3
    assert 90 < max(map(len, lines)) <= 100


def test_a_cell_of_json_is_in_the_letters_of_every_keyboard():
    table = Table(title="a ± b", columns=texts("name"), rows=(("−1\u202f234 ± 2",),))
    assert table_json(table) == {"title": "a +/- b", "columns": ["name"], "rows": [["-1234 +/- 2"]], "note": ""}
