"""Smooth functions of frequency at many lines, from their values at a few of them."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray

# Lines from node to node. A motion that dies out in a time t is a transform of the width 1 / t; in a record of length T
# cubic interpolation misses a share of about (2 pi EVERY t / T)^4 / 43.
EVERY = 8
# The first lines are nodes themselves: there an integrator turns quickly.
EXACT = 64


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Nodes:
    """Frequencies at which smooth functions are evaluated, and the way from there to all lines."""

    s: ComplexArray
    """Laplace variable of the first lines and of the nodes [rad/s], shape (exact + nodes,)."""
    shares: FloatArray
    """Weights of four neighbours at the lines between the middle two, shape (4, ``EVERY``)."""
    exact: int
    """How many lines are evaluated as they are."""
    lines: int
    """Number of lines."""

    @classmethod
    def of(cls, frequency_hz: FloatArray) -> "Nodes":
        """Return the nodes for evenly spaced lines, shape (lines,)."""
        lines = frequency_hz.size
        exact = min(EXACT, lines)
        intervals = -(-(lines - exact) // EVERY)
        nodes = exact + EVERY * np.arange(-1, intervals + 2 if intervals else -1)
        step = (frequency_hz[-1] - frequency_hz[0]) / (lines - 1)
        places = np.concatenate([np.arange(exact), nodes])
        x = np.arange(EVERY) / EVERY
        # Lagrange's polynomials through -1, 0, 1, 2
        shares = np.stack(
            [
                -x * (x - 1.0) * (x - 2.0) / 6.0,
                (x + 1.0) * (x - 1.0) * (x - 2.0) / 2.0,
                -(x + 1.0) * x * (x - 2.0) / 2.0,
                (x + 1.0) * x * (x - 1.0) / 6.0,
            ]
        )
        s = np.asarray(2j * np.pi * (frequency_hz[0] + step * places))
        return cls(s=s, shares=shares, exact=exact, lines=lines)

    def at_lines(self, values: ComplexArray) -> ComplexArray:
        """Return functions at all lines, shape (..., lines), from their values at ``s``."""
        lines = np.empty((*values.shape[:-1], self.lines), dtype=np.complex128)
        lines[..., : self.exact] = values[..., : self.exact]
        nodes = values[..., self.exact :]
        if nodes.shape[-1]:
            neighbours = np.stack([nodes[..., i : nodes.shape[-1] - 3 + i] for i in range(4)], axis=-1)
            between = (neighbours @ self.shares).reshape(*values.shape[:-1], -1)
            lines[..., self.exact :] = between[..., : self.lines - self.exact]
        return lines
