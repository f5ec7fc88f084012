"""Tables of the fingerprint: parameters, combinations, physical values, margins, budget, fit."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from shaftprint.digits import fine_unit, interval, p_value_text, plain, to_digit_of, unit_text, with_deviation
from shaftprint.plain_table import MEANING, Column, Symbol, Table, numbers, texts
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.fingerprint._drive_fingerprint import DriveFingerprint
    from shaftprint.fingerprint._fingerprint import Fingerprint, Quality
    from shaftprint.identify.fit._estimate import Estimate
    from shaftprint.identify.fit._identification import Identification
    from shaftprint.identify.uncertainty._budget import Budget, BudgetRow

# A share that is printed as 0 % says as much.
SMALLEST_PERCENT = 0.5
NO_TRUTH: Mapping[str, float] = {}
INTERVAL_NOTE = (
    "± is one standard deviation. It is not shown where the interval says something else. The 95 % interval is that of "
    "the profile likelihood where there is one; an open end, marked with an asterisk, is a bound of the search "
    "and not a result."
)
PHYSICAL_NOTE = (
    "Standard deviations hold the scale of the torque gauge too, with the sign with which it enters; that of "
    "K_Q holds the wander of the load. The difference is that from the vessel file."
)
BUDGET_NOTE = (
    "Shares of the variance, to first order; they add up to 100 %. Noise of two outputs is correlated: each has half "
    "of what they share, and a share is negative where their errors make up for each other."
)


def parameter_table(fingerprint: "Fingerprint", truth: Mapping[str, float] = NO_TRUTH) -> Table:
    """Return the free parameters with intervals, beside the truth where it is known."""
    return quantity_table("Identified parameters, normalised with the working point", fingerprint.parameters, truth)


def combination_table(fingerprint: "Fingerprint | DriveFingerprint", truth: Mapping[str, float] = NO_TRUTH) -> Table:
    """Return the combinations of parameters that the test finds better than the parameters alone.

    It stands below the table of the parameters, whose note is its own.
    """
    return quantity_table("Combinations of parameters", fingerprint.combinations, truth, note="")


def physical_table(fingerprint: "Fingerprint", truth: Mapping[str, float] = NO_TRUTH) -> Table:
    """Return the physical values beside those of the vessel file (torsional vibration calculation) and the truth."""
    title = "Physical values beside those of the vessel file, at the propeller shaft unless the unit says otherwise"
    return quantity_table(title, fingerprint.physical, truth, note=PHYSICAL_NOTE)


def margin_table(fingerprint: "Fingerprint", truth: Mapping[str, float] = NO_TRUTH) -> Table:
    """Return the stability margins with intervals, beside the truth where it is known."""
    return quantity_table("Stability margins", fingerprint.margins, truth)


def quantity_table(
    title: str,
    quantities: "Sequence[Estimate]",
    truth: Mapping[str, float] = NO_TRUTH,
    *,
    note: str = INTERVAL_NOTE,
) -> Table:
    """Return quantities with intervals, beside the truth and the values of the vessel file where there are such.

    ``title``: what the table shows. ``quantities``: its rows. ``truth``: true values by name. ``note``: what a reader
    must know with it.
    """
    has_truth = any(quantity.name in truth for quantity in quantities)
    has_expected = any(quantity.expected is not None for quantity in quantities)
    columns = (*texts("quantity"), *numbers("value ± std", "95 % interval"))
    columns += (*numbers("truth"), *texts("truth within")) * has_truth
    columns += numbers("vessel file", "difference") * has_expected
    rows = []
    for quantity in quantities:
        factor, unit = fine_unit(quantity.unit, quantity.value, *_ends(quantity))
        cells: tuple[str, ...] = (Symbol(quantity.name), value_text(quantity, factor), _interval_text(quantity, factor))
        cells += _truth_cells(quantity, truth, factor) * has_truth
        cells += (expected_text(quantity, factor), _difference(quantity)) * has_expected
        rows.append((*cells, unit_text(unit), quantity.meaning))
    return Table(title=title, columns=(*columns, *texts("unit"), MEANING), rows=tuple(rows), note=note)


def value_text(quantity: "Estimate", factor: float = 1.0) -> str:
    """Return value and standard deviation; the value alone where only its interval tells how well it is known.

    ``factor``: what the number is multiplied by for its unit.
    """
    std = quantity.stated_std
    if std is None:
        text = to_digit_of(factor * quantity.value, factor * _std_of_digits(quantity))
        return text + " (at its bound)" * quantity.at_bound
    return with_deviation(factor * quantity.value, factor * std)


def _std_of_digits(quantity: "Estimate") -> float:
    """Return the standard deviation that sets the digits of a number: the one shown, or that of its interval."""
    return quantity.interval_std if quantity.stated_std is None else quantity.std


def _ends(quantity: "Estimate") -> tuple[float, ...]:
    return (quantity.std,) if quantity.interval_95 is None else quantity.interval_95


def _interval_text(quantity: "Estimate", factor: float) -> str:
    lower, upper = quantity.ends_95
    if not (math.isfinite(lower) and math.isfinite(upper)):
        return "not known"
    text = interval(factor * lower, factor * upper, factor * _std_of_digits(quantity))
    open_low, open_high = quantity.interval_open
    if open_low:
        text = text.replace(" to ", "* to ", 1)
    return f"{text}*" if open_high else text


def _truth_cells(quantity: "Estimate", truth: Mapping[str, float], factor: float) -> tuple[str, str]:
    true = truth.get(quantity.name, math.nan)
    lower, upper = quantity.ends_95
    inside = "–" if math.isnan(true) else "yes" if lower <= true <= upper else "no"
    return to_digit_of(factor * true, factor * _std_of_digits(quantity)), inside


def expected_text(quantity: "Estimate", factor: float = 1.0) -> str:
    """Return the value of the vessel file with its standard deviation, or to the digit of the measured one.

    ``factor``: what the number is multiplied by for its unit.
    """
    if quantity.expected is None:
        return "–"
    if not quantity.expected_std:
        return to_digit_of(factor * quantity.expected, factor * _std_of_digits(quantity))
    return with_deviation(factor * quantity.expected, factor * quantity.expected_std)


def _difference(quantity: "Estimate") -> str:
    if not quantity.expected:
        return "–"
    return f"{plain(PERCENT * (quantity.value / quantity.expected - 1.0), 1)} %"


def truth_of_combinations(identification: "Identification", truth: Mapping[str, float]) -> dict[str, float]:
    """Return the true value of each combination of the structure; held parameters count as true.

    Combinations of parameters whose truth is not known are left out.
    """
    held = {p.name: p.value if p.held else math.nan for p in identification.structure.parameters}
    true_values = held | dict(truth)
    values = {c.name: float(c.of(true_values)) for c in identification.structure.combinations}  # type: ignore[arg-type]
    return {name: value for name, value in values.items() if math.isfinite(value)}


def budget_table(budget: "Budget") -> Table:
    """Return standard deviation and shares of all sources for every number whose uncertainty is known."""
    shown = [row for row in budget.rows if row.shares]
    sources = [
        source
        for source in budget.sources
        if any(abs(PERCENT * row.shares.get(source, 0.0)) >= SMALLEST_PERCENT for row in shown)
    ]
    rows = tuple(
        (Symbol(row.name), _one_std(row), *(_share(PERCENT * row.shares.get(source, 0.0)) for source in sources))
        for row in shown
    )
    headings = (Column(Symbol(source), number=True) for source in sources)
    return Table(
        title="Uncertainty budget",
        columns=(*texts("quantity"), *numbers("one std"), *headings),
        rows=rows,
        note=BUDGET_NOTE,
    )


def _one_std(row: "BudgetRow") -> str:
    factor, unit = fine_unit(row.unit, row.value, row.std)
    return f"{to_digit_of(factor * row.std, factor * row.std)} {unit_text(unit)}".strip()


def _share(percent: float) -> str:
    return "–" if abs(percent) < SMALLEST_PERCENT else f"{plain(percent, 0)} %"


TELLING_PERCENT = 50.0
"""FitPercent of a perfect model below which the noise decides it, so that it says nothing of a model."""


def fit_table(fingerprint: "Fingerprint") -> Table:
    """Return FitPercent of each output beside that of a model without error, which only the noise is in the way of."""
    quality = fingerprint.quality
    rows = tuple(
        (Symbol(name), f"{plain(value, 2)} %", f"{plain(quality.fit_ceiling[name], 2)} %")
        if quality.fit_ceiling[name] >= TELLING_PERCENT
        else (Symbol(name), "–", f"less than {TELLING_PERCENT:.0f} %")
        for name, value in quality.fit_percent.items()
    )
    return Table(
        title="FitPercent (thesis eq. 2.41)",
        columns=(*texts("output"), *numbers("FitPercent", "a perfect model, on average")),
        rows=rows,
        note=(
            "A fitted model follows some of the noise, so it may come out a little above a perfect one. "
            f"{_chi_square(quality)}{quality.starts_at_optimum} of {quality.starts} starts reached the result."
        ),
    )


def _chi_square(quality: "Quality") -> str:
    if quality.chi_square is None:
        return ""
    chance = "" if quality.p_value is None else f", p-value {p_value_text(quality.p_value)}"
    return f"Chi-square {plain(quality.chi_square, 1)} for {quality.degrees_of_freedom} degrees of freedom{chance}; "
