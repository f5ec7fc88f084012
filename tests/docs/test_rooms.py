"""What is made from the code stands in the repository as it is made now; the floors hold every room."""

import ast
import re
import sys
import tomllib
from pathlib import Path

import pytest
from made_pages import MADE, PAGES, STUB
from room_diagram import SOURCE, floors, imports, purpose, stub
from wings import files_of, wings

ROOT = Path(__file__).parents[2]
RUN = "run python docs/_extensions/made_pages.py"
# it reads every file of the package
SLOW = {ROOT / "docs" / "rooms.md"}


@pytest.mark.parametrize(
    "page", [pytest.param(page, marks=[pytest.mark.slow] if page in SLOW else [], id=page.name) for page in PAGES]
)
def test_what_is_made_is_fresh(page):
    (shown,) = MADE.findall(page.read_text(encoding="utf-8"))
    assert shown == PAGES[page](), RUN


def test_type_checkers_see_every_room():
    assert STUB.read_text(encoding="utf-8") == stub(), RUN
    listed = re.findall(r"^from shaftprint import (\w+) as \1$", stub(), flags=re.MULTILINE)
    assert set(listed) == {name for floor in floors() for name in floor} - {"cli"}


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


@pytest.mark.parametrize("room", [name for floor in floors() for name in floor])
def test_every_room_and_leaf_module_says_what_it_is_for(room):
    assert len(purpose(room)) > 20


HOUSE = (ROOT / "docs" / "house.md").read_text(encoding="utf-8")


def test_the_house_shows_twelve_nouns_with_their_files():
    """A test of the pages runs what it shows of them."""
    shown = re.findall(r"^\*\*(\w+)\*\*, `([\w/]+\.py)`: .*?^```python\n(.*?)^```", HOUSE, flags=re.M | re.S)
    assert len(shown) == 12
    for noun, path, lines in shown:
        assert re.search(rf"^class {noun}\b", (SOURCE / path).read_text(encoding="utf-8"), flags=re.M), noun
        assert len(lines.splitlines()) <= 10, noun


def test_files_that_the_house_names_are_there():
    named = re.findall(r"`([\w/]+/_?\w+\.py)`", HOUSE)
    assert len(named) > 100
    assert [path for path in named if not (SOURCE / path).exists()] == []


# comes with pydantic and jinja2
PULLED_IN = {"pydantic_core", "markupsafe"}
# loaded when somebody asks for a PDF: a sentence says which extra to take
ON_REQUEST = {"report/paper reportlab"}


def test_the_core_needs_no_extra():
    """What the files of the core import when they are loaded comes with `pip install shaftprint`."""
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    own = {re.split(r"[<>=!;\[ ]", one)[0].replace("-", "_") for one in settings["project"]["dependencies"]}
    beside = set().union(*(files_of(modules) for _, modules in wings().values()))
    foreign = {
        f"{path.relative_to(SOURCE).parent.as_posix()} {name}"
        for path in sorted(set(SOURCE.rglob("*.py")) - beside)
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        for name in loaded(node)
        if name not in own | PULLED_IN | set(sys.stdlib_module_names) | {"shaftprint"}
    }
    assert foreign == ON_REQUEST


def loaded(node):
    """Return the packages that a statement of a file loads at once."""
    if isinstance(node, ast.Import):
        return {alias.name.split(".")[0] for alias in node.names}
    return {(node.module or "").split(".")[0]} if isinstance(node, ast.ImportFrom) else set()


def test_a_wing_holds_what_is_there():
    for name, (what, modules) in wings().items():
        assert what, name
        assert [str(path) for path in files_of(modules) if not path.exists()] == []
