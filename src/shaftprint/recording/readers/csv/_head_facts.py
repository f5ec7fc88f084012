"""What the lines above the titles of a text file say: sample rate or step, second of the first row, date."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest

from shaftprint.recording.readers._units import seconds_in
from shaftprint.recording.readers.csv._fields import split_row

_RATES = (
    "sample rate", "samplerate", "sampling rate", "sample frequency", "sampling frequency", "sampling freq",
    "scan rate", "fs", "abtastrate", "abtastfrequenz", "messrate",
)  # fmt: skip
_STEPS = (
    "sample interval", "sampling interval", "sampleinterval", "sample period", "sampling period", "sample time",
    "scan interval", "time interval", "increment", "xincrement", "x increment", "tinc", "delta x", "delta t", "dt",
    "hresolution", "h resolution", "interval", "abtastintervall", "messintervall",
)  # fmt: skip
_STARTS = ("start", "t0", "xorigin", "x origin", "hoffset", "h offset")
_HERTZ = {
    "": 1.0,
    "hz": 1.0,
    "khz": 1e3,
    "mhz": 1e6,
    "s/s": 1.0,
    "sa/s": 1.0,
    "ks/s": 1e3,
    "samples/s": 1.0,
    "1/s": 1.0,
}
_VALUE = re.compile(r"([+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d+)?)\s*(\S*)")
_KEY = re.compile(r"(?P<key>[^\[(:=]*[^\[(:=\s])\s*(?:[\[(](?P<unit>[^\])]*)[\])])?")
_PAIR = re.compile(r"(?P<key>[^:=]+?)\s*[:=]\s*(?P<value>\S.*)")


@dataclass(frozen=True, kw_only=True, slots=True)
class HeadFacts:
    """What a head says."""

    rate_hz: float | None = None
    """Sample rate [Hz]."""
    start_s: float = 0.0
    """Second of the first row [s]."""
    source: str = ""
    """The field from which the rate is."""
    rounded: float = 0.0
    """By how much of itself the rate may be off, as it is printed."""


def head_facts(lines: Sequence[str], delimiter: str) -> HeadFacts:
    """Return what some lines say of the clock; rows of the form key and value, or titles with a value below each.

    ``lines``: the lines above the rows of numbers, the titles among them. ``delimiter``: what stands between fields.
    """
    rate_hz, start_s, source, rounded = None, 0.0, "", 0.0
    for key, unit, value in _pairs(lines, delimiter):
        match = _VALUE.fullmatch(value)
        if match is None:
            continue
        number, word = float(match[1].replace(",", ".")), match[2] or unit
        if key in _RATES and number > 0.0 and word.lower() in _HERTZ and rate_hz is None:
            rate_hz, source, rounded = number * _HERTZ[word.lower()], key, _rounded(match[1], number)
        elif key in _STEPS and number > 0.0 and rate_hz is None:
            second = seconds_in(word) if word else 1.0
            if second is not None:
                rate_hz, source = float(f"{1.0 / (number * second):.9g}"), key
                rounded = _rounded(match[1], number)
        elif key in _STARTS:
            start_s = number * ((seconds_in(word) if word else 1.0) or 0.0)
    return HeadFacts(rate_hz=rate_hz, start_s=start_s, source=source, rounded=rounded)


def _rounded(printed: str, number: float) -> float:
    """Return by how much of itself a printed number may be off: half its last decimal; a whole one is meant so."""
    mantissa, _, exponent = printed.lower().replace(",", ".").partition("e")
    decimals = len(mantissa.partition(".")[2])
    return 0.5 * 10.0 ** (int(exponent or 0) - decimals) / number if decimals or exponent else 0.0


def plain_key(text: str) -> str:
    """Return what a field says as programs write it in several ways: small letters, single spaces, no underscores."""
    return " ".join(text.replace("_", " ").lower().split())


def is_fact(field: str) -> bool:
    """Return whether a field beside titles is none, but the name or the value of what is said of the clock."""
    written = _PAIR.fullmatch(field)
    return (
        plain_key(written["key"] if written is not None else field) in (*_RATES, *_STEPS, *_STARTS)
        or _VALUE.fullmatch(field) is not None
    )


def _pairs(lines: Sequence[str], delimiter: str) -> list[tuple[str, str, str]]:
    """Return key, unit and value of every field that has one beside, behind or below it."""
    rows = [split_row(line, delimiter) for line in lines]
    pairs = []
    none: list[str] = []
    for row, below in zip_longest(rows, rows[1:], fillvalue=none):
        for place, field in enumerate(row):
            written = _PAIR.fullmatch(field)
            candidates = (
                [written["value"]] if written is not None else [*row[place + 1 : place + 2], *below[place : place + 1]]
            )
            key = _KEY.fullmatch(written["key"] if written is not None else field)
            if key is None:
                continue
            value = next((one for one in candidates if _VALUE.fullmatch(one.strip()) is not None), "")
            # a value and its unit in fields of their own, where that is no value a channel
            behind = "".join(row[place + 2 : place + 3]) if candidates and value == candidates[0] else ""
            unit = key["unit"] or (behind if _VALUE.fullmatch(behind) is None else "")
            pairs.append((plain_key(key["key"]), unit.strip(" []()"), value.strip()))
    return pairs
