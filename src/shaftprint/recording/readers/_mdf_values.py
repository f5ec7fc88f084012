"""What the conversion of an MDF 4 channel makes of its counts: numbers, and none where it gives a text."""

import importlib
import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.escape import printable
from shaftprint.recording.readers._no_value import codes_without_value

# ASAM MDF 4.1, block CC: types of a conversion.
_FORMULA, _RANGES, _VALUE_TO_TEXT, _RANGE_TO_TEXT = 3, 6, 7, 8
# ASAM MDF 3, block CC.
_FORMULA_OF_MDF_3 = 10
_WHOLE, _LONGEST_FORMULA = re.compile(r"(?<![\w.])\d+(?![\w.])"), 1000
# Numbers of states are small; larger ones belong to a quantity.
_LARGEST_STATE = 64


def is_worked_out_here(conversion: Any, *, is_v4: bool) -> bool:
    """Return whether the numbers of a conversion are worked out here, not by the library.

    The library takes a formula of whole counts in their own width, where 2 * X overflows, and passes the counts on
    where it cannot work a formula out; of whole counts in a table of ranges it finds none, and of others makes texts.
    """
    kind = -1 if conversion is None else int(conversion.conversion_type)
    if not is_v4:
        return kind == _FORMULA_OF_MDF_3
    return kind in (_FORMULA, _RANGES) or kind >= _VALUE_TO_TEXT


def by_formula(conversion: Any, counts: NDArray[Any]) -> FloatArray:
    """Return the values of counts by the formula of a conversion.

    Raises RecordingError if it cannot be worked out.
    """
    numexpr = importlib.import_module("numexpr")
    text = str(conversion.formula).strip(" \t\r\n\0")
    counted = counts.astype(np.float64)
    try:
        if len(text) > _LONGEST_FORMULA:
            raise ValueError("too long")
        # powers of whole numbers would be worked out to the last digit, however many there are
        names = {"X": counted, "X1": counted, "x": counted, "x1": counted}
        values = numexpr.evaluate(_WHOLE.sub(r"\g<0>.0", text), local_dict=names, global_dict={})
    except (ArithmeticError, ValueError, KeyError, TypeError, SyntaxError, AttributeError, NameError) as error:
        shown = printable(text)[:80]
        raise RecordingError(
            f'expected a formula that can be worked out, found "{shown}" ({printable(str(error))[:80]}); '
            "export the channel as numbers."
        ) from None
    return np.broadcast_to(np.asarray(values, dtype=np.float64), counts.shape).copy()


def _by_ranges(conversion: Any, counts: NDArray[Any]) -> FloatArray:
    """Return the values of a table of ranges, whose upper ends belong to them for whole counts only."""
    values = np.full(len(counts), float(conversion.default))
    for place in reversed(range((int(conversion.val_param_nr) - 1) // 3)):
        lower, upper = conversion[f"lower_{place}"], conversion[f"upper_{place}"]
        below = counts < upper if counts.dtype.kind == "f" else counts <= upper
        values[(counts >= lower) & below] = conversion[f"phys_{place}"]
    return values


def numbers_of(conversion: Any, counts: NDArray[Any]) -> FloatArray:
    """Return the values of counts: scaled where the conversion gives a number, not a number where it gives a text.

    A table of texts alone is a list of states, of which the counts are the numbers; "not available" is none of them.

    ``conversion``: the library's conversion, or None. ``counts``: what the file holds, without conversion. Raises
    RecordingError if it turns texts into something, or bits into texts.
    """
    values = np.empty(len(counts))
    kind = -1 if conversion is None else int(conversion.conversion_type)
    if kind == _FORMULA:
        return by_formula(conversion, counts)
    if kind == _RANGES:
        return _by_ranges(conversion, counts)
    if kind < _VALUE_TO_TEXT:
        values[:] = counts if conversion is None else conversion.convert(counts)
        return values
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
