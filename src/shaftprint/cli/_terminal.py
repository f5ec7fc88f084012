"""The gate to the terminal: whatever a command prints goes through here, and no text out of a file moves the cursor."""

import click

from shaftprint.escape import terminal_line


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
