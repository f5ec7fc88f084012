"""How large the orders of one window are, from what is no test line, and what that costs a line.

Two numbers an order are found by least squares at the Fourier bins of its band, each weighted with the noise around
it, without the test lines: what a line and an order have in common is left to the line. That is the joint fit of lines
and orders (Frisch and Waugh, "Partial time regressions as compared with individual trends", Econometrica 1 (1933)).
What is then taken off at a line is known as well as the order is: its variance is added to that of the line. Where line
and order are the same wave, as a sine at the shaft order at constant speed, nothing of the order is known besides the
line, and the line has next to no weight.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray

# An order larger than the mean torque would turn the shaft backwards: the deviation of its parts beforehand.
_LARGEST = 1.0
# Bins over which the noise around a bin is averaged.
_AROUND_BINS = 41
_ROUNDS = 3
_FLAT = 1e-6
# Of a bin that the orders explain altogether nothing can be said of the noise.
_MOST_TAKEN = 0.9


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class OrderFit:
    """Orders of one window over the load."""

    coefficient: FloatArray
    """Cosine and sine part of each order over the torque of the working point, shape (waves,)."""
    covariance: FloatArray
    """Their covariance, shape (waves, waves)."""
    taken: FloatArray
    """Share of the noise of each bin that the fit has taken with it, shape (bins,): they add up to half the number of
    coefficients, one degree of freedom each."""

    def variance_at(self, waves: ComplexArray) -> float:
        """Return the variance ``E|a|^2`` of what was taken off at a line.

        ``waves``: complex amplitudes that the waves of the orders have at the line, shape (waves,).
        """
        return float((waves @ self.covariance @ waves.conj()).real)


def fit_orders(torque: ComplexArray, waves: ComplexArray, chosen: BoolArray) -> OrderFit:
    """Find the orders in the Fourier amplitudes of the torque.

    ``torque``: Fourier amplitudes of the torque, over the working point, without the test lines, shape (bins,).
    ``waves``: those of the waves of the orders, shape (waves, bins). ``chosen``: bins to use: bands of the orders
    without test lines, shape (bins,).
    """
    places = np.flatnonzero(chosen)
    values, columns = torque[places], waves[:, places]
    # flat at first, and so small that what is known beforehand does not count
    power = np.full(places.size, _FLAT * np.mean(np.abs(values) ** 2) + np.finfo(np.float64).tiny)
    taken = np.zeros(places.size)
    for _ in range(_ROUNDS):
        information = (columns / power) @ columns.conj().T
        # a real coefficient has real and imaginary part of each bin as data, each with half of the power
        covariance = np.linalg.inv(2.0 * information.real + np.eye(len(columns)) / _LARGEST**2)
        coefficient = 2.0 * covariance @ ((columns.conj() / power) @ values).real
        taken = np.einsum("ib,ij,jb->b", columns, covariance, columns.conj()).real / power
        rest = np.abs(values - coefficient @ columns) ** 2
        power = _around(rest / (1.0 - np.minimum(taken, _MOST_TAKEN)))
    of_all = np.zeros(torque.size)
    of_all[places] = np.minimum(taken, _MOST_TAKEN)
    return OrderFit(coefficient=coefficient, covariance=covariance, taken=of_all)


def _around(power: FloatArray) -> FloatArray:
    """Return the mean power around each bin, shape (bins,)."""
    reach = np.ones(_AROUND_BINS)
    total = np.convolve(power, reach, mode="full")
    count = np.convolve(np.ones(power.size), reach, mode="full")
    half = _AROUND_BINS // 2
    mean: FloatArray = (total / count)[half : half + power.size]
    return np.maximum(mean, np.finfo(np.float64).tiny)
