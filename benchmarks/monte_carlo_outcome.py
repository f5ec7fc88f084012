"""What one simulated test gave, and what many of them say together."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import kstest

from shaftprint.arrays import FloatArray
from shaftprint.distributions import NORMAL_95
from shaftprint.identify import Estimate
from shaftprint.identify.uncertainty._profile import Interval


@dataclass(frozen=True, kw_only=True, slots=True)
class Row:
    """One number of one simulated test."""

    error: float
    """Estimate minus truth."""
    std: float
    """Standard deviation that the fit states."""
    linear: float
    """Error of the best linear estimate from the same noise: its variance is the Cramer-Rao bound. Not a number where
    there is none."""
    inside: bool
    """Whether the 95 % interval holds the truth."""
    is_open: bool
    """Whether the interval has an end that the data do not set."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Outcome:
    """One simulated test."""

    rows: Mapping[str, Row]
    """Every parameter and combination by name."""
    p_value: float
    """p-value of the fit."""
    agrees: bool | None = None
    """Whether refits with each number held at its truth say of all what the intervals say; None if not asked."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Number:
    """What many tests say of one number."""

    name: str
    """Name of the parameter or combination."""
    bias: float
    """Mean error over the bound."""
    variance_ratio: float
    """Mean square of the errors over the Cramer-Rao bound."""
    steady_ratio: float
    """The same with the chance of these draws taken out: the linear estimate from the same noise has the ratio 1."""
    error_ratio: float
    """Root of the mean square of the errors over the stated standard deviations."""
    coverage: float
    """Share of the tests whose 95 % interval holds the truth."""
    steady_coverage: float
    """The same with the chance of these draws taken out: the linear estimate's interval covers 95 %."""
    is_open: float
    """Share of the tests whose interval has an open end."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Result:
    """What many tests of one structure say."""

    name: str
    """Name of the case."""
    tests: int
    """Number of tests."""
    numbers: tuple[Number, ...]
    """Every parameter and combination."""
    uniform: float
    """p-value of the Kolmogorov-Smirnov test that the p-values of the fits are uniform."""
    rejected: float
    """Share of the fits that are rejected at 5 %."""
    agreeing: tuple[int, int]
    """Number of tests in which refits with held numbers say what the intervals say, and of those that were asked."""


def row_of(estimate: Estimate, interval: Interval, truth: float, linear: float = np.nan) -> Row:
    """Return what a test says of one number."""
    return Row(
        error=estimate.value - truth,
        std=estimate.std,
        linear=linear,
        inside=(interval.lower <= truth or interval.lower_open) and (truth <= interval.upper or interval.upper_open),
        is_open=interval.lower_open or interval.upper_open,
    )


def together(name: str, outcomes: Sequence[Outcome], bounds: Mapping[str, float] | None = None) -> Result:
    """Return what many tests say.

    Parameters
    ----------
    name
        Name of the case.
    outcomes
        The tests.
    bounds
        Cramer-Rao bound of every number, as a standard deviation; where there is none, the stated ones are compared.
    """
    p_values = np.array([outcome.p_value for outcome in outcomes])
    asked = [outcome.agrees for outcome in outcomes if outcome.agrees is not None]
    return Result(
        name=name,
        tests=len(outcomes),
        numbers=tuple(
            _number(number, [outcome.rows[number] for outcome in outcomes], (bounds or {}).get(number, np.nan))
            for number in outcomes[0].rows
        ),
        uniform=float(kstest(p_values, "uniform").pvalue),
        rejected=float(np.mean(p_values < 0.05)),
        agreeing=(sum(asked), len(asked)),
    )


def _number(name: str, rows: Sequence[Row], bound: float) -> Number:
    error, std, linear = (np.array([getattr(row, field) for row in rows]) for field in ("error", "std", "linear"))
    inside = np.array([row.inside for row in rows])
    known = np.isfinite(std)
    square = float(np.mean(error**2)) / bound**2
    return Number(
        name=name,
        bias=float(error.mean()) / (_typical(error) if np.isnan(bound) else bound),
        variance_ratio=square,
        steady_ratio=square - float(np.mean(linear**2)) / bound**2 + 1.0,
        error_ratio=float(np.sqrt(np.mean((error[known] / std[known]) ** 2))) if known.any() else np.nan,
        coverage=float(inside.mean()),
        steady_coverage=float(np.mean(inside) - np.mean(np.abs(linear) < NORMAL_95 * bound) + 0.95),
        is_open=float(np.mean([row.is_open for row in rows])),
    )


def _typical(error: FloatArray) -> float:
    return float(np.sqrt(np.mean(error**2)))
