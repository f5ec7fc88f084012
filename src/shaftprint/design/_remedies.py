"""What would help where a plan does not meet its wishes: knowledge from elsewhere, another speed."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from shaftprint.catalogue import ShipRole
from shaftprint.design._plan import Plan, predicted_accuracy
from shaftprint.errors import DesignError
from shaftprint.identify import Prior
from shaftprint.models import Role
from shaftprint.notebook import Shown

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
        number = max(self.ratios, key=lambda name: self.ratios[name])
        rest = f"{number} would still be {self.worst:.2g} times its wish"
        return f"With {self.name} {'every wish would be met' if self.worst <= 1.0 else rest}."


def remedies(plan: Plan, design: Callable[[tuple[float, ...]], Plan] | None = None) -> tuple[Remedy, ...]:
    """Return what would bring a plan nearer to its wishes, the best first.

    Parameters
    ----------
    plan
        The plan.
    design
        The plan at other speeds, for the effect of a second leg; not asked where the plan has two already.
    """
    found = [_known_besides(plan, name, prior) for name, prior in _knowledge(plan).items()]
    if design is not None and len(plan.legs) == 1:
        found += _second_leg(plan, design)
    return tuple(sorted(found, key=lambda remedy: remedy.worst))


def _knowledge(plan: Plan) -> dict[str, tuple[str, Prior]]:
    """Return what could be known besides: in words, and as a prior of a parameter."""
    structure, values = plan.line.structure, plan.line.by_name
    free = {p.name for p in structure.free} - set(plan.priors)

    def name_of(role: Role) -> str | None:
        name = structure.named_as(role)
        return name if name in free else None

    knowledge = {}
    if (name := name_of(ShipRole.SET_POINT_LATENCY)) is not None:
        words = f"the latency of the set point known to {1000.0 * LATENCY_STD_S:g} ms"
        knowledge[name] = words, Prior(values[name], LATENCY_STD_S)
    if (name := name_of(ShipRole.INERTIA_UPSTREAM)) is not None:
        words = f"the inertia upstream of the gauge known from the builder to {100.0 * INERTIA_SHARE:g} %"
        knowledge[name] = words, Prior(values[name], INERTIA_SHARE * values[name])
    return knowledge


def _known_besides(plan: Plan, parameter: str, known: tuple[str, Prior]) -> Remedy:
    words, prior = known
    accuracy = predicted_accuracy(
        plan.structures,
        plan.legs,
        plan.noise,
        values=plan.line.by_name,
        priors={**plan.priors, parameter: prior},
        earlier=plan.earlier,
    )
    ratios = {name: accuracy.estimate(name).std / target for name, target in plan.targets.items()}
    return Remedy(name=words, worst=max(ratios.values()), ratios=ratios)


def _second_leg(plan: Plan, design: Callable[[tuple[float, ...]], Plan]) -> list[Remedy]:
    """Return what half of the time would bring at the speed farthest off that leaves room for the set point."""
    limits, share = plan.limits, plan.legs[0].speed_share
    clear = _CLEAR * limits.set_point_rpm
    lowest, highest = limits.lowest_speed_rpm + clear, limits.highest_speed_rpm - clear
    level = plan.legs[0].level_rpm
    other = lowest if level / lowest > highest / level else highest
    try:
        both = design((share, other / limits.engine_speed_rpm))
    except DesignError:
        return []
    return [Remedy(name=f"half of the time at {other:.0f} rpm", worst=max(both.ratios.values()), ratios=both.ratios)]
