"""Bars are drawn on a terminal only."""

import io

import pytest
from rich.console import Console

from shaftprint.cli import _progress
from shaftprint.cli._progress import progress


@pytest.fixture
def terminal(monkeypatch):
    screen = io.StringIO()
    monkeypatch.setattr(
        _progress, "Console", lambda **_: Console(file=screen, force_terminal=True, width=100, legacy_windows=False)
    )
    return screen


def _work(*, hidden):
    with progress(hidden=hidden) as steps:
        steps.begin("Reading", total=2.0)
        steps.advance(1.0)
        steps.reach(1.5)
        done = None if steps.bars is None else [(task.completed, task.total) for task in steps.bars.tasks]
        steps.begin("Drawing")
        after = None if steps.bars is None else [(task.completed, task.total) for task in steps.bars.tasks]
        steps.end()
        return done, after


def test_bars_on_a_terminal(terminal):
    done, after = _work(hidden=False)
    assert done == [(1.5, 2.0)]
    assert after == [(2.0, 2.0), (0, None)]
    assert "Reading" in terminal.getvalue()
    assert "Drawing" in terminal.getvalue()


def test_no_bars_on_request(terminal):
    assert _work(hidden=True) == (None, None)
    assert terminal.getvalue() == ""


def test_no_bars_without_terminal(capsys):
    assert _work(hidden=False) == (None, None)
    assert capsys.readouterr() == ("", "")
