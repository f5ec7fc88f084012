"""The table of equations: every name in it exists, and every equation of the thesis is in it."""

import importlib
import re
from pathlib import Path

import pytest

PAGE = (Path(__file__).parents[2] / "docs" / "theory" / "equations.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| ([^|]+) \| .+ \| ([^|]+) \|$", PAGE, flags=re.MULTILINE)
NAMES = sorted(set(re.findall(r"`(shaftprint\.[\w.]+)`", PAGE)))
# Last numbered equation of each chapter and appendix of the thesis.
LAST = {"2": 41, "3": 10, "4": 27, "5": 4, "C": 8, "D": 8}


@pytest.mark.parametrize("name", NAMES)
def test_what_holds_an_equation_exists_and_is_described(name):
    path, _, last = name.rpartition(".")
    value = getattr(importlib.import_module(path), last)
    assert value.__doc__


def covered():
    """Return every equation that the first columns name, such as ``2.26 to 2.28, 4.1``."""
    found = set()
    for first, _ in ROWS:
        for part in first.split(","):
            ends = re.findall(r"\b([2-5CD])\.(\d+)\b", part)
            if "table" in part or "section" in part or not ends:
                continue
            chapter, low = ends[0]
            found |= {(chapter, number) for number in range(int(low), int(ends[-1][1]) + 1)}
    return found


def test_no_equation_is_missing():
    numbered = {(chapter, number) for chapter, last in LAST.items() for number in range(1, last + 1)}
    assert covered() == numbered


def test_every_row_names_code():
    rows = [where for first, where in ROWS if first.strip() not in {"equation", "---"}]
    assert len(rows) > 50
    assert all("`shaftprint." in where for where in rows)
