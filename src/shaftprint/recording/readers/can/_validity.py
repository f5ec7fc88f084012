"""Which counts of a signal are values, and why the others are none: the one rule for all logs of a bus."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.recording.readers._no_value import codes_without_value
from shaftprint.recording.readers.can._frames import is_j1939, is_nmea_2000
from shaftprint.recording.readers.can._messages import Message, Signal

# SAE J1939-71, ranges of parameters: the last count that is a value, by the number of bits; what is above says that
# there is none: reserved, error, not available.
_LAST_VALUE = {
    8: 0xFA,
    10: 0x3FA,
    12: 0xFAF,
    16: 0xFAFF,
    20: 0xFAFFF,
    24: 0xFAFFFF,
    28: 0xFAFFFFF,
    32: 0xFAFFFFFF,
}
# NMEA 2000: so many of the highest counts say that there is no value, of fields of a byte and more.
_NMEA_CODES = 3
_BYTE = 8
# Counts of 8, 16 or 32 bits at their end, above all others by more than a sixteenth of the range, are no values of
# a quantity that moves: of one with fewer levels nobody knows.
_WHOLE_BYTES = (8, 16, 32)
_APART, _FEWEST_LEVELS, _JUDGED = 1.0 / 16.0, 8, 65_536
# Counts of a sign, all bits set: apart from the others where they come no nearer.
_NEAREST = 8
# A value that is printed in a DBC file may be off by this part of a count.
_ROUNDING = 1e-6


@dataclass(frozen=True, kw_only=True, slots=False)
class Validity:
    """The rule for one signal."""

    message: Message
    """Its message."""
    signal: Signal
    """The signal."""
    identifier: int
    """The identifier under which it came."""
    apart: tuple[int, ...] = ()
    """Counts, with their sign, that stand apart from the others of this log."""

    @cached_property
    def standard(self) -> str:
        """The standard that says which counts are none; empty where none does."""
        if not self.message.is_extended or self.signal.is_float or self.signal.bits < 2:
            return ""
        if is_nmea_2000(self.identifier) and self.signal.spn is None:
            return "NMEA 2000"
        if self.message.is_j1939 or self.signal.spn is not None or is_j1939(self.identifier):
            return "SAE J1939-71"
        return ""

    @cached_property
    def _texts(self) -> dict[str, list[int]]:
        is_list = len(self.signal.texts) == 1 << min(self.signal.bits, 32)
        named = self.signal.texts.items()
        by_text: dict[str, list[int]] = {}
        for code in codes_without_value(named, is_list=is_list):
            by_text.setdefault(f'"{self.signal.texts[int(code)]}"', []).append(int(code))
        return by_text

    @property
    def has_range(self) -> bool:
        """Whether the file states a range."""
        return self.signal.lowest > -np.inf or self.signal.highest < np.inf

    @property
    def outside(self) -> str:
        """The reason of values that lie outside that range, in words."""
        return f"outside {self.signal.lowest:g} to {self.signal.highest:g}"

    def reasons(self, numbers: NDArray[Any]) -> Iterable[tuple[str, NDArray[np.bool_]]]:
        """Yield why counts are no values and which they are; a count may have several reasons.

        ``numbers``: counts with their sign, shape (messages,).
        """
        signal = self.signal
        for text, codes in self._texts.items():
            yield text, np.isin(numbers, np.array(codes).astype(numbers.dtype))
        if self.standard:
            yield from self._by_standard(numbers)
        for code in self.apart:
            yield _apart_in_words(code), numbers == code
        if self.has_range:
            slack = _ROUNDING * abs(signal.factor)
            values = self.values(numbers)
            yield self.outside, ~((values >= signal.lowest - slack) & (values <= signal.highest + slack))

    def values(self, numbers: NDArray[Any]) -> NDArray[np.float64]:
        """Return counts in the unit of the signal."""
        return numbers.astype(np.float64) * self.signal.factor + self.signal.offset

    def _by_standard(self, numbers: NDArray[Any]) -> Iterable[tuple[str, NDArray[np.bool_]]]:
        bits, is_nmea = self.signal.bits, self.standard == "NMEA 2000"
        highest = (1 << (bits - 1 if self.signal.is_signed else bits)) - 1
        if self.signal.is_signed and not is_nmea:
            # the standard knows no sign: what stands apart is told by the log
            return
        yield "not available", numbers == highest
        if bits < _BYTE:
            return
        if is_nmea:
            yield "error", numbers == highest - 1
            yield "reserved", numbers == highest - _NMEA_CODES + 1
        elif bits in _LAST_VALUE:
            above = numbers > _LAST_VALUE[bits]
            top = numbers >> np.uint64(bits - _BYTE)
            yield "not available", above & (top == 0xFF)
            yield "error", above & (top == 0xFE)
            yield "reserved", above & (top < 0xFE)


class Tally:
    """What is seen of a signal in one pass through its log."""

    def __init__(self, validity: Validity) -> None:
        """Begin with nothing.

        ``validity``: the rule so far.
        """
        self._validity = validity
        self._last = (1 << validity.signal.bits - (1 if validity.signal.is_signed else 0)) - 1
        self._counts: Counter[str] = Counter()
        self.total = self.invalid = self.short = 0
        self._ends = {self._last: 0}
        if validity.signal.is_signed and validity.standard:
            self._ends[-1] = 0
        self._highest, self._nearest = -np.inf, np.inf
        self._levels: set[Any] = set()

    def add(self, numbers: NDArray[Any], is_short: NDArray[np.bool_]) -> None:
        """Take a block of counts with their sign, and which of their messages were too short to hold them."""
        self.total += len(numbers)
        self.short += int(np.count_nonzero(is_short))
        numbers = numbers[~is_short]
        none = np.zeros(len(numbers), dtype=bool)
        for reason, which in self._validity.reasons(numbers):
            new = which & ~none
            self._counts[reason] += int(np.count_nonzero(new))
            none |= new
        self.invalid += int(np.count_nonzero(none))
        if self._is_judged:
            inner = numbers[~none]
            for code in self._ends:
                is_end = inner == code
                self._ends[code] += int(np.count_nonzero(is_end))
                inner = inner[~is_end]
            if inner.size:
                self._highest = max(self._highest, float(inner.max()))
                self._nearest = min(self._nearest, float(np.abs(inner.astype(np.float64) + 1.0).min()))
                if len(self._levels) < _FEWEST_LEVELS:
                    self._levels |= set(np.unique(inner[:_JUDGED]).tolist())

    @property
    def outside(self) -> int:
        """Values that lie outside the range, and are none for no other reason."""
        return self._counts[self._validity.outside]

    @property
    def without_value(self) -> int:
        """Counts that are no values, for whatever reason."""
        return self.invalid + self.short + sum(self._ends[code] for code in self.apart)

    @property
    def is_empty(self) -> bool:
        """Whether none of the counts is a value, for whatever reason but the range alone."""
        return self.without_value == self.total and not self.outside

    @property
    def is_all_outside(self) -> bool:
        """Whether none of the counts is a value, and the range is the reason of some."""
        return self.without_value == self.total and self.outside > 0

    @property
    def rule(self) -> Validity:
        """The rule with what the log says of it."""
        return replace(self._validity, apart=self.apart)

    @property
    def _is_judged(self) -> bool:
        signal = self._validity.signal
        if signal.is_float or self._validity.has_range or signal.bits not in _WHOLE_BYTES:
            return False
        return signal.is_signed or not self._validity.standard

    @property
    def apart(self) -> tuple[int, ...]:
        """Counts that stand apart from all others."""
        if not self._levels and self._ends.get(-1) and not self._ends[self._last]:
            # a field that is never filled in, by a sender that knows no sign
            return (-1,)
        if len(self._levels) < _FEWEST_LEVELS:
            return ()
        is_far = {self._last: self._highest <= (1.0 - _APART) * self._last, -1: self._nearest >= _NEAREST}
        return tuple(code for code, count in self._ends.items() if count and is_far[code])

    def counted(self) -> str:
        """Return how many values there are not and why; empty where there are all."""
        parts = [f"{count} {reason}" for reason, count in self._counts.items() if count]
        parts += [f"{self._ends[code]} {_apart_in_words(code)}" for code in self.apart]
        parts += [f"{self.short} in messages too short for them"] if self.short else []
        by = f" by {self._validity.standard}" if self._validity.standard else ""
        none = self.without_value
        return f"{none} of {self.total} values are none{by}: {', '.join(parts)}." if none else ""


def _apart_in_words(code: int) -> str:
    return f"of all others apart ({code})"
