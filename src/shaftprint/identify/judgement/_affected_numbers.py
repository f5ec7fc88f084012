"""Which numbers depend on which reason: the one table, by what a number is made of.

A gauge that shows everything by a factor too large leaves the normalised torque as it is, but not the inertia upstream:
that is known in kg m2 and divided by the torque that the gauge shows. All that is told apart with its help (gains,
margins, the parts of the delay) is then wrong too; the slope of the propeller torque and the sum of the delays are not.
What a number is made of follows from its role.
"""

from collections.abc import Mapping, Sequence
from typing import get_args

from shaftprint.identify.fit._estimate import Estimate
from shaftprint.models._role import Basis
from shaftprint.reasons import Reason, ReasonKind

ALL: frozenset[Basis] = frozenset(get_args(Basis))

OF_WORKING_POINT: frozenset[Basis] = frozenset(("speed", "set point"))
"""What a number of the working point is made of, and none of governor, inertia or load."""

WHOLE = "the fit as a whole is not trustworthy"

AFFECTED: Mapping[ReasonKind, tuple[frozenset[Basis], str]] = {
    "recording clock": (ALL, "it depends on the clock of the recording"),
    "channel clock": (ALL, "it depends on the clocks of the channels running alike"),
    "speed scale": (ALL, "it depends on a speed that is off by one factor"),
    "held samples": (ALL - {"speed"}, "it depends on a channel that keeps its last value"),
    "set-point band": (frozenset(("delay", "governor")), "it depends on a set point that its channel shows late"),
    "late set point": (frozenset(("clock", "pitch clock")), "it depends on a set point that its channel shows late"),
    "late pitch feedback": (frozenset(("pitch clock",)), "it depends on a pitch that its channel shows late"),
    "clipping": (ALL - {"speed"}, "it depends on a torque that is clipped"),
    "gauge steadiness": (
        ALL - {"speed", "set point", "delay", "clock"},
        "it depends on a torque gauge and a load that stay the same during the test",
    ),
    "engine limit": (ALL, WHOLE),
    "gauge latency": (ALL - {"speed", "set point"}, "it depends on the latency of the torque gauge"),
    "hidden inertia": (ALL - {"speed", "set point"}, "it depends on a torque that shows the inertia behind the gauge"),
    "legs apart": (ALL, WHOLE),
    "elastic coupling": (ALL - {"speed"}, "it depends on a line that does not twist"),
    "gauge scale": (frozenset(("torque", "governor")), "it depends on the scale of the torque gauge"),
    "set-point shape": (ALL - {"speed"}, "it depends on a set point that was not recorded as it was"),
    "set-point scale": (ALL - {"speed"}, "it depends on the scale of the set point"),
    "prior": (ALL - {"speed", "set point"}, "it depends on a prior that the data contradict"),
    "record": (ALL, "it depends on how its records were taken"),
    "gauge line": (
        frozenset(("torque", "level", "load", "governor", "delay")),
        "it depends on the zero of the torque gauge, or on its line",
    ),
    "gauge zero": (frozenset(("level",)), "it depends on the zero of the torque gauge"),
    "gear ratio": (frozenset(("torque", "governor")), "it depends on the gear ratio"),
    "propeller": (frozenset(("size",)), "it depends on the diameter of the propeller"),
    "too few data": (ALL, WHOLE),
    "gap": (ALL, WHOLE),
    "misfit": (ALL, WHOLE),
    "contradicting data": (ALL, WHOLE),
    "suspect": (frozenset(), ""),
    "lines left out": (ALL, "the model does not hold at the lines that were left out"),
    "unstable": (ALL, WHOLE),
    "not unique": (ALL, WHOLE),
}
"""For each kind of reason, the most important first: what depends on it, and why, as a clause."""

WEIGHT = {kind: weight for weight, kind in enumerate(AFFECTED)}


def by_weight(reasons: Sequence[Reason]) -> tuple[Reason, ...]:
    """Return reasons, the most important first, each once; of the latency that legs find the first stands for all."""
    first = {one.where: one for one in reversed(reasons) if one.kind == "gauge latency"}
    once = dict.fromkeys(one for one in reasons if one.kind != "gauge latency" or one is first[one.where])
    return tuple(sorted(once, key=lambda reason: WEIGHT[reason.kind]))


def basis_of(number: Estimate) -> frozenset[Basis]:
    """Return what a number is made of; everything where it has no role, as a number of an own structure may not."""
    if number.role is None or not number.role.basis:
        return ALL
    form = number.role.physical
    in_newton_metres = form is not None and number.unit == form.unit
    if in_newton_metres:
        return number.role.basis | {"torque"}
    if number.role.over_torque:
        return number.role.basis | {"level"}
    if "torque" in number.role.basis and not number.role.of_sensor:
        # a torque without a unit is over rho n^2 D^5, of what goes with the square of the speed
        return number.role.basis | {"size" if number.unit == "-" else "level"}
    return number.role.basis


def depends_on(number: Estimate, kind: ReasonKind) -> bool:
    """Return whether a number depends on what a reason of some kind calls in question."""
    affected, _ = AFFECTED[kind]
    return bool(basis_of(number) & affected)


def clause_of(number: Estimate, reasons: Sequence[Reason]) -> str:
    """Return why a number may not be trusted, by the first of the reasons that it depends on; empty where by none."""
    return next((AFFECTED[reason.kind][1] for reason in reasons if depends_on(number, reason.kind)), "")
