"""The gate to the terminal: whatever a command prints goes through here, and no text out of a file moves the cursor."""

from collections.abc import Sequence

import click

from shaftprint.escape import terminal_line

# Letters of tables and sentences that a terminal's code page may lack.
_PLAIN = str.maketrans(
    {"−": "-", "±": "+/-", "°": " deg", "–": "-", "∞": "inf", "\u202f": "", "²": "2", "·": " ", "“": '"', "”": '"'}
)


def on_terminal(text: str) -> str:
    """Return a text of a table or of the report with letters that every terminal has."""
    return text.replace("s⁻¹", "1/s").translate(_PLAIN)


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


def print_findings(title: str, findings: Sequence[str]) -> None:
    """Print findings in words, one a line, under a title."""
    echo(title)
    for finding in findings or ("None.",):
        echo(f"  * {finding}")
    echo()
