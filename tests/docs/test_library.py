"""The rooms that one import gives: all of them, loaded when they are used, with the names that the tables promise."""

import importlib
import pkgutil
import re
import subprocess
import sys
from pathlib import Path

import pytest
from room_diagram import listed_rooms, with_rooms

import shaftprint as sp

ROOT = Path(__file__).parents[2]
# the command line is no library
ROOMS = {room.name for room in pkgutil.iter_modules(sp.__path__)} - {"__main__", "cli"}
LIBRARY = (ROOT / "docs" / "library.md").read_text(encoding="utf-8")


def test_every_room_is_given_by_the_package():
    for room in ROOMS:
        assert getattr(sp, room) is importlib.import_module(f"shaftprint.{room}")


def test_a_session_offers_what_has_words_of_the_field():
    assert {"vessel", "identify", "errors", "units", "open_survey", "__version__"} < set(dir(sp))
    assert not {"cli", "notebook", "escape", "files"} & set(dir(sp))
    # a room that nobody thought of is offered
    assert len(set(dir(sp)) & ROOMS) > 30


def test_a_name_that_is_not_there_is_refused_with_the_rooms():
    with pytest.raises(AttributeError, match=r"has no attribute 'turbine'; its rooms are bench, campaign, .*catalogue"):
        _ = sp.turbine


@pytest.mark.parametrize(
    ("guess", "right"),
    [
        ("load_fingerprint", "sp.fingerprint.read_fingerprint"),
        ("read_vessel", "sp.vessel.load_vessel"),
        ("load_recording", "sp.recording.read_recording"),
        ("bode_charts", "sp.report.bode_chart"),
        ("Vessel", "sp.vessel.Vessel"),
        ("open", "sp.open_survey"),
    ],
)
def test_a_name_that_somebody_guesses_is_answered_with_the_right_one(guess, right):
    with pytest.raises(AttributeError, match=f"has no attribute '{guess}'; is .*{re.escape(right)}.* meant"):
        getattr(sp, guess)


def test_the_import_loads_no_room():
    code = (
        "import sys, shaftprint as sp; sp.__version__; print([m for m in sys.modules if m.startswith('shaftprint.')])"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout == "[]\n"


def promised():
    """Return room and name of every noun and verb in the tables of the page and of the package."""
    for room, nouns in re.findall(
        r"^\| \[(\w+)\]\(reference/generated/\w+\.rst\) \|(.*)\|$", LIBRARY, flags=re.MULTILINE
    ):
        yield from ((room, name) for name in re.findall(r"`(\w+)`", nouns))
    room = ""
    for first, rest in re.findall(r"^(``\w+``|) {2,}(.*)$", sp.__doc__, flags=re.MULTILINE):
        room = first.strip("`") or room
        yield from ((room, name) for name in re.findall(r"``(\w+)``", rest))


@pytest.mark.parametrize(("room", "name"), sorted(set(promised())))
def test_nouns_and_verbs_are_public(room, name):
    assert name in importlib.import_module(f"shaftprint.{room}").__all__


def test_both_tables_are_read():
    assert len(set(promised())) > 40


def test_the_reference_lists_every_room():
    assert sorted(listed_rooms()) == sorted(ROOMS)
    page = with_rooms((ROOT / "docs" / "reference" / "index.md").read_text(encoding="utf-8"))
    assert re.findall(r"^generated/(\w+)$", page, flags=re.MULTILINE) == ["commands", *listed_rooms()]
    rows = re.findall(r"^\| \[(\w+)\]\(generated/\w+\.rst\) \| \w", page, flags=re.MULTILINE)
    # by task, each once
    assert sorted(rows) == sorted(ROOMS)


def test_every_example_is_on_the_page():
    listed = set(re.findall(r"`(\w+\.py)`", LIBRARY))
    assert listed == {path.name for path in (ROOT / "examples").glob("*.py")}
