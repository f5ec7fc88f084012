"""Two fingerprints as one difference with its covariance, and the directions of the causes in it.

What is a share, such as a gain or an inertia, is compared by its logarithm, a time as it is. The covariance of the
difference is what each test left open, and of what was stated beforehand only what does not cancel: where both vessel
files state the same scale of the gauge, its error moves both tests alike (``_shared_errors``).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.catalogue._roles import ShipRole
from shaftprint.drift._causes import CAUSES, GAUGE, GAUGE_SCALE, Cause, by_role, may_happen, of_number
from shaftprint.drift._doubts import doubts_of, judged_together, left_out_of
from shaftprint.drift._shared_errors import SharedErrors, shared_errors
from shaftprint.drift._single_test import SingleTest, single_test
from shaftprint.drift._straight import straightened

if TYPE_CHECKING:
    from shaftprint.fingerprint._line_fingerprint import LineFingerprint
    from shaftprint.models._role import Role


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Judged:
    """What can be judged of tests: numbers that all of them have, and what may have moved these."""

    names: tuple[str, ...]
    """Numbers that are judged together."""
    left_out: dict[str, str]
    """Why others are not, by name."""
    causes: tuple[Cause, ...]
    """What may have moved the numbers."""
    directions: FloatArray
    """What a change of each cause by 1, or by a second, does to the numbers of a test; shape (numbers, causes)."""
    not_judged: tuple[Cause, ...]
    """What may have moved numbers that were left out: it is not excluded."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Pair(Judged):
    """The difference of two fingerprints."""

    difference: FloatArray
    """Other minus first: of logarithms, and of times [s]; shape (numbers,)."""
    covariance: FloatArray
    """Its covariance where nothing changed, shape (numbers, numbers)."""


def pair_of(
    first: "LineFingerprint", other: "LineFingerprint", *, load_repeatability: float, moved: FloatArray | None = None
) -> Pair | None:
    """Return the difference of two fingerprints; None where one of them does not hold its numbers together.

    ``first``, ``other``: two fingerprints of one ship, the earlier one first. ``load_repeatability``: standard
    deviation of the torque that a propeller takes at one speed from day to day, as a share. ``moved``: what a change of
    the ship has done to the numbers, shape (numbers,); nothing when not given.
    """
    if first.joint is None or other.joint is None:
        return None
    doubts = doubts_of(first, other)
    names = judged_together(doubts)
    roles = {name: first.quantity(name).role for name in names}
    singles = [single_test(one, names) for one in (first, other)]
    by = None if moved is None else np.array([np.zeros(len(names)), moved])
    before, after = straightened((first, other), singles, names, by)
    # the propeller takes another torque on another day
    shared = shared_errors(first, other)
    load = np.array([load_repeatability * (role == ShipRole.TORQUE) for role in roles.values()])
    units = {name: first.quantity(name).unit for name in names}
    causes, directions = directions_of(roles, before.loadings.get(GAUGE_SCALE), units)
    return Pair(
        names=names,
        left_out=left_out_of(doubts),
        difference=after.values - before.values,
        covariance=_covariance(before, after, shared, unmoved=alike(first, other) and not shared.of_each_piece)
        + 2.0 * np.diag(load**2),
        causes=causes,
        not_judged=not_judged(causes, doubts, (first, other)),
        directions=directions,
    )


def not_judged(
    causes: tuple[Cause, ...], doubts: Mapping[str, str], fingerprints: "Sequence[LineFingerprint]"
) -> tuple[Cause, ...]:
    """Return the causes that move numbers which were left out, so that they are not excluded.

    ``causes``: those that are judged. ``doubts``: why each number is not judged; empty where it is. ``fingerprints``:
    fingerprints that have these numbers.
    """
    of_all = {
        name: one.quantity(name).role for one in fingerprints if one.joint is not None for name in one.joint.names
    }
    every = set(of_all.values())
    roles = {role for name, role in of_all.items() if doubts[name]}
    return tuple(
        cause
        for cause in CAUSES
        if cause not in causes
        and may_happen(cause, every)
        and any(role in alike for alike in cause.roles for role in roles)
    )


def alike(first: "LineFingerprint", other: "LineFingerprint") -> bool:
    """Return whether two tests weigh what was stated against their data alike: the same lines, the same structure."""
    return weighing(first) == weighing(other)


def weighing(test: "LineFingerprint") -> tuple[frozenset[str], str]:
    """Return what is the same of tests that are ``alike``."""
    return frozenset(one.sha256 for one in test.sources if one.role in ("campaign", "drive")), test.structure


def _covariance(before: SingleTest, after: SingleTest, shared: SharedErrors, *, unmoved: bool) -> FloatArray:
    """Return the covariance of the difference where nothing changed.

    What was stated in common cancels where it moves both alike. Of tests with the same lines and structure it does: by
    how much its effects differ is noise of the estimates at which they were worked out, which is in their covariance.
    Of two lines a share of it is of each piece alone. Such a piece is another one in truth too: where the inertia of a
    line is larger than that of the drawing, its estimates are those of the larger one less what the drawing pulls.
    """
    own = shared.of_each_piece
    covariance = before.own + after.own
    nothing = np.zeros(len(covariance))
    for source in dict.fromkeys((*before.loadings, *after.loadings)):
        one, two = (test.loadings.get(source, nothing) for test in (before, after))
        if source not in shared.common:
            parts: tuple[FloatArray, ...] = (one, two)
        elif unmoved:
            parts = ()
        else:
            pieces = (test.stated[source] - test.loadings[source] for test in (before, after))
            parts = (np.sqrt(1.0 - own) * (two - one), *(np.sqrt(own) * piece for piece in pieces))
        for part in parts:
            covariance = covariance + np.outer(part, part)
    return covariance


def directions_of(
    roles: "dict[str, Role | None]", scale: FloatArray | None, units: Mapping[str, str] = MappingProxyType({})
) -> tuple[tuple[Cause, ...], FloatArray]:
    """Return what may have moved the numbers, and how.

    ``roles``: role of each number; where none has one, as in a drive, each may have moved by itself. ``scale``: what
    one standard deviation of the scale of the gauge does to them; None where it is known exactly. ``units``: unit of
    each number that has no role.
    """
    names = list(roles)
    moved = {cause: by_role(cause, roles) for cause in CAUSES}
    if not any(roles.values()):
        moved = {of_number(name, units[name]): (name,) for name in names}
    columns = {cause: np.isin(names, there).astype(np.float64) for cause, there in moved.items() if there}
    torque = list(roles.values()).index(ShipRole.TORQUE) if ShipRole.TORQUE in roles.values() else None
    if scale is not None and torque is not None and scale[torque]:
        # the torque coefficient goes with the scale itself
        columns[GAUGE] = scale / abs(scale[torque])
    return tuple(columns), np.array(list(columns.values())).T.reshape(len(names), len(columns))
