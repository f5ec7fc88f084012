"""What a long run reports while it works; whoever calls it may show it."""

from typing import Protocol

from shaftprint.notebook._progress import cell_progress


class Progress(Protocol):
    """The steps of a run, one after the other."""

    def begin(self, text: str, total: float | None = None) -> None:
        """Begin the next step, with its amount of work where that is known."""

    def advance(self, amount: float) -> None:
        """Add an amount of work that is done."""

    def reach(self, amount: float) -> None:
        """Set the amount of work that is done."""

    def tell(self, step: str, detail: str) -> None:
        """Say what is being done of a step whose amount of work is not known."""

    def end(self) -> None:
        """End the last step."""


class Silent:
    """Progress that nobody looks at."""

    def begin(self, text: str, total: float | None = None) -> None:
        """Do nothing."""

    def advance(self, amount: float) -> None:
        """Do nothing."""

    def reach(self, amount: float) -> None:
        """Do nothing."""

    def tell(self, step: str, detail: str) -> None:
        """Do nothing."""

    def end(self) -> None:
        """Do nothing."""


SILENT = Silent()


def shown_here() -> Progress:
    """Return progress that a notebook shows below its cell; silent elsewhere."""
    return cell_progress() or SILENT
