"""What is validated: a structure with its values, how well they are known, and what they were identified from."""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, block_of, frozen_float, known_part
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.likelihood._fitted_response import FittedResponse
from shaftprint.models._structure import Structure
from shaftprint.notebook._shown import Shown


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Model(Shown):
    """A structure with its values, how well they are known, and what they were identified from."""

    name: str
    """What it is called."""
    structure: Structure
    """The structure, from ``n_set`` to ``n`` and ``M_s``."""
    values: FloatArray
    """All its parameters, shape (parameters,)."""
    covariance: FloatArray
    """Covariance of its free parameters, shape (free, free); zero where nothing is stated."""
    used: tuple[str, ...] = ()
    """Names of the tests that it was identified from."""
    not_known: tuple[str, ...] = ()
    """Free parameters of which the data say nothing: no band holds them."""

    @property
    def has_uncertainty(self) -> bool:
        """Whether anything is stated about how well the parameters are known."""
        return bool(np.any(self.covariance > 0.0))


def model_of(structure: Structure, values: Mapping[str, float] | None = None, *, name: str | None = None) -> Model:
    """Return a model with stated values and nothing about how well they are known, such as one of the thesis' sets.

    ``values``: values by name; those not named take their default. ``name``: what it is called; the structure's name by
    default. Raises StructureError if a name is not a parameter of the structure.
    """
    free = len(structure.free)
    return Model(
        name=name or structure.name,
        structure=structure,
        values=frozen_float(structure.vector(values or {})),
        covariance=frozen_float(np.zeros((free, free))),
    )


def identified_model(identification: Identification, *, used: Collection[str] = ()) -> Model:
    """Return the model that an identification found, the first of a joint fit.

    ``identification``: the fit; the lines and records that it was fitted to count as used. ``used``: names of further
    tests that it was made with, which it does not know of.
    """
    structure = identification.structure
    names = [estimate.name for estimate in identification.parameters]
    covariance = block_of(identification.covariance, names, [parameter.name for parameter in structure.free])
    return Model(
        name=structure.name,
        structure=structure,
        values=identification.structure_values(),
        covariance=frozen_float(known_part(covariance)),
        used=tuple(dict.fromkeys([*_seen(identification), *used])),
        not_known=tuple(
            p.name for p, variance in zip(structure.free, np.diag(covariance), strict=True) if not np.isfinite(variance)
        ),
    )


def _seen(identification: Identification) -> Iterator[str]:
    """Yield the names of the lines and records of a fit."""
    for part in identification.parts:
        if isinstance(part, FittedResponse):
            yield from (name for name, fitted in zip(part.response.lines, part.fitted, strict=True) if fitted)
        else:
            yield part.name
