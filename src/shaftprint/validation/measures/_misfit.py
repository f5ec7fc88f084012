"""How much of the motion a model misses beyond what noise and its own uncertainty explain.

In an excerpt of ``N`` samples the residual ``r = y - f`` of the right model is noise ``v`` and what the covariance
``C`` of the parameters lets the model be off, ``J^T d``. All of them are projected on where an error of the model can
lie (``Reach``), which takes their means off. With the mean square ``s`` of the noise and ``G = J J^T`` then::

    E[r^T r / N] = s + tr(C G) / N        Var[r^T r / N] = Var[v^T v / N] + 2 tr((C G)^2) / N^2

What ``r^T r / N`` has beyond that is the mean square of the model's error; its root over that of the motion is
reported. Where the model errs by ``m``, noise and error mix and add ``4 m^T R m / N^2`` to the variance, ``R`` being
the covariance of the noise, and the parameters as much with ``J^T C J`` for ``R``.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import chi_square_tail, deviations
from shaftprint.identify.likelihood._fit_percent import fit_percent
from shaftprint.units import PERCENT
from shaftprint.validation.measures._noise_pieces import NoisePieces, quadratic_form
from shaftprint.validation.measures._reach import EVERYWHERE, Reach

Outcome = Literal["passes", "fails", "undecided"]
# With fewer pieces of noise their scatter says little, and the autocovariance is asked as well.
_FEWEST_PIECES = 12


@dataclass(frozen=True, kw_only=True, slots=True)
class Misfit:
    """How well one output of a model explains one excerpt."""

    output: str
    """Name of the output."""
    fit_percent: float
    """FitPercent (thesis eq. 2.41), of all frequencies, nothing taken off [%]."""
    fit_ceiling: float
    """FitPercent that the true model would reach with this noise [%]."""
    error: float
    """Root mean square of what the model misses beyond noise and its own uncertainty, over that of the motion [-]."""
    error_interval: tuple[float, float]
    """Interval of the error at the coverage of the settings [-]."""
    p_value: float
    """Probability that noise and the model's own uncertainty leave as much as is left, or more."""
    noise_pieces: int
    """How many pieces of noise as long as the excerpt were found; 0 where none is as long, and shorter ones serve."""
    outcome: Outcome
    """Whether the error is surely at most, or surely more than, what is allowed."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Compared:
    """Data and model of one output in one excerpt."""

    output: str
    """Name of the output."""
    place: int
    """Its place among speed and torque."""
    measured: FloatArray
    """Data, shape (samples,)."""
    model: FloatArray
    """Model, shape (samples,)."""
    slopes: FloatArray
    """Derivatives of the model to its free parameters, shape (free, samples)."""
    noise: NoisePieces
    """Noise like that in the excerpt."""
    reach: Reach = EVERYWHERE
    """Where in the excerpt an error of the model can lie; for noise in pieces as long as the excerpt."""

    @property
    def autocovariance(self) -> FloatArray:
        """Autocovariance of the noise of the output from lag 0 on, shape (lags,)."""
        return self.noise.autocovariances[self.place]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Unfiltered:
    """Data and model of the same at all frequencies; of their noise the variance is enough."""

    measured: FloatArray
    """Data, shape (samples,)."""
    model: FloatArray
    """Model, shape (samples,)."""
    noise_variance: float
    """Variance of the noise, with what it is off on average."""

    @property
    def fit_percent(self) -> float:
        """FitPercent (thesis eq. 2.41) [%]."""
        return fit_percent(self.measured.astype(np.complex128), self.model.astype(np.complex128))

    @property
    def fit_ceiling(self) -> float:
        """FitPercent that the true model would reach with this noise [%]."""
        spread = float(np.std(self.measured))
        return PERCENT * (1.0 - float(np.sqrt(self.noise_variance)) / spread) if spread > 0.0 else float(np.nan)


def misfit_of(
    raw: Unfiltered,
    smooth: Compared,
    covariance: FloatArray,
    *,
    largest_error: float,
    coverage: float,
) -> Misfit:
    """Return how well one output of a model explains one excerpt.

    ``raw``, ``smooth``: data and model of all frequencies, and through the low-pass. ``covariance``: covariance of the
    free parameters, shape (free, free). ``largest_error``: share of the motion that the model may miss. ``coverage``:
    coverage of the interval of the error.
    """
    residual, slopes = smooth.reach.of(smooth.measured - smooth.model), smooth.reach.of(smooth.slopes)
    samples = residual.size
    pieces, autocovariance = smooth.reach.of(smooth.noise.pieces[:, smooth.place]), smooth.autocovariance
    trace_of_square = smooth.reach.trace_of_square(pieces, autocovariance, samples)
    energy, energy_variance = _noise_energy(smooth, pieces, 2.0 * trace_of_square / samples**2)
    spread = covariance @ (slopes @ slopes.T / samples)
    expected = energy + float(np.trace(spread))
    variance = energy_variance + 2.0 * float(np.trace(spread @ spread))
    mean_square = float(np.mean(residual**2))
    beyond = mean_square - expected
    along = slopes @ residual / samples
    noise_along = max(quadratic_form(residual, autocovariance) - trace_of_square, 0.0) / samples**2
    mixed = 4.0 * (noise_along + float(along @ covariance @ along))
    half = deviations(coverage) * np.sqrt(variance + (mixed if beyond > 0.0 else 0.0))
    motion = float(np.std(smooth.measured))
    # a residual that happens to be smaller than the noise does not make the error known better than noise allows
    ends = (beyond, beyond - half, max(beyond, 0.0) + half)
    error, low, high = (float(np.sqrt(max(square, 0.0))) / motion for square in ends)
    return Misfit(
        output=smooth.output,
        fit_percent=raw.fit_percent,
        fit_ceiling=raw.fit_ceiling,
        error=error,
        error_interval=(low, high),
        p_value=_tail(mean_square, expected, variance),
        noise_pieces=smooth.noise.pieces.shape[0] if smooth.noise.as_long else 0,
        outcome="fails" if low > largest_error else "passes" if high <= largest_error else "undecided",
    )


def _noise_energy(smooth: Compared, pieces: FloatArray, by_colour: float) -> tuple[float, float]:
    """Return the mean square of the noise in the excerpt, and the variance of what it and its estimate are off.

    ``by_colour`` is the variance of the former that its covariance lets expect.
    """
    energies = np.mean(pieces**2, axis=1)
    count = energies.size
    scatter = float(np.var(energies, ddof=1)) if count > 1 else 0.0
    if count < _FEWEST_PIECES or not smooth.noise.as_long:
        scatter = max(scatter, by_colour)
    # as many independent pieces as excerpts would fit into all that was found
    effective = count * pieces.shape[1] / smooth.measured.size
    return float(energies.mean()), scatter * (1.0 + 1.0 / effective)


def _tail(square: float, expected: float, variance: float) -> float:
    """Return the share of a scaled chi-square of that mean and variance at or beyond what was found."""
    if not variance > 0.0:
        return float(square <= expected)
    return chi_square_tail(2.0 * square * expected / variance, 2.0 * expected**2 / variance)
