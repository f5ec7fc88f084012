"""Nouns and tables as JSON."""

from __future__ import annotations

import dataclasses
import enum
import math
from collections.abc import Collection, Mapping

from shaftprint.cli._terminal import output
from shaftprint.digits import plain_letters
from shaftprint.escape import printable
from shaftprint.late import late
from shaftprint.plain_table import Table

with late():
    import numpy as np
    import pydantic

    from shaftprint.models import _role


# An array with more numbers than this is data, not an answer: it stays in the files that the command writes.
MOST_NUMBERS = 10_000


def give(name: str, noun: object) -> None:
    """Give a noun with all digits to the JSON document and the workbook, where there are such; nothing is printed."""
    chosen = output()
    if chosen.workbook is not None:
        chosen.workbook.nouns[name] = noun
    if chosen.document is not None:
        chosen.document.result[name] = as_json(noun)


def as_json(noun: object) -> object:
    """Return a noun as lists, dictionaries, text and numbers.

    Numbers that are not finite become null, complex ones a pair of real and imaginary part, and arrays of more than
    10 000 numbers their shape.
    """
    match noun:
        case pydantic.BaseModel():
            return as_json(noun.model_dump())
        case None | bool() | int():
            return noun
        case enum.Enum():
            return as_json(noun.value)
        case _role.Role():
            return as_json(noun.name)
        case str():
            return printable(str(noun), keep="\n")
        case float() | np.floating():
            return float(noun) if math.isfinite(noun) else None
        case complex() | np.complexfloating():
            return [as_json(noun.real), as_json(noun.imag)]
        case np.ndarray():
            return as_json(noun.tolist()) if noun.size <= MOST_NUMBERS else {"shape": list(noun.shape)}
        case np.generic():
            return as_json(noun.item())
        case Mapping():
            return {str(as_json(name)): as_json(value) for name, value in noun.items()}
        case tuple() if hasattr(noun, "_asdict"):
            return as_json(noun._asdict())
        case Collection():
            return [as_json(value) for value in noun]
        case _ if dataclasses.is_dataclass(noun):
            names = (field.name for field in dataclasses.fields(noun) if not field.name.startswith("_"))
            return {name: as_json(getattr(noun, name)) for name in names}
        case _:
            return printable(str(noun))


def table_json(table: Table) -> dict[str, object]:
    """Return a table with its cells as they are printed, in the letters of every keyboard."""
    return {
        "title": _text(table.title),
        "columns": [_text(column.heading) for column in table.columns],
        "rows": [[_text(cell) for cell in row] for row in table.rows],
        "note": _text(table.note),
    }


def _text(text: str) -> str:
    return printable(plain_letters(text)).replace("\u00a0", " ")
