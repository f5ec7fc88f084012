"""What would help where a plan does not meet its wishes: knowledge from elsewhere, another speed."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from shaftprint.catalogue._known_propeller import sails_free
from shaftprint.catalogue._roles import ShipRole
from shaftprint.design.plan._plan import Plan, predicted_accuracy
from shaftprint.errors import DesignError
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.prediction._accuracy import Accuracy
from shaftprint.notebook._shown import Shown

LATENCY_STD_S = 0.005
"""How well a latency can be measured on a bench, or read from a data sheet [s]."""
INERTIA_SHARE = 0.03
"""How well a builder's calculation of torsional vibration knows an inertia, over its value."""
# A set point turns round so far before a limit of the speed, over its own largest deviation.
_CLEAR = 1.15


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class Remedy(Shown):
    """One thing that could be done besides, and what it would make of the worst wish."""

    name: str
    """What is done, such as ``a second leg at 829 rpm``."""
    worst: float
    """Largest predicted deviation over its wish."""
    ratios: Mapping[str, float]
    """Predicted deviation over the wish, by name."""

    @property
    def sentence(self) -> str:
        """Say what it would bring."""
        if self.worst <= 1.0:
            return f"With {self.name} every wish would be met."
        number = max(self.ratios, key=lambda name: self.ratios[name])
        rest = f"be {self.worst:.2g} times its wish" if math.isfinite(self.worst) else "not be known"
        return f"With {self.name} {number} would still {rest}."


def remedies(plan: Plan, design: Callable[[tuple[float, ...]], Plan] | None = None) -> tuple[Remedy, ...]:
    """Return what would bring a plan nearer to its wishes, the best first.

    Parameters
    ----------
    plan
        The plan.
    design
        The plan at other speeds, for the effect of a second leg; not asked where the plan has two already, nor of a
        ship that sails free, whose numbers belong to one speed.
    """
    knowledge = _knowledge(plan)
    every = [_known_besides(plan, *known) for known in knowledge]
    is_bound = len(plan.legs) > 1 or sails_free(plan.ship.structure)
    other = None if design is None or is_bound else _at_second_speed(plan, design)
    if other is not None:
        every.append(_remedy(f"half of the time at {other.legs[-1].level_rpm:.0f} rpm", other, other.predicted))
    if len(every) > 1 and knowledge:
        priors = {name: prior for _, more in knowledge for name, prior in more.items()}
        words = " and ".join(remedy.name for remedy in every)
        every.append(_known_besides(other or plan, words, priors))
    return tuple(sorted(every, key=lambda remedy: remedy.worst))


def _knowledge(plan: Plan) -> list[tuple[str, dict[str, Prior]]]:
    """Return what could be known besides: in words, and as a prior of a parameter."""
    structure, values = plan.ship.structure, plan.ship.by_name
    free = {p.name for p in structure.free} - set(plan.priors)
    latency, inertia = (structure.named_as(role) for role in (ShipRole.SET_POINT_LATENCY, ShipRole.INERTIA_UPSTREAM))
    knowledge = []
    if latency in free:
        words = f"the latency of the set point known to {1000.0 * LATENCY_STD_S:g} ms"
        knowledge.append((words, {latency: Prior(values[latency], LATENCY_STD_S)}))
    if inertia in free:
        words = f"the inertia upstream of the gauge known from the builder to {100.0 * INERTIA_SHARE:g} %"
        knowledge.append((words, {inertia: Prior(values[inertia], INERTIA_SHARE * values[inertia])}))
    return knowledge


def _known_besides(plan: Plan, words: str, more: Mapping[str, Prior]) -> Remedy:
    accuracy = predicted_accuracy(
        plan.structures,
        plan.legs,
        plan.noise,
        values=plan.ship.by_name,
        priors={**plan.priors, **more},
        earlier=plan.earlier,
    )
    return _remedy(words, plan, accuracy)


def _remedy(words: str, plan: Plan, accuracy: Accuracy) -> Remedy:
    ratios = {name: accuracy.estimate(name).std / target for name, target in plan.targets.items()}
    return Remedy(name=words, worst=max(ratios.values()), ratios=ratios)


def _at_second_speed(plan: Plan, design: Callable[[tuple[float, ...]], Plan]) -> Plan | None:
    """Return the plan with a second leg at the speed farthest off that leaves room for the set point."""
    limits, leg = plan.limits, plan.legs[0]
    clear = _CLEAR * limits.set_point_rpm
    lowest, highest = limits.lowest_speed_rpm + clear, limits.highest_speed_rpm - clear
    other = lowest if leg.level_rpm / lowest > highest / leg.level_rpm else highest
    try:
        return design((leg.speed_share, other / limits.engine_speed_rpm))
    except DesignError:
        return None
