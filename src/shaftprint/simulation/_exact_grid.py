"""A grid of nodes with two of them at every time at which something jumps."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Self

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.simulation._grid import NODES

# Nodes before the start, on the straight line that late signals were on.
PRE = 4
# Delays one after the other behind which a jump is followed: each passes a state that takes an order off it.
PASSAGES = 5
# Jumps closer than this share of the shortest step are one.
CLOSE = 1e-9


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ExactGrid:
    """Nodes, with a stretch between every two jumps."""

    time_s: FloatArray
    """Times of the nodes [s], ascending, equal where something jumps, shape (nodes,)."""
    stretch: IntArray
    """Number of the stretch of each node, shape (nodes,)."""

    @classmethod
    def between(cls, keys_s: FloatArray, jumps_s: FloatArray, longest_step_s: float) -> Self:
        """Return a grid with nodes at some times, two at jumps.

        Parameters
        ----------
        keys_s
            Times that must be nodes, the first and the last of the grid among them, ascending.
        jumps_s
            Those among them at which something jumps.
        """
        least = NODES - 1
        edges = np.concatenate([keys_s[:1], jumps_s[(jumps_s > keys_s[0]) & (jumps_s < keys_s[-1])], keys_s[-1:]])
        times, numbers = [], []
        for number, (begin, end) in enumerate(pairwise(edges)):
            inner = keys_s[(keys_s > begin) & (keys_s < end)]
            points = np.concatenate([[begin], inner, [end]])
            # enough nodes for a cubic in every stretch, however short
            longest = min(longest_step_s, (end - begin) / least)
            counts = np.ceil(np.diff(points) / longest - 1e-9).astype(int)
            parts = [a + (b - a) * np.arange(n) / n for a, b, n in zip(points[:-1], points[1:], counts, strict=True)]
            times.append(np.concatenate([*parts, [end]]))
            numbers.append(np.full(times[-1].size, number))
        return cls(time_s=np.concatenate(times), stretch=np.concatenate(numbers))

    @property
    def step_s(self) -> FloatArray:
        """Length of each step [s], zero between the two nodes of a jump, shape (nodes - 1,)."""
        return np.diff(self.time_s)

    def stencils(self, delay_s: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
        """Return the nodes that give each late signal at start, middle and end of each step, and their weights.

        Four nodes of one stretch, none later than the node of the step. ``PRE`` nodes stand before the start, at equal
        distances of the longest delay. At a jump the start of a step takes what is after it, its end what was before.

        Returns
        -------
            First node, counted from the first of those before the start, shape (steps, delays, 3); weights of the
            values and of how fast they change [1/s], shape (steps, delays, 3, 4).
        """
        step = self.step_s
        steps = step.size
        spacing = max(float(delay_s.max(initial=0.0)), 1e-3)
        early = self.time_s[0] + spacing * np.arange(-PRE, 0.0)
        times = np.concatenate([early, self.time_s])
        stretch = np.concatenate([np.full(PRE, -1), self.stretch])
        begins = np.searchsorted(stretch, np.arange(-1, self.stretch[-1] + 1))
        ends = np.searchsorted(stretch, np.arange(-1, self.stretch[-1] + 1), side="right") - 1
        now = np.arange(steps) + PRE
        place = self.time_s[:-1, None, None] + step[:, None, None] * np.array([0.0, 0.5, 1.0]) - delay_s[None, :, None]
        tolerance = CLOSE * max(float(step[step > 0.0].min()), 1e-12)
        left, right = place - tolerance, place + tolerance
        # an empty step stands on the left of its jump; every other starts on the right and ends on the left
        after = np.array([True, True, False])[None, None, :] & (step > 0.0)[:, None, None]
        node = np.where(after, np.searchsorted(times, right) - 1, np.searchsorted(times, left) - 1)
        node = np.clip(node, 0, None)
        part = stretch[node] + 1
        last = np.minimum(ends[part], now[:, None, None])
        first = np.clip(node - 1, begins[part], np.maximum(last - NODES + 1, begins[part]))
        weight, change = _weights(times[first[..., None] + np.arange(NODES)], place)
        return first, weight, change


def _weights(nodes: FloatArray, place: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return Lagrange's weights of four nodes, shape (..., 4), at a place, and their slopes."""
    weight, slope = np.empty_like(nodes), np.empty_like(nodes)
    for m in range(NODES):
        others = [other for other in range(NODES) if other != m]
        scale = np.prod([nodes[..., m] - nodes[..., other] for other in others], axis=0)
        a, b, c = (place - nodes[..., other] for other in others)
        weight[..., m] = a * b * c / scale
        slope[..., m] = (a * b + a * c + b * c) / scale
    return weight, slope


def jump_times(jumps_s: FloatArray, delay_s: FloatArray, stop_s: float) -> FloatArray:
    """Return the times at which a jump of an input arrives anywhere, ascending.

    Parameters
    ----------
    jumps_s
        Times at which an input jumps or turns a corner [s].
    delay_s
        Delays [s]; one after the other in any order.
    """
    found = [jumps_s]
    for _ in range(PASSAGES):
        late = (found[-1][:, None] + delay_s[delay_s > 0.0][None, :]).ravel()
        found.append(np.unique(late[late < stop_s]))
    times = np.unique(np.concatenate(found))
    # what arrives by two ways at one time differs by rounding
    distinct = np.concatenate([[True], np.diff(times) > CLOSE * max(1.0, abs(stop_s))])
    return np.asarray(times[distinct])
