"""Limits on the terminal: the answer, what may be trusted, the tables, and the whole line with them."""

from __future__ import annotations

from shaftprint.cli._terminal import print_findings
from shaftprint.cli.output._json import give
from shaftprint.cli.output._tables import print_table, print_tables
from shaftprint.digits import fine_unit, interval, stated_interval, unit_text, with_deviation
from shaftprint.late import late
from shaftprint.plain_table import MEANING, Symbol, Table, numbers, texts

with late():
    from shaftprint.fingerprint._line_with_limits import LineWithLimits
    from shaftprint.identify.fit._estimate import Estimate
    from shaftprint.limits._candidates import Kind
    from shaftprint.limits._limit_fit import LimitFit
    from shaftprint.tables._fingerprint import quantity_table


FITS = {"limits": "the fit to small signals, levels beside its governor", "joint fit": "all of the test in one fit"}
NOTE = "± is one standard deviation, with that of the working point."


def print_line(line: LineWithLimits) -> None:
    """Print every parameter of the line with its limits."""
    title = f"The line with its limits: {FITS[line.found_by]}"
    print_table(quantity_table(title, line.parameters, note=NOTE))


def print_limits(limits: LimitFit) -> None:
    """Print the answer first: limits with their levels, what may be trusted, then the tables."""
    print_findings(
        "Limits", [limits.sentence, *(_answer(limits, number) for number in _first_numbers(limits))], is_answer=True
    )
    give("limits", limits.numbers)
    print_findings("Not seen", list(limits.not_seen.values()))
    print_tables([_number_table(limits), _governor_table(limits)])
    trusted = ", ".join(number.name for number in limits.trusted) or "none"
    doubted = [f"{number.name}: {number.doubt}." for number in limits.numbers if not number.trusted]
    print_findings("Verdict", [f"Numbers that can be trusted: {trusted}.", *doubted])


def _first_numbers(limits: LimitFit) -> list[Estimate]:
    """Return the number by which each limit is known."""
    return [next(number for number in limits.numbers if number.limit == kind.value) for kind in limits.kinds]


def _answer(limits: LimitFit, number: Estimate) -> str:
    value = stated_interval(number.value, *_ends(number), number.interval_std, number.unit)
    trust = "trusted" if number.trusted else f"not trusted, {number.doubt}"
    gain = f"Likelihood-ratio statistic {limits.gains[Kind(number.limit)]:.0f}."
    return f"{number.limit}: {number.name} = {value}, {trust}. {gain}"


def _ends(number: Estimate) -> tuple[float, float]:
    """Return the ends of the interval; one that the data did not set is infinite."""
    return number.interval_95 or number.limits_95


def _number_table(limits: LimitFit) -> Table:
    columns = (*texts("symbol"), *numbers("value ± std", "95 % interval"), *texts("unit", "trusted"), MEANING)
    return Table(title="Numbers of the limits", columns=columns, rows=tuple(map(_number_row, limits.numbers)))


def _number_row(number: Estimate) -> tuple[str, ...]:
    lower, upper = _ends(number)
    factor, unit = fine_unit(number.unit, number.value, number.std, lower, upper)
    return (
        Symbol(number.name),
        with_deviation(factor * number.value, factor * number.std),
        interval(factor * lower, factor * upper, factor * number.std),
        unit_text(unit),
        "yes" if number.trusted else number.doubt,
        number.meaning,
    )


def _governor_table(limits: LimitFit) -> Table:
    columns = (*texts("symbol"), *numbers("value ± std"), *texts("unit"))
    rows = tuple(map(_governor_row, limits.governor))
    return Table(title="Governor that goes with them", columns=columns, rows=rows)


def _governor_row(estimate: Estimate) -> tuple[str, str, str]:
    factor, unit = fine_unit(estimate.unit, estimate.value, estimate.std)
    text = with_deviation(factor * estimate.value, factor * estimate.std)
    return Symbol(estimate.name), text + " (at its bound)" * estimate.at_bound, unit_text(unit)
