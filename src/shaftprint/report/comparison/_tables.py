"""Tables of several fingerprints: numbers beside each other, differences, conditions."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from shaftprint.digits import interval, p_value_text, plain, rounded, to_digit_of, unit_text, with_deviation
from shaftprint.distributions import NORMAL_95
from shaftprint.plain_table import MEANING, Column, Symbol, Table, numbers, texts
from shaftprint.tables._conditions import ship_text, tested_text, water_facts
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.fingerprint._line_fingerprint import LineFingerprint
    from shaftprint.identify.fit._estimate import Estimate
    from shaftprint.report.comparison._differences import Difference

NOT_THERE = "–"
MOVING = ": normalised numbers, which move with the working point"


def difference_table(first: str, other: str, found: "Sequence[Difference]") -> Table:
    """Return every number that two fingerprints share with its difference, interval and significance.

    ``first``, ``other``: names of the two. ``found``: their differences.
    """
    rows = tuple(
        (
            Symbol(one.first.name),
            with_deviation(one.first.value, one.first.std),
            with_deviation(one.other.value, one.other.std),
            *_apart(one),
            one.outcome,
            unit_text(one.first.unit),
            one.first.meaning,
        )
        for one in found
    )
    return Table(
        title=f"{other} compared with {first}{MOVING if all(one.normalised for one in found) else ''}",
        columns=(
            *texts("quantity"),
            *numbers(first, other, "difference", "95 % interval"),
            Column("%", number=True, spare=True),
            *numbers("p"),
            *texts("outcome", "unit"),
            MEANING,
        ),
        rows=rows,
        note=_not_compared(found),
    )


def _not_compared(differences: "Sequence[Difference]") -> str:
    """Return why numbers are not compared, each reason once with their names; empty where all are."""
    names: dict[str, list[str]] = {}
    for one in differences:
        reason, _, instead = one.because.partition("; ")
        if reason:
            names.setdefault(reason, []).append(f"{one.first.name} ({instead})" if instead else one.first.name)
    return " ".join(f"Not compared, {reason}: {', '.join(listed)}." for reason, listed in names.items())


def _apart(one: "Difference") -> tuple[str, str, str, str]:
    """Return difference, interval, percent and p-value as they are printed."""
    share = NOT_THERE if one.first.value == 0.0 else f"{plain(PERCENT * one.value / abs(one.first.value), 1)} %"
    if one.interval_95 is None or one.p_value is None:
        return rounded(one.value), NOT_THERE, share, NOT_THERE
    low, high = one.interval_95
    std = 0.5 * (high - low) / NORMAL_95
    return to_digit_of(one.value, std), interval(low, high, std), share, p_value_text(one.p_value)


def beside_table(fingerprints: "Mapping[str, Fingerprint]") -> list[Table]:
    """Return physical values, margins, combinations and parameters of all fingerprints, a table each."""
    groups = (
        ("Physical values", "physical"),
        ("Stability margins", "margins"),
        ("Combinations of parameters", "combinations"),
        ("Parameters, normalised with the working point of each test", "parameters"),
    )
    tables = [_beside(title, {n: getattr(f, group) for n, f in fingerprints.items()}) for title, group in groups]
    return [table for table in tables if table.rows]


def _beside(title: str, quantities: "Mapping[str, Sequence[Estimate]]") -> Table:
    there = {name: {q.name: q for q in column} for name, column in quantities.items()}
    names = list(dict.fromkeys(q for column in there.values() for q in column))
    rows: list[tuple[str, ...]] = []
    for name in names:
        units = {column[name].unit for column in there.values() if name in column}
        cells = [_cell(column.get(name)) for column in there.values()]
        rows.append((Symbol(name), *cells, " or ".join(sorted(unit_text(unit) for unit in units))))
    note = "± is one standard deviation, in brackets the 95 % interval."
    return Table(title=title, columns=texts("quantity", *quantities, "unit"), rows=tuple(rows), note=note)


def _cell(quantity: "Estimate | None") -> str:
    if quantity is None:
        return NOT_THERE
    lower, upper = quantity.ends_95
    bound = ", at its bound" if quantity.at_bound else ""
    return f"{with_deviation(quantity.value, quantity.std)} ({interval(lower, upper, quantity.std)}){bound}"


def condition_table(fingerprints: "Mapping[str, Fingerprint]") -> Table:
    """Return vessel, test, working point, structure, lines and verdict of all fingerprints."""
    rows = (
        ("vessel", *(f.conditions.vessel for f in fingerprints.values())),
        ("test", *(f.conditions.campaign for f in fingerprints.values())),
        *_stated_rows(fingerprints),
        ("made", *(f.created.strftime("%Y-%m-%d %H:%M %Z") for f in fingerprints.values())),
        ("engine speed", *(_working(f.conditions.engine_speed) for f in fingerprints.values())),
        ("shaft torque", *(_working(f.conditions.shaft_torque) for f in fingerprints.values())),
        ("structure", *(f.structure for f in fingerprints.values())),
        ("test lines used", *(", ".join(f.conditions.lines_used) for f in fingerprints.values())),
        ("signals prepared in", *(f"{f.conditions.mode} mode" for f in fingerprints.values())),
        ("verdict", *(f.verdict.reason for f in fingerprints.values())),
    )
    return Table(title="Conditions of the tests", columns=texts("what", *fingerprints), rows=rows)


def _stated_rows(fingerprints: "Mapping[str, Fingerprint]") -> list[tuple[str, ...]]:
    """Return what somebody has stated of the tests, a row for each thing that is stated of one of them."""
    stated = [
        {"ship": ship_text(one.ship), "tested": tested_text(one.tested_at), "place": one.place or ""}
        | {title.lower(): text for title, text in water_facts(one)}
        for one in (fingerprint.conditions for fingerprint in fingerprints.values())
    ]
    titles = dict.fromkeys(title for one in stated for title, text in one.items() if text)
    return [(title, *(one.get(title) or NOT_THERE for one in stated)) for title in titles]


def stated_table(fingerprints: "Mapping[str, Fingerprint]") -> Table:
    """Return ship, time, place and water of all fingerprints; no row where nothing is stated."""
    rows = tuple(_stated_rows(fingerprints))
    return Table(title="Stated of the tests", columns=texts("what", *fingerprints), rows=rows)


def _working(quantity: "Estimate") -> str:
    return f"{with_deviation(quantity.value, quantity.std)} {unit_text(quantity.unit)}"


def source_table(fingerprints: "Mapping[str, LineFingerprint]") -> Table:
    """Return the files that went into fingerprints, with their hashes."""
    rows = tuple(
        (name, source.name, source.role, source.sha256)
        for name, fingerprint in fingerprints.items()
        for source in fingerprint.sources
    )
    return Table(
        title="Files that went into the fingerprints",
        columns=texts("fingerprint", "file", "what it is", "SHA-256"),
        rows=rows,
    )
