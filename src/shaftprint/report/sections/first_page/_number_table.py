"""The numbers that a superintendent asks for, with no more digits than their intervals leave."""

import math
from typing import TYPE_CHECKING

from shaftprint.catalogue._gauge import GAUGE_K_I, GAUGE_K_P
from shaftprint.digits import fine_unit, plain, unit_text
from shaftprint.fingerprint._vessel_fields import inertia_in_words
from shaftprint.identify.judgement._number_precision import share_of
from shaftprint.plain_table import Table, numbers, texts
from shaftprint.report.sections.first_page._doubts import is_off
from shaftprint.tables._fingerprint import expected_text
from shaftprint.units import MILLI

if TYPE_CHECKING:
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.identify.fit._estimate import Estimate

NUMBERS = (
    ("I_dn", "Inertia behind the gauge: propeller, shaft, entrained water"),
    ("I_up", "Inertia before the gauge: engine, coupling, gearbox"),
    ("K_Q", "Torque coefficient of the propeller"),
    ("t_d + t_sp", "Delay from the set point to the fuel"),
    (GAUGE_K_P.name, "Proportional gain of the governor"),
    (GAUGE_K_I.name, "Integral gain of the governor"),
    ("gain margin", "The governor gain may grow by this factor before the speed hunts"),
    ("phase margin", "Phase margin of the governed line"),
    ("delay margin", "So much more delay would make it hunt"),
)
"""Names of quantities, and what they are in words that need no control engineering."""


SIDES = {"downstream": "behind", "upstream": "before"}
"""Sides of the gauge as a vessel file calls them, and in words."""


def number_table(fingerprint: "Fingerprint") -> list[Table]:
    """Return the table of the numbers that are there; nothing where none is."""
    there = {one.name: one for kind in fingerprint.numbers.values() for one in kind}
    rows: list[tuple[str, ...]] = []
    for name, words in NUMBERS:
        quantity = there.get(name)
        if quantity is None:
            continue
        value, interval = shown(quantity)
        expected = expected_shown(quantity) + (" (!)" if is_off(quantity) else "")
        doubt = fingerprint.verdict.not_trusted.get(name)
        known = share_of(doubt or "")
        mark = f" (not to be used{f': known to {known}' if known else ''})"
        marked = f"{words}{mark}" if doubt else words
        rows.append((marked, value, interval, expected))
    if not rows:
        return []
    columns = (*texts("what"), *numbers("found", "95 % interval", "vessel file"))
    stated = {side: inertia_of_file(fingerprint, side) for side in SIDES}
    note = "; ".join(f"{words} the gauge: {stated[side]}" for side, words in SIDES.items() if stated[side])
    note = f"Vessel file, {note}." if note else ""
    return [Table(title="What was found", columns=columns, rows=tuple(rows), note=note)]


def inertia_of_file(fingerprint: "Fingerprint", side: str) -> str:
    """Return what the vessel file states of the inertia on one side of the gauge at the engine shaft, for a page."""
    return inertia_in_words(fingerprint.vessel_fields, side).replace("kg m2", unit_text("kg m2")).replace("^2", "²")


def shown(quantity: "Estimate") -> tuple[str, str]:
    """Return a value with its unit and its 95 % interval, with the digits that the interval leaves; times in ms."""
    scale, unit = _scale(quantity)
    value, lower, upper = (scale * number for number in (quantity.value, *quantity.ends_95))
    decimals = _decimals(value, upper - lower)
    text = f"{_rounded(value, decimals)} {unit}".strip()
    if not math.isfinite(upper - lower):
        return text, "not known"
    return text, f"{_rounded(lower, decimals)} to {_rounded(upper, decimals)}"


def expected_shown(quantity: "Estimate") -> str:
    """Return the value of the vessel file; where it has no deviation, with the digits of the measured value."""
    scale, _ = _scale(quantity)
    if quantity.expected is None or quantity.expected_std:
        return expected_text(quantity, scale)
    lower, upper = (scale * number for number in quantity.ends_95)
    return _rounded(scale * quantity.expected, _decimals(scale * quantity.value, upper - lower))


def _scale(quantity: "Estimate") -> tuple[float, str]:
    if quantity.unit == "s":
        return MILLI, "ms"
    scale, unit = fine_unit(quantity.unit, quantity.value, *quantity.ends_95)
    return scale, unit_text(unit)


def _decimals(value: float, width: float) -> int:
    """Return how many decimals are shown, less than none above ten: two digits of half the interval, or of the value.

    So the same number has the same digits in the tables below and on the command line.
    """
    least = width / 2.0 if math.isfinite(width) and width > 0.0 else abs(value) / 10.0
    return 0 if not 0.0 < least < math.inf else 1 - math.floor(math.log10(least))


def _rounded(value: float, decimals: int) -> str:
    return plain(round(value, decimals), max(0, decimals))
