"""Attributes of variables and files of NetCDF and HDF5, as text or number."""

from collections.abc import Mapping
from typing import Any

import numpy as np


def plain(value: Any) -> object:
    """Return an attribute as text or number, as far as it is one."""
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    array = np.asarray(value)
    if array.size == 1 and array.dtype.kind in "fiu":
        return float(array.ravel()[0])
    if array.size == 1 and array.dtype.kind in "SO":
        first = array.ravel()[0]
        return first.decode("utf-8", "replace") if isinstance(first, bytes) else str(first)
    return str(value)


def numbers_among(attributes: Mapping[str, Any]) -> dict[str, float]:
    """Return the attributes that are one number, by their names in small letters; those of a library are left out."""
    values = {name.lower(): plain(value) for name, value in attributes.items() if not name.startswith("_")}
    return {name: float(value) for name, value in values.items() if isinstance(value, int | float)}
