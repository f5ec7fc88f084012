"""Progress bars on the error output of a terminal."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator
from dataclasses import dataclass

import click

from shaftprint.cli._terminal import echo, output
from shaftprint.escape import printable
from shaftprint.late import late

with late():
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn

no_progress_option = click.option("--no-progress", is_flag=True, help="Show no progress bars.")
"""The option of every command that takes longer than a second."""


@dataclass(kw_only=True, slots=True)
class Steps:
    """The steps of a command, one bar each; without a terminal nothing is shown."""

    bars: Progress | None
    """Where the bars are drawn; None where they are not."""
    in_words: bool = False
    """Whether each step is named on the error output when it begins, with its time when it ends."""
    current: TaskID | None = None
    """The bar of the step that runs."""
    running: tuple[str, float] | None = None
    """Text and begin [s] of the step that is named in words."""
    told: str = ""
    """The step that was told last."""

    def begin(self, text: str, total: float | None = None) -> None:
        """End the running step and begin the next.

        ``text``: what is being done. ``total``: amount of work, in any unit; None where it is not known.
        """
        self.end()
        if self.in_words:
            self.running = (text, time.monotonic())
            echo(f"{text} ...", err=True)
        if self.bars is None:
            return
        self.current = self.bars.add_task(printable(text), total=total)

    def tell(self, step: str, detail: str) -> None:
        """Say what is being done of a step whose amount of work is not known; another step is begun.

        ``detail``: what of it is being done; empty where there is nothing to say.
        """
        if step != self.told:
            self.begin(step)
            self.told = step
        if self.in_words and detail:
            echo(f"  {detail}", err=True)
        if self.bars is not None and self.current is not None:
            self.bars.update(self.current, description=printable(f"{step}: {detail}" if detail else step))

    def advance(self, amount: float) -> None:
        """Move the running bar by an amount of work."""
        if self.bars is not None and self.current is not None:
            self.bars.advance(self.current, amount)

    def reach(self, amount: float) -> None:
        """Set the running bar to an amount of work."""
        if self.bars is not None and self.current is not None:
            self.bars.update(self.current, completed=amount)

    def end(self) -> None:
        """Fill the running bar."""
        if self.running is not None:
            text, begin = self.running
            echo(f"{text}: {time.monotonic() - begin:.1f} s", err=True)
            self.running = None
        if self.bars is not None and self.current is not None:
            total = self.bars.tasks[self.bars.task_ids.index(self.current)].total or 1.0
            self.bars.update(self.current, total=total, completed=total)


@contextlib.contextmanager
def progress(*, hidden: bool) -> Iterator[Steps]:
    """Give the bars of a command; they disappear when the block ends."""
    console = Console(stderr=True)
    chosen = output()
    if chosen.verbose or hidden or chosen.quiet or not console.is_terminal:
        steps = Steps(bars=None, in_words=chosen.verbose)
        yield steps
        steps.end()
        return
    columns = (TextColumn("{task.description}", markup=False), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True) as bars:
        yield Steps(bars=bars)
