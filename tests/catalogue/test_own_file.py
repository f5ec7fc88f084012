"""The name of a structure as it is typed: a shipped one, or one in a file of the user's."""

import pytest

from shaftprint.catalogue._own_structure import own_file


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
