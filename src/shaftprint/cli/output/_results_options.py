"""The options of a command that writes a folder of results: where, over what, and whether bars are shown."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

from shaftprint.cli._gathered_options import gathered_options
from shaftprint.cli.output._output_folder import force_option, output_folder
from shaftprint.cli.output._progress import Steps, no_progress_option, progress


@dataclass(frozen=True, kw_only=True, slots=True)
class Results:
    """Where results go, and what is shown while they are made."""

    output: Path
    """The folder."""
    force: bool
    """Whether results may be put between files that are not of this command."""
    no_progress: bool
    """Whether no bars are shown."""

    def folder(self, command: str) -> AbstractContextManager[Path]:
        """Give a folder whose files appear in that of the results as a whole; see ``output_folder``."""
        return output_folder(self.output, of=command, force=self.force)

    def progress(self) -> AbstractContextManager[Steps]:
        """Give the bars of the command."""
        return progress(hidden=self.no_progress)


def results_options(what: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Return what adds ``--output``, ``--force`` and ``--no-progress``, taken as one ``results``.

    ``what``: what ``--output`` is.
    """
    output = click.option("-o", "--output", required=True, type=click.Path(path_type=Path), help=what)
    return gathered_options(Results, (output, force_option, no_progress_option), name="results")
