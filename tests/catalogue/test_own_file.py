"""The name of a structure as it is typed: a shipped one, or one in a file of the user's."""

import pytest

from shaftprint.catalogue._own_structure import TypedName, chosen_structures, own_file
from shaftprint.errors import StructureError


@pytest.mark.parametrize(
    ("text", "path", "name"),
    [
        ("my_ship.py:my_loop", "my_ship.py", "my_loop"),
        (r"C:\ships\my_ship.py:my_loop", r"C:\ships\my_ship.py", "my_loop"),
        (r"C:\ships\my_ship.py", r"C:\ships\my_ship.py", ""),
        ("/home/me/a b.py:x", "/home/me/a b.py", "x"),
        ("my_ship.PY:x", "my_ship.PY", "x"),
        ("my_ship.py:", "my_ship.py", ""),
    ],
)
def test_file_and_name_are_told_apart(text, path, name):
    found = own_file(text)
    assert (str(found[0]), found[1]) == (path, name)


@pytest.mark.parametrize("text", ["CL4", "gauge-closed", "OL-PID"])
def test_a_shipped_name_is_no_file(text):
    assert own_file(text) is None


LOOP = """
from shaftprint.models import FirstOrderLag, Parameter, Structure

TAU = Parameter("tau", "s", 0.1, 10.0, 1.0, "time of the lag")


def my_loop():
    return Structure(name="MY-LOOP", title="a lag", input="u", outputs={"y": FirstOrderLag(TAU)})


ready = my_loop()
number = 3


def with_an_argument(gain):
    return gain


def of_another_kind():
    return "a text"


def that_fails():
    return 1 / 0


def _of_the_file_alone():
    return ready
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "my_ship.py"
    path.write_text(LOOP, encoding="utf-8")
    return path


def test_structures_of_a_file_and_of_the_shipped_ones_are_taken_once(file):
    texts = [TypedName(text) for text in (f"{file}:my_loop", "gauge-closed", f"{file}:my_loop", "GAUGE-CLOSED")]
    assert [one.name for one in chosen_structures(texts)] == ["MY-LOOP", "GAUGE-CLOSED"]


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("", r"my_ship\.py: expected the name of a structure in it, such as .*my_ship\.py:my_loop"),
        ("loop", r"my_ship\.py: found no loop; its structures are my_loop, ready, of_another_kind, that_fails"),
        ("number", r"my_ship\.py:number: expected a Structure, or a function without arguments .*, found int"),
        ("with_an_argument", r"expected a function without arguments, found arguments gain"),
        ("of_another_kind", r"my_ship\.py:of_another_kind: expected a Structure, found str"),
        ("that_fails", r"my_ship\.py, line 24: ZeroDivisionError: division by zero\."),
    ],
)
def test_what_is_no_structure_of_a_file_is_said(file, name, expected):
    with pytest.raises(StructureError, match=expected):
        chosen_structures([TypedName(f"{file}:{name}")])


def test_two_structures_of_one_name_are_told_apart_by_their_files(file, tmp_path):
    other = tmp_path / "other_ship.py"
    other.write_text(LOOP, encoding="utf-8")
    with pytest.raises(StructureError, match=r"two structures have the name MY-LOOP, my_ship\.py:my_loop and other_"):
        chosen_structures([TypedName(f"{path}:my_loop") for path in (file, other)])


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("x = (", r"line 1: SyntaxError: '\(' was never closed"),
        ("raise SystemExit", r"line 1: SystemExit"),
        ("import shaftprint_of_nobody", r"line 1: ModuleNotFoundError: No module named 'shaftprint_of_nobody'"),
        (
            "from shaftprint.catalogue import structure\n\n\ndef mine():\n    return structure('CL4')\n",
            r"mine: its name CL4 is that of a shipped structure; give it its own",
        ),
    ],
)
def test_a_file_that_cannot_be_used_is_one_sentence(tmp_path, text, expected):
    path = tmp_path / "mine.py"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(StructureError, match=expected):
        chosen_structures([TypedName(f"{path}:mine")])


def test_a_file_is_a_python_file_that_is_there(tmp_path):
    with pytest.raises(StructureError, match=r"expected a file whose name ends in \.py"):
        chosen_structures([TypedName(f"{tmp_path / 'mine.txt'}:mine")])
    with pytest.raises(StructureError, match=r"expected a Python file, found nothing there"):
        chosen_structures([TypedName(f"{tmp_path / 'mine.py'}:mine")])
    (tmp_path / "folder.py").mkdir()
    with pytest.raises(StructureError, match=r"expected a Python file, found a folder"):
        chosen_structures([TypedName(f"{tmp_path / 'folder.py'}:mine")])
