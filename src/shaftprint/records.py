"""Frozen dataclasses and models as JSON and back: what a file may hold is checked here, before a noun is made of it.

A noun that stands in a file is its own record: a dataclass whose arrays are ``Floats``, ``AnyFloats`` or ``TwoRows``
is a field of a ``Record`` like any number, and keeps by ``__post_init__`` what its numbers must be together.
"""

from typing import Annotated, Any, Final, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, GetCoreSchemaHandler, TypeAdapter, ValidationError
from pydantic_core import CoreSchema, core_schema

from shaftprint.arrays import FloatArray, frozen_complex, frozen_float
from shaftprint.notebook._shown import field_words

# Larger than anything on a ship in any unit, and small enough that products and squares stay numbers.
_LARGEST: Final = 1e30
MOST: Final = 100_000
"""A file with longer lists or texts was not written by the program."""

Number = Annotated[float, Field(allow_inf_nan=False, ge=-_LARGEST, le=_LARGEST)]
PositiveNumber = Annotated[float, Field(allow_inf_nan=False, gt=0.0, le=_LARGEST)]
NotNegativeNumber = Annotated[float, Field(allow_inf_nan=False, ge=0.0, le=_LARGEST)]
Text = Annotated[str, Field(max_length=MOST)]
Texts = Annotated[tuple[Text, ...], Field(max_length=MOST)]
Named = dict[Text, Number]


class Record(BaseModel):
    """A frozen part of a file; fields that it does not know are refused, in the dataclasses in it too."""

    model_config = ConfigDict(frozen=True, extra="forbid", ser_json_inf_nan="strings", defer_build=True)

    def __dir__(self) -> list[str]:
        """Return the words of the field; pydantic's stay out of what a session completes."""
        return field_words(super().__dir__(), BaseModel)


class _Numbers:
    """An array in a file: lists of numbers within lists, each as long as the others."""

    def __init__(self, *, is_bounded: bool) -> None:
        """Say whether every number must be finite; else it may be infinite."""
        self.is_bounded = is_bounded

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """Return how pydantic reads and writes it."""
        writes = core_schema.plain_serializer_function_ser_schema(self.lists)
        return core_schema.no_info_plain_validator_function(self.array, serialization=writes)

    def array(self, values: object) -> NDArray[Any]:
        """Return the read-only array of lists."""
        try:
            array = frozen_float(values)  # type: ignore[arg-type]
        except (TypeError, ValueError, OverflowError):
            raise ValueError("expected lists of numbers, each as long as the others, found others") from None
        # what is not there numpy takes for nan
        if array.size > MOST or not np.all(np.abs(array) <= (_LARGEST if self.is_bounded else np.inf)):
            kind = f"finite numbers up to {_LARGEST:g}" if self.is_bounded else "numbers"
            raise ValueError(f"expected at most {MOST} {kind}, found others")
        return array

    def lists(self, array: NDArray[Any]) -> Any:
        """Return an array as lists."""
        return array.tolist()


class _TwoRows(_Numbers):
    """A complex array in a file: its real parts, then its imaginary parts."""

    def array(self, values: object) -> NDArray[Any]:
        """Return the read-only complex array of two rows; an array is taken as it is."""
        if isinstance(values, np.ndarray):
            return frozen_complex(values)
        parts = super().array(values)
        if parts.ndim == 0 or len(parts) != 2:
            raise ValueError("expected two rows: real and imaginary parts")
        return frozen_complex(parts[0] + 1j * parts[1])

    def lists(self, array: NDArray[Any]) -> Any:
        """Return a complex array as two lists."""
        return [array.real.tolist(), array.imag.tolist()]


Floats: TypeAlias = Annotated[FloatArray, _Numbers(is_bounded=True)]
"""An array of finite numbers."""
AnyFloats: TypeAlias = Annotated[FloatArray, _Numbers(is_bounded=False)]
"""An array of numbers that may be infinite."""
TwoRows: TypeAlias = Annotated[NDArray[np.complex128], _TwoRows(is_bounded=True)]
"""A complex array of finite numbers."""


_Noun = TypeVar("_Noun")


def noun_of(kind: type[_Noun], content: object, *, named: str) -> _Noun:
    """Return a frozen dataclass of what stands in a JSON file; fields that it does not know are refused.

    Parameters
    ----------
    named
        What it is called where a field is wrong, such as ``truth``.

    Raises
    ------
    ValueError
        If a field is missing, not known or of another type; all of them are named.
    """
    try:
        # dataclasses take their settings from what holds them
        holder = TypeAdapter(dict[str, kind], config=ConfigDict(extra="forbid"))  # type: ignore[valid-type]
        return holder.validate_python({named: content})[named]
    except ValidationError as error:
        raise ValueError(faults(error)) from None


def faults(error: ValidationError, *, most: int | None = None) -> str:
    """Return which fields are wrong and why, in one line; one of a whole record names its fields itself."""
    every = error.errors()
    shown = [_fault(details["loc"], details["msg"].removeprefix("Value error, ")) for details in every[:most]]
    left_out = len(every) - len(shown)
    return "; ".join([*shown, f"and {left_out} more"] if left_out else shown)


def _fault(place: tuple[int | str, ...], words: str) -> str:
    return f"{'.'.join(map(str, place))}: {words}" if place else words
