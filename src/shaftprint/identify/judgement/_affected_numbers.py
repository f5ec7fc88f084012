"""Which numbers hang on which reason: the one table, by the role that a number has.

A gauge that shows everything by a factor too large leaves the normalised torque as it is, but not the inertia upstream:
that is known in kg m2 and divided by the torque that the gauge shows. All that is told apart with its help (gains,
margins, the parts of the delay) is then wrong too; the slope of the propeller torque and the sum of the delays are not.
"""

from collections.abc import Mapping, Sequence
from typing import Literal, TypeAlias, get_args

from shaftprint.reasons import Reason, ReasonKind

Role: TypeAlias = Literal[
    "torque", "inertia", "load", "governor", "delay", "part of delay", "latency", "speed", "set point"
]
"""What a number is made of: torque in N m; inertia over torque; slope of the load; governor and engine, told apart with
the upstream inertia; the sum of the delays; its parts; the latency of the gauge; the speed; the set-point line."""

ALL: frozenset[Role] = frozenset(get_args(Role))
TORQUE: frozenset[Role] = frozenset(("torque", "inertia", "load", "latency"))

ROLES: Mapping[str, frozenset[Role]] = {
    "n_0": frozenset(("speed",)),
    "M_s0": frozenset(("torque",)),
    "K_Q": frozenset(("torque",)),
    "I_up": frozenset(("torque",)),
    "tau_up": frozenset(("torque",)),
    "I_dn": frozenset(("torque", "inertia")),
    "I": frozenset(("torque", "inertia")),
    "tau_dn": frozenset(("inertia",)),
    "tau_n": frozenset(("inertia",)),
    "k_q": frozenset(("load",)),
    "gauge zero share": frozenset(("load",)),
    "t_gauge": frozenset(("latency",)),
    "t_d + t_sp": frozenset(("delay",)),
    "t_d": frozenset(("delay", "part of delay", "governor")),
    "t_sp": frozenset(("delay", "part of delay", "governor")),
    "delay margin": frozenset(("part of delay", "governor")),
    "gain margin": frozenset(("governor",)),
    "phase margin": frozenset(("governor",)),
    "g": frozenset(("governor",)),
    "K_p": frozenset(("governor",)),
    "K_i": frozenset(("governor",)),
    "omega_n": frozenset(("governor",)),
    "zeta": frozenset(("governor",)),
    "K_p / K_i": frozenset(("governor",)),
    "v K_i / (k_q - g)": frozenset(("governor",)),
    "v K_p / (tau_up + tau_dn)": frozenset(("governor",)),
    "governor proportional action": frozenset(("torque", "governor")),
    "governor integral action": frozenset(("torque", "governor")),
    "c_set": frozenset(("set point",)),
}
"""What each number is made of. One that is not here, as of an own structure, hangs on every reason."""

WHOLE = "the fit as a whole is not trustworthy"

HANGING: Mapping[ReasonKind, tuple[frozenset[Role], str]] = {
    "recording clock": (ALL, "it hangs on the clock of the recording"),
    "channel clock": (ALL, "it hangs on clocks of the channels that run alike"),
    "clipping": (ALL - {"speed"}, "it hangs on a torque that is cut off"),
    "gauge steadiness": (
        ALL - {"speed", "set point", "delay"},
        "it hangs on a torque gauge and a load that stay the same during the test",
    ),
    "gauge scale": (frozenset(("torque", "governor", "part of delay")), "it hangs on the scale of the torque gauge"),
    "set-point shape": (ALL - {"speed"}, "it hangs on a set point that was not recorded as it was"),
    "set-point scale": (ALL - {"speed"}, "it hangs on the scale of the set point"),
    "gauge latency": (ALL - {"speed", "set point"}, "it hangs on the latency of the torque gauge"),
    "prior": (ALL - {"speed", "set point"}, "it hangs on what was known before the test, which the data contradict"),
    "gear ratio": (frozenset(("torque", "governor")), "it hangs on the gear ratio"),
    "too few data": (ALL, WHOLE),
    "gap": (ALL, WHOLE),
    "misfit": (ALL, WHOLE),
    "contradicting data": (ALL, WHOLE),
    "suspect": (frozenset(), ""),
    "lines left out": (ALL, "the model does not hold at the lines that were left out"),
    "unstable": (ALL, WHOLE),
    "not unique": (ALL, WHOLE),
}
"""For each kind of reason, the most important first: the roles that hang on it, and why, as a clause."""

WEIGHT = {kind: place for place, kind in enumerate(HANGING)}


def by_weight(reasons: Sequence[Reason]) -> tuple[Reason, ...]:
    """Return reasons, the most important first, each once."""
    return tuple(sorted(dict.fromkeys(reasons), key=lambda reason: WEIGHT[reason.kind]))


def hangs_on(name: str, kind: ReasonKind) -> bool:
    """Return whether a number hangs on what a reason of some kind calls in question."""
    roles, _ = HANGING[kind]
    return bool(ROLES.get(name, ALL) & roles)


def clause_of(name: str, reasons: Sequence[Reason]) -> str:
    """Return why a number may not be trusted, by the first of the reasons that it hangs on; empty where by none."""
    return next((HANGING[reason.kind][1] for reason in reasons if hangs_on(name, reason.kind)), "")
