"""Sister ships of a class: which of them is not as the others are, in what, and how much sisters differ.

Each ship is held against the class that the others tell, so that an odd one does not widen what it is judged by. Its
difference is whitened by what its tests leave open *and* by how much sisters differ as built: with the former alone a
tolerance of an injection pump is taken for whatever cause lies across it. Ships that are found no longer count among
the others, and all are judged once more.
"""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.choices import LOAD_REPEATABILITY
from shaftprint.distributions import deviations, f_tail, normal_cdf
from shaftprint.drift._along import p_value_of_largest
from shaftprint.drift._between_ships import (
    Departure,
    Spread,
    between_ships,
    departure_of,
    prediction,
    shrunk,
    spread_of,
)
from shaftprint.drift._causes import Cause
from shaftprint.drift._class_finding import CauseSpread, ClassFinding, NumberSpread, ShipNumber, ShipSize, ShipStanding
from shaftprint.drift._class_numbers import ClassNumbers, Sister, class_numbers
from shaftprint.drift._differ import NOT_DETERMINED, NOT_TOLD, UNLIKELY
from shaftprint.drift._discoveries import discoveries
from shaftprint.drift._finding import ShipChange, SizedCause, odds_against
from shaftprint.drift._single_test import is_share
from shaftprint.fingerprint._design import another_design, in_short

FEWEST_SISTERS = 4
"""Ships that a class has at least: three others tell how much ships differ."""
_COVERAGE = 0.95
_FARTHEST, _BISECTIONS = 38.0, 60
# Degrees of freedom beyond which Student's t is the normal distribution.
_NORMAL = 1000.0


def judge_sisters(
    ships: Sequence[Sister],
    *,
    load_repeatability: float = LOAD_REPEATABILITY,
    tolerances: Mapping[Cause, float] | None = None,
) -> ClassFinding:
    """Return which ships of a class are not as their sisters are, what may be other in them, and how sisters differ.

    Of the ships that are named, one in twenty at most is a sound one in the mean.

    Parameters
    ----------
    ships
        Ships of one class, each with one test at least.
    load_repeatability
        Standard deviation of the torque that a propeller takes at one speed from day to day, as a share.
    tolerances
        Standard deviations between sisters as they are built that the builder states, by cause: shares, or times [s].
        Where they are given they are known, and so are the usual ones of other causes; else the ships tell how much of
        the usual ones there is.
    """
    if len(ships) < FEWEST_SISTERS:
        return _nothing(f"expected {FEWEST_SISTERS} ships with tests that can be judged or more, found {len(ships)}")
    place, designs = another_design([ship.tests[0].fingerprint.stated_fields for ship in ships])
    if designs:
        return _nothing(f"{ships[0].name} and {ships[place].name}: {in_short(designs)}")
    numbers = class_numbers(ships, load_repeatability=load_repeatability, tolerances=tolerances)
    if not numbers.causes:
        return _nothing(NOT_TOLD, numbers.left_out)
    try:
        changes, odd = _judged(numbers)
        spread = spread_of(numbers, tuple(at for at in range(len(ships)) if at not in odd))
        return ClassFinding(
            ships=tuple(
                ShipStanding(name=ship.name, tests=len(ship.tests), is_odd=at in odd, change=change)
                for at, (ship, change) in enumerate(zip(ships, changes, strict=True))
            ),
            causes=_cause_spreads(numbers, spread),
            numbers=_number_spreads(ships, numbers, spread),
            names=numbers.names,
            left_out=numbers.left_out,
            not_judged=numbers.not_judged,
        )
    except np.linalg.LinAlgError:
        return _nothing(NOT_DETERMINED, numbers.left_out)


def _nothing(because: str, left_out: dict[str, str] | None = None) -> ClassFinding:
    return ClassFinding(ships=(), causes=(), numbers=(), names=(), left_out=left_out or {}, because=because)


def _judged(numbers: ClassNumbers) -> tuple[list[ShipChange], tuple[int, ...]]:
    """Return the clearest departure of each ship, and the places of those that are beyond chance."""
    places = range(len(numbers.values))
    odd: tuple[int, ...] = ()
    while True:
        others = [tuple(at for at in places if at != ship and at not in odd) for ship in places]
        changes = [
            _change(departure_of(numbers, ship, spread_of(numbers, others[ship])), numbers.causes) for ship in places
        ]
        found = discoveries([change.p_value for change in changes], UNLIKELY)
        # the others must remain a class, and what was found once stays found
        if set(found) <= set(odd) or len(places) - len(set(found) | set(odd)) < FEWEST_SISTERS:
            return changes, found
        odd = tuple(sorted({*found, *odd}))


