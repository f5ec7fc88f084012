"""Names for array types, and read-only arrays for the values that rooms hand on."""

from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray: TypeAlias = NDArray[np.float64]
ComplexArray: TypeAlias = NDArray[np.complex128]
RealOrComplexArray: TypeAlias = FloatArray | ComplexArray
BoolArray: TypeAlias = NDArray[np.bool_]
IntArray: TypeAlias = NDArray[np.int64]


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
