"""The page of the rooms and the table in CONTRIBUTING hold what the import contract and the source say."""

import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs" / "_extensions"))

from room_diagram import MADE, PAGE, SOURCE, floors, imports, made  # noqa: E402

CONTRIBUTING = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")


@pytest.mark.slow
def test_the_drawing_is_that_of_the_imports():
    (shown,) = MADE.findall(PAGE.read_text(encoding="utf-8"))
    assert shown == made(), "run python docs/_extensions/room_diagram.py"


def test_imports_point_down():
    """Not the contract again: here they are counted from the syntax trees."""
    floor_of = {name: number for number, floor in enumerate(floors()) for name in floor}
    arrows = [(room, other) for room, others in imports().items() for other in others]
    assert len(arrows) > 100
    assert [(a, b) for a, b in arrows if floor_of[a] >= floor_of[b]] == []


def test_every_room_and_leaf_module_is_on_a_floor():
    there = {path.stem for path in SOURCE.iterdir() if path.is_dir() or path.suffix == ".py"} - {
        "__init__",
        "__main__",
        "__pycache__",
        "py",
    }
    assert {name for floor in floors() for name in floor} == there


def test_contributing_describes_every_room_and_leaf_module_once():
    described = re.findall(r"`(\w+)`", "".join(re.findall(r"^\| (`[^|]+) \|", CONTRIBUTING, flags=re.MULTILINE)))
    for name in (name for floor in floors() for name in floor):
        assert described.count(name) == 1, name
