"""How the set point goes to the level of a leg, from one leg to the next, and back: straight ramps, never a jump."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.campaign._excitation import ROUNDING_S
from shaftprint.campaign._leg import Leg

if TYPE_CHECKING:
    from shaftprint.arrays import FloatArray
    from shaftprint.campaign._excitation import Excitation

# A move smaller than this is the rounding of a voltage [V].
_NOTHING_V = 1e-9


@dataclass(frozen=True, kw_only=True, slots=True)
class Move:
    """What the set point does between two excitations of which one is a leg.

    It stands at ``from_v``, goes straight to ``to_v``, and stands there.
    """

    free_s: tuple[float, float]
    """When the excitation before has stopped, and when the one after it starts [s]; 0 and infinite without one."""
    start_s: float
    """When the ramp begins [s]."""
    stop_s: float
    """When it ends [s]."""
    from_v: float
    """Set point before [V]."""
    to_v: float
    """Set point after [V]."""
    where: str
    """Between which excitations, in words."""

    def value_at(self, time_s: "FloatArray") -> "FloatArray":
        """Return the set point [V] at times between the two excitations."""
        return np.interp(time_s, [self.start_s, self.stop_s], [self.from_v, self.to_v])

    @property
    def fits(self) -> bool:
        """Whether there is time for it."""
        return self.start_s >= self.free_s[0] - ROUNDING_S and self.stop_s <= self.free_s[1] + ROUNDING_S


def moves_of(
    tests: "Sequence[Excitation]",
    *,
    offset_v: float,
    duration_s: float,
    ramp_s: float | None,
    ramp_v_per_s: float | None,
) -> tuple[Move, ...]:
    """Return the moves of a campaign in order of time.

    A ramp to a leg ends where the leg starts, with the value with which that begins; the ramp back to the offset begins
    where a leg stops. Between two legs the set point waits at the last value of the first.

    ``tests``: what moves the set point of the speed, in order of time. ``offset_v``, ``duration_s``: set point outside
    of every test [V], and length of the campaign [s]. ``ramp_s``, ``ramp_v_per_s``: time [s] or rate [V/s] of every
    ramp; without both they jump.
    """
    moves = []
    for before, after in pairwise((None, *tests, None)):
        if not isinstance(before, Leg) and not isinstance(after, Leg):
            continue
        from_v, to_v = ends_of_move(before, after, offset_v=offset_v)
        length_s = length_of_move_s(abs(to_v - from_v), ramp_s=ramp_s, ramp_v_per_s=ramp_v_per_s)
        begin_s = 0.0 if before is None else before.stop_s
        end_s = duration_s if after is None else after.start_s
        start_s = end_s - length_s if isinstance(after, Leg) else begin_s
        moves.append(
            Move(
                free_s=(begin_s, end_s),
                start_s=start_s,
                stop_s=start_s + length_s,
                from_v=from_v,
                to_v=to_v,
                where=_where(before, after),
            )
        )
    return tuple(moves)


def ends_of_move(before: "Excitation | None", after: "Excitation | None", *, offset_v: float) -> tuple[float, float]:
    """Return where the set point stands after one test and where it goes to for the next [V]; the offset without."""
    from_v = _value(before, before.stop_s) if isinstance(before, Leg) else offset_v
    to_v = _value(after, after.start_s) if isinstance(after, Leg) else offset_v
    return from_v, to_v


def length_of_move_s(volts: float, *, ramp_s: float | None, ramp_v_per_s: float | None) -> float:
    """Return how long the ramp over so many volts takes [s]; 0 where it is none, or jumps."""
    if volts < _NOTHING_V or (ramp_s is None and ramp_v_per_s is None):
        return 0.0
    return ramp_s if ramp_s is not None else volts / (ramp_v_per_s or 1.0)


def faults_of(moves: "Sequence[Move]", *, ramp_s: float | None, ramp_v_per_s: float | None) -> list[str]:
    """Return what is wrong with the ramps of a campaign, one sentence each.

    ``moves``: from `moves_of`. ``ramp_s``, ``ramp_v_per_s``: what the campaign states of them.
    """
    if ramp_s is not None and ramp_v_per_s is not None:
        return ["expected one of ramp_s and ramp_v_per_s, found both."]
    if ramp_s is None and ramp_v_per_s is None:
        jumps = [move for move in moves if abs(move.to_v - move.from_v) >= _NOTHING_V]
        return [
            f"expected ramp_s or ramp_v_per_s, how the set point goes from {move.from_v:g} to {move.to_v:g} V "
            f"{move.where} without a jump, found neither."
            for move in jumps[:1]
        ]
    return [
        f"expected at least {move.stop_s - move.start_s:.4g} s {move.where} for the ramp from {move.from_v:g} to "
        f"{move.to_v:g} V, found {move.free_s[1] - move.free_s[0]:.4g} s."
        for move in moves
        if not move.fits
    ]


def _value(leg: Leg, time_s: float) -> float:
    return float(leg.value_at(np.array([time_s]))[0])


def _where(before: "Excitation | None", after: "Excitation | None") -> str:
    """Return between which excitations a move is, in words."""
    if before is None:
        return "" if after is None else f"before {after.name}"
    return f"after {before.name}" if after is None else f"between {before.name} and {after.name}"
