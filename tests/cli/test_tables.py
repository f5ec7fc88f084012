"""Tables on a terminal and in a file."""

import io

import pytest
from rich.console import Console

from shaftprint.cli import _tables
from shaftprint.cli._tables import print_table


def test_table_in_a_file_is_not_folded(capsys):
    long = "a meaning of many words " * 5
    print_table("Title [s]", ("name", "value [rad/s]"), [(long, "1.5"), ("b [x]", "20")], numbers=(1,))
    lines = [line.rstrip() for line in capsys.readouterr().out.splitlines()]
    assert lines[0] == "Title [s]"
    assert any(line.strip().startswith(long.strip()) and line.endswith("1.5") for line in lines)
    # markup in a cell is text, and numbers stand to the right
    place = next(line for line in lines if "b [x]" in line)
    assert place.endswith(" 20")


@pytest.mark.parametrize(("width", "shown"), [(40, False), (120, True)])
def test_spare_column_is_left_out_on_a_narrow_terminal(monkeypatch, width, shown):
    screen = io.StringIO()
    monkeypatch.setattr(
        _tables,
        "Console",
        lambda **_: Console(file=screen, force_terminal=True, width=width, legacy_windows=False, color_system=None),
    )
    print_table("Title", ("name", "value", "meaning"), [("tau_dn", "0.3198", "inertia " * 5)], spare=True)
    assert "0.3198" in screen.getvalue()
    assert ("meaning" in screen.getvalue()) is shown
    assert ("inertia" in screen.getvalue()) is shown
