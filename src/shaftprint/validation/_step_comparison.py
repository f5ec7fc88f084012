"""Overshoot, rise, settling and peak of data and model beside each other.

What noise does to these numbers is not symmetric: the largest of many noisy samples is too large. Pieces of the ship's
own noise are therefore laid over the model's response; their mean is what the model lets one expect to measure, their
scatter the standard deviation of the measured number. The band of the model is the scatter over parameters drawn from
their covariance, to first order.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import deviations
from shaftprint.validation.measures._misfit import Compared
from shaftprint.validation.measures._step_numbers import STEP_NUMBERS, step_numbers

_FEWEST_PIECES = 3
# A number that so small a share of the noisy responses shows is no number to compare.
_SHOWN_SHARE = 0.8


@dataclass(frozen=True, kw_only=True, slots=True)
class StepNumber:
    """One number of a step response, measured and expected."""

    output: str
    """Name of the output."""
    name: str
    """``overshoot``, ``rise time``, ``settling time``, ``peak`` or ``peak time``."""
    unit: str
    """Unit of the values."""
    measured: float
    """From the data; not a number where noise hides it."""
    measured_std: float
    """Its standard deviation by the noise of the ship; not a number where too few pieces of noise were found."""
    expected: float
    """From the model, as noise would show it."""
    expected_std: float
    """Its standard deviation by the uncertainty of the parameters."""
    agrees: bool | None
    """Whether both agree at the coverage of the settings; None where that cannot be said."""


def compare_steps(
    smooth: Compared,
    time_s: FloatArray,
    covariance: FloatArray,
    *,
    settled_share: float,
    coverage: float,
    draws: int,
    rng: np.random.Generator,
) -> tuple[StepNumber, ...]:
    """Return the numbers of one step of one output.

    ``smooth``: data and model through the low-pass. ``time_s``: time after the step [s], shape (samples,).
    ``covariance``: covariance of the free parameters, shape (free, free). ``settled_share``: share of the height within
    which a step has settled. ``coverage``: coverage at which both agree. ``draws``: parameter sets drawn for the band.
    ``rng``: source of the draws.
    """
    measured = step_numbers(smooth.measured[None], time_s, settled_share=settled_share)[:, 0]
    plain = step_numbers(smooth.model[None], time_s, settled_share=settled_share)[:, 0]
    pieces = smooth.noise.pieces[:, smooth.place]
    usable = smooth.noise.as_long and pieces.shape[0] >= _FEWEST_PIECES
    expected, std = plain, np.full(plain.size, np.nan)
    if usable:
        expected, std = _moments(step_numbers(smooth.model + pieces, time_s, settled_share=settled_share))
    # few pieces of noise give a deviation that is itself not well known: Student's t instead of the normal distribution
    noise_reach = deviations(coverage, max(pieces.shape[0] - 1, 1))
    band = _band(smooth, time_s, covariance, settled_share, draws, rng)
    numbers = []
    for row, (name, unit) in enumerate(STEP_NUMBERS.items()):
        reach = float(np.hypot(noise_reach * std[row], deviations(coverage) * band[row]))
        apart = abs(float(measured[row] - expected[row]))
        numbers.append(
            StepNumber(
                output=smooth.output,
                name=name,
                unit=unit,
                measured=float(measured[row]),
                measured_std=float(std[row]),
                expected=float(expected[row]),
                expected_std=float(band[row]),
                agrees=bool(apart <= reach) if np.isfinite(apart + reach) else None,
            )
        )
    return tuple(numbers)


def _moments(numbers: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return mean and standard deviation of each number; nan for one that many responses do not show."""
    shown = np.isfinite(numbers)
    count = shown.sum(axis=1)
    enough = count >= np.maximum(_SHOWN_SHARE * numbers.shape[1], 2.0)
    mean = np.where(shown, numbers, 0.0).sum(axis=1) / np.maximum(count, 1)
    square = np.where(shown, (numbers - mean[:, None]) ** 2, 0.0).sum(axis=1) / np.maximum(count - 1, 1)
    return np.where(enough, mean, np.nan), np.where(enough, np.sqrt(square), np.nan)


def _band(
    smooth: Compared,
    time_s: FloatArray,
    covariance: FloatArray,
    settled_share: float,
    draws: int,
    rng: np.random.Generator,
) -> FloatArray:
    """Return the standard deviation of each number by the parameters, shape (numbers,)."""
    if not np.any(covariance > 0.0):
        return np.zeros(len(STEP_NUMBERS))
    size, vectors = np.linalg.eigh(covariance)
    root = vectors * np.sqrt(np.maximum(size, 0.0))
    changes = rng.standard_normal((draws, size.size)) @ root.T
    return _moments(step_numbers(smooth.model + changes @ smooth.slopes, time_s, settled_share=settled_share))[1]
