"""What a command prints as a workbook: each table on a sheet, numbers as numbers, the fingerprint with all digits."""

from __future__ import annotations

import io
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import click

from shaftprint.errors import ShaftprintError
from shaftprint.files import written_whole
from shaftprint.late import late
from shaftprint.plain_table import Table, numbers, texts
from shaftprint.tables._workbook import Sheet, Value, expect_writer, sheet_of, style_for, write_workbook

with late():
    from shaftprint.fingerprint import _line_fingerprint

ENDING = ".xlsx"


@dataclass(kw_only=True, slots=True)
class Workbook:
    """The tables and nouns of a command that end in one file."""

    path: Path
    """The file."""
    tables: list[Table] = field(default_factory=list)
    """Tables as they are printed, those of the details too."""
    nouns: dict[str, Any] = field(default_factory=dict)
    """What the command gives beside them, by name."""

    def write(self) -> None:
        """Write the file, whole or not at all."""
        sheets = [*self._fingerprints(), *(sheet_of(table) for table in self.tables if table.rows)]
        # the library has words of its own for a disk that is full
        content = io.BytesIO()
        write_workbook(content, sheets)
        with written_whole(self.path) as part:
            part.write_bytes(content.getbuffer())

    def _fingerprints(self) -> Iterator[Sheet]:
        """Return numbers and sources of each fingerprint that the command gives."""
        for name, noun in self.nouns.items():
            if isinstance(noun, _line_fingerprint.LineFingerprint):
                yield Sheet(title=f"Numbers of {name}", columns=NUMBER_COLUMNS, rows=list(_numbers(noun)))
                sources = [(one.name, one.role, one.sha256) for one in noun.sources]
                yield Sheet(title=f"Sources of {name}", columns=texts("file", "what it is", "SHA-256"), rows=sources)


NUMBER_COLUMNS = (
    *texts("quantity"),
    *numbers("value", "std", "95 % from", "95 % to"),
    *texts("bound of the search", "unit"),
    *numbers("vessel file", "vessel file, std"),
    *texts("usable", "why not", "meaning"),
)


def workbook_at(path: Path) -> Workbook:
    """Return an empty workbook that will be written to a file.

    Raises click.ClickException if the file cannot be one, is there already, or the library is not installed.
    """
    if path.suffix.lower() != ENDING:
        raise click.ClickException(f"--xlsx {path}: expected a file that ends in {ENDING}.")
    if path.exists() or not path.resolve().parent.is_dir():
        words = "exists already; choose another name" if path.exists() else "expected an existing folder; make it first"
        raise click.ClickException(f"--xlsx {path}: {words}.")
    try:
        expect_writer()
    except ShaftprintError as error:
        raise click.ClickException(f"--{error}") from error
    return Workbook(path=path)


def _numbers(fingerprint: _line_fingerprint.LineFingerprint) -> Iterator[Sequence[Value]]:
    """Return all numbers of a fingerprint with all digits, shown to the second digit of their deviation."""
    verdict = fingerprint.verdict
    for group in ("parameters", "combinations", "physical", "margins"):
        for one in getattr(fingerprint, group, ()):
            std = one.std if one.stated_std is not None else math.nan
            doubt = verdict.not_trusted.get(one.name, "") if verdict.trustworthy else "the fit is not trustworthy"
            shown = style_for(one.std)
            cells = [(number, shown) for number in (one.value, std, *one.ends_95)]
            expected = [("" if e is None else (e, shown)) for e in (one.expected, one.expected_std)]
            bound = " and ".join(end for end, is_open in zip(("from", "to"), one.interval_open, strict=True) if is_open)
            yield (one.name, *cells, bound, one.unit, *expected, "no" if doubt else "yes", doubt, one.meaning)
