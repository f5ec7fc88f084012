"""Quadratic forms of the differences between ships, one a tolerance of building, and what they are expected to be.

With ``V`` the covariance of all ships, ``P = V^-1 - V^-1 X (X' V^-1 X)^-1 X' V^-1`` and ``X`` the common mean, the
form of a tolerance is ``y' P K_d P y``, ``K_d = t_d t_d'`` in each ship. ``V`` is ``D + L L'``, one block ``D`` a ship
and few errors ``L`` that ships share, so that everything comes of products of small matrices.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.drift._class_numbers import ClassNumbers

# Differences are not weighed as if ships did not differ at all.
_LEAST_SCALE = 0.05


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Forms:
    """The quadratic forms of some ships, one for each tolerance, worked out at one choice of the scales."""

    surplus: FloatArray
    """What they are beyond what the tests leave open, shape (tolerances,)."""
    sensitivity: FloatArray
    """What the scales do to them, shape (tolerances, tolerances)."""
    ratios: FloatArray
    """What they are over what they are expected to be with these scales, shape (tolerances,)."""


def quadratic_forms(numbers: ClassNumbers, ships: tuple[int, ...], scales: FloatArray) -> Forms:
    """Return the quadratic forms of some ships at one choice of the scales.

    A tolerance is one of its ship, so that ``K_d`` has one block and all comes of products of small matrices.
    """
    places, building = list(ships), numbers.building
    weighing = _projection(numbers, ships, scales)
    values = weighing.times(numbers.values[places, :, None])[:, :, 0] @ building
    seen = building.T @ weighing.sides
    alone = building.T @ weighing.blocks @ building
    beside = seen @ weighing.inner @ seen.transpose(0, 2, 1)
    squares = np.einsum("sdr,sdq->drq", seen, seen)
    sensitivity = np.tensordot(weighing.inner @ squares @ weighing.inner, squares, axes=([1, 2], [1, 2]))
    sensitivity += (alone * (alone - 2.0 * beside)).sum(axis=0)
    form, expected = (values**2).sum(axis=0), np.einsum("stt->t", alone - beside)
    return Forms(
        surplus=form - _of_tests(numbers, ships, weighing),
        sensitivity=sensitivity,
        ratios=form / np.where(expected > 0.0, expected, 1.0),
    )


def weights_of_mean(numbers: ClassNumbers, ships: tuple[int, ...], scales: FloatArray) -> FloatArray:
    """Return how the mean of some ships follows from their numbers, shape (numbers, ships * numbers).

    Of all weights ``A`` with ``A X = 1`` the best are ``A - A V P``; here ``A`` takes all ships alike.
    """
    size, count = numbers.building.shape[0], len(ships)
    alike = numbers.common[list(ships)].mean(axis=0)
    covariance = _own(numbers, ships, scales) / count + _apart(numbers, ships) @ alike.T
    away = _projection(numbers, ships, scales).times(covariance)
    weights: FloatArray = (np.eye(size) / count - away).reshape(-1, size).T
    return weights


def _of_tests(numbers: ClassNumbers, ships: tuple[int, ...], weighing: "_Projection") -> FloatArray:
    """Return what is expected of each form by what tests leave open, ``tr(P K_d P C)``; shape (tolerances,)."""
    own, sides, inner = numbers.own[list(ships)], weighing.sides, weighing.inner
    seen, through = numbers.building.T @ sides, weighing.blocks @ numbers.building
    moved = own @ through
    across = inner @ (sides.transpose(0, 2, 1) @ own @ sides).sum(axis=0) @ inner
    expected: FloatArray = (through * moved).sum(axis=(0, 1))
    expected += ((seen @ across - 2.0 * moved.transpose(0, 2, 1) @ sides @ inner) * seen).sum(axis=(0, 2))
    expected += ((numbers.building.T @ weighing.times(_apart(numbers, ships))) ** 2).sum(axis=(0, 2))
    return expected


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Projection:
    """What weighs differences from the mean, ``P``: a block of each ship less ``sides inner sides'``."""

    blocks: FloatArray
    """Shape (ships, numbers, numbers)."""
    sides: FloatArray
    """Shape (ships, numbers, columns)."""
    inner: FloatArray
    """Shape (columns, columns)."""

    def times(self, columns: FloatArray) -> FloatArray:
        """Return ``P`` times columns of shape (ships, numbers, columns)."""
        along = np.einsum("spr,spc->rc", self.sides, columns)
        product: FloatArray = self.blocks @ columns - self.sides @ (self.inner @ along)
        return product


def _projection(numbers: ClassNumbers, ships: tuple[int, ...], scales: FloatArray) -> _Projection:
    """Return what weighs differences from the mean.

    ``V^-1 = D^-1 - D^-1 L (1 + L' D^-1 L)^-1 L' D^-1`` (M. A. Woodbury, "Inverting modified matrices", 1950). What an
    error does to all ships alike is no difference from the mean: ``P`` is the same without it, and nothing has to
    cancel.
    """
    size, errors = numbers.building.shape[0], numbers.common.shape[2]
    apart = _apart(numbers, ships)
    blocks = np.asarray(np.linalg.inv(_own(numbers, ships, scales)), dtype=np.float64)
    left = blocks @ apart
    shared = np.linalg.inv(np.eye(errors) + np.einsum("spk,spl->kl", apart, left))
    level = blocks - left @ shared @ left.sum(axis=0).T
    inner = np.zeros((errors + size, errors + size))
    inner[:errors, :errors], inner[errors:, errors:] = shared, np.linalg.inv(level.sum(axis=0))
    return _Projection(blocks=blocks, sides=np.concatenate([left, level], axis=2), inner=inner)


def _own(numbers: ClassNumbers, ships: tuple[int, ...], scales: FloatArray) -> FloatArray:
    """Return the covariance of each ship by itself, ``D``; shape (ships, numbers, numbers)."""
    between = (numbers.building * np.maximum(scales, _LEAST_SCALE)) @ numbers.building.T
    own: FloatArray = numbers.own[list(ships)] + between
    return own


def _apart(numbers: ClassNumbers, ships: tuple[int, ...]) -> FloatArray:
    """Return what each error that some ships share does to them beside what it does to all alike."""
    common = numbers.common[list(ships)]
    apart: FloatArray = common - common.mean(axis=0)
    return apart
