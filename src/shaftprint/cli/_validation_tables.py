"""A validation as tables on the terminal."""

import math
from collections.abc import Sequence

from shaftprint.cli._fingerprint_tables import print_findings
from shaftprint.cli._tables import print_table
from shaftprint.validation import ExcerptComparison, Misfit, RemainingDelay, StepNumber, Validation

PERCENT = 100.0
MS_PER_S = 1000.0
OUTPUTS = {"n": "speed", "M_s": "torque"}
WORDS = {"passes": "passes", "fails": "fails", "undecided": "does not fail; noise hides part of it"}


def print_validation(validation: Validation) -> None:
    """Print the verdict, every excerpt, the numbers of every step, and how it was found."""
    print_findings(f"Validation: {WORDS[validation.outcome]}", validation.sentences)
    _print_excerpts(validation)
    steps = [comparison for comparison in validation.comparisons if comparison.step_numbers]
    if steps:
        _print_steps(steps)
    print_findings("How this was found", validation.findings)


def print_compared_models(validations: Sequence[Validation]) -> None:
    """Print FitPercent and outcome of several models side by side, a row an excerpt."""
    names = [validation.model.name for validation in validations]
    rows = []
    for group in zip(*(validation.comparisons for validation in validations), strict=True):
        first = group[0]
        ceiling = " / ".join(f"{misfit.fit_ceiling:.1f}" for misfit in first.misfits)
        cells = [" / ".join(f"{misfit.fit_percent:.1f}" for misfit in one.misfits) for one in group]
        rows.append((_where(first), ceiling, *cells))
    rows.append(("outcome", "", *(validation.outcome for validation in validations)))
    print_table("FitPercent of speed / torque", ("stretch", "ceiling", *names), rows)


def _print_excerpts(validation: Validation) -> None:
    allowed = f"{PERCENT * validation.settings.largest_error:.0f} %"
    coverage = f"{PERCENT * validation.settings.coverage:.0f} %"
    rows = []
    for comparison in validation.comparisons:
        outcome = f"{comparison.outcome} (seen)" if comparison.excerpt.in_sample else comparison.outcome
        for misfit, delay in zip(comparison.misfits, comparison.delays, strict=True):
            rows.append(
                (
                    _where(comparison),
                    outcome,
                    OUTPUTS[misfit.output],
                    f"{misfit.fit_percent:.1f}",
                    f"{misfit.fit_ceiling:.1f}",
                    _error(misfit),
                    _probability(misfit.p_value),
                    _delay(delay),
                )
            )
            outcome = ""
    columns = (
        "stretch",
        f"missed at most {allowed}?",
        "output",
        "FitPercent",
        "ceiling",
        f"missed beyond noise [% of motion], {coverage}",
        "p",
        "delay left [ms] +/- 1 std",
    )
    print_table(f"{validation.model.name} against records it has not seen", columns, rows, numbers=(3, 4, 6))


def _print_steps(steps: Sequence[ExcerptComparison]) -> None:
    rows = []
    for comparison in steps:
        for number in comparison.step_numbers:
            if math.isnan(number.measured) and math.isnan(number.expected):
                continue
            rows.append(
                (
                    _where(comparison),
                    OUTPUTS[number.output],
                    f"{number.name} [{number.unit}]",
                    _with_std(number.measured, number.measured_std),
                    _with_std(number.expected, number.expected_std),
                    _agreement(number),
                )
            )
    columns = ("step", "output", "number", "measured +/- noise", "model +/- parameters", "agree")
    print_table("Numbers of the steps", columns, rows)


def _where(comparison: ExcerptComparison) -> str:
    return f"{comparison.excerpt.record}, {comparison.excerpt.title}"


def _error(misfit: Misfit) -> str:
    low, high = (PERCENT * end for end in misfit.error_interval)
    return f"{PERCENT * misfit.error:.1f} ({low:.1f} to {high:.1f})"


def _probability(p: float) -> str:
    return "< 1e-4" if p < 1e-4 else f"{p:.2g}"


def _delay(delay: RemainingDelay) -> str:
    if math.isnan(delay.delay_s):
        return "not found"
    return f"{MS_PER_S * delay.delay_s:.1f} +/- {MS_PER_S * delay.std_s:.1f}"


def _with_std(value: float, std: float) -> str:
    if math.isnan(value):
        return "not shown"
    return f"{value:.3g}" if math.isnan(std) else f"{value:.3g} +/- {std:.2g}"


def _agreement(number: StepNumber) -> str:
    return {True: "yes", False: "no", None: ""}[number.agrees]
