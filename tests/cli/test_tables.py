"""Tables on a terminal and in a file."""

from shaftprint.cli._terminal import print_findings
from shaftprint.cli.output._tables import print_table, print_tables
from shaftprint.tables import Symbol, Table, numbers, texts


def test_a_table_in_a_file_has_lines_of_a_hundred_letters(capsys):
    long = "a meaning of many words " * 3
    columns = (*texts("name"), *numbers("value [rad/s]"))
    print_table(Table(title="Title [s]", columns=columns, rows=((long, "1.5"), ("b [x]", "20"))))
    lines = [line.rstrip() for line in capsys.readouterr().out.splitlines()]
    assert lines[0] == "Title [s]"
    assert any(line.strip().startswith(long.strip()) and line.endswith("1.5") for line in lines)
    print_table(Table(title="Title [s]", columns=columns, rows=((2 * long, "1.5"),)))
    assert max(map(len, capsys.readouterr().out.splitlines())) <= 100
    # markup in a cell is text, and numbers stand to the right
    place = next(line for line in lines if "b [x]" in line)
    assert place.endswith(" 20")


def test_a_table_that_is_too_wide_goes_on_below(monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", "44")
    columns = (*texts("name"), *numbers("value", "95 % interval"), *texts("meaning"))
    rows = (
        (Symbol("v K_i / (k_q - g)"), "0.3198 ± 0.0021", "0.3157 to 0.3239", "gain over the slope"),
        (Symbol("K_p"), "1.2 ± 0.3", "0.6 to 1.8", "the proportional gain of the governor of the engine"),
    )
    print_table(Table(title="Title", columns=columns, rows=rows))
    assert capsys.readouterr().out.splitlines() == [
        "Title",
        "",
        " name                            value",
        " ─────────────────────────────────────",
        " v K_i / (k_q - g)   0.3198 +/- 0.0021",
        " K_p                       1.2 +/- 0.3",
        "",
        " name                   95 % interval",
        " ────────────────────────────────────",
        " v K_i / (k_q - g)   0.3157 to 0.3239",
        " K_p                       0.6 to 1.8",
        "",
        " name                meaning",
        " ───────────────────────────────────────────",
        " v K_i / (k_q - g)   gain over the slope",
        " K_p                 the proportional gain",
        "                     of the governor of the",
        "                     engine",
        "",
    ]


def test_thousands_of_a_sentence_stand_as_in_tables(capsys):
    print_findings("Limits", ["M1 beyond full load, 5\u202f773 of 5\u202f395 N m"])
    assert "5773 of 5395 N m" in capsys.readouterr().out


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
