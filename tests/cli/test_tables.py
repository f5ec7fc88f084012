"""Tables on a terminal and in a file."""

import pytest

from shaftprint.cli.output import print_table, print_tables
from shaftprint.tables import Column, Table, numbers, texts


def test_table_in_a_file_is_not_folded(capsys):
    long = "a meaning of many words " * 5
    columns = (*texts("name"), *numbers("value [rad/s]"))
    print_table(Table(title="Title [s]", columns=columns, rows=((long, "1.5"), ("b [x]", "20"))))
    lines = [line.rstrip() for line in capsys.readouterr().out.splitlines()]
    assert lines[0] == "Title [s]"
    assert any(line.strip().startswith(long.strip()) and line.endswith("1.5") for line in lines)
    # markup in a cell is text, and numbers stand to the right
    place = next(line for line in lines if "b [x]" in line)
    assert place.endswith(" 20")


@pytest.mark.parametrize(("width", "shown"), [(40, False), (120, True)])
def test_spare_column_is_left_out_on_a_narrow_terminal(monkeypatch, capsys, width, shown):
    # what passes for a terminal
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", str(width))
    columns = (*texts("name", "value"), Column("meaning", spare=True))
    print_table(Table(title="Title", columns=columns, rows=(("tau_dn", "0.3198", "inertia " * 5),)))
    screen = capsys.readouterr().out
    assert "0.3198" in screen
    assert ("meaning" in screen) is shown
    assert ("inertia" in screen) is shown


def test_a_common_note_comes_once_and_empty_tables_not_at_all(capsys):
    def table(title, rows, note):
        return Table(title=title, columns=texts("name"), rows=rows, note=note)

    rows = (("−1\u202f234 ± 2",),)
    print_tables(
        [table("a", rows, "± is one"), table("b", rows, "± is one"), table("c", (), "x"), table("d", rows, "y")]
    )
    lines = [line.strip() for line in capsys.readouterr().out.splitlines() if line.strip()]
    titles_and_notes = [line for line in lines if line not in {"name", "-1234 +/- 2"} and "─" not in line]
    assert titles_and_notes == ["a", "b", "+/- is one", "d", "y"]
    assert lines.count("-1234 +/- 2") == 3
