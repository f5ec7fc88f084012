"""Tables of the fingerprint: parameters, combinations, physical values, margins, fit."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from shaftprint.distributions import NORMAL_95
from shaftprint.report._numbers import decimals_of, interval, plain, rounded, with_deviation
from shaftprint.report._symbols import unit_text
from shaftprint.report._table import Cell, Table, symbol_html

if TYPE_CHECKING:
    from shaftprint.fingerprint import Fingerprint, Quality, Quantity
    from shaftprint.identify import Identification

INTERVAL_NOTE = (
    "± is one standard deviation; it is left out where it does not tell what the interval tells. The 95 % interval is "
    "that of the profile likelihood where there is one; an open end, marked with an asterisk, is a bound of the search "
    "and not a result."
)


def parameter_table(fingerprint: "Fingerprint", truth: Mapping[str, float]) -> Table:
    """Return the free parameters with intervals, beside the truth where it is known."""
    return _quantities("Identified parameters, normalised with the working point", fingerprint.parameters, truth)


def combination_table(fingerprint: "Fingerprint", truth: Mapping[str, float]) -> Table:
    """Return the combinations of parameters that the test finds better than the parameters alone."""
    return _quantities("Combinations of parameters", fingerprint.combinations, truth)


def truth_of_combinations(identification: "Identification", truth: Mapping[str, float]) -> dict[str, float]:
    """Return the true value of each combination of the structure; held parameters count as true.

    Combinations of parameters whose truth is not known are left out.
    """
    held = {p.name: p.value if p.held else math.nan for p in identification.structure.parameters}
    known = held | dict(truth)
    values = {c.name: float(c.of(known)) for c in identification.structure.combinations}  # type: ignore[arg-type]
    return {name: value for name, value in values.items() if math.isfinite(value)}


def _quantities(caption: str, quantities: "Sequence[Quantity]", truth: Mapping[str, float]) -> Table:
    header: tuple[Cell, ...] = ("quantity", "value ± std", "95 % interval", "unit", "meaning")
    told = any(quantity.name in truth for quantity in quantities)
    if told:
        header = (*header[:3], "truth", "truth within", *header[3:])
    rows: list[tuple[Cell, ...]] = []
    for quantity in quantities:
        lower, upper = limits(quantity)
        cells: tuple[Cell, ...] = (
            symbol_html(quantity.name),
            _value_text(quantity) + (" (at its bound)" if quantity.at_bound else ""),
            _interval_text(quantity),
        )
        if told:
            true = truth.get(quantity.name, math.nan)
            inside = "–" if math.isnan(true) else "yes" if lower <= true <= upper else "no"
            cells = (*cells, plain(true, decimals_of(true, quantity.std)), inside)
        rows.append((*cells, unit_text(quantity.unit), quantity.meaning))
    return Table(caption=caption, header=header, rows=tuple(rows), note=INTERVAL_NOTE)


def _value_text(quantity: "Quantity") -> str:
    """Return value and standard deviation; the value alone where only its interval tells how well it is known."""
    std = quantity.stated_std
    return rounded(quantity.value) if std is None else with_deviation(quantity.value, std)


def limits(quantity: "Quantity") -> tuple[float, float]:
    """Return the 95 % interval of a quantity: the profile's, or else that of its standard deviation."""
    if quantity.interval_95 is not None:
        return quantity.interval_95
    return quantity.value - NORMAL_95 * quantity.std, quantity.value + NORMAL_95 * quantity.std


def _interval_text(quantity: "Quantity") -> str:
    lower, upper = limits(quantity)
    if not (math.isfinite(lower) and math.isfinite(upper)):
        return "not known"
    text = interval(lower, upper, quantity.std)
    open_low, open_high = quantity.interval_open
    if open_low:
        text = text.replace(" to ", "* to ", 1)
    return f"{text}*" if open_high else text


def physical_table(fingerprint: "Fingerprint", truth: Mapping[str, float]) -> Table:
    """Return the physical values beside those of the vessel file (torsional vibration calculation) and the truth."""
    told = any(quantity.name in truth for quantity in fingerprint.physical)
    rows: list[tuple[Cell, ...]] = []
    for quantity in fingerprint.physical:
        lower, upper = limits(quantity)
        expected = quantity.expected
        share = "–" if not expected else f"{plain(100.0 * (quantity.value / expected - 1.0), 1)} %"
        true = truth.get(quantity.name, math.nan)
        rows.append(
            (
                symbol_html(quantity.name),
                with_deviation(quantity.value, quantity.std),
                interval(lower, upper, quantity.std),
                *((plain(true, decimals_of(true, quantity.std)),) if told else ()),
                expected_text(quantity),
                share,
                unit_text(quantity.unit),
                quantity.meaning,
            )
        )
    beside = ("truth", "vessel file") if told else ("vessel file",)
    return Table(
        caption="Physical values beside those of the vessel file",
        header=("quantity", "value ± std", "95 % interval", *beside, "difference", "unit", "meaning"),
        rows=tuple(rows),
        note=(
            "Standard deviations hold the scale of the torque gauge too, with the sign with which it enters; that of "
            "K_Q holds the wander of the load. The difference is that from the vessel file."
        ),
    )


def expected_text(quantity: "Quantity") -> str:
    """Return the value of the vessel file with its standard deviation, where there are such."""
    if quantity.expected is None:
        return "–"
    if not quantity.expected_std:
        return rounded(quantity.expected)
    return with_deviation(quantity.expected, quantity.expected_std)


def margin_table(fingerprint: "Fingerprint", truth: Mapping[str, float]) -> Table:
    """Return the stability margins with intervals, beside the truth where it is known."""
    return _quantities("Stability margins", fingerprint.margins, truth)


def fit_table(fingerprint: "Fingerprint") -> Table:
    """Return FitPercent of each output beside that of a model without error, which only the noise is in the way of."""
    quality = fingerprint.quality
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (symbol_html(name), f"{plain(value, 2)} %", f"{plain(quality.fit_ceiling[name], 2)} %")
        for name, value in quality.fit_percent.items()
    )
    return Table(
        caption="FitPercent (thesis eq. 2.41)",
        header=("output", "FitPercent", "a perfect model, on average"),
        rows=rows,
        note=(
            "A fitted model follows some of the noise, so it may come out a little above a perfect one. "
            f"{_chi_square(quality)}{quality.starts_at_optimum} of {quality.starts} starts reached the result."
        ),
    )


def _chi_square(quality: "Quality") -> str:
    if quality.chi_square is None:
        return ""
    return f"Chi-square {plain(quality.chi_square, 1)} for {quality.degrees_of_freedom} degrees of freedom; "
