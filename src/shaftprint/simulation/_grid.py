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
    weight, change = cubic_weights(place - first)
    change = change / step_s
    # a delay that varies may grow to eight times what it is at rest
    longest = (int(-first.min(initial=0)) + 2) * (8 if varies else 1)
    return Stencils(first=first, weight=weight, change=change, mask=(1 << longest.bit_length()) - 1)


def cubic_weights(place: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return Lagrange's weights of nodes 0, 1, 2 and 3 at places between or beside them, and their slopes."""
    weight = np.empty((*place.shape, NODES), dtype=place.dtype)
    slope = np.empty_like(weight)
    for node in range(NODES):
        others = [other for other in range(NODES) if other != node]
        scale = 1.0 / np.prod([node - other for other in others])
        a, b, c = (place - other for other in others)
        weight[..., node] = scale * a * b * c
        slope[..., node] = scale * (a * b + a * c + b * c)
    return weight, slope


def shifted(
    y: FloatArray, before: FloatArray, shift_steps: complex, samples: int, every: int
) -> tuple[FloatArray, FloatArray]:
    """Return a recorded output at samples that are late by some steps, and how fast it changes there, a step.

    Parameters
    ----------
    y
        Values at all nodes, shape (nodes, ...).
    before
        What it was before the first, shape (...).
    shift_steps
        Steps by which the samples are late; negative where they are early.
    every
        Steps between two samples.
    """
    place = -shift_steps
    first = int(np.floor(np.real(place))) - 1
    weight, slope = cubic_weights(np.asarray(place - first))
    value = np.zeros((samples, *y.shape[1:]), dtype=np.result_type(y, weight))
    change = np.zeros_like(value)
    wanted = np.arange(samples) * every + first
    for node in range(NODES):
        at = wanted + node
        taken = np.where((at >= 0).reshape(-1, *[1] * (y.ndim - 1)), y[np.clip(at, 0, y.shape[0] - 1)], before)
        value += weight[node] * taken
        change += slope[node] * taken
    return value, change
