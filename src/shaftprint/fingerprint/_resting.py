"""Which numbers would leave their intervals if something that was taken as known were another."""

from collections.abc import Mapping, Sequence

import numpy as np

from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.search._conditional_minimum import Conditional
from shaftprint.identify.uncertainty._profile import Interval
from shaftprint.models._combination import Combination

# Starts of the search beside the optimum: with one number held elsewhere the best branch may be another.
_STARTS = 8


def resting_on(
    identification: Identification,
    margins: Sequence[Combination],
    intervals: Mapping[str, Interval],
    *,
    name: str,
    at: Sequence[float],
) -> tuple[str, ...]:
    """Return the names of the numbers that leave their 95 % intervals where one parameter is held at another value.

    ``identification``: the fit. ``margins``: its margins as numbers. ``intervals``: the intervals of parameters,
    combinations and margins, by name. ``name``: a free parameter. ``at``: the values at which it is held; those beyond
    its bounds are taken at them.
    """
    objective = identification.objective
    place = [p.name for p in objective.free_parameters].index(name)
    held = np.clip(np.array(at), objective.lower[place], objective.upper[place])
    optimum = identification.values[list(objective.free)]
    moved, _ = Conditional.of(objective, place).lowest(held, optimum[np.newaxis], starts=_STARTS)
    named = objective.named(objective.complete(moved))
    with np.errstate(all="ignore"):
        values = {p.name: named[p.name] for p in objective.free_parameters if p.name != name}
        values |= {one.name: np.asarray(one.of(named)) for one in (*objective.combinations, *margins)}
    return tuple(
        number
        for number, there in values.items()
        if number in intervals and np.any((there < intervals[number].lower) | (there > intervals[number].upper))
    )
