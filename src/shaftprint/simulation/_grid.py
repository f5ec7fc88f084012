"""Where delayed signals are found on a uniform grid of nodes."""

import math
from dataclasses import dataclass
from typing import TypeAlias, TypeVar

import numpy as np

from shaftprint.arrays import FloatArray, IntArray

# Nodes that a cubic needs.
NODES = 4

Place = TypeVar("Place", FloatArray, complex)
Four: TypeAlias = tuple[Place, Place, Place, Place]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Stencils:
    """Nodes and weights of each delay at the middle and the end of a step."""

    first: IntArray
    """First of four nodes, relative to the node of the step, shape (delays, 2)."""
    weight: FloatArray
    """Weights of their values, shape (delays, 2, 4)."""
    change: FloatArray
    """Weights of their values in how fast the signal changes [1/s], shape (delays, 2, 4)."""
    bend: FloatArray
    """Weights of their values in how fast that changes [1/s^2], shape (delays, 2, 4)."""
    mask: int
    """Size of the ring of nodes less one; the size is a power of two."""


def stencils(delay_s: FloatArray, step_s: float, *, varies: bool = False) -> Stencils:
    """Return the stencils of delays, exact to the fourth order of the step.

    A cubic goes through the two nodes on either side of the place (Lagrange); where the delay is shorter than three
    steps, through the last four nodes that are known.

    ``delay_s``: delays [s], shape (delays,), at least 0; complex where a derivative is taken by a complex step.
    ``varies``: whether one of them is only what it is at rest.
    """
    position = np.array([0.5, 1.0])[None, :] - delay_s[:, None] / step_s
    first = np.minimum(np.floor(position.real).astype(np.int64) - 1, 1 - NODES)
    weight, change, bend = (np.stack(four, axis=-1) for four in cubic_weights(position - first))
    # a delay that varies may grow to eight times what it is at rest; beyond, the oldest signal is taken
    longest = (int(-first.min(initial=0)) + 2) * (8 if varies else 1)
    return Stencils(
        first=first,
        weight=weight,
        change=change / step_s,
        bend=bend / step_s**2,
        mask=(1 << longest.bit_length()) - 1,
    )


def cubic_weights(x: Place) -> tuple[Four[Place], Four[Place], Four[Place]]:
    """Return Lagrange's weights of nodes 0, 1, 2 and 3 at places between or outside them, their slopes and bends."""
    a, b, c, d = x, x - 1.0, x - 2.0, x - 3.0
    weight = (-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0)
    slope = (
        -(c * d + b * d + b * c) / 6.0,
        (c * d + a * d + a * c) / 2.0,
        -(b * d + a * d + a * b) / 2.0,
        (b * c + a * c + a * b) / 6.0,
    )
    return weight, slope, (-(b + c + d) / 3.0, a + c + d, -(a + b + d), (a + b + c) / 3.0)


@dataclass(frozen=True, slots=True, eq=False)
class Shift:
    """Samples of a recorded output that is late by some steps, or early."""

    steps: complex
    """Steps by which the samples are late; negative where they are early."""
    samples: int
    """Number of samples."""
    every: int
    """Steps between two samples."""

    def value(self, y: FloatArray, before: FloatArray) -> FloatArray:
        """Return the output at the samples, shape (samples, ...).

        ``y``: values at all nodes, shape (nodes, ...). ``before``: what it was before the first, shape (...).
        """
        return self._sum(y, before, 0)

    def change(self, y: FloatArray, before: FloatArray) -> FloatArray:
        """Return how fast the output changes at the samples, a step."""
        return self._sum(y, before, 1)

    def _sum(self, y: FloatArray, before: FloatArray, kind: int) -> FloatArray:
        position = -self.steps
        first = math.floor(position.real) - 1
        weights = cubic_weights(position - first)[kind]
        ahead = max(0, -first)
        last = (self.samples - 1) * self.every + first + NODES
        behind = max(0, last - y.shape[0])
        padded = np.concatenate([np.repeat(before[None], ahead, axis=0), y, np.repeat(y[-1:], behind, axis=0)])
        start = first + ahead
        stop = (self.samples - 1) * self.every + 1
        parts = (weights[m] * padded[start + m : start + m + stop : self.every] for m in range(NODES))
        return np.asarray(sum(parts))
