"""How much a line that lies far from the model counts: what an estimated covariance and bad lines do to the likelihood.

Where the covariance ``C`` of a line of ``m`` real numbers is known, its share of the negative log-likelihood is half of
``d^2 = (y - f)^T C^-1 (y - f)``. Two things change it to half of ``K log(1 + d^2 / c)``, that of a multivariate t
density but for a factor (Lange, Little and Taylor, Robust statistical modeling using the t distribution, 1989, eq. 1):

- A covariance that was estimated from ``nu`` real degrees of freedom (``nu / 2`` complex samples): with the covariance
  that may have been behind it integrated out, the likelihood is a t density of ``nu - m + 2`` degrees of freedom (Box
  and Tiao, Bayesian Inference in Statistical Analysis, 1973, chapter 8, here for complex samples), ``c = nu - m``.
- A line that may be bad: a t density of few degrees of freedom on purpose, which are ``c``.

The factor is chosen such that under normal noise likelihood ratios are chi-square, so that profiles and standard
deviations are right: averaged over the noise and over estimated covariances, the curvature ``A`` of the cost is the
variance ``B`` of its slope (Godambe, An optimum property of regular maximum likelihood estimation, 1960). For an
estimated covariance alone that gives ``K = nu - m + 2``.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray

# Below this the logarithm is taken from its series.
NEAR = 1e-3
NODES = 200
# Where a covariance has hardly more degrees of freedom than numbers, its weight is that of one more (spectra).
LEAST_EXCESS = 1.0
# So many standard deviations of a squared distance above its mean is no normal noise.
BAD_LINE = 6.0
# A covariance of so many degrees of freedom is as good as known.
LARGEST_EXCESS = 1e9


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Tails:
    """The cost of each line as a function of its squared distance: half of ``gain d^2 L(bend d^2)``.

    ``L(x) = log(1 + x) / x`` is 1 at 0; a line of known covariance has the gain 1 and no bend.
    """

    gain: FloatArray
    """``K / c`` of each line, shape (lines,)."""
    bend: FloatArray
    """``1 / c`` of each line, shape (lines,)."""
    information: FloatArray
    """Information of each line over that of a known covariance without bad lines, on average, shape (lines,)."""
    averaged: bool
    """Whether the curvature is taken on average too: heavy tails follow the noise of few lines too closely."""

    @property
    def normal(self) -> bool:
        """Whether no line has a tail: the residuals are their own."""
        return not self.bend.any()

    def shaped(self, table: FloatArray) -> FloatArray:
        """Return residuals whose half square sum is the cost, and their derivatives, from the weighted ones.

        ``table``: weighted residuals and below them their derivatives, shape (starts, 1 + free, size, lines).
        """
        residuals = table[:, 0]
        squares = np.einsum("smf,smf->sf", residuals, residuals)
        level, slope = _logarithm(squares * self.bend)
        factor = np.sqrt(self.gain * level)
        # Derivative of the factor to d^2, twice: d^2 changes by twice the product of residuals and their derivatives.
        change = self.gain * self.bend * slope / factor
        along = np.einsum("smf,skmf->skf", residuals, table[:, 1:])
        shaped = factor[:, None, None, :] * table
        shaped[:, 1:] += (change[:, None, :] * along)[:, :, None, :] * residuals[:, None]
        return np.asarray(shaped)

    def curvature(self, table: FloatArray) -> FloatArray:
        """Return derivatives whose products are the second derivatives of the cost, but for those of the model.

        A line so far off that its cost bends down has none along its residual. Where they are ``averaged`` only a bad
        line, farther off than normal noise brings it, has less than the average.

        ``table``: as in ``shaped``. Returns shape (starts, free, size, lines).
        """
        residuals, slopes = table[:, 0], table[:, 1:]
        squares = np.einsum("smf,smf->sf", residuals, residuals)
        x = squares * self.bend
        if self.averaged:
            size = residuals.shape[1]
            limit = size + BAD_LINE * np.sqrt(2.0 * size)
            weight_along = np.minimum((1.0 + limit * self.bend) / (1.0 + x), 1.0)
            return np.asarray(np.sqrt(self.information * weight_along)[:, None, None, :] * slopes)
        weight = np.sqrt(self.gain / (1.0 + x))
        across = np.sqrt(np.maximum(1.0 - x, 0.0) / (1.0 + x)) - 1.0
        share = np.divide(across, squares, out=np.zeros_like(squares), where=squares > 0.0)
        along = np.einsum("smf,skmf->skf", residuals, slopes)
        return np.asarray(
            weight[:, None, None, :] * (slopes + (share[:, None, :] * along)[:, :, None, :] * residuals[:, None])
        )


def estimated_tails(degrees_of_freedom: FloatArray, size: int) -> Tails:
    """Return the tails of lines whose covariance was estimated.

    ``degrees_of_freedom``: real degrees of freedom behind each covariance, infinite for a known one, shape (lines,).
    ``size``: number of real data of a line.
    """
    excess = excess_freedom(degrees_of_freedom, size)
    bend = 1.0 / excess
    return Tails(gain=1.0 + 2.0 * bend, bend=bend, information=1.0 - size / (excess + size + 2.0), averaged=False)


def student_tails(degrees_of_freedom: FloatArray, size: int, shape: float) -> Tails:
    """Return the tails of lines of which some may be bad: never lighter than ``estimated_tails``.

    ``degrees_of_freedom``, ``size``: as in ``estimated_tails``. ``shape``: degrees of freedom of the t density.
    """
    excess = excess_freedom(degrees_of_freedom, size)
    # The t density of an estimated covariance has excess + 2 degrees of freedom and (excess + 2) / excess of its scale.
    of_density = np.minimum(shape, excess + 2.0)
    bend = (1.0 + 2.0 / excess) / of_density
    curvature, variance = _averages(bend, excess, size)
    return Tails(gain=curvature / variance, bend=bend, information=curvature**2 / variance, averaged=True)


def excess_freedom(degrees_of_freedom: FloatArray, size: int) -> FloatArray:
    """Return by how much the degrees of freedom exceed the number of data of a line, at least a little."""
    return np.maximum(degrees_of_freedom - size, LEAST_EXCESS)


def _averages(bend: FloatArray, excess: FloatArray, size: int) -> tuple[FloatArray, FloatArray]:
    """Return curvature ``A`` and variance of the slope ``B`` of ``log(1 + bend d^2) / (2 bend)``, of each line.

    Both are averages over normal noise, over complex Wishart estimates of its covariance and over all directions of the
    model's derivatives, and 1 for a known covariance without bend. With ``q = size / 2`` channels and
    ``k = excess / 2 + 1`` the squared distance is ``excess (1 - u) / u``, ``u`` from a beta distribution of ``k`` and
    ``q``: Hotelling's in complex form (Giri, On the complex analogues of T^2- and R^2-tests, 1965).
    """
    channels = size // 2
    finite = np.minimum(excess, LARGEST_EXCESS)[:, None]
    k = 0.5 * finite + 1.0
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    # u = x^(4 / k) takes away the steep part of the density and what is left of a logarithm at 0; expm1 keeps the
    # digits of 1 - u.
    x = 0.5 * (1.0 + nodes)
    log = 4.0 * np.log(x) / k
    u, complement = np.exp(log), -np.expm1(log)
    density = weights * x**3 * complement ** (channels - 1)
    density /= density.sum(axis=1, keepdims=True)
    share = bend[:, None] * finite
    # Slope of log(1 + bend d^2) / bend to d^2, over u.
    slope = 1.0 / (u + share * complement)
    squared = np.sum(density * slope**2 * complement, axis=1)
    mean = np.sum(density * slope * (1.0 + (channels - 1) * u), axis=1)
    ratio = 0.5 * finite[:, 0] / (channels * k[:, 0])
    return ratio * (mean - share[:, 0] * squared), ratio * 0.5 * finite[:, 0] * squared


def _logarithm(x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return ``log(1 + x) / x`` and its derivative."""
    near, far = np.minimum(x, NEAR), np.maximum(x, NEAR)
    level = np.log1p(far) / far
    close = x < NEAR
    return (
        np.where(close, 1.0 - near / 2.0 + near**2 / 3.0 - near**3 / 4.0, level),
        np.where(close, -0.5 + 2.0 * near / 3.0 - 3.0 * near**2 / 4.0, (1.0 / (1.0 + far) - level) / far),
    )
