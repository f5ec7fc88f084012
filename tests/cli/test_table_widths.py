"""Every table of every command on terminals of 80, 100 and 200 letters: no cut word, no lost name.

Those of ``limits`` are read in ``test_limits_output``, which calls it anyway.
"""

import pytest
from tests.cli.readable_tables import expect_all_readable, printed_tables


@pytest.fixture
def tables_of(run):
    """Call a command and return the tables that it prints."""

    def call(*arguments):
        with printed_tables() as printed:
            result = run(*arguments)
        # the demo's model fails its large steps, and has tables as well
        assert result.exit_code == (3 if arguments[0] == "validate" else 0), result.stderr
        return printed(result.stdout)

    return call


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
    "plan": (
        "plan", "--vessel", "stan-tug-1205", "--within", "3min", "--limit", "set-point=0.5V", "--rpm-per-volt", "-251",
        "--offset", "-5", "--wish", "tau_dn=10%", "-o", "{o}",
    ),
}  # fmt: skip


def _expect_output_readable(tables_of, words, folder, tmp_path):
    places = {"demo": folder, "o": tmp_path / "result"}
    expect_all_readable(tables_of(*(word.format(**places) for word in words)))


@pytest.mark.parametrize("name", QUICK)
def test_tables_of_quick_commands(tables_of, demo, tmp_path, name):
    _expect_output_readable(tables_of, QUICK[name], demo[0], tmp_path)


@pytest.mark.parametrize(("columns", "widest"), [("80", 80), ("100", 100), ("", 100)])
@pytest.mark.parametrize("name", ["show", "structures", "inertia beside a fingerprint", "predict"])
def test_no_line_is_wider_than_the_terminal(run, demo, monkeypatch, name, columns, widest):
    """Titles and notes too; in a file or a pipe a line has 100 letters, whatever reads it."""
    monkeypatch.setenv("COLUMNS", columns)
    result = run(*(word.format(demo=demo[0]) for word in QUICK[name]))
    assert result.exit_code == 0, result.stderr
    assert [line for line in result.stdout.splitlines() if len(line) > widest] == []


@pytest.mark.slow
@pytest.mark.parametrize("name", [pytest.param(one, marks=pytest.mark.long) if one == "plan" else one for one in SLOW])
def test_tables_of_commands_that_calculate(tables_of, demo, tmp_path, name):
    _expect_output_readable(tables_of, SLOW[name], demo[0], tmp_path)
