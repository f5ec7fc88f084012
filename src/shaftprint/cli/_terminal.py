"""The gate to the terminal: whatever a command prints goes through here, and no text out of a file moves the cursor."""

import click
from rich.text import Text

from shaftprint.escape import printable, terminal_line


def echo(line: object = "", *, err: bool = False) -> None:
    """Print one line.

    Parameters
    ----------
    line
        Text or a path; line breaks at its end leave empty lines, others are replaced.
    err
        Whether it goes to the error output.
    """
    click.echo(terminal_line(str(line)), err=err)


def literal(text: str, *, style: str = "") -> Text:
    """Return text for rich that stands for itself: no brackets are markup in it, no words between colons pictures."""
    return Text(printable(text), style=style)
