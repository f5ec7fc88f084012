"""The line below the cell of a notebook: shown there only, in text that cannot run, and gone at the end."""

import sys
from types import SimpleNamespace

import pytest

from shaftprint.notebook._progress import CellProgress, cell_bar, cell_progress


class Shown:
    """What a notebook would show, the newest last."""

    def __init__(self):
        self.bundles = []

    def __call__(self, bundle, *, raw, display_id):
        assert raw
        assert display_id
        self.bundles.append(bundle)
        return self

    def update(self, bundle, *, raw):
        assert raw
        self.bundles.append(bundle)


@pytest.fixture
def shown(monkeypatch):
    shown = Shown()
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: SimpleNamespace(kernel="k")))
    monkeypatch.setitem(sys.modules, "IPython.display", SimpleNamespace(display=shown))
    return shown


def test_a_step_shows_how_far_it_is_and_its_text_cannot_run(shown):
    line = cell_progress()
    line.begin("Reading <script>", total=4.0)
    line._shown_s = 0.0
    line.reach(1.0)
    assert shown.bundles[-1]["text/html"] == '<progress value="0.250"></progress> Reading &lt;script&gt;'
    assert shown.bundles[-1]["text/plain"] == "Reading <script>, 25 %"
    line.tell("Fitting", "start 2")
    assert shown.bundles[-1]["text/html"] == "<progress></progress> Fitting: start 2"
    line.end()
    assert shown.bundles[-1] == {"text/html": "", "text/plain": ""}


def test_a_bar_goes_when_all_is_done(shown):
    reach = cell_bar("Simulating")
    reach(1.0)
    assert shown.bundles[-1] == {"text/html": "", "text/plain": ""}


def test_without_a_notebook_nothing_is_shown(shown, monkeypatch):
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: None))
    assert cell_progress() is None
    cell_bar("Simulating")(0.5)
    assert shown.bundles == []


def test_many_small_steps_are_few_messages(shown):
    line = CellProgress(shown)
    line.begin("Reading", total=1000.0)
    for _ in range(1000):
        line.advance(1.0)
    assert len(shown.bundles) < 100
