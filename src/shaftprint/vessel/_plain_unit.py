"""The unit of a channel, which may be spelled in many ways in a vessel file."""

from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import BeforeValidator

from shaftprint.units import plain_unit, unit_factor

# The unit in which a sensor is kept whose channel is in another one.
_KEPT_AS = {"mV": "V", "uV": "V", "A": "mA", "uA": "mA", "MN m": "kN m"}


def as_plain_unit(unit: Any) -> Any:
    """Return a unit as vessel files write it; what is no text as it is, to be refused with its field."""
    return plain_unit(unit) if isinstance(unit, str) else unit


PLAIN_UNIT = BeforeValidator(as_plain_unit)
"""Reads a unit in any of its spellings."""


def in_kept_unit(content: Any, *, per_unit: str, readings: Sequence[str] = ()) -> Any:
    """Return the table of a sensor whose channel is in mV, uV, A, uA or MN m as that of one in V, mA or kN m.

    ``content``: the table as it stands in the file. ``per_unit``: its field that is for one unit of the channel.
    ``readings``: its fields in the unit of the channel. What is no such table is returned as it is.
    """
    if not isinstance(content, Mapping):
        return content
    given = as_plain_unit(content.get("unit"))
    wanted = _KEPT_AS.get(given) if isinstance(given, str) else None
    factor = unit_factor(given, wanted) if wanted is not None else None
    if factor is None:
        return content
    changed = {per_unit: 1.0 / factor, **dict.fromkeys(readings, factor)}
    return {
        **content,
        "unit": wanted,
        **{key: _times(content[key], by) for key, by in changed.items() if key in content},
    }


def _times(value: Any, factor: float) -> Any:
    """Return a number, or the readings of a table, times a factor; what is neither as it is, to be refused."""
    if isinstance(value, list | tuple):
        return [
            [_times(pair[0], factor), *pair[1:]] if isinstance(pair, list | tuple) and pair else pair for pair in value
        ]
    return factor * value if isinstance(value, int | float) and not isinstance(value, bool) else value
