"""A grid of nodes with two of them at every time at which something jumps."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.errors import ExactStepsError
from shaftprint.simulation._grid import NODES

# Nodes before the start, on the straight line that late signals were on.
PRE = 4
# Delays one after the other behind which a jump is followed: each passes a state that takes an order off it.
PASSAGES = 5
# So many fit into the memory of a small computer, at a few hundred bytes each.
MOST_JUMPS = 1_000_000
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

        ``keys_s``: times that must be nodes, the first and the last of the grid among them, ascending. ``jumps_s``:
        those among them at which something jumps.
        """
        inside = jumps_s[(jumps_s > keys_s[0]) & (jumps_s < keys_s[-1])]
        edges = np.concatenate([keys_s[:1], inside, keys_s[-1:]])
        stretch = np.searchsorted(inside, keys_s[:-1], side="right")
        gaps = np.diff(keys_s)
        # enough nodes for a cubic in every stretch, however short
        longest = np.minimum(longest_step_s, np.diff(edges)[stretch] / (NODES - 1))
        counts = np.ceil(gaps / longest - 1e-9).astype(np.int64)
        number = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
        times = np.repeat(keys_s[:-1], counts) + np.repeat(gaps / counts, counts) * number
        stretches = np.repeat(stretch, counts)
        # each stretch ends with its own node, at the time at which the next begins
        last = np.searchsorted(stretches, np.arange(edges.size - 1), side="right")
        return cls(
            time_s=np.insert(times, last, edges[1:]),
            stretch=np.insert(stretches, last, np.arange(edges.size - 1)),
        )

    @property
    def step_s(self) -> FloatArray:
        """Length of each step [s], zero between the two nodes of a jump, shape (nodes - 1,)."""
        return np.diff(self.time_s)

    def with_past(self, delay_s: FloatArray) -> FloatArray:
        """Return the times of the nodes behind ``PRE`` more ahead of the start, the longest delay apart [s]."""
        spacing = max(float(delay_s.max(initial=0.0)), 1e-3)
        return np.concatenate([self.time_s[0] + spacing * np.arange(-PRE, 0.0), self.time_s])

    def first_nodes(self, delay_s: FloatArray) -> IntArray:
        """Return the first of four nodes that give each late signal at start, middle and end of each step.

        All of one stretch, none later than the node of the step. At a jump the start of a step takes what is after it,
        its end what was before.

        Returns node, counted from the first of ``with_past``, shape (steps, delays, 3).
        """
        step, times = self.step_s, self.with_past(delay_s)
        stretch = np.concatenate([np.full(PRE, -1), self.stretch])
        numbers = np.arange(-1, self.stretch[-1] + 1)
        begins, ends = np.searchsorted(stretch, numbers), np.searchsorted(stretch, numbers, side="right") - 1
        now = np.arange(step.size) + PRE
        tolerance = max(CLOSE * float(step[step > 0.0].min()), 4.0 * np.spacing(np.abs(times).max()))
        nodes = np.empty((step.size, delay_s.size, 3), dtype=np.int64)
        for j, delay in enumerate(delay_s):
            for m, share in enumerate((0.0, 0.5, 1.0)):
                past_s = self.time_s[:-1] + share * step - delay
                # an empty step stands on the left of its jump; every other starts on the right and ends on the left
                after = (step > 0.0) & (share < 1.0)
                node = np.clip(np.searchsorted(times, past_s + np.where(after, tolerance, -tolerance)) - 1, 0, None)
                part = stretch[node] + 1
                last = np.minimum(ends[part], now)
                nodes[:, j, m] = np.clip(node - 1, begins[part], np.maximum(last - NODES + 1, begins[part]))
        return nodes


def jump_times(jumps_s: FloatArray, delay_s: FloatArray, stop_s: float) -> FloatArray:
    """Return the times at which a jump of an input arrives anywhere, ascending.

    ``jumps_s``: times at which an input jumps or turns a corner [s]. ``delay_s``: delays [s]; one after the other in
    any order. Raises ExactStepsError if there are more than can be followed.
    """
    arrivals = [jumps_s]
    for _ in range(PASSAGES):
        late = (arrivals[-1][:, None] + delay_s[delay_s > 0.0][None, :]).ravel()
        arrivals.append(np.unique(late[late < stop_s]))
        if sum(times.size for times in arrivals) > MOST_JUMPS:
            raise ExactStepsError(
                f"exact steps: expected inputs whose jumps and corners arrive at up to {MOST_JUMPS} times, found more; "
                "shorten the record, or use simulate."
            )
    times = np.unique(np.concatenate(arrivals))
    # what arrives by two ways at one time differs by rounding
    distinct = np.concatenate([[True], np.diff(times) > CLOSE * max(1.0, abs(stop_s))])
    return np.asarray(times[distinct])
