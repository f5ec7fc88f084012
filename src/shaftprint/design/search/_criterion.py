"""What a plan makes small: one number from the covariance that a test would give, with its gradient.

A criterion is a function of ``V = G^T M^-1 G``, the covariance of the wanted numbers, which for information ``F_k`` of
a line with the weight ``w_k`` changes by ``-G^T M^-1 F_k M^-1 G dw_k``. So its gradient is ``-tr(B F_k)`` with a
positive semi-definite ``B`` (Pukelsheim, Optimal Design of Experiments, 2006, chapters 6 and 7).
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray


class Criterion(ABC):
    """What a plan makes small."""

    __slots__ = ()

    @abstractmethod
    def value_and_weight(self, inverse: FloatArray, slopes: FloatArray) -> tuple[float, FloatArray]:
        """Return the criterion and ``B``.

        ``inverse``: covariance of the free parameters, shape (free, free). ``slopes``: derivatives of the wanted
        numbers, over their targets or values, to the free parameters, shape (free, numbers).
        """


@dataclass(frozen=True, slots=True)
class WorstWish(Criterion):
    """Logarithm of the p-norm of deviations over wishes, near that of the worst one but smooth."""

    power: float = 12.0
    """``p``."""

    def value_and_weight(self, inverse: FloatArray, slopes: FloatArray) -> tuple[float, FloatArray]:
        """Return ``log(sum r^p) / p`` of the ratios ``r`` and ``B = sum_q (share_q / 2 v_q) m_q m_q^T``."""
        columns = inverse @ slopes
        variances = np.einsum("fq,fq->q", slopes, columns)
        logs = 0.5 * self.power * np.log(variances)
        highest = logs.max()
        powers = np.exp(logs - highest)
        value = float((highest + np.log(powers.sum())) / self.power)
        shares = powers / powers.sum()
        return value, np.asarray((columns * (0.5 * shares / variances)) @ columns.T)


@dataclass(frozen=True, slots=True)
class DeterminantWithFloor(Criterion):
    """Mean logarithm of the half axes of the numbers' ellipsoid, each number with a floor of its own added.

    ``log det(V + floor^2 I) / 2 q``: D-optimal for ``q`` numbers far above the floor (Pukelsheim, section 6.2), and
    with no gain from a number that is known better.
    """

    floor: float
    """Deviation below which nothing is gained, in the units of the scaled numbers."""

    def value_and_weight(self, inverse: FloatArray, slopes: FloatArray) -> tuple[float, FloatArray]:
        """Return the criterion and ``B = M^-1 G (V + floor^2 I)^-1 G^T M^-1 / 2 q``."""
        columns = inverse @ slopes
        count = slopes.shape[1]
        covariance = slopes.T @ columns + self.floor**2 * np.eye(count)
        _, logarithm = np.linalg.slogdet(covariance)
        return float(logarithm) / (2.0 * count), np.asarray(
            columns @ np.linalg.solve(covariance, columns.T) / (2.0 * count)
        )