def _change(departure: Departure, causes: Sequence[Cause]) -> ShipChange:
    """Return the departure of a ship from its class, with every cause by itself."""
    scores, freedom = departure.white.scores().tolist(), departure.freedom.tolist()
    ordered = sorted(range(len(causes)), key=lambda place: -abs(scores[place]))
    best = ordered[0]
    candidates = []
    for at in ordered:
        size, std = (float(column[0]) for column in departure.white.sizes((at,)))
        size, std = causes[at].stated(size, std)
        odds = _student_odds(scores[at], scores[best], freedom[best])
        candidates.append(SizedCause(cause=causes[at], size=size, std=std, score=scores[at], odds=odds))
    largest = max(_normal_score(score, own) for score, own in zip(scores, freedom, strict=True))
    return ShipChange(candidates=tuple(candidates), p_value=p_value_of_largest(largest, departure.white.cosines()))


def _student_odds(score: float, best: float, freedom: float) -> float:
    """Return the likelihood under the best cause over that under another, where the variance was told by few ships."""
    if freedom > _NORMAL:
        return odds_against(score, abs(best))
    return float(((freedom + best**2) / (freedom + score**2)) ** (0.5 * (freedom + 1.0)))


def _normal_score(score: float, freedom: float) -> float:
    """Return the standard normal score that is as improbable as one of Student's t."""
    p_value = f_tail(score**2, 1.0, freedom)
    low, high = 0.0, _FARTHEST
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if 2.0 * float(normal_cdf(-middle)) > p_value else (low, middle)
    return low


def _cause_spreads(numbers: ClassNumbers, spread: Spread) -> tuple[CauseSpread, ...]:
    """Return how sisters differ along each cause, and where each ship stands, as if it were that cause alone."""
    departures = [departure_of(numbers, ship, spread) for ship in range(len(numbers.values))]
    effects = shrunk(numbers, spread)
    spreads = []
    for at, (cause, direction) in enumerate(zip(numbers.causes, numbers.directions.T, strict=True)):
        tolerance = float(numbers.tolerances[at])
        variance = float(spread.scales[at]) * tolerance**2
        own = (tolerance * effects[:, at]).tolist()
        sizes = [_size(*one, direction=direction, cause=cause) for one in zip(departures, own, strict=True)]
        half = [
            deviations(_COVERAGE, float(one.freedom[at])) * float(one.white.sizes((at,))[1][0]) for one in departures
        ]
        spreads.append(
            CauseSpread(
                cause=cause,
                std=math.sqrt(variance),
                half_width=float(np.median(half)),
                ships=tuple(sizes),
            )
        )
    return tuple(spreads)


def _size(departure: Departure, effect: float, *, direction: FloatArray, cause: Cause) -> ShipSize:
    along = np.linalg.solve(departure.covariance, direction)
    information = float(along @ direction)
    size, std = cause.stated(
        float(along @ departure.difference) / information,
        math.sqrt(float(along @ departure.measured @ along)) / information,
    )
    return ShipSize(size=size, std=std, shrunk=cause.stated(effect, 0.0)[0])


def _number_spreads(ships: Sequence[Sister], numbers: ClassNumbers, spread: Spread) -> tuple[NumberSpread, ...]:
    """Return each number of the class: its mean, where a new sister's lies, and every ship's."""
    first = ships[0].tests[0].fingerprint
    variance, freedom = prediction(numbers, spread)
    effects, between = shrunk(numbers, spread) @ numbers.building.T, between_ships(numbers, spread)
    departures = [departure_of(numbers, ship, spread) for ship in range(len(ships))]
    found = []
    for at, name in enumerate(numbers.names):
        quantity = first.quantity(name)
        unscaled = math.exp if is_share(quantity.role, quantity.unit) else float
        mean = float(spread.mean[at])
        factor = deviations(_COVERAGE, float(freedom[at]))
        half = factor * math.sqrt(float(variance[at]))
        own = [
            ShipNumber(
                value=unscaled(mean + float(one.difference[at])),
                std=math.sqrt(float(one.measured[at, at])) * (unscaled(mean) if unscaled is math.exp else 1.0),
                shrunk=unscaled(mean + float(effects[ship, at])),
                is_outside=abs(float(one.difference[at])) > factor * math.sqrt(float(one.covariance[at, at])),
            )
            for ship, one in enumerate(departures)
        ]
        std = math.sqrt(float(between[at, at]))
        found.append(
            NumberSpread(
                name=name,
                unit=quantity.unit,
                mean=unscaled(mean),
                std=std * (unscaled(mean) if unscaled is math.exp else 1.0),
                interval_95=(unscaled(mean - half), unscaled(mean + half)),
                ships=tuple(own),
            )
        )
    return tuple(found)
