"""Bytes of rows to numbers, compiled: every number is the float64 nearest to what is written, as Python's own is.

What is unusual in a field is left to Python, and whether a row has as many fields as the others is seen on the way.
"""

import numpy as np

from shaftprint.kernels._compiled import compiled
from shaftprint.recording.readers.csv._fields import OVERLOAD

SKIP, AS_TEXT = -1, -2
"""Targets of a column that is not read, and of one of which the place is noted."""

_POWERS = 10.0 ** np.arange(23)
_LINE_FEED, _RETURN, _SPACE, _TAB, _ZERO, _NINE, _PLUS, _MINUS = 10, 13, 32, 9, 48, 57, 43, 45
_EXPONENTS = (69, 101)
# a place that cannot be negative needs no second look at each letter
_ONE = np.uintp(1)
_EXACT = 1 << 53
_NONE, _MOST_DIGITS = np.uintp(0), np.uintp(19)
_SPLIT = 134_217_729.0
_UNSURE = 1e-6


@compiled(nogil=True)
def _low(a, b, product):  # type: ignore[no-untyped-def]
    """Return what the rounded product of two numbers lacks, exactly (Dekker 1971)."""
    c = _SPLIT * a
    a_high = c - (c - a)
    a_low = a - a_high
    c = _SPLIT * b
    b_high = c - (c - b)
    b_low = b - b_high
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low


@compiled(nogil=True)
def _scaled(digits, power):  # type: ignore[no-untyped-def]
    """Return ``digits * 10**power`` rounded once, and whether that is sure."""
    if digits == 0:
        return 0.0, True
    if power < -22 or power > 22:
        return 0.0, False
    number = float(digits)
    scale = _POWERS[abs(power)]
    if digits <= _EXACT:
        return (number / scale if power < 0 else number * scale), True
    if number >= 1.8e19:
        return 0.0, False
    # more digits than a float64 holds: the quotient or product to twice its precision, rounded where no tie is near
    lacking = float(np.int64(digits - np.uint64(number)))
    if power < 0:
        first = number / scale
        product = first * scale
        second = ((number - product) - _low(first, scale, product) + lacking) / scale
    else:
        first = number * scale
        second = _low(number, scale, first) + lacking * scale
    total = first + second
    off = abs(second - (total - first))
    half = 0.5 * (np.nextafter(total, np.inf) - total)
    return total, off < half * (1.0 - _UNSURE)


@compiled(nogil=True)
def rows_of(text, delimiter, decimal, width, least, targets, numbers, texts, odd):  # type: ignore[no-untyped-def]
    """Read rows; return how many there are and how many fields are left to Python, or -1 where a row is none.

    ``text``: whole lines, shape (bytes,): the line feed of the last one ends the search for the end of any field.
    ``delimiter``, ``decimal``: letters between columns and in numbers; a space as delimiter for white space of any
    length. ``width``, ``least``: number of fields of a row, and how many it has at least. ``targets``: which row of
    ``numbers`` takes each column, or one of the marks above, shape (width,).
    ``numbers``: filled with the numbers, shape (columns, most rows). ``texts``: filled with begin and end of fields
    that stay text, in their order, shape (most fields, 2). ``odd``: filled with column, row, begin and end of what is
    neither a number nor empty, shape (most, 4).
    """
    size, at = np.uintp(text.size), np.uintp(0)
    row, kept, strange = 0, 0, 0
    delimiter, decimal = np.uint8(delimiter), np.uint8(decimal)
    spaced = delimiter == _SPACE
    while at < size:
        # a line without anything is no row
        begin = at
        while text[at] == _SPACE or text[at] == _TAB or text[at] == _RETURN:
            at += _ONE
        if text[at] == _LINE_FEED:
            at += _ONE
            continue
        at = at if spaced else begin
        column = 0
        while True:
            if column >= width:
                return -1, 0, 0
            target = targets[column]
            begin = at
            digits, power = np.uint64(0), np.int64(0)
            sign, is_number = 1.0, target >= 0
            letter = text[at]
            if is_number:
                while letter == _SPACE:
                    at += _ONE
                    letter = text[at]
                if letter in (_MINUS, _PLUS):
                    sign = -1.0 if letter == _MINUS else 1.0
                    at += _ONE
                    letter = text[at]
                # of more than 19 digits it overflows, and is left to Python; the same loop stands here twice, since a
                # function of its own halves the speed of all
                first = at
                while _ZERO <= letter <= _NINE:
                    digits = digits * np.uint64(10) + np.uint64(letter - _ZERO)
                    at += _ONE
                    letter = text[at]
                count = at - first
                if letter == decimal:
                    at += _ONE
                    letter = text[at]
                    first = at
                    while _ZERO <= letter <= _NINE:
                        digits = digits * np.uint64(10) + np.uint64(letter - _ZERO)
                        at += _ONE
                        letter = text[at]
                    behind = at - first
                    count += behind
                    power = -np.int64(behind)
                is_number = _NONE < count <= _MOST_DIGITS
                if is_number and (letter == _EXPONENTS[0] or letter == _EXPONENTS[1]):
                    at += _ONE
                    is_small = text[at] == _MINUS
                    if text[at] == _MINUS or text[at] == _PLUS:
                        at += _ONE
                    exponent, first = 0, at
                    while _ZERO <= text[at] <= _NINE:
                        exponent = min(exponent * 10 + (text[at] - _ZERO), 9999)
                        at += _ONE
                    is_number = at > first
                    power += -exponent if is_small else exponent
                    letter = text[at]
            end = at
            while letter != _LINE_FEED and letter != delimiter and not (spaced and letter == _TAB):
                if letter != _SPACE and letter != _RETURN:
                    end = at + _ONE
                    is_number = False
                at += _ONE
                letter = text[at]
            if target >= 0:
                value = np.nan
                if is_number:
                    value, is_number = _scaled(digits, power)
                    # what means an overload is left to Python too
                    is_number = is_number and value < OVERLOAD
                if is_number:
                    value *= sign
                elif end > begin:
                    if strange >= odd.shape[0]:
                        return -1, 0, 0
                    odd[strange, 0], odd[strange, 1], odd[strange, 2], odd[strange, 3] = target, row, begin, end
                    strange += 1
                numbers[target, row] = value
            elif target == AS_TEXT:
                texts[kept, 0], texts[kept, 1] = begin, max(end, begin)
                kept += 1
            column += 1
            while spaced and (text[at] == _SPACE or text[at] == _TAB or text[at] == _RETURN):
                at += _ONE
            if text[at] == _LINE_FEED:
                at += _ONE
                break
            if not spaced:
                at += _ONE
        if column < least:
            return -1, 0, 0
        for missing in range(column, width):
            if targets[missing] >= 0:
                numbers[targets[missing], row] = np.nan
            elif targets[missing] == AS_TEXT:
                texts[kept, 0], texts[kept, 1] = at, at
                kept += 1
        row += 1
    return row, kept, strange
