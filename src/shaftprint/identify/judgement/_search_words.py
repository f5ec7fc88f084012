"""What the optima of a search mean, in sentences."""

import numpy as np

from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._optima import SAME_COST, WITHIN, Optimum, is_passed_over, is_rival
from shaftprint.identify.judgement._phrases import number
from shaftprint.spelling import listed

# How many optima, and how many parameters of a rival, a sentence names.
NAMED = 4
# Parameters of a rival that differ by no more standard deviations are not named beside others that do.
DIFFERS = 1.0


def search_words(identification: Identification, optima: tuple[Optimum, ...]) -> tuple[str, ...]:
    """Return what the optima of a search mean, the result being the first of them."""
    others = optima[1:]
    return (
        _reached(optima),
        *wrong_basin_words(optima),
        *[_passed_over(optimum) for optimum in others if is_passed_over(optimum)][:1],
        *[_missed(optimum) for optimum in others if optimum.stable and optimum.distance < -SAME_COST * WITHIN][:1],
        *[rival_words(identification, optimum) for optimum in others if is_rival(optimum)][:1],
        *_bounds(identification, optima[0]),
    )


def _reached(optima: tuple[Optimum, ...]) -> str:
    total = sum(o.starts for o in optima)
    reached = sum(o.starts for o in optima if o.connected)
    if total == 1:
        return "One start was made: whether its optimum is the only one was not examined."
    valley = ", which is a valley: see what the data cannot tell apart" if sum(o.connected for o in optima) > 1 else ""
    others = [o for o in optima if not o.connected]
    if not others:
        return f"All {total} starts reached the same optimum{valley}."
    shown = ", ".join(f"cost {o.cost:.4g} ({_starts(o.starts)})" for o in others[:NAMED])
    more = f" and {len(others) - NAMED} more" if len(others) > NAMED else ""
    return (
        f"{reached} of {total} starts reached the optimum of cost {optima[0].cost:.4g}{valley}; the others ended in "
        f"{len(others)} more: {shown}{more}."
    )


def _starts(count: int) -> str:
    return "1 start" if count == 1 else f"{count} starts"


def wrong_basin_words(optima: tuple[Optimum, ...]) -> list[str]:
    """Return that another optimum attracted more starts than the result, where one did."""
    reached = sum(o.starts for o in optima if o.connected)
    busiest = max(optima, key=lambda o: o.starts)
    if busiest.connected or busiest.starts <= reached:
        return []
    return [
        f"An optimum of cost {busiest.cost:.4g} attracted {_starts(busiest.starts)}, more than the best one with "
        f"{reached}: a search from few starts would have ended there."
    ]


def _passed_over(optimum: Optimum) -> str:
    return (
        f"An optimum of lower cost ({optimum.cost:.4g}, {_starts(optimum.starts)}) was passed over, since the model is "
        "unstable there: what was tested is not, so that structure or data are in doubt."
    )


def _missed(optimum: Optimum) -> str:
    return (
        f"A start that was stopped on its way leads to a lower cost of {optimum.cost:.4g}: search with more iterations."
    )


def rival_words(identification: Identification, rival: Optimum) -> str:
    """Return that the result is not unique, with the parameters that differ most in their standard deviations."""
    objective = identification.objective
    free = list(objective.free)
    change = np.abs(rival.values - identification.values)[free]
    # no standard deviation, as of what the data say nothing of, is the widest that there is
    apart = np.divide(change, np.sqrt(np.diag(identification.covariance)), out=np.zeros(len(free)), where=change > 0.0)
    most = [int(i) for i in np.argsort(-apart, kind="stable")[:NAMED]]
    most = [i for i in most if apart[i] > DIFFERS] or most[:1]
    differences = [
        f"{p.name} = {number(float(rival.values[free[i]]), p.unit)} instead of "
        f"{number(float(identification.values[free[i]]), p.unit)}"
        for i, p in ((i, objective.free_parameters[i]) for i in most)
    ]
    return (
        f"The result is not unique: another optimum, with {listed(differences)}, lies only "
        f"{max(rival.distance, 0.0):.2g} of deviance higher, within the 95 % limit of {WITHIN:.2f}."
    )


def _bounds(identification: Identification, optimum: Optimum) -> list[str]:
    units = {p.name: p.unit for p in identification.objective.free_parameters}
    return [
        f"{name} stopped at its bound {number(identification.value(name), units[name])}: the data would go on."
        for name in optimum.at_bound
    ]
