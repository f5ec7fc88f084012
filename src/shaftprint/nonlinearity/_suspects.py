"""The nonlinearities that are looked for, each as one or two more terms of the replay."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from shaftprint.nonlinearity._fit import ABSENT, foretold
from shaftprint.nonlinearity._record import Record
from shaftprint.nonlinearity._replay import NONE

Kind: TypeAlias = Literal[
    "torque limit",
    "motoring limit",
    "rate limit of the fuel rack",
    "rate limit of the set point",
    "deadband",
    "quantised set point",
    "turbocharger lag",
    "governor windup",
    "quadratic propeller only",
]

Values: TypeAlias = Mapping[str, float]

# Shares of what the linear governor asks for at the most: a limit that cuts less than a twentieth is hardly one.
_LIMIT_SHARES = (0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.87, 0.94)
_MOTORING_SHARES = (0.02, 0.1, 0.3, 0.5, 0.7, 0.85)
_LEAST_MOTORING = 0.02
_RACK_RATES = tuple(np.geomspace(0.3, 30.0, 10).tolist())
_SET_POINT_RATES = tuple(np.geomspace(0.02, 8.0, 12).tolist())
_DEADBANDS = tuple(np.geomspace(5e-4, 0.03, 8).tolist())
_AIR = (0.25, 0.4, 0.55, 0.7, 0.85)
_BOOST_S = (0.6, 1.5, 4.0)


Starts: TypeAlias = list[dict[str, float]]


@dataclass(frozen=True, kw_only=True, slots=True)
class Suspect:
    """One nonlinearity that may be present."""

    kind: Kind
    """What it is called."""
    terms: tuple[str, ...]
    """Terms of the replay that it frees."""
    starts: Callable[[Record, Values], Starts]
    """Gives values of its terms to try; none where it is in the replay already or cannot act."""


def _torque_limits(record: Record, values: Values) -> Starts:
    if values["limit"] < NONE:
        return []
    engine, _ = foretold(record, values)
    full = np.interp(record.speed, record.curve_speed, record.curve_torque)
    return [{"limit": share * float(np.max(engine / full))} for share in _LIMIT_SHARES]


def _motoring_limits(record: Record, values: Values) -> Starts:
    engine, _ = foretold(record, values)
    lowest = -float(np.min(engine))
    if values["m_min"] < NONE or lowest < _LEAST_MOTORING:
        return []
    return [{"m_min": share * lowest} for share in _MOTORING_SHARES]


def _smoke_limits(record: Record, values: Values) -> Starts:
    """Return a grid of shares without boost and of times of the boost, below the full-load curve."""
    if values["air"] < 1.0:
        return []
    limit = min(values["limit"], 1.0) if values["limit"] >= NONE else values["limit"]
    return [{"air": air, "boost_s": boost_s, "limit": limit} for air in _AIR for boost_s in _BOOST_S]


def _listed(name: str, tries: tuple[float, ...]) -> Callable[[Record, Values], Starts]:
    def starts(record: Record, values: Values) -> Starts:
        return [{name: value} for value in tries] if values[name] == ABSENT[name] else []

    return starts


SUSPECTS: tuple[Suspect, ...] = (
    Suspect(kind="torque limit", terms=("limit",), starts=_torque_limits),
    Suspect(kind="motoring limit", terms=("m_min",), starts=_motoring_limits),
    Suspect(kind="rate limit of the fuel rack", terms=("r_x",), starts=_listed("r_x", _RACK_RATES)),
    Suspect(kind="rate limit of the set point", terms=("r_s",), starts=_listed("r_s", _SET_POINT_RATES)),
    Suspect(kind="deadband", terms=("d_e",), starts=_listed("d_e", _DEADBANDS)),
    Suspect(kind="turbocharger lag", terms=("air", "boost_s"), starts=_smoke_limits),
)
"""All that are terms of the replay; a quantised set point is looked for in another way."""
