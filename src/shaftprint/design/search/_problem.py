"""The design as a smooth function of the complex amplitudes of all lines, with its exact gradient.

Each leg's lines are scaled so that the p-norm of all uses of its bounds is one. The function therefore does not change
when a leg's amplitudes are multiplied by a number, and has no constraints.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.design.search._criterion import Criterion
from shaftprint.design.search._uses import Uses


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Possibility:
    """Information of the lines for one possible ship."""

    of_lines: tuple[FloatArray, ...]
    """Information of each line of each leg, for a unit of amplitude over a second, shape (lines, free, free)."""
    of_priors: FloatArray
    """Information of the priors, shape (free, free)."""
    slopes: FloatArray
    """Derivatives of the wanted numbers, scaled, to the free parameters, shape (free, numbers)."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Problem:
    """What is made small over the amplitudes of all legs."""

    possibilities: tuple[Possibility, ...]
    """Possible ships; the criterion is their mean."""
    uses: tuple[Uses, ...]
    """Uses of the bounds, of each leg."""
    seconds: tuple[float, ...]
    """Length of the window of each leg [s]."""
    criterion: Criterion
    """What is made small."""
    power: float
    """Power of the norm of the uses."""

    def split(self, unknowns: FloatArray) -> list[ComplexArray]:
        """Return the complex amplitudes of each leg, from real parts and imaginary parts leg by leg."""
        amplitudes, start = [], 0
        for use in self.uses:
            count = len(use.harmonics)
            real, imaginary = unknowns[start : start + count], unknowns[start + count : start + 2 * count]
            amplitudes.append(real + 1j * imaginary)
            start += 2 * count
        return amplitudes

    def value_and_gradient(self, unknowns: FloatArray) -> tuple[float, FloatArray]:
        """Return the criterion and its derivatives to the unknowns, shape (unknowns,)."""
        legs = self.split(unknowns)
        norms = [use.norm(leg, self.power) for use, leg in zip(self.uses, legs, strict=True)]
        weights = [
            seconds * np.abs(leg) ** 2 / norm**2
            for seconds, leg, (norm, _) in zip(self.seconds, legs, norms, strict=True)
        ]
        value, slopes = self._criterion(weights)
        parts = []
        for leg, seconds, (norm, norm_slope), weight, slope in zip(
            legs, self.seconds, norms, weights, slopes, strict=True
        ):
            gradient = 2.0 * seconds / norm**2 * slope * leg - (2.0 / norm * float(slope @ weight)) * norm_slope
            parts += [gradient.real, gradient.imag]
        return value, np.concatenate(parts)

    def _criterion(self, weights: list[FloatArray]) -> tuple[float, list[FloatArray]]:
        """Return the mean criterion and its derivatives to the weights of the lines of each leg."""
        values = []
        slopes = [np.zeros_like(weight) for weight in weights]
        for possibility in self.possibilities:
            information = possibility.of_priors + sum(
                np.tensordot(weight, lines, axes=1) for weight, lines in zip(weights, possibility.of_lines, strict=True)
            )
            value, positive = self.criterion.value_and_weight(inverse_of(information), possibility.slopes)
            values.append(value)
            for slope, lines in zip(slopes, possibility.of_lines, strict=True):
                slope -= np.tensordot(lines, positive, axes=2) / len(self.possibilities)
        return float(np.mean(values)), slopes


def inverse_of(information: FloatArray) -> FloatArray:
    """Return the inverse of an information matrix, each parameter scaled by its own information before."""
    scale = np.sqrt(np.diag(information))
    inverse: FloatArray = np.linalg.inv(information / np.outer(scale, scale)) / np.outer(scale, scale)
    return inverse
