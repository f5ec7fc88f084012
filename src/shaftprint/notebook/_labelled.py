"""Data of a noun with names, units and meanings, as pandas and xarray hold them."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.notebook._library import library

if TYPE_CHECKING:
    from pandas import DataFrame
    from xarray import Dataset


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Variable:
    """An array with the names of its dimensions."""

    dims: tuple[str, ...]
    """Names of the dimensions; those that are rows of the table in the order of ``rows``."""
    values: NDArray[Any]
    """The numbers or texts, one axis a dimension."""
    unit: str = ""
    """Unit; none for texts, ``-`` for a number without unit."""
    meaning: str = ""
    """What it is."""

    @property
    def attributes(self) -> dict[str, str]:
        """Unit and meaning by the names that plots of xarray look for."""
        texts = {"units": self.unit, "long_name": self.meaning}
        return {name: text for name, text in texts.items() if text}


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LabelledData:
    """What a noun holds, for packages that know arrays with labels."""

    rows: tuple[str, ...]
    """Dimensions that become the rows of a table."""
    variables: Mapping[str, Variable]
    """What was measured or found, by name."""
    coordinates: Mapping[str, Variable]
    """What stands along the dimensions, by name; one for each row dimension of its name."""
    attributes: Mapping[str, Any] = field(default_factory=dict)
    """Facts on the whole."""

    def dataset(self) -> "Dataset":
        """Return everything as a dataset of xarray.

        Raises ExportError if xarray is not installed.
        """
        xarray = library("xarray", "to_xarray")

        def arrays(variables: Mapping[str, Variable]) -> dict[str, Any]:
            # copies: the arrays of a noun are read-only, and stay so
            return {name: (one.dims, np.array(one.values), one.attributes) for name, one in variables.items()}

        dataset: Dataset = xarray.Dataset(
            arrays(self.variables), coords=arrays(self.coordinates), attrs=dict(self.attributes)
        )
        return dataset

    def frame(self) -> "DataFrame":
        """Return what has the dimensions of the rows as a table of pandas; ``attrs`` holds units and meanings.

        Raises ExportError if pandas is not installed.
        """
        pandas = library("pandas", "to_pandas")
        shape = tuple(self.coordinates[name].values.size for name in self.rows)
        along = [self.coordinates[name].values for name in self.rows]
        index = pandas.MultiIndex.from_product(along, names=self.rows) if len(along) > 1 else None
        every = {name: one for name, one in self.coordinates.items() if name not in self.rows} | dict(self.variables)
        columns = {name: one for name, one in every.items() if set(one.dims) <= set(self.rows)}
        frame: DataFrame = pandas.DataFrame(
            {name: _along(one, self.rows, shape).ravel() for name, one in columns.items()},
            index=pandas.Index(along[0], name=self.rows[0]) if index is None else index,
        )
        frame.attrs = {
            **self.attributes,
            "units": {name: one.unit for name, one in columns.items() if one.unit},
            "meanings": {name: one.meaning for name, one in columns.items() if one.meaning},
        }
        return frame


def _along(variable: Variable, rows: tuple[str, ...], shape: tuple[int, ...]) -> NDArray[Any]:
    """Return a variable repeated along the rows that it does not have, shape (rows)."""
    lengths = dict(zip(variable.dims, variable.values.shape, strict=True))
    return np.array(np.broadcast_to(variable.values.reshape([lengths.get(name, 1) for name in rows]), shape))


class Labelled(ABC):
    """A noun that holds data which pandas and xarray can take over."""

    __slots__ = ()

    @abstractmethod
    def labelled(self) -> LabelledData:
        """Return its data with their labels."""

    def to_xarray(self) -> "Dataset":
        """Return its data as a dataset of xarray: dimensions by name, units and meanings as attributes.

        Raises ExportError if xarray is not installed.
        """
        return self.labelled().dataset()

    def to_pandas(self) -> "DataFrame":
        """Return its data as a table of pandas, with ``attrs["units"]`` and ``attrs["meanings"]`` by column.

        What does not fit the rows of one table, such as a covariance, is in ``to_xarray`` only.

        Raises ExportError if pandas is not installed.
        """
        return self.labelled().frame()
