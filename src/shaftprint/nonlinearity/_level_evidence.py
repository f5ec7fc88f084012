"""Whether governor and engine answer small and large excitation alike: gain and delay, test by test."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.nonlinearity._fit import Fit, slope_columns
from shaftprint.nonlinearity._record import Record
from shaftprint.nonlinearity._tails import chi_square_tail

if TYPE_CHECKING:
    from shaftprint.campaign import Campaign

_LARGEST_GAIN_STD = 0.5
_LEVEL_RATIO = 1.5


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LevelEvidence:
    """Gain and delay between speed error and engine torque of every test, relative to the governor of all tests."""

    tests: tuple[str, ...]
    """Names of the tests that say something."""
    size: FloatArray
    """Largest deviation of the set point from its mean in each [-], shape (tests,)."""
    gain: FloatArray
    """Gain over that of all tests together, minus 1 [-], shape (tests,)."""
    gain_std: FloatArray
    """Its standard deviation, shape (tests,)."""
    delay_s: FloatArray
    """Delay beyond that of all tests together [s], shape (tests,)."""
    delay_std_s: FloatArray
    """Its standard deviation [s], shape (tests,)."""
    large_minus_small: float
    """Mean gain of the larger tests minus that of the smaller [-]; not a number where all are alike."""
    large_minus_small_std: float
    """Its standard deviation."""
    p_value: float
    """Probability of that difference by chance; 1 where it is not known. Too small by a factor of about four at 5 %."""

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for name in ("size", "gain", "gain_std", "delay_s", "delay_std_s"):
            object.__setattr__(self, name, frozen_float(getattr(self, name)))


def level_evidence(record: Record, linear: Fit, campaign: "Campaign") -> LevelEvidence:
    """Fit gain and delay of each test apart, to first order about the linear governor of all tests.

    The propeller is inside the measured speed and torque: its level dependence is not in these numbers.
    """
    columns = slope_columns(record, linear, ("K_p", "K_i", "t_d"))
    both = np.stack([columns[:, 0] + columns[:, 1], columns[:, 2] / linear.values["t_d"]], axis=1)
    variance = linear.whitened.squares / max(linear.count - len(linear.free), 1)
    time, asked = record.value_time_s, record.values_of(record.set_point)
    names, rows = [], []
    for test in campaign.excitations:
        inside = (time >= test.start_s) & (time < test.stop_s)
        if np.count_nonzero(inside) <= linear.whitened.taps.size:
            continue
        seen = linear.whitened.filtered(np.where(inside[:, np.newaxis], both, 0.0))
        inverse = np.linalg.pinv(seen.T @ seen, hermitian=True)
        change = -inverse @ (seen.T @ linear.whitened.residual)
        std = np.sqrt(variance * inverse.diagonal())
        if 0.0 < std[0] < _LARGEST_GAIN_STD:
            names.append(test.name)
            size = float(np.abs(asked[inside] - asked[inside].mean()).max())
            rows.append((size, change[0], std[0], change[1], std[1]))
    table = np.array(rows).reshape(-1, 5)
    difference, difference_std = _difference(table)
    known = np.isfinite(difference)
    return LevelEvidence(
        tests=tuple(names),
        size=table[:, 0],
        gain=table[:, 1],
        gain_std=table[:, 2],
        delay_s=table[:, 3],
        delay_std_s=table[:, 4],
        large_minus_small=difference,
        large_minus_small_std=difference_std,
        p_value=chi_square_tail((difference / difference_std) ** 2, 1) if known else 1.0,
    )


def _difference(table: FloatArray) -> tuple[float, float]:
    """Return the weighted mean gain of large tests minus that of small ones, with its standard deviation."""
    nothing = (float("nan"), float("nan"))
    if len(table) < 2 or table[:, 0].max() < _LEVEL_RATIO * table[:, 0].min():
        return nothing
    large = table[:, 0] > np.sqrt(table[:, 0].max() * table[:, 0].min())
    means, variances = [], []
    for chosen in (large, ~large):
        weight = 1.0 / table[chosen, 2] ** 2
        means.append(float(weight @ table[chosen, 1] / weight.sum()))
        variances.append(float(1.0 / weight.sum()))
    return means[0] - means[1], float(np.sqrt(sum(variances)))
