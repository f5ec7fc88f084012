"""Every table of every command on terminals of 80, 100 and 200 letters: no cut word, no lost name."""

import pytest

from shaftprint.cli.output import table_lines
from shaftprint.digits import plain_letters
from shaftprint.tables import Symbol, Table

WIDTHS = (80, 100, 200)


@pytest.fixture
def tables_of(run, monkeypatch):
    """Call a command and return the tables that it makes."""

    def call(*arguments):
        tables = []
        check = Table.__post_init__

        def remembered(table):
            check(table)
            tables.append(table)

        with monkeypatch.context() as patch:
            patch.setattr(Table, "__post_init__", remembered)
            result = run(*arguments)
        assert result.exit_code == 0, result.stderr
        # a report makes tables too, which no command prints
        return [table for table in tables if table.rows and _shown(table.title) in result.stdout]

    return call


def _shown(text):
    return plain_letters(text).replace("\u00a0", " ")


def _expect_readable(table, width):
    lines = table_lines(table, width)
    page = [line for line in lines if "─" not in line]
    words = {word for line in page for word in line.split()}
    cells = [cell for row in table.rows for cell in row] + [column.heading for column in table.columns]
    lost = {word for cell in cells for word in _shown(cell).split()} - words
    assert not lost, table.title
    for row in table.rows:
        for cell, column in zip(row, table.columns, strict=True):
            if column.number or isinstance(cell, Symbol):
                assert any(_shown(cell) in line for line in page), (table.title, cell)
    too_long = [line for line in lines if len(line) > width]
    longest_name = max(len(_shown(row[0])) for row in table.rows)
    longest_cell = max(len(word) for cell in cells for word in [_shown(cell)])
    assert not too_long or longest_name + longest_cell > width, (table.title, too_long)


QUICK = {
    "show": ("show", "{demo}"),
    "structures": ("structures",),
    "inertia": ("inertia", "stan-tug-1205"),
    "inertia beside a fingerprint": ("inertia", "stan-tug-1205", "--fingerprint", "{demo}"),
    "compare": ("compare", "{demo}", "{demo}", "--name", "November 2019", "--name", "a much longer name of 2023"),
    "predict": ("predict", "--campaign", "short", "--vessel", "stan-tug-1205"),
    "simulate": ("simulate", "--fingerprint", "{demo}", "--campaign", "short", "--between", "0", "30", "-o", "{o}.csv"),
    "inspect": ("inspect", "{demo}/recording.nc", "--vessel", "stan-tug-1205"),
}
TEST = ("{demo}/recording.nc", "--vessel", "stan-tug-1205", "--campaign", "short")
SLOW = {
    "inspect with a campaign": ("inspect", *TEST),
    "identify": ("identify", *TEST, "--structure", "GAUGE-CLOSED", "--structure", "CL4", "-o", "{o}"),
    "compare-structures": ("compare-structures", *TEST, "--structure", "CL3", "--structure", "CL4"),
    "validate": ("validate", *TEST, "--fingerprint", "{demo}", "--thesis-sets"),
    "explain": ("explain", *TEST),
    "limits": ("limits", *TEST),
    "plan": (
        "plan", "--vessel", "stan-tug-1205", "--within", "3min", "--limit", "set-point=0.5V", "--rpm-per-volt", "-251",
        "--offset", "-5", "--wish", "tau_dn=10%", "-o", "{o}",
    ),
}  # fmt: skip


def _expect_all_readable(tables_of, words, folder, tmp_path):
    places = {"demo": folder, "o": tmp_path / "result"}
    tables = tables_of(*(word.format(**places) for word in words))
    assert tables
    for table in tables:
        for width in WIDTHS:
            _expect_readable(table, width)


@pytest.mark.parametrize("name", QUICK)
def test_tables_of_quick_commands(tables_of, demo, tmp_path, name):
    _expect_all_readable(tables_of, QUICK[name], demo[0], tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("name", SLOW)
def test_tables_of_commands_that_calculate(tables_of, demo, tmp_path, name):
    _expect_all_readable(tables_of, SLOW[name], demo[0], tmp_path)
