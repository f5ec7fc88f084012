"""How much sister ships differ, and how far one of them is from the others: empirical Bayes in closed form.

Numbers of ship ``s`` are ``y_s = mu + b_s + e_s``: ``e_s`` with the covariance ``C`` that its tests state, ``b_s``
with ``R = k R0``. ``R0`` is the covariance of ships that differ within the tolerances of their causes; how much of it
there is in this class, ``k``, is what the ships themselves tell. With ``V = C + k R0`` of all ships, ``P = V^-1 - V^-1
X (X' V^-1 X)^-1 X' V^-1`` and ``X`` the common mean, the quadratic form ``q = y' P R0 P y`` has the expectation ``tr(P
R0 P C) + k tr(P R0 P R0)``, from which ``k`` follows (C. R. Rao, "Estimation of variance and covariance components:
MINQUE theory", Journal of Multivariate Analysis 1, 1971). Its variance is ``2 tr(P R0 P V P R0 P V) / tr(P R0 P
R0)^2``.

Eight ships cannot tell a spread of each cause: one is told by seven differences, and a limit of Student's t with six
degrees of freedom is twice that of the normal distribution. One scale is told by all causes together.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.drift._along import Whitened, whitened
from shaftprint.drift._class_numbers import ClassNumbers

# The weights are worked out with the scale of the time before, and not quite without a spread.
_ROUNDS, _LEAST_SCALE = 2, 0.05
_MOST_FREEDOM = 1e6


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Spread:
    """How much some ships of a class differ."""

    ships: tuple[int, ...]
    """Places of the ships that tell it."""
    scale: float
    """``k``, the share of the covariance of the tolerances; 1 where ships differ by as much as the tolerances say."""
    scale_variance: float
    """Its variance."""
    mean: FloatArray
    """Mean of the class, shape (numbers,)."""
    weights: FloatArray
    """How it follows from the numbers of all ships, shape (numbers, ships * numbers)."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Departure:
    """How far one ship is from the class that others tell."""

    white: Whitened
    """Its difference and the directions of causes, in coordinates in which a sister's difference is white."""
    freedom: FloatArray
    """Degrees of freedom of the score of each cause, whose variance is in part an estimate; shape (causes,)."""
    difference: FloatArray
    """Ship minus class mean, shape (numbers,)."""
    covariance: FloatArray
    """Of that difference in a sound sister, shape (numbers, numbers)."""
    measured: FloatArray
    """What of it is not the spread of ships: their tests, shape (numbers, numbers)."""


def spread_of(numbers: ClassNumbers, ships: tuple[int, ...]) -> Spread:
    """Return how much some ships of a class differ, and their mean.

    Parameters
    ----------
    numbers
        Numbers of all ships of the class.
    ships
        Places of those that tell it, two at least.
    """
    size = len(numbers.names)
    rows = np.concatenate([np.arange(at * size, (at + 1) * size) for at in ships])
    values = numbers.values[list(ships)].reshape(-1)
    tests = numbers.covariance[np.ix_(rows, rows)]
    built = np.kron(np.eye(len(ships)), numbers.tolerance)
    level = np.tile(np.eye(size, dtype=np.float64), (len(ships), 1))
    scale = 1.0
    for _ in range(_ROUNDS):
        within, _effects = _projection(tests + max(scale, _LEAST_SCALE) * built, level)
        form = within @ built @ within
        of_built = float(np.sum(form * built))
        scale = max((float(values @ form @ values) - float(np.sum(form * tests))) / of_built, 0.0)
    total = tests + scale * built
    both = form @ total
    _differences, mean = _projection(tests + max(scale, _LEAST_SCALE) * built, level)
    weights = np.zeros((size, numbers.covariance.shape[0]))
    weights[:, rows] = mean
    return Spread(
        ships=ships,
        scale=scale,
        scale_variance=2.0 * float(np.sum(both * both.T)) / of_built**2,
        mean=mean @ values,
        weights=weights,
    )


def _projection(covariance: FloatArray, level: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return what weighs differences from the mean, and what makes the mean."""
    inverse = np.asarray(np.linalg.inv(covariance), dtype=np.float64)
    mean = np.asarray(np.linalg.solve(level.T @ inverse @ level, level.T @ inverse), dtype=np.float64)
    return inverse - inverse @ level @ mean, mean


def departure_of(numbers: ClassNumbers, ship: int, spread: Spread) -> Departure:
    """Return how far a ship is from the class that others tell.

    Parameters
    ----------
    numbers
        Numbers of all ships of the class.
    ship
        Place of the ship.
    spread
        What others tell; the ship may be among them, for its distance from a mean that it has a part in.

    Raises
    ------
    numpy.linalg.LinAlgError
        If the covariance is not positive definite.
    """
    size, count = numbers.values.shape[1], len(numbers.values)
    against = -spread.weights
    against[:, ship * size : (ship + 1) * size] += np.eye(size)
    measured = against @ numbers.covariance @ against.T
    built = against @ np.kron(np.eye(count), numbers.tolerance) @ against.T
    covariance = measured + spread.scale * built
    difference = numbers.values[ship] - spread.mean
    return Departure(
        white=whitened(difference, covariance, numbers.directions),
        freedom=_freedom(numbers.directions, covariance, built, spread.scale_variance),
        difference=difference,
        covariance=covariance,
        measured=measured,
    )


def _freedom(directions: FloatArray, covariance: FloatArray, built: FloatArray, variance: float) -> FloatArray:
    """Return the degrees of freedom that an estimated variance has, from its own mean and variance (Satterthwaite)."""
    along = np.linalg.solve(covariance, directions)
    estimate = np.einsum("pd,pq,qd->d", along, covariance, along)
    by_scale = np.einsum("pd,pq,qd->d", along, built, along)
    relative = (by_scale / estimate) ** 2 * variance
    return _of_relative_variance(relative)


def _of_relative_variance(relative: FloatArray) -> FloatArray:
    freedom: FloatArray = 2.0 / np.maximum(relative, 2.0 / _MOST_FREEDOM)
    return freedom


def prediction(numbers: ClassNumbers, spread: Spread) -> tuple[FloatArray, FloatArray]:
    """Return variance and degrees of freedom of each true number of a new sister about the mean; shape (numbers,) each.

    Parameters
    ----------
    numbers
        Numbers of all ships of the class.
    spread
        What its ships tell.
    """
    count = len(numbers.values)
    mean = spread.weights @ numbers.covariance @ spread.weights.T
    built = numbers.tolerance + spread.weights @ np.kron(np.eye(count), numbers.tolerance) @ spread.weights.T
    variance: FloatArray = np.diag(mean + spread.scale * built).copy()
    relative = (np.diag(built) / np.maximum(variance, np.finfo(float).tiny)) ** 2 * spread.scale_variance
    return variance, _of_relative_variance(relative)


def shrunk(numbers: ClassNumbers, spread: Spread) -> FloatArray:
    """Return the difference of each ship from the mean, drawn to it as far as its tests are uncertain.

    It is the expectation of ``b_s`` where the difference is known; shape (ships, numbers).
    """
    rows = []
    for ship in range(len(numbers.values)):
        departure = departure_of(numbers, ship, spread)
        own = np.linalg.solve(departure.covariance, departure.difference)
        # of a ship that has a part in the mean, the covariance of effect and difference is smaller by that part
        size = len(numbers.names)
        part = spread.weights[:, ship * size : (ship + 1) * size]
        rows.append(spread.scale * numbers.tolerance @ (np.eye(size) - part).T @ own)
    return np.array(rows)
