"""Multisines that move something else, beside a leg of the speed: in its periods, about the middle of their input."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from shaftprint.campaign._multisine import Multisine

if TYPE_CHECKING:
    from shaftprint.campaign._leg import Leg

_ROUNDING = 1e-9


def runs_beside(multisine: Multisine, leg: "Leg") -> bool:
    """Return whether a multisine has the times and the period of a leg, so that their lines stay apart."""
    times = [(one.start_s, one.settled_s, one.stop_s, one.length_of_period_s) for one in (multisine, leg)]
    return all(abs(one - other) <= _ROUNDING * max(abs(other), 1.0) for one, other in zip(*times, strict=True))


def faults_beside(multisines: Iterable[Multisine], legs: "Iterable[Leg]", middles_v: Mapping[str, float]) -> list[str]:
    """Return what is wrong with multisines of further inputs, one sentence each.

    ``multisines``: those that move something else than the set point of the speed. ``legs``: those of the speed.
    ``middles_v``: voltage of each further input outside of its tests [V].
    """
    every, errors = tuple(legs), []
    taken: dict[tuple[str, int], str] = {}
    for one in multisines:
        leg = next((leg for leg in every if runs_beside(one, leg)), None)
        if leg is None:
            errors.append(
                f"expected {one.name}, which moves {one.input}, beside a multisine of the speed with the same start_s, "
                "settled_s, stop_s and period_s, found none."
            )
            continue
        for harmonic in leg.lines:
            taken.setdefault((leg.name, harmonic), leg.name)
        twice = [(harmonic, taken[leg.name, harmonic]) for harmonic in one.lines if (leg.name, harmonic) in taken]
        if twice:
            errors.append(
                f"expected {one.name} to have harmonics of its own, found {twice[0][0]} in {twice[0][1]} too; two "
                "inputs on one line cannot be told apart."
            )
        taken.update({(leg.name, harmonic): one.name for harmonic in one.lines})
        middle_v = middles_v.get(one.input)
        if middle_v is not None and abs(one.level_v - middle_v) > _ROUNDING:
            errors.append(
                f"expected level_v of {one.name} to be further_offsets_v.{one.input} = {middle_v:g}, about which that "
                f"stands still, found {one.level_v:g}."
            )
    return errors
