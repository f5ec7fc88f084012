"""The gate to the terminal: whatever a command prints goes through here, and no text out of a file moves the cursor.

What is printed is an answer, sentences under a title, a table, or a line as it is. With ``--json`` the same become one
document on the standard output; with ``--quiet`` only the answer is printed, and details only with ``--verbose``.
"""

import json
import os
import shutil
import sys
import textwrap
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import click

from shaftprint.digits import NARROW_SPACE
from shaftprint.escape import printable, terminal_line

WIDTH = 100
"""Width of what goes into a file or a pipe; a terminal has its own [letters]."""
NARROWEST = 40
_KEY = "shaftprint.output"


@dataclass(kw_only=True, slots=True)
class Document:
    """What a command has to say, as the members of one JSON object."""

    command: str
    """Name of the command."""
    answer: list[str] = field(default_factory=list)
    """The answer, in sentences."""
    findings: list[dict[str, Any]] = field(default_factory=list)
    """Titles with their sentences."""
    tables: list[dict[str, Any]] = field(default_factory=list)
    """Tables as they are printed."""
    lines: list[str] = field(default_factory=list)
    """Other lines."""
    result: dict[str, Any] = field(default_factory=dict)
    """Nouns with all digits, by name."""


@dataclass(kw_only=True, slots=True)
class Output:
    """How a command speaks."""

    quiet: bool = False
    """Whether only the answer is printed, and no progress."""
    verbose: bool = False
    """Whether details are printed, and each step of long work is named with its time, without a terminal too."""
    in_details: bool = False
    """Whether what is printed now is a detail, see ``details``."""
    document: Document | None = None
    """Where everything goes instead of the terminal; None without ``--json``."""
    workbook: Any = None
    """Where tables and numbers go as well, see ``output/_workbook.py``; None without ``--xlsx``."""

    @property
    def answers_only(self) -> bool:
        """Whether only answers are printed now."""
        return self.quiet or (self.in_details and not self.verbose)


def output() -> Output:
    """Return how the command that runs speaks."""
    context = click.get_current_context(silent=True)
    if context is None:
        return Output()
    chosen: Output = context.meta.setdefault(_KEY, Output())
    return chosen


@contextmanager
def details() -> Iterator[None]:
    """Let what is printed inside, but for answers, be seen with ``--verbose`` and ``--json`` only."""
    chosen = output()
    before, chosen.in_details = chosen.in_details, True
    try:
        yield
    finally:
        chosen.in_details = before


def is_detailed() -> bool:
    """Return whether details are wanted."""
    chosen = output()
    return chosen.document is not None or chosen.workbook is not None or (chosen.verbose and not chosen.quiet)


def width() -> int:
    """Return how many letters a line may have: COLUMNS where it is set, else those of the terminal, else 100."""
    stated = os.environ.get("COLUMNS", "")
    if stated.isdecimal() and int(stated) > 0:
        return max(int(stated), NARROWEST)
    if not sys.stdout.isatty():
        return WIDTH
    return max(shutil.get_terminal_size((WIDTH, 24)).columns, NARROWEST)


def _put(text: str = "", *, err: bool = False) -> None:
    """Print a text; where whoever reads has gone, as ``| head`` does, what follows is printed nowhere."""
    try:
        click.echo(text, err=err)
    except BrokenPipeError:
        # the files that a command writes are wanted all the same
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, (sys.stderr if err else sys.stdout).fileno())
        os.close(nowhere)


def echo(line: object = "", *, err: bool = False) -> None:
    """Print one line as it is.

    ``line``: text or a path; line breaks at its end leave empty lines, others are replaced. ``err``: whether it goes to
    the error output.
    """
    chosen = output()
    text = terminal_line(str(line))
    if err:
        _put(text, err=True)
    elif chosen.document is not None:
        chosen.document.lines += [text.strip()] if text.strip() else []
    elif not chosen.answers_only:
        _put(text)


def ring() -> None:
    """Ring the bell of a terminal; a file or a pipe has none."""
    if sys.stderr.isatty():
        click.echo("\a", nl=False, err=True)


def say(sentence: str, *, indent: str = "") -> None:
    """Print prose, wrapped between words; line breaks at its end leave empty lines."""
    chosen = output()
    if chosen.document is not None:
        chosen.document.lines.append(printable(sentence.strip()))
    elif not chosen.answers_only:
        _put(_wrapped(sentence, indent, indent) + "\n" * (len(sentence) - len(sentence.rstrip("\n"))))


def answer(text: str | Path) -> None:
    """Print what the user has asked for, with ``--quiet`` too: a sentence, which is wrapped, or a path as it is."""
    chosen = output()
    if chosen.document is not None:
        chosen.document.answer.append(printable(str(text)))
    else:
        _put(_wrapped(text, "", "") if isinstance(text, str) else terminal_line(str(text)))


def print_findings(title: str, findings: Sequence[str], *, is_answer: bool = False) -> None:
    """Print findings in words, one a line, under a title.

    ``title``, ``findings``: what they are on, and they. ``is_answer``: whether they are what the user has asked for:
    then they are printed with ``--quiet`` too.
    """
    chosen = output()
    if chosen.document is not None:
        sentences = [printable(finding) for finding in findings]
        if is_answer:
            chosen.document.answer += [printable(title), *sentences]
        else:
            chosen.document.findings.append({"title": printable(title), "sentences": sentences})
        return
    if chosen.answers_only and not is_answer:
        return
    _put(_wrapped(title, "", ""))
    for finding in findings or ("None.",):
        _put(_wrapped(finding, "  * ", "    "))
    _put()


def print_lines_of_table(title: str, lines: Sequence[str]) -> None:
    """Print a table that is laid out already, its title in bold on a terminal."""
    headed = [click.style(line, bold=True) for line in _wrapped(title, "", "").split("\n")]
    for line in (*headed, "", *map(printable, lines), ""):
        _put(_with_letters_of_the_stream(line))


def _with_letters_of_the_stream(line: str) -> str:
    """Return a line of a table; a rule is of hyphens where the code page has no other, as that of files on Windows."""
    try:
        line.encode(sys.stdout.encoding)
    except UnicodeEncodeError:
        return line.replace("─", "-")
    return line


def print_document() -> None:
    """Print the JSON object of a command that has ended, and write its workbook, where they were asked for."""
    chosen = output()
    if chosen.workbook is not None:
        chosen.workbook.write()
    document = chosen.document
    if document is not None:
        _put(json.dumps(asdict(document), ensure_ascii=True, allow_nan=False, indent=1))


def _wrapped(text: str, first: str, following: str) -> str:
    # thousands stand as in tables here, whatever sentence a page has of them
    lines = textwrap.wrap(
        printable(text.rstrip("\n")).replace(NARROW_SPACE, ""),
        width(),
        initial_indent=first,
        subsequent_indent=following,
        break_long_words=False,
        break_on_hyphens=False,
    )
    return "\n".join(lines)
