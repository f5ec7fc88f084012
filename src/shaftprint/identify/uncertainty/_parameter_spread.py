"""How the free parameters of one structure scatter, as far as the data fix them."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, known_part
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._covariance import known_covariance
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._pseudo_inverse import LOST_SHARE
from shaftprint.models._structure import Structure


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ParameterSpread:
    """Values of a structure's parameters, and how its free ones scatter."""

    structure: Structure
    """The structure."""
    values: FloatArray
    """All its parameters, shape (parameters,)."""
    covariance: FloatArray
    """Covariance of its free parameters within the known directions, shape (free, free)."""
    unknown: FloatArray
    """The other directions as columns, in units of ``1 / scale``, shape (free, lost)."""
    scale: FloatArray
    """Root of the information of each parameter alone, shape (free,)."""

    @classmethod
    def of_covariance(cls, structure: Structure, values: FloatArray, covariance: FloatArray) -> "ParameterSpread":
        """Return the spread that a covariance describes; nothing is known of a parameter of infinite variance."""
        lost = ~np.isfinite(np.diag(covariance))
        size = np.sqrt(np.where(lost, 1.0, np.diag(covariance)))
        scale = 1.0 / np.where(size > 0.0, size, 1.0)
        return cls(
            structure=structure,
            values=values,
            covariance=known_part(covariance),
            unknown=np.eye(lost.size)[:, lost],
            scale=scale,
        )

    def deviation(self, slopes: FloatArray) -> FloatArray:
        """Return standard deviations to first order for slopes of shape (free, ...); nan where the data fix nothing."""
        variance = np.einsum("i...,ij,j...->...", slopes, self.covariance, slopes)
        scaled = slopes / self.scale.reshape(-1, *(1,) * (slopes.ndim - 1))
        along = np.linalg.norm(np.tensordot(self.unknown, scaled, axes=(0, 0)), axis=0)
        informed = along <= LOST_SHARE * np.linalg.norm(scaled, axis=0)
        return np.sqrt(np.where(informed, np.maximum(variance, 0.0), np.nan))


def spread_of(identification: Identification, experiment: int = 0) -> ParameterSpread:
    """Return the spread of the parameters of one experiment's structure.

    Raises IdentificationError if there is no experiment of that number.
    """
    objective = identification.objective
    if not 0 <= experiment < len(objective.terms):
        raise IdentificationError(f"experiment {experiment}: expected a number from 0 to {len(objective.terms) - 1}.")
    one = objective.terms[experiment]
    covariance, information = known_covariance(objective, identification.values[list(objective.free)])
    columns = list(one.columns)
    return ParameterSpread(
        structure=one.structure,
        values=one.structure_values(identification.values),
        covariance=covariance[np.ix_(columns, columns)],
        unknown=information.unknown[columns],
        scale=information.scale[columns],
    )
