"""Tables of a validation: what a model misses of records that it has not seen, and the numbers of steps."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from shaftprint.digits import p_value_text, plain, rounded, with_deviation
from shaftprint.plain_table import Table, numbers, texts
from shaftprint.units import MILLI, PERCENT

if TYPE_CHECKING:
    from shaftprint.validation._step_comparison import StepNumber
    from shaftprint.validation._validation import ExcerptComparison, Validation
    from shaftprint.validation.measures._delay import RemainingDelay
    from shaftprint.validation.measures._misfit import Misfit


def misfit_table(validation: "Validation") -> Table:
    """Return what the model misses of every excerpt and output beyond noise, and the delay that is left."""
    rows = tuple(
        _misfit_row(comparison, misfit, delay)
        for comparison in validation.comparisons
        for misfit, delay in zip(comparison.misfits, comparison.delays, strict=True)
    )
    allowed = f"{PERCENT * validation.settings.largest_error:g} %"
    coverage = f"{PERCENT * validation.settings.coverage:g} % interval"
    return Table(
        title=f"What {validation.model.name} misses of records that it has not seen",
        columns=(
            *texts("excerpt and output"),
            *numbers("beyond noise", coverage, "p", "FitPercent", "right model", "delay left [ms]"),
            *texts("outcome"),
        ),
        rows=rows,
        symbols=True,
        note=f"Shares of the motion in the excerpt. It passes where the interval lies below {allowed}, and fails where "
        "it lies above.",
    )


def _misfit_row(comparison: "ExcerptComparison", misfit: "Misfit", delay: "RemainingDelay") -> tuple[str, ...]:
    low, high = (PERCENT * end for end in misfit.error_interval)
    return (
        f"{excerpt_name(comparison)}: {misfit.output}",
        f"{plain(PERCENT * misfit.error, 1)} %",
        f"{plain(low, 1)} to {plain(high, 1)} %",
        p_value_text(misfit.p_value),
        f"{plain(misfit.fit_percent, 1)} %",
        f"{plain(misfit.fit_ceiling, 1)} %",
        "not found" if math.isnan(delay.delay_s) else _milliseconds(delay),
        misfit.outcome + (" (identified from it)" if comparison.excerpt.in_sample else ""),
    )


def _milliseconds(delay: "RemainingDelay") -> str:
    return with_deviation(MILLI * delay.delay_s, MILLI * delay.std_s)


def excerpt_name(comparison: "ExcerptComparison") -> str:
    """Return the name of an excerpt with its record."""
    return f"{comparison.excerpt.record}, {comparison.excerpt.title}".replace(" -", " −")


def _of_step(comparison: "ExcerptComparison") -> str:
    """Return the name of a step by its second alone, for rows that have more to say."""
    at = comparison.excerpt.step_s
    return excerpt_name(comparison) if at is None else f"{comparison.excerpt.record}, {at:.1f} s"


def models_table(validations: "Sequence[Validation]") -> Table:
    """Return FitPercent and outcome of several models side by side, a row an excerpt."""
    rows = [
        (
            excerpt_name(group[0]),
            _of_outputs([misfit.fit_ceiling for misfit in group[0].misfits]),
            *(_of_outputs([misfit.fit_percent for misfit in one.misfits]) for one in group),
        )
        for group in zip(*(validation.comparisons for validation in validations), strict=True)
    ]
    rows.append(("outcome", "", *(validation.outcome for validation in validations)))
    names = [validation.model.name for validation in validations]
    return Table(
        title="FitPercent of speed / torque", columns=texts("excerpt", "right model", *names), rows=tuple(rows)
    )


def _of_outputs(percent: Sequence[float]) -> str:
    return " / ".join(plain(value, 1) for value in percent)


def step_number_table(validation: "Validation") -> Table:
    """Return overshoot, rise and settling of every step, measured and by the model."""
    rows = tuple(
        (
            f"{_of_step(comparison)}: {number.name} of {number.output} [{number.unit}]",
            _with_std(number.measured, number.measured_std),
            _with_std(number.expected, number.expected_std),
            _agreement(number),
        )
        for comparison in validation.comparisons
        for number in comparison.step_numbers
        if not (math.isnan(number.measured) and math.isnan(number.expected))
    )
    return Table(
        title="Numbers of the steps",
        columns=texts("step and number", "measured ± noise", "model ± parameters", "agree"),
        rows=rows,
        symbols=True,
    )


def _with_std(value: float, std: float) -> str:
    if math.isnan(value):
        return "not shown"
    return rounded(value, 3) if math.isnan(std) else with_deviation(value, std)


def _agreement(number: "StepNumber") -> str:
    return {True: "yes", False: "no", None: ""}[number.agrees]
