"""What the symbols of a table mean, beside them: one place for all tables of a report."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from shaftprint.plain_table import MEANING, Symbol, Table
from shaftprint.report.charts._text import CHANNELS

if TYPE_CHECKING:
    from shaftprint.report.sections._sections import Inputs, Section

SHARES = {"n", "M_s", "n_set", "e"}
"""Channels whose deviations are over their own value at the working point."""


def meanings_of(inputs: "Inputs") -> dict[str, str]:
    """Return what parameters, numbers and channels of a report are, by their symbols."""
    fingerprint = inputs.fingerprint
    fits = (*inputs.fits.values(), inputs.identification)
    return {
        **CHANNELS,
        **{parameter.name: parameter.meaning for fit in fits for parameter in fit.structure.parameters},
        **{
            quantity.name: quantity.meaning
            for group in (fingerprint.parameters, fingerprint.combinations, fingerprint.physical, fingerprint.margins)
            for quantity in group
        },
    }


def in_words(channels: "Sequence[tuple[str, str]]") -> str:
    """Return what outputs and inputs of a ship's responses are, for a caption; empty where one is not a ship's."""
    names = list(dict.fromkeys(name for pair in channels for name in pair))
    if not all(name in CHANNELS for name in names):
        return ""
    listed = "; ".join(f"{name}: {CHANNELS[name]}" for name in names)
    if not SHARES.issuperset(names):
        return f"{listed}. "
    return f"{listed}; each as a deviation over its value at the working point: 0 dB is 1 % for 1 %. "


def explained(section: "Section", meanings: Mapping[str, str]) -> "Section":
    """Return a section whose tables say what their symbols mean."""
    return replace(section, tables=[_explained(table, meanings) for table in section.tables])


def _explained(table: Table, meanings: Mapping[str, str]) -> Table:
    """Return a table with a column of meanings where one holds symbols and none says what they are."""
    if MEANING in table.columns:
        return table
    words = [next((_meaning(cell, meanings) for cell in row if isinstance(cell, Symbol)), "") for row in table.rows]
    heads = [
        f"{column.heading}: {meaning}"
        for column in table.columns
        if isinstance(column.heading, Symbol) and (meaning := _meaning(column.heading, meanings))
    ]
    note = f"{table.note} {'; '.join(heads)}." if heads else table.note
    if not any(words):
        return replace(table, note=note.strip())
    rows = tuple((*row, meaning) for row, meaning in zip(table.rows, words, strict=True))
    return replace(table, columns=(*table.columns, MEANING), rows=rows, note=note.strip())


def _meaning(symbol: str, meanings: Mapping[str, str]) -> str:
    return meanings.get(symbol.partition(" [")[0], "")
