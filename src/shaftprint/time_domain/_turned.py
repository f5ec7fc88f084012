"""Rows made as short as they can be."""

import numpy as np

from shaftprint.arrays import FloatArray


def turned(rows: FloatArray) -> FloatArray:
    """Return rows of the same products with each other that are no longer than many, shape (rows, rows)."""
    if rows.shape[1] < rows.shape[0]:
        return np.pad(rows, ((0, 0), (0, rows.shape[0] - rows.shape[1])))
    triangle: FloatArray = np.linalg.qr(rows.T, mode="r")  # type: ignore[assignment]
    return triangle.T
