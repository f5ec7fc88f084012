"""Where delayed signals are found on a uniform grid of nodes."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, IntArray

# Nodes that a cubic needs.
NODES = 4


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

    Parameters
    ----------
    delay_s
        Delays [s], shape (delays,), at least 0; complex where a derivative is taken by a complex step.
    varies
        Whether one of them is only what it is at rest.
    """
    place = np.array([0.5, 1.0])[None, :] - delay_s[:, None] / step_s
    first = np.minimum(np.floor(place.real).astype(np.int64) - 1, 1 - NODES)
    weight, change, bend = cubic_weights(place - first)
    # a delay that varies may grow to eight times what it is at rest; beyond, the oldest signal is taken
    longest = (int(-first.min(initial=0)) + 2) * (8 if varies else 1)
    return Stencils(
        first=first,
        weight=weight,
        change=change / step_s,
        bend=bend / step_s**2,
        mask=(1 << longest.bit_length()) - 1,
    )


def cubic_weights(place: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return Lagrange's weights of nodes 0, 1, 2 and 3 at places between or beside them, their slopes and bends."""
    weight = np.empty((*place.shape, NODES), dtype=place.dtype)
    slope, bend = np.empty_like(weight), np.empty_like(weight)
    for node in range(NODES):
        others = [other for other in range(NODES) if other != node]
        scale = 1.0 / np.prod([node - other for other in others])
        a, b, c = (place - other for other in others)
        weight[..., node] = scale * a * b * c
        slope[..., node] = scale * (a * b + a * c + b * c)
        bend[..., node] = scale * 2.0 * (a + b + c)
    return weight, slope, bend


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

        Parameters
        ----------
        y
            Values at all nodes, shape (nodes, ...).
        before
            What it was before the first, shape (...).
        """
        return self._sum(y, before, 0)

    def change(self, y: FloatArray, before: FloatArray) -> FloatArray:
        """Return how fast the output changes at the samples, a step."""
        return self._sum(y, before, 1)

    def _sum(self, y: FloatArray, before: FloatArray, kind: int) -> FloatArray:
        place = -self.steps
        first = int(np.floor(np.real(place))) - 1
        weights = cubic_weights(np.asarray(place - first))[kind]
        ahead = max(0, -first)
        last = (self.samples - 1) * self.every + first + NODES
        behind = max(0, last - y.shape[0])
        padded = np.concatenate([np.repeat(before[None], ahead, axis=0), y, np.repeat(y[-1:], behind, axis=0)])
        start = first + ahead
        stop = (self.samples - 1) * self.every + 1
        parts = (weights[m] * padded[start + m : start + m + stop : self.every] for m in range(NODES))
        return np.asarray(sum(parts))
