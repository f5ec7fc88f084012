"""The glossary: its tables of symbols come from the code, its terms are used, and nothing is typed twice."""

import re
import sys
from pathlib import Path

import pytest

from shaftprint.catalogue import STRUCTURES, structure

DOCS = Path(__file__).parents[2] / "docs"
sys.path.insert(0, str(DOCS / "_extensions"))

from glossary_tables import TABLES, quantity_rows, symbol_rows, table  # noqa: E402

PAGE = (DOCS / "glossary.md").read_text(encoding="utf-8")
TERMS = re.findall(r"^\| ([^|]+) \| ([^|]+) \| ([^|]+) \| ([^|]+) \|$", PAGE, flags=re.MULTILINE)[2:]
PROSE = "\n".join(
    path.read_text(encoding="utf-8").lower()
    for path in (*(DOCS.parent / "src").rglob("*.py"), *DOCS.rglob("*.md"), DOCS.parent / "README.md")
    if path.name != "glossary.md" and "decisions" not in path.parts
)


def test_the_page_names_every_table():
    assert re.findall(r"<!-- table: (\w+) -->", PAGE) == list(TABLES)


@pytest.mark.parametrize("name", STRUCTURES)
def test_every_symbol_of_a_structure_is_there_with_its_unit(name):
    rows = {(symbol.strip("`"), unit.strip("`")) for symbol, _, unit, *_ in symbol_rows()}
    shipped = structure(name)
    assert rows >= {(item.name, item.unit) for item in (*shipped.parameters, *shipped.combinations)}


def test_an_inertia_time_has_its_inertia():
    """tau = 2 pi I n / M."""
    physical = {symbol.strip("`"): form for symbol, _, _, form, _ in symbol_rows()}
    assert physical["tau_dn"] == "I_dn [kg m2]"
    assert physical["k_q"] == ""


def test_quantities_of_a_room_are_read_with_their_continued_lines():
    rows = {(room, quantity): (unit, meaning) for quantity, meaning, unit, room in quantity_rows()}
    assert rows["models", "``M_s``"] == (
        "-",
        "deviation of shaft torque at the gauge over its working-point value; positive when the engine drives the "
        "propeller",
    )
    assert rows["torsion", "stiffness, damping"][0] == "N m/rad, N m s/rad"


def test_a_bar_in_a_cell_does_not_end_it():
    assert table(("a",), [["100 (1 - |y|)"]]).splitlines()[2] == r"| 100 (1 - \|y\|) |"


def test_terms_are_in_order_and_have_a_meaning_of_one_sentence():
    names = [term.lower() for term, *_ in TERMS]
    assert len(names) > 40
    assert names == sorted(names)
    for term, meaning, *_ in TERMS:
        assert meaning[0].isupper(), term
        assert meaning.endswith("."), term
        assert ". " not in meaning, term


@pytest.mark.parametrize("term", [term for term, *_ in TERMS])
def test_every_term_is_used(term):
    assert re.sub(r" \(.*\)", "", term).lower().strip("`") in PROSE


def test_no_symbol_of_the_catalogue_is_explained_by_hand():
    symbols = {symbol for symbol, *_ in symbol_rows()}
    assert not symbols & {term.strip() for term, *_ in TERMS}
