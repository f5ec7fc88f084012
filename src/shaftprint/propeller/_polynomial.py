"""A polynomial in advance ratio and pitch ratio, with its slopes."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Polynomial:
    """A sum of ``c (P/D)^x J^y``."""

    coefficient: FloatArray
    """``c`` of each term, shape (terms,)."""
    pitch_power: FloatArray
    """``x`` of each term, shape (terms,)."""
    advance_power: FloatArray
    """``y`` of each term, shape (terms,)."""

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for name in ("coefficient", "pitch_power", "advance_power"):
            object.__setattr__(self, name, frozen_float(getattr(self, name)))

    def value(self, advance: FloatArray, pitch_ratio: FloatArray) -> FloatArray:
        """Return the polynomial, shape of the arguments; complex for complex arguments."""
        return self._sum(advance, pitch_ratio, self.coefficient, self.pitch_power, self.advance_power)

    def advance_slope(self, advance: FloatArray, pitch_ratio: FloatArray) -> FloatArray:
        """Return the derivative to ``J``, shape of the arguments."""
        lower = np.maximum(self.advance_power - 1.0, 0.0)
        return self._sum(advance, pitch_ratio, self.coefficient * self.advance_power, self.pitch_power, lower)

    def pitch_slope(self, advance: FloatArray, pitch_ratio: FloatArray) -> FloatArray:
        """Return the derivative to ``P/D``, shape of the arguments."""
        lower = np.maximum(self.pitch_power - 1.0, 0.0)
        return self._sum(advance, pitch_ratio, self.coefficient * self.pitch_power, lower, self.advance_power)

    def powers_of_advance(self, pitch_ratio: float) -> FloatArray:
        """Return the coefficients of ``J^0, J^1, ...`` at one pitch ratio, shape (powers,)."""
        coefficients = np.zeros(int(self.advance_power.max()) + 1)
        np.add.at(coefficients, self.advance_power.astype(np.int64), self.coefficient * pitch_ratio**self.pitch_power)
        return coefficients

    @staticmethod
    def _sum(
        advance: FloatArray, pitch_ratio: FloatArray, coefficient: FloatArray, pitch: FloatArray, power: FloatArray
    ) -> FloatArray:
        terms = np.asarray(pitch_ratio)[..., None] ** pitch * np.asarray(advance)[..., None] ** power
        return np.asarray((coefficient * terms).sum(axis=-1))


def polynomial(terms: Sequence[Sequence[float]]) -> Polynomial:
    """Return the polynomial of terms (power of ``P/D``, power of ``J``, coefficient)."""
    table = np.array(terms)
    return Polynomial(coefficient=table[:, 2], pitch_power=table[:, 0], advance_power=table[:, 1])
