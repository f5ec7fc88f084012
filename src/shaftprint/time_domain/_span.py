"""What rows span, from the eigenvalues of their products: a fraction of the time of a decomposition of the rows."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from shaftprint.arrays import FloatArray

# Directions of which less than this share remains beside others say nothing of their own.
INDEPENDENT = 1e-5


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Span:
    """The space of rows that may depend on each other."""

    rows: FloatArray
    """The rows, shape (rows, length)."""
    turn: FloatArray
    """Weights of the rows in each vector of an orthonormal basis, shape (rows, rank)."""

    @classmethod
    def of(cls, rows: FloatArray, *, independent: float = INDEPENDENT) -> Self:
        """Return the span of rows; directions smaller than the given share of the largest are left out."""
        size = np.linalg.norm(rows, axis=1)
        scale = np.where(size > 0.0, size, 1.0)
        squares, vectors = np.linalg.eigh((rows @ rows.T) / np.outer(scale, scale))
        kept = squares > independent**2 * squares.max(initial=0.0)
        return cls(rows=rows, turn=vectors[:, kept] / np.sqrt(squares[kept]) / scale[:, None])

    @property
    def rank(self) -> int:
        """Number of independent directions."""
        return int(self.turn.shape[1])

    def explained(self, target: FloatArray) -> float:
        """Return the squared length of a vector, shape (length,), within the span."""
        return float(np.sum((self.turn.T @ (self.rows @ target)) ** 2))

    def shares(self, target: FloatArray) -> FloatArray:
        """Return the weights of the rows whose sum is nearest to a vector, shape (rows,)."""
        return np.asarray(self.turn @ (self.turn.T @ (self.rows @ target)))


def qr_reduced(rows: FloatArray) -> FloatArray:
    """Return rows with the same products with each other, but no longer than many, shape (rows, rows)."""
    if rows.shape[1] < rows.shape[0]:
        return np.pad(rows, ((0, 0), (0, rows.shape[0] - rows.shape[1])))
    triangle: FloatArray = np.linalg.qr(rows.T, mode="r")  # type: ignore[assignment]
    return triangle.T
