"""The newest tests of sister ships as one vector of numbers with its covariance, and how ships may differ as built."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.catalogue._roles import ShipRole
from shaftprint.choices import NEWEST_TESTS
from shaftprint.drift._causes import GAUGE_SCALE, Cause
from shaftprint.drift._dated import DatedTest
from shaftprint.drift._doubts import judged_in
from shaftprint.drift._history import History
from shaftprint.drift._pair import Judged, directions_of, not_judged
from shaftprint.drift._series import own_covariances, stated_errors
from shaftprint.drift._shared_errors import is_common
from shaftprint.drift._single_test import SingleTest, single_test
from shaftprint.drift._straight import straightened
from shaftprint.fingerprint._vessel_fields import BEHIND, TVC

if TYPE_CHECKING:
    from shaftprint.models._role import Role

OTHER_TOLERANCES: Final[dict["Role", float]] = {
    ShipRole.ACTUATOR_DAMPING: 0.03,
    # a test finds what the builder states
    ShipRole.INERTIA_UPSTREAM: 0.0,
}
"""Standard deviations between sister ships of numbers that no cause moves alone."""
PIECES_STD = 0.005
"""Standard deviation between sisters of the inertia ahead of the gauge: engine, flywheel and gearbox by one drawing."""
_USUAL_TOLERANCE = 0.01


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Sister:
    """A ship of a class with the tests that stand for it."""

    name: str
    """What it is called."""
    tests: tuple[DatedTest, ...]
    """Its tests, the earliest first."""


def sister_of(name: str, history: History, *, newest: int = NEWEST_TESTS) -> Sister:
    """Return a ship with its newest tests, none of which was made before the last thing that was done to it.

    Where no test was made since, the newest one stands for it. ``name``: what it is called. ``history``: its tests, and
    what was done to it. ``newest``: how many tests stand for it at most.
    """
    last = max((event.at for event in history.events), default=None)
    since = tuple(test for test in history.tests if last is None or test.at >= last)
    return Sister(name=name, tests=(since or history.tests[-1:])[-newest:])


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ClassNumbers(Judged):
    """The numbers of all ships of a class."""

    values: FloatArray
    """Mean of the tests of each ship: logarithms, and times [s]; shape (ships, numbers)."""
    own: FloatArray
    """Covariance that the tests of each ship leave open by themselves; shape (ships, numbers, numbers)."""
    common: FloatArray
    """What one deviation of each error that several ships share does to them; shape (ships, numbers, errors)."""
    building: FloatArray
    """What one standard deviation of each tolerance of building does to the numbers, those of the causes first; shape
    (numbers, tolerances)."""
    tolerances: FloatArray
    """That standard deviation for each cause: a share, or a time [s]; shape (causes,)."""
    is_known: bool
    """Whether the tolerances are known; else the ships tell how much of them there is."""

    def covariance_of(self, sums: FloatArray) -> FloatArray:
        """Return the covariance of weighted sums of the numbers that tests leave open.

        ``sums``: weights of the numbers of all ships, those of one ship together; shape (sums, ships * numbers).
        """
        count, size = self.values.shape
        of_ship = sums.reshape(-1, count, size).transpose(1, 0, 2)
        along = sums @ self.common.reshape(count * size, -1)
        covariance: FloatArray = (of_ship @ self.own @ of_ship.transpose(0, 2, 1)).sum(axis=0) + along @ along.T
        return covariance


def class_numbers(
    ships: Sequence[Sister], *, load_repeatability: float, tolerances: Mapping[Cause, float] | None = None
) -> ClassNumbers:
    """Return the numbers that all tests of all ships have, a mean of each ship.

    ``ships``: ships of one class, each with one test at least. ``load_repeatability``: standard deviation of the torque
    that a propeller takes at one speed from day to day, as a share. ``tolerances``: standard deviations between sisters
    as they are built, by cause: shares, or times [s]. Where they are given they are known, and so are the usual ones of
    other causes.
    """
    tests = [test.fingerprint for ship in ships for test in ship.tests]
    judged = judged_in([test for ship in ships for test in ship.tests])
    names = judged.names
    roles = {name: tests[0].quantity(name).role for name in names}
    units = {name: tests[0].quantity(name).unit for name in names}
    singles = straightened(tests, judged.told([single_test(one, names) for one in tests]), names)
    load = np.diag([(load_repeatability * (role == ShipRole.TORQUE)) ** 2 for role in roles.values()])
    covariances = own_covariances(tests, singles, judged.whole)
    own = [one + np.diag(unknown) for one, unknown in zip(covariances, judged.unknown, strict=True)]
    weights = _weights(ships, own)
    alone, common = _left_open(ships, singles, weights, [one + load for one in own], judged.whole)
    causes, directions = directions_of(roles, singles[0].loadings.get(GAUGE_SCALE), units)
    stated = np.array([(tolerances or {}).get(cause, cause.tolerance) for cause in causes])
    return ClassNumbers(
        names=names,
        left_out=judged.left_out,
        values=weights @ np.array([one.values for one in singles]),
        own=alone,
        common=common,
        building=np.column_stack([_building(roles, causes, directions * stated), _pieces(roles, singles)]),
        tolerances=stated,
        is_known=tolerances is not None,
        causes=causes,
        directions=directions,
        not_judged=not_judged(causes, judged.doubts, tests),
    )


def _weights(ships: Sequence[Sister], own: Sequence[FloatArray]) -> FloatArray:
    """Return by how much each test counts in the mean of its ship, shape (ships, tests)."""
    precise = np.array([1.0 / np.trace(one) for one in own])
    of_ship = np.repeat(np.arange(len(ships)), [len(ship.tests) for ship in ships])
    weights = np.where(of_ship == np.arange(len(ships))[:, None], precise, 0.0)
    normalised: FloatArray = weights / weights.sum(axis=1, keepdims=True)
    return normalised


def _left_open(
    ships: Sequence[Sister],
    singles: Sequence[SingleTest],
    weights: FloatArray,
    own: Sequence[FloatArray],
    whole: BoolArray,
) -> tuple[FloatArray, FloatArray]:
    """Return what tests leave open of the mean of each ship alone, and what errors do that several ships share.

    A drawing or an engine type is the same in all ships, a sensor is one of its ship.
    """
    tests = [test.fingerprint for ship in ships for test in ship.tests]
    of_ship = [place for place, ship in enumerate(ships) for _ in ship.tests]
    alone = np.einsum("st,tpq->spq", weights**2, np.array(own))
    common = []

    def shared(source: str, one: int, other: int) -> bool:
        same = source not in BEHIND or of_ship[one] == of_ship[other]
        return same and is_common(source, tests[one], tests[other])

    for moved in stated_errors(tests, singles, shared, whole):
        of_ships = weights @ moved
        concerned = np.flatnonzero(of_ships.any(axis=1))
        if concerned.size > 1:
            common.append(of_ships)
        else:
            alone[concerned] += of_ships[concerned, :, None] * of_ships[concerned, None, :]
    return alone, np.array(common).reshape(-1, *alone.shape[:2]).transpose(1, 2, 0)


def _pieces(roles: "dict[str, Role | None]", singles: Sequence[SingleTest]) -> FloatArray:
    """Return what pieces ahead of the gauge that differ from their drawing do to the numbers, shape (numbers, 0 or 1).

    A ship with heavier pieces is another one in truth: estimates are those of the heavier line, less what the drawing
    pulls, so that its inertia stays that of the drawing and the gains move.
    """
    upstream = [at for at, role in enumerate(roles.values()) if role == ShipRole.INERTIA_UPSTREAM]
    drawn = [one for one in singles if upstream and one.stated.get(TVC, np.zeros(len(roles)))[upstream[0]]]
    if not drawn:
        return np.zeros((len(roles), 0))
    apart = [(one.stated[TVC] - one.loadings[TVC]) / one.stated[TVC][upstream[0]] for one in drawn]
    column: FloatArray = PIECES_STD * np.mean(apart, axis=0)[:, np.newaxis]
    return column


def _building(roles: "dict[str, Role | None]", causes: Sequence[Cause], of_causes: FloatArray) -> FloatArray:
    """Return what tolerances of building do to the numbers: those of the causes, and of numbers that no cause moves."""
    alone = [any(len(one.roles) == 1 and role in one.roles[0] for one in causes) for role in roles.values()]
    others = [
        0.0 if moved or role is None else OTHER_TOLERANCES.get(role, _USUAL_TOLERANCE)
        for moved, role in zip(alone, roles.values(), strict=True)
    ]
    of_numbers = np.diag(others)[:, np.array(others) > 0.0]
    building: FloatArray = np.column_stack([of_causes, of_numbers])
    return building
