"""What the conversion of an MDF 4 channel makes of its counts: numbers, and none where it gives a text."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.recording.readers._no_value import codes_without_value

# ASAM MDF 4.1, block CC: types of a conversion.
_VALUE_TO_TEXT, _RANGE_TO_TEXT = 7, 8
# Numbers of states are small; larger ones belong to a quantity.
_LARGEST_STATE = 64


def is_text_table(conversion: Any) -> bool:
    """Return whether a conversion of MDF 4 gives texts for some or all of its counts."""
    return conversion is not None and int(conversion.conversion_type) >= _VALUE_TO_TEXT


def numbers_of(conversion: Any, counts: NDArray[Any]) -> FloatArray:
    """Return the values of counts: scaled where the conversion gives a number, not a number where it gives a text.

    A table of texts alone is a list of states, of which the counts are the numbers; "not available" is none of them.

    Parameters
    ----------
    conversion
        The library's conversion, or None.
    counts
        What the file holds, without conversion.

    Raises
    ------
    RecordingError
        If it turns texts into something, or bits into texts.
    """
    values = np.empty(len(counts))
    if not is_text_table(conversion):
        values[:] = counts if conversion is None else conversion.convert(counts)
        return values
    kind = int(conversion.conversion_type)
    if kind not in (_VALUE_TO_TEXT, _RANGE_TO_TEXT):
        raise RecordingError("expected a conversion that gives numbers, found one of texts or of bits to texts.")
    entries = _entries(conversion, kind)
    default = conversion.referenced_blocks.get("default_addr")
    is_list = isinstance(default, bytes | None) and all(isinstance(entry, bytes) for *_, entry in entries)
    if is_list:
        values[:] = counts
        texts = [(number, entry) for number, (*_, entry) in enumerate(entries)]
        named = [(number, text.decode("utf-8", "replace")) for number, text in texts]
        is_state = all(upper < _LARGEST_STATE for _, upper, _ in entries)
        without = codes_without_value(named, is_list=is_state)
        if len(without) == len(entries) and not is_state:
            raise RecordingError(
                f"expected a scale, found a conversion that says for {len(entries)} counts that there is no value "
                f"({named[0][1]}) and nothing of the others; export it again with its scale."
            )
        for number in without:
            lower, upper, _ = entries[int(number)]
            values[(counts >= lower) & (counts <= upper)] = np.nan
        return values
    values[:] = np.nan if isinstance(default, bytes) else numbers_of(default, counts)
    # of entries that overlap the first holds; one that begins where another ends holds there
    for is_open in (False, True):
        for lower, upper, entry in reversed(entries):
            here = (counts >= lower) & ((counts < upper) if is_open else (counts <= upper))
            if here.any():
                values[here] = np.nan if isinstance(entry, bytes) else numbers_of(entry, counts[here])
    return values


def unit_of(conversion: Any) -> str:
    """Return the unit that a conversion gives, that of the numbers of a table of texts where it has none itself."""
    if conversion is None:
        return ""
    inner = getattr(conversion, "referenced_blocks", None) or {}
    return getattr(conversion, "unit", "") or next(
        (unit for block in inner.values() if not isinstance(block, bytes) and (unit := unit_of(block))), ""
    )


def _entries(conversion: Any, kind: int) -> list[tuple[float, float, Any]]:
    """Return first count, last count and text or conversion of each entry."""
    blocks = conversion.referenced_blocks
    if kind == _VALUE_TO_TEXT:
        numbers = [conversion[f"val_{place}"] for place in range(int(conversion.val_param_nr))]
        return [(number, number, blocks[f"text_{place}"]) for place, number in enumerate(numbers)]
    ends = range(int(conversion.val_param_nr) // 2)
    return [(conversion[f"lower_{place}"], conversion[f"upper_{place}"], blocks[f"text_{place}"]) for place in ends]
