"""How the set point goes to the level of a leg, from one leg to the next, and back: straight ramps, never a jump."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.campaign._leg import Leg

if TYPE_CHECKING:
    from shaftprint.arrays import FloatArray
    from shaftprint.campaign._campaign import Campaign, Excitation

# A move smaller than this is the rounding of a voltage [V].
_NOTHING_V = 1e-9
_ROUNDING_S = 1e-9


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
        return self.start_s >= self.free_s[0] - _ROUNDING_S and self.stop_s <= self.free_s[1] + _ROUNDING_S


def moves_of(campaign: "Campaign") -> tuple[Move, ...]:
    """Return the moves of a campaign in order of time.

    A ramp to a leg ends where the leg starts, with the value with which that begins; the ramp back to the offset begins
    where a leg stops. Between two legs the set point waits at the last value of the first.
    """
    tests = campaign.of_input().excitations
    if not any(isinstance(test, Leg) for test in tests):
        return ()
    stations: Sequence[Excitation | None] = (None, *tests, None)
    moves = (_move(campaign, before, after) for before, after in pairwise(stations))
    return tuple(move for move in moves if move is not None)


def _move(campaign: "Campaign", before: "Excitation | None", after: "Excitation | None") -> Move | None:
    from_v = _value(before, before.stop_s) if isinstance(before, Leg) else campaign.offset_v
    to_v = _value(after, after.start_s) if isinstance(after, Leg) else campaign.offset_v
    if not isinstance(before, Leg) and not isinstance(after, Leg):
        return None
    free_s = (0.0 if before is None else before.stop_s, campaign.duration_s if after is None else after.start_s)
    length_s = _length_s(campaign, abs(to_v - from_v))
    start_s, stop_s = (free_s[1] - length_s, free_s[1]) if isinstance(after, Leg) else (free_s[0], free_s[0] + length_s)
    words = f"between {before.name} and {after.name}" if before and after else ""
    return Move(
        free_s=free_s,
        start_s=start_s,
        stop_s=stop_s,
        from_v=from_v,
        to_v=to_v,
        where=words or (f"before {after.name}" if after else f"after {before.name}" if before else ""),
    )


def _value(leg: Leg, time_s: float) -> float:
    return float(leg.value_at(np.array([time_s]))[0])


def _length_s(campaign: "Campaign", volts: float) -> float:
    """Return how long a move of so many volts takes [s]; 0 where no ramp is stated."""
    if volts < _NOTHING_V:
        return 0.0
    if campaign.ramp_s is not None:
        return campaign.ramp_s
    return 0.0 if campaign.ramp_v_per_s is None else volts / campaign.ramp_v_per_s


def faults_of(campaign: "Campaign") -> list[str]:
    """Return what is wrong with the ramps of a campaign, one sentence each."""
    moves = moves_of(campaign)
    if campaign.ramp_s is not None and campaign.ramp_v_per_s is not None:
        return ["expected one of ramp_s and ramp_v_per_s, found both."]
    if campaign.ramp_s is None and campaign.ramp_v_per_s is None:
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
