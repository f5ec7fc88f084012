"""Numbers and names as they stand in the sentences of this room."""

import math
from collections.abc import Collection, Sequence

from shaftprint.digits import after_number
from shaftprint.spelling import listed

# Below this a probability is given by its order of magnitude; below the smallest only as smaller than that.
EXACT, SMALLEST = 1e-4, 1e-12


def probability(p: float) -> str:
    """Return ``p = 0.031``, or ``p < 1e-7`` where only its order of magnitude matters."""
    if p >= EXACT:
        return f"p = {p:.1g}" if p < 10.0 * EXACT else f"p = {p:.2g}"
    order = -12 if p < SMALLEST else math.floor(math.log10(p)) + 1
    return f"p < 1e{order}"


def spans(names: Collection[str], order: Sequence[str]) -> str:
    """Return names in their order, three or more neighbours by their ends: ``S1, S3 to S5 and S9``."""
    places = sorted(order.index(name) for name in names)
    runs: list[list[int]] = []
    for index in places:
        if runs and index == runs[-1][-1] + 1:
            runs[-1].append(index)
        else:
            runs.append([index])
    words: list[str] = []
    for run in runs:
        words += [f"{order[run[0]]} to {order[run[-1]]}"] if len(run) > 2 else [order[index] for index in run]
    return listed(words)


def number(value: float, unit: str, *, digits: int = 4) -> str:
    """Return a value with its unit, where it has one."""
    return f"{value:.{digits}g}{after_number(unit)}"
