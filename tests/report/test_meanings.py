"""Symbols of a table have their meaning beside them, whichever table of the report it is."""

from shaftprint.plain_table import MEANING, Column, Symbol, Table, numbers, texts
from shaftprint.report.sections._meanings import explained, in_words
from shaftprint.report.sections._sections import Section

MEANINGS = {"K_p": "gain of the governor", "n": "engine speed"}


def shown(table):
    (made,) = explained(Section(key="k", title="T", tables=(table,)), MEANINGS).tables
    return made


def test_symbols_of_rows_get_a_column_and_those_of_headings_a_note():
    columns = (*texts("quantity"), Column(Symbol("n"), number=True))
    rows = ((Symbol("K_p [s]"), "1"), (Symbol("my own"), "2"))
    made = shown(Table(title="T", columns=columns, rows=rows, note="Shares."))
    assert made.columns == (*columns, MEANING)
    assert [row[-1] for row in made.rows] == ["gain of the governor", ""]
    assert made.note == "Shares. n: engine speed."


def test_a_table_with_meanings_and_one_without_symbols_stay_as_they_are():
    with_meaning = Table(title="T", columns=(*texts("a"), MEANING), rows=((Symbol("K_p"), "mine"),))
    plain = Table(title="T", columns=(*texts("line"), *numbers("K_p")), rows=(("K_p", "1"),))
    assert (shown(with_meaning), shown(plain)) == (with_meaning, plain)


def test_a_caption_says_what_the_outputs_of_a_ship_are():
    told = in_words((("n", "n_set"), ("M_s", "n_set")))
    assert told.startswith(
        "n: engine speed; n_set: set point of the engine speed; M_s: shaft torque; each as a deviation"
    )
    # the speed of a ship at the quay is over no speed of its own, and a drive has names of its own
    assert in_words((("v_s", "n_set"),)) == "v_s: speed of the ship; n_set: set point of the engine speed. "
    assert in_words((("speed", "voltage"),)) == ""
