"""What the attributes of a NetCDF variable say of its counts: their sign, their range and which of them are no values.

The rules are those of the NetCDF Users Guide, appendix A, "Attribute Conventions".
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

# of netcdf.h: what the library writes where nothing was written; a byte has none, as each of its values may be meant
_NEVER_WRITTEN = {"f4": 9.969209968386869e36, "f8": 9.969209968386869e36, "i2": -32767, "i4": -2147483647}
_NEVER_WRITTEN |= {"u2": 65535, "u4": 4294967295}


def never_written(dtype: np.dtype[Any]) -> float | None:
    """Return the count that the NetCDF library writes where nothing was written, None of types that have none."""
    return _NEVER_WRITTEN.get(f"{dtype.kind}{dtype.itemsize}")


@dataclass(frozen=True, kw_only=True, slots=True)
class CountRule:
    """Which counts of a variable are values."""

    scale: float
    """Unit per count."""
    offset: float
    """Value of count zero."""
    is_unsigned: bool = False
    """Whether the counts have no sign, whatever their type says."""
    fills: tuple[float, ...] = ()
    """Counts that are no values."""
    lowest: float = -np.inf
    """Lowest count that is a value."""
    highest: float = np.inf
    """Highest count that is a value."""

    @classmethod
    def of(cls, attributes: Mapping[str, Any], dtype: np.dtype[Any], *, unwritten: float | None = None) -> Self:
        """Return the rule of a variable by its attributes; ``unwritten`` is no value where no attribute says another.

        Raises ValueError if an attribute holds no number.
        """
        numbers = {name: np.asarray(attributes[name]).ravel() for name in _NUMBERS if name in attributes}
        scale, offset = (float(numbers[key][0]) if key in numbers else usual for key, usual in _PACKED)
        unsigned = dtype.kind == "i" and _text(attributes.get("_Unsigned")).lower() == "true"
        wrap = float(2 ** (8 * dtype.itemsize)) if unsigned else 0.0
        fills = [value for key in ("_FillValue", "missing_value") if key in numbers for value in numbers[key]]
        if "_FillValue" not in numbers and unwritten is not None:
            fills.append(np.asarray(unwritten))
        bounds = [-np.inf, np.inf]
        for key, sides in (("valid_range", (0, 1)), ("valid_min", (0,)), ("valid_max", (1,))):
            if key in numbers and numbers[key].size == len(sides):
                in_unit = _is_in_unit(numbers[key], dtype, scale, offset)
                for side, bound in zip(sides, numbers[key], strict=True):
                    # the lowest value has the highest count where the scale is negative
                    at = 1 - side if in_unit and scale < 0.0 else side
                    bounds[at] = (float(bound) - offset) / scale if in_unit else _wrapped(float(bound), wrap)
        return cls(
            scale=scale,
            offset=offset,
            is_unsigned=unsigned,
            fills=tuple(_wrapped(float(value), wrap) for value in fills),
            lowest=bounds[0],
            highest=bounds[1],
        )

    def values(self, counts: NDArray[Any]) -> NDArray[Any]:
        """Return counts as they are where all are values and ``int16``, else as numbers, NaN where they are none."""
        if self.is_unsigned:
            counts = counts.astype(counts.dtype.newbyteorder("=")).view(f"u{counts.dtype.itemsize}")
        has_rule = self.fills or np.isfinite(self.lowest) or np.isfinite(self.highest)
        if counts.dtype.kind == "i" and counts.dtype.itemsize == 2 and not has_rule:
            return counts.astype(np.int16)
        values = counts.astype(np.float64)
        is_none = (values < self.lowest) | (values > self.highest)
        for fill in self.fills:
            is_none |= values == fill
        values[is_none] = np.nan
        return values


_PACKED = (("scale_factor", 1.0), ("add_offset", 0.0))
_NUMBERS = ("scale_factor", "add_offset", "_FillValue", "missing_value", "valid_range", "valid_min", "valid_max")


def _is_in_unit(bounds: NDArray[Any], dtype: np.dtype[Any], scale: float, offset: float) -> bool:
    """Return whether bounds are meant in the unit: real ones of packed whole counts are."""
    return dtype.kind in "iu" and bounds.dtype.kind == "f" and (scale != 1.0 or offset != 0.0)


def _wrapped(count: float, wrap: float) -> float:
    return count + wrap if wrap and count < 0.0 else count


def _text(value: Any) -> str:
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)
