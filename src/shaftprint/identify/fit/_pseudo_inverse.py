"""The inverse of an information matrix within the directions that the data tell something about."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray

# Directions whose scaled information is below this share of the largest are not identifiable at all.
RANK_TOLERANCE = 1e-12
# A number depends on such a direction when more than this share of its scaled slope lies in it.
LOST_SHARE = 1e-3


@dataclass(frozen=True, slots=True, eq=False)
class PseudoInverse:
    """Inverse of ``J J^T`` in the known directions, and the unknown ones."""

    inverse: FloatArray
    """Inverse in the known directions, shape (free, free)."""
    unknown: FloatArray
    """The other directions as columns, in units of ``1 / scale``, shape (free, lost)."""
    scale: FloatArray
    """Root of the information of each parameter alone, shape (free,)."""

    @classmethod
    def of(cls, rows: FloatArray) -> "PseudoInverse":
        """Return the inverse for derivatives ``J`` of shape (free, rows)."""
        information = rows @ rows.T
        scale = np.sqrt(np.diag(information))
        scale[scale == 0.0] = 1.0
        values, vectors = np.linalg.eigh(information / np.outer(scale, scale))
        informed = values > RANK_TOLERANCE * values[-1]
        inverse = (vectors[:, informed] / values[informed]) @ vectors[:, informed].T / np.outer(scale, scale)
        return cls(inverse=inverse, unknown=vectors[:, ~informed], scale=scale)

    @property
    def lost(self) -> BoolArray:
        """Which parameters take part in an unknown direction, shape (free,)."""
        return np.asarray(np.linalg.norm(self.unknown, axis=1) > LOST_SHARE)

    def knows(self, slopes: FloatArray) -> bool:
        """Return whether a number with these slopes, shape (free,), depends on known directions only."""
        scaled = slopes / self.scale
        return bool(np.linalg.norm(self.unknown.T @ scaled) <= LOST_SHARE * np.linalg.norm(scaled))
