"""How far long work is, as one line below the cell of a notebook."""

import sys
import time
from collections.abc import Callable
from typing import Any

from shaftprint.escape import html_text

_LEAST_S = 0.2
"""Between two changes of the line: each is a message to the browser."""


class CellProgress:
    """The steps of a run, one after the other; the line goes when the run ends, and stays where it fails."""

    def __init__(self, display: Any) -> None:
        """Begin with an empty line; ``display``: what shows a bundle of texts and returns its handle."""
        self._handle = display({"text/html": "", "text/plain": ""}, raw=True, display_id=True)
        self._text, self._done = "", 0.0
        self._total: float | None = None
        self._shown_s = 0.0

    def begin(self, text: str, total: float | None = None) -> None:
        """Begin the next step, with its amount of work where that is known."""
        self._text, self._total, self._done = text, total, 0.0
        self._show(at_once=True)

    def advance(self, amount: float) -> None:
        """Add an amount of work that is done."""
        self.reach(self._done + amount)

    def reach(self, amount: float) -> None:
        """Set the amount of work that is done."""
        self._done = amount
        self._show(at_once=False)

    def tell(self, step: str, detail: str) -> None:
        """Say what is being done of a step whose amount of work is not known."""
        self.begin(f"{step}: {detail}" if detail else step)

    def end(self) -> None:
        """Take the line away."""
        self._handle.update({"text/html": "", "text/plain": ""}, raw=True)

    def _show(self, *, at_once: bool) -> None:
        now = time.monotonic()
        if not at_once and now - self._shown_s < _LEAST_S:
            return
        self._shown_s = now
        share = None if not self._total else min(max(self._done / self._total, 0.0), 1.0)
        bar = "<progress></progress>" if share is None else f'<progress value="{share:.3f}"></progress>'
        said = self._text if share is None else f"{self._text}, {100.0 * share:.0f} %"
        self._handle.update({"text/html": f"{bar} {html_text(self._text)}", "text/plain": said}, raw=True)


def cell_progress() -> CellProgress | None:
    """Return a line below the cell that runs; None outside of a notebook."""
    # a notebook has loaded it; others need not have it
    ipython = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    if getattr(shell, "kernel", None) is None:
        return None
    return CellProgress(sys.modules["IPython.display"].display)


def cell_bar(text: str) -> Callable[[float], None]:
    """Return what shows the share of one step that is done, 0 to 1, below the cell; nothing outside of a notebook."""
    line = cell_progress()
    if line is None:
        return lambda share: None
    line.begin(text, total=1.0)

    def reach(share: float) -> None:
        line.reach(share)
        if share >= 1.0:
            line.end()

    return reach
