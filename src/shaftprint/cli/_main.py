"""The program ``shaftprint``: its commands and how they end."""

import gc
import os
import sys

import click

from shaftprint import __version__
from shaftprint.cli._command_group import CommandGroup

_MADE_BEFORE_A_SEARCH = 100_000


@click.group(cls=CommandGroup, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, message="%(prog)s %(version)s")
def shaftprint() -> None:
    """Find the fingerprint of a ship's propulsion line in a logger recording.

    The fingerprint is the line's physical parameters with their uncertainty, its frequency response and
    its stability margins. Begin with `shaftprint start`, or with
    `shaftprint demo` on a simulated ship.
    """


def main() -> None:
    """Run the program; this is the entry point of the installed command."""
    # Matrices are small here: threads that share one wait for each other, the longer the more cores there are. NumPy is
    # not loaded yet; who sets another number keeps it.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # What is imported and fitted lives to the end: searches of it for garbage took a tenth of a run.
    gc.set_threshold(_MADE_BEFORE_A_SEARCH)
    for stream in (sys.stdout, sys.stderr):
        # a name that the console's code page lacks must not end a run of minutes
        stream.reconfigure(errors="replace")  # type: ignore[union-attr]
    shaftprint(prog_name="shaftprint")
