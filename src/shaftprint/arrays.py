"""Names for array types, read-only arrays for the values that rooms hand on, and parts of arrays."""

from collections.abc import Sequence
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray: TypeAlias = NDArray[np.float64]
ComplexArray: TypeAlias = NDArray[np.complex128]
RealOrComplexArray: TypeAlias = FloatArray | ComplexArray
BoolArray: TypeAlias = NDArray[np.bool_]
IntArray: TypeAlias = NDArray[np.int64]
_Kind = TypeVar("_Kind", bound=np.generic)


def frozen_float(values: ArrayLike) -> FloatArray:
    """Return the values as a read-only array of float64, without a copy where none is needed."""
    array = np.asarray(values, dtype=np.float64).view()
    array.flags.writeable = False
    return array


def frozen_complex(values: ArrayLike) -> ComplexArray:
    """Return the values as a read-only array of complex128, without a copy where none is needed."""
    array = np.asarray(values, dtype=np.complex128).view()
    array.flags.writeable = False
    return array


def frozen_bool(values: ArrayLike) -> BoolArray:
    """Return the values as a read-only array of bool, without a copy where none is needed."""
    array = np.asarray(values, dtype=np.bool_).view()
    array.flags.writeable = False
    return array


def block_of(matrix: ArrayLike, order: Sequence[str], names: Sequence[str]) -> FloatArray:
    """Return rows and columns of a square matrix by their names, shape (names, names).

    ``order``: the names of all of them. Raises ValueError if it has not one of the names.
    """
    places = [order.index(name) for name in names]
    return np.asarray(matrix, dtype=np.float64).reshape(len(order), len(order))[np.ix_(places, places)]


def known_part(covariance: FloatArray) -> FloatArray:
    """Return a covariance with zeros for all of which nothing is known, those of infinite variance."""
    lost = ~np.isfinite(np.diag(covariance))
    return np.where(lost[:, None] | lost[None, :], 0.0, covariance)


def correlation_of(covariance: FloatArray) -> FloatArray:
    """Return the correlation of a covariance; nan where a variance is infinite."""
    std = np.sqrt(np.diag(covariance))
    std[np.isinf(std)] = np.nan
    return np.asarray(covariance / np.outer(std, std))


def in_blocks(values: NDArray[_Kind], length: int) -> NDArray[_Kind]:
    """Return values in blocks of one length, shape (blocks, length); what is left at the end does not count."""
    count = values.size // length
    return values[: count * length].reshape(count, length)


def runs_of(wanted: BoolArray) -> list[tuple[int, int]]:
    """Return the first place and that after the last of every run that is true, in order."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], wanted, [False]])))
    return [(first, stop) for first, stop in edges.reshape(-1, 2).tolist()]
