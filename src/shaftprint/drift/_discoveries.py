"""Which of many p-values count, when few of those that count may be by chance."""

from collections.abc import Sequence


def discoveries(p_values: Sequence[float], share: float) -> tuple[int, ...]:
    """Return the places of the p-values that count, in their order.

    Of all that count the given share at most is by chance in the mean (Y. Benjamini, Y. Hochberg, "Controlling the
    false discovery rate", Journal of the Royal Statistical Society B 57, 1995): the largest ``i`` for which the
    ``i``-th smallest is no larger than ``share i / count``.

    ``p_values``: probability of each that chance alone makes as much or more. ``share``: the share, such as 0.05.
    """
    ordered = sorted(range(len(p_values)), key=lambda at: p_values[at])
    count = len(p_values)
    last = max((place for place, at in enumerate(ordered, 1) if p_values[at] <= share * place / count), default=0)
    return tuple(sorted(ordered[:last]))
