"""What a test cannot see: the changes of the parameters that leave every response unchanged.

The sensitivity of the exact response to the free parameters is taken over a wide grid of frequencies, at random points
between the bounds. A change of the parameters is lost where the sensitivity maps it to zero; what is lost at random
points is lost everywhere but at exceptional values (Rothenberg, Identification in parametric models, 1971: the rank
decides whether parameters are identifiable near a point; whether a distant set gives the same response it cannot say).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._block import Block
from shaftprint.models._structure import Structure

# From below the slowest line of a ship to what no logger sees; rows are scaled, so the width costs nothing.
OMEGA_RAD_S = np.geomspace(1e-3, 1e4, 120)
# A block of one's own may have numerical derivatives. They are right to eleven digits only where the response is no
# steeper in a parameter than this, d ln H / d ln p: that of a delay at high frequency is.
STEEPEST = 3.0
FEWEST_ROWS = 2
POINTS = 4
# Share of the range between the bounds that points keep away from each bound.
MARGIN = 0.1
# Relative singular value below which a direction is lost. True ones stay above 1e-7 in the shipped structures, rounding
# leaves 1e-14, numerical derivatives 1e-11.
TOLERANCE = 1e-11
NUMERICAL_TOLERANCE = 1e-9
SCALING_ROUNDS = 4
# A parameter takes part in a lost direction when its scaled component exceeds this.
LOST_SHARE = 1e-5


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class NullSpace:
    """Directions of the free parameters that change no response, at several points."""

    structure: Structure
    """The structure."""
    table: FloatArray
    """All parameters at each point, shape (points, parameters)."""
    scale: FloatArray
    """Change of each free parameter that is one in scaled coordinates, shape (points, free)."""
    basis: FloatArray
    """Orthonormal directions in scaled coordinates, shape (points, free, lost)."""

    @property
    def rank(self) -> int:
        """Number of independent numbers that the responses fix."""
        return int(self.basis.shape[1] - self.basis.shape[2])

    def of_lost(self) -> BoolArray:
        """Return which free parameters take part in a lost direction, shape (free,)."""
        return np.asarray(np.linalg.norm(self.basis, axis=2).max(axis=0) > LOST_SHARE)


def null_space(structure: Structure, outputs: Sequence[str], rng: np.random.Generator) -> NullSpace:
    """Return what cannot be found of a structure's free parameters from some of its outputs.

    Raises StructureError if no parameter is free, or the response is finite nowhere.
    """
    if not structure.free:
        raise StructureError(f"structure {structure.name} has no free parameter: free one with free_between().")
    table = np.stack([_random_point(structure, rng) for _ in range(POINTS)])
    null_spaces = [null_directions(structure, outputs, values) for values in table]
    # At an exceptional point more is lost than elsewhere.
    fewest = min(directions.shape[1] for _, directions in null_spaces)
    kept = [row for row, (_, directions) in enumerate(null_spaces) if directions.shape[1] == fewest]
    return NullSpace(
        structure=structure,
        table=table[kept],
        scale=np.stack([null_spaces[row][0] for row in kept]),
        basis=np.stack([null_spaces[row][1] for row in kept]),
    )


def null_directions(structure: Structure, outputs: Sequence[str], values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the scale of each free parameter and the lost directions at one point, in that scale, as columns.

    Raises StructureError if the response is finite nowhere.
    """
    rows = _relative_sensitivity(structure, outputs, values)
    scale = np.array([p.upper - p.lower for p in structure.free])
    rows = rows * scale
    # Every frequency counts alike, and so does every parameter: the rank is then as clear as it can be. Both parts of a
    # complex row have one scale, because one of them may be nothing but rounding.
    for _ in range(SCALING_ROUNDS):
        rows = rows / _nonzero(np.abs(rows).max(axis=1, keepdims=True))
        columns = _nonzero(np.linalg.norm(rows, axis=0))
        rows, scale = rows / columns, scale / columns
    # Rows of zeros, so that there are as many directions as parameters however few frequencies are left.
    padding = np.zeros((len(structure.free), len(structure.free)))
    _, singular, right = np.linalg.svd(np.concatenate([rows.real, rows.imag, padding]), full_matrices=False)
    tolerance = NUMERICAL_TOLERANCE if _is_numerical(structure) else TOLERANCE
    rank = int(np.sum(singular > tolerance * singular[0])) if singular[0] > 0.0 else 0
    return scale, right[rank:].T


def _relative_sensitivity(structure: Structure, outputs: Sequence[str], values: FloatArray) -> ComplexArray:
    """Return the derivatives over the response, shape (channels and frequencies, free)."""
    with np.errstate(all="ignore"):
        response, gradient = structure.gradient(values, 1j * OMEGA_RAD_S)
        relative = gradient / response
    wanted = [row for row, (output, _) in enumerate(structure.channels) if output in outputs]
    table = relative[:, wanted].reshape(len(structure.free), -1).T
    rows: ComplexArray = table[np.isfinite(table).all(axis=1)]
    if _is_numerical(structure):
        at = np.array([values[structure.names.index(p.name)] for p in structure.free])
        gentle = np.abs(rows * at).max(axis=1) <= STEEPEST
        rows = rows[gentle] if gentle.sum() >= FEWEST_ROWS * len(structure.free) else rows
    if not rows.size:
        raise StructureError(f"structure {structure.name}: its response is finite at no frequency; check its blocks.")
    return rows


def _is_numerical(structure: Structure) -> bool:
    """Return whether a block leaves its derivatives to differences."""
    return any(type(block).derivatives is Block.derivatives for block in structure.blocks)


def _random_point(structure: Structure, rng: np.random.Generator) -> FloatArray:
    share = MARGIN + (1.0 - 2.0 * MARGIN) * rng.random(len(structure.parameters))
    drawn = (
        p.value if p.held else p.lower + part * (p.upper - p.lower)
        for p, part in zip(structure.parameters, share, strict=True)
    )
    return np.array(list(drawn))


def _nonzero(values: FloatArray) -> FloatArray:
    return np.where(values == 0.0, 1.0, values)
