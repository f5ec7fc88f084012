"""Bars are drawn on a terminal only."""

import pytest

from shaftprint.cli.output._progress import progress


@pytest.fixture
def terminal(monkeypatch):
    """Let the error output pass for a terminal."""
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "100")


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


@pytest.mark.usefixtures("terminal")
def test_bars_on_a_terminal(capsys):
    done, after = _work(hidden=False)
    assert done == [(1.5, 2.0)]
    assert after == [(2.0, 2.0), (0, None)]
    shown = capsys.readouterr().err
    assert "Reading" in shown
    assert "Drawing" in shown


@pytest.mark.usefixtures("terminal")
def test_no_bars_on_request(capsys):
    assert _work(hidden=True) == (None, None)
    assert capsys.readouterr() == ("", "")


def test_no_bars_without_terminal(capsys, monkeypatch):
    monkeypatch.delenv("FORCE_COLOR", raising=False)
    assert _work(hidden=False) == (None, None)
    assert capsys.readouterr() == ("", "")
