"""The limits that are looked for: parameters of the one governor that has them all, and levels to try."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.catalogue._limited_governor import GovernorSymbol


class Kind(Enum):
    """A limit that is fitted; the value is its name in words."""

    TORQUE = "torque limit"
    MOTORING = "motoring limit"
    SMOKE = "smoke limit"
    RATE = "rate limit of the fuel rack"
    RAMP = "rate limit of the set point"
    DEADBAND = "deadband"
    HELD = "held set point"
    QUANTUM = "quantised set point"


STRUCTURE_LIMITS: Mapping[Kind, tuple[str, ...]] = {
    Kind.TORQUE: ("torque",),
    Kind.MOTORING: ("torque",),
    Kind.SMOKE: ("torque", "smoke"),
    Kind.RATE: ("rate",),
    Kind.DEADBAND: ("deadband",),
    Kind.RAMP: ("ramp",),
}
"""Limits of ``catalogue.limited`` and ``time_domain.structure_for``; a set point that is held or rounded has none."""

# Values with which a limit does nothing. None of them is a round zero, for that would be another simulation.
IDLE: Mapping[str, float] = {
    GovernorSymbol.TORQUE_LIMIT: 60.0,
    GovernorSymbol.MOTORING_LIMIT: -60.0,
    GovernorSymbol.ANTI_WINDUP: 0.5,
    GovernorSymbol.RACK_RATE: 1e5,
    GovernorSymbol.DEADBAND: 1e-12,
    GovernorSymbol.UNBOOSTED_TORQUE: 1.0,
    GovernorSymbol.TURBOCHARGER_LAG: 1.0,
    GovernorSymbol.SET_POINT_RATE: 1e5,
}


@dataclass(frozen=True, kw_only=True, slots=True)
class LimitCandidate:
    """One limit that may act."""

    kind: Kind
    """What it is."""
    level: str
    """Parameter of its level, rate or width."""
    companions: tuple[str, ...] = ()
    """Further parameters that are fitted with it."""
    shares: tuple[float, ...] = ()
    """Levels to try, strongest limit first, as shares of the extreme torque that the governor asks for."""
    levels: tuple[float, ...] = ()
    """The same as values of the parameter."""


CANDIDATES: tuple[LimitCandidate, ...] = (
    LimitCandidate(
        kind=Kind.TORQUE,
        level=GovernorSymbol.TORQUE_LIMIT,
        companions=(GovernorSymbol.ANTI_WINDUP,),
        shares=(0.4, 0.5, 0.6, 0.7, 0.8, 0.87, 0.93, 0.97),
    ),
    LimitCandidate(
        kind=Kind.MOTORING,
        level=GovernorSymbol.MOTORING_LIMIT,
        companions=(GovernorSymbol.ANTI_WINDUP,),
        shares=(0.05, 0.3, 0.6, 0.85),
    ),
    LimitCandidate(kind=Kind.RATE, level=GovernorSymbol.RACK_RATE, levels=tuple(np.geomspace(0.5, 30.0, 9).tolist())),
    LimitCandidate(
        kind=Kind.RAMP, level=GovernorSymbol.SET_POINT_RATE, levels=tuple(np.geomspace(0.01, 4.0, 12).tolist())
    ),
    LimitCandidate(
        kind=Kind.DEADBAND, level=GovernorSymbol.DEADBAND, levels=(0.016, 0.011, 0.0075, 0.005, 0.0033, 0.0022, 0.0015)
    ),
    LimitCandidate(
        kind=Kind.SMOKE,
        level=GovernorSymbol.UNBOOSTED_TORQUE,
        companions=(GovernorSymbol.TURBOCHARGER_LAG, GovernorSymbol.ANTI_WINDUP),
        levels=(0.3, 0.42, 0.55, 0.7, 0.85, 0.95),
    ),
)
"""In the order in which they are tried."""

LAGS_S = (0.6, 1.6)
"""Lags of the turbocharger that are tried with each torque without boost [s]."""

LARGEST_UNBOOSTED = 0.95
FULL_SHARES = (0.5, 0.65, 0.8, 0.9, 1.1, 1.25)
"""Full-load torques over that of the vessel file that are tried beside a smoke limit."""


def starts_of(
    candidate: LimitCandidate, values: Mapping[str, float], torque: FloatArray, full: float
) -> list[dict[str, float]]:
    """Return the values of its parameters to try, the strongest limit first.

    ``values``: present value of every parameter. ``torque``: brake torque that the governor asks for, over that of the
    working point, shape (samples,). ``full``: full-load torque of the vessel file over the brake torque of the working
    point.
    """
    match candidate.kind:
        case Kind.TORQUE if values[GovernorSymbol.UNBOOSTED_TORQUE] < IDLE[GovernorSymbol.UNBOOSTED_TORQUE]:
            # a smoke limit is a share of the torque limit: what there is without boost stays
            unboosted = values[GovernorSymbol.UNBOOSTED_TORQUE]
            return [
                {
                    GovernorSymbol.TORQUE_LIMIT: share * full,
                    GovernorSymbol.UNBOOSTED_TORQUE: min(unboosted / share, LARGEST_UNBOOSTED),
                }
                for share in FULL_SHARES
            ]
        case Kind.TORQUE:
            # below the torque of steady running there is no line that could be tested
            highest = float(np.max(torque))
            tried = [max(share * highest, 1.02) for share in candidate.shares]
            return [{GovernorSymbol.TORQUE_LIMIT: level} for level in dict.fromkeys(tried)]
        case Kind.MOTORING:
            lowest = float(np.min(torque))
            return (
                [{GovernorSymbol.MOTORING_LIMIT: share * lowest} for share in candidate.shares]
                if lowest < -0.05
                else []
            )
        case Kind.SMOKE:
            limit = (
                values[GovernorSymbol.TORQUE_LIMIT]
                if values[GovernorSymbol.TORQUE_LIMIT] < IDLE[GovernorSymbol.TORQUE_LIMIT]
                else full
            )
            return [
                {
                    GovernorSymbol.UNBOOSTED_TORQUE: a,
                    GovernorSymbol.TURBOCHARGER_LAG: lag,
                    GovernorSymbol.TORQUE_LIMIT: limit,
                }
                for a in candidate.levels
                for lag in LAGS_S
            ]
        case _:
            return [{candidate.level: level} for level in candidate.levels]


def idle_values(gone: Kind, kept: Sequence[Kind], full: float) -> dict[str, float]:
    """Return values of a limit's parameters at which it does nothing beside others that are kept.

    A smoke limit is a share of the torque limit: without one, of the full-load torque of the vessel file, ``full``.
    """
    idle = {name: IDLE[name] for name in set(parameters_of([gone])) - set(parameters_of(kept))}
    return idle | ({GovernorSymbol.TORQUE_LIMIT: full} if gone is Kind.TORQUE and Kind.SMOKE in kept else {})


def parameters_of(kinds: Sequence[Kind]) -> tuple[str, ...]:
    """Return the free parameters of some limits."""
    present = [candidate for candidate in CANDIDATES if candidate.kind in kinds]
    return tuple(dict.fromkeys(name for one in present for name in (one.level, *one.companions)))
