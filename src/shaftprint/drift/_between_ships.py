"""How much sister ships differ, and how far one of them is from the others: empirical Bayes in closed form.

Numbers of ship ``s`` are ``y_s = mu + b_s + e_s``: ``e_s`` with the covariance ``C`` that its tests state, ``b_s``
with ``R``, the sum of ``k_d t_d t_d'`` over the tolerances of building, each in the direction of its cause. How much
of each there is in this class, ``k_d``, is what the ships themselves tell. With ``V`` the covariance of all ships, ``P
= V^-1 - V^-1 X (X' V^-1 X)^-1 X' V^-1`` and ``X`` the common mean, the quadratic forms ``y' P K_d P y`` with ``K_d =
t_d t_d'`` in each ship have the expectations ``tr(P K_d P C) + sum of k_e tr(P K_d P K_e)``, linear equations of which
the ``k`` are the solution (C. R. Rao, "Estimation of variance and covariance components: MINQUE theory", Journal of
Multivariate Analysis 1, 1971). Twice the inverse of their matrix is the covariance of the solution.

Eight ships cannot tell a spread of each cause: one is told by seven differences, and a limit of Student's t with six
degrees of freedom is twice that of the normal distribution. So each ``k_d`` is drawn to the one ``k`` of all causes as
far as they look alike (``_moderation``): with ships that differ as the tolerances say, they are told together. Who
knows the tolerances states them, and nothing is told from the ships: then the scores are normal.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.drift._along import Whitened, whitened
from shaftprint.drift._class_numbers import ClassNumbers
from shaftprint.drift._moderation import worth_of_common
from shaftprint.drift._quadratic_forms import quadratic_forms, weights_of_mean

# The weights are worked out with the scales of the time before.
_ROUNDS = 2
_MOST_FREEDOM = 1e6


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Spread:
    """How much some ships of a class differ."""

    ships: tuple[int, ...]
    """Places of the ships that tell it."""
    scales: FloatArray
    """Variance between ships over that of each tolerance, 1 where they differ as it says; shape (tolerances,)."""
    scale_covariance: FloatArray
    """Its covariance, shape (tolerances, tolerances)."""
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


def between_ships(numbers: ClassNumbers, spread: Spread) -> FloatArray:
    """Return the covariance of the numbers of one ship among its sisters, shape (numbers, numbers)."""
    covariance: FloatArray = (numbers.building * spread.scales) @ numbers.building.T
    return covariance


def spread_of(numbers: ClassNumbers, ships: tuple[int, ...]) -> Spread:
    """Return how much some ships of a class differ, and their mean.

    ``numbers``: numbers of all ships of the class. ``ships``: places of those that tell it, two at least.
    """
    count = numbers.building.shape[1]
    common = np.ones(count)
    if numbers.is_known:
        return _spread(numbers, ships, common, np.zeros((count, count)))
    for _ in range(_ROUNDS):
        forms = quadratic_forms(numbers, ships, common)
        common = np.full(count, max(forms.surplus.sum() / forms.sensitivity.sum(), 0.0))
    forms = quadratic_forms(numbers, ships, common)
    stated = np.diag(forms.sensitivity) > 0.0
    freedom = len(ships) - 1.0
    worth = worth_of_common(forms.ratios[stated], freedom)
    scales = common
    for _ in range(_ROUNDS):
        forms = quadratic_forms(numbers, ships, scales)
        # a cause without a tolerance keeps the common scale
        drawn = np.where(stated, np.diag(forms.sensitivity), 1.0) * worth / freedom
        inverse = np.linalg.inv(forms.sensitivity + np.diag(drawn))
        scales = np.maximum(inverse @ (forms.surplus + drawn * common), 0.0)
    by_common = inverse @ drawn
    known_to = 2.0 * inverse + 2.0 / forms.sensitivity.sum() * np.outer(by_common, by_common)
    return _spread(numbers, ships, scales, known_to)


def _spread(numbers: ClassNumbers, ships: tuple[int, ...], scales: FloatArray, known_to: FloatArray) -> Spread:
    """Return the spread of some ships with their mean, from its scales and the covariance of these."""
    size = numbers.building.shape[0]
    mean = weights_of_mean(numbers, ships, scales)
    weights = np.zeros((size, *numbers.values.shape))
    weights[:, list(ships)] = mean.reshape(size, len(ships), size)
    return Spread(
        ships=ships,
        scales=scales,
        scale_covariance=known_to,
        mean=mean @ numbers.values[list(ships)].reshape(-1),
        weights=weights.reshape(size, -1),
    )


def departure_of(numbers: ClassNumbers, ship: int, spread: Spread) -> Departure:
    """Return how far a ship is from the class that others tell.

    ``numbers``: numbers of all ships of the class. ``ship``: place of the ship. ``spread``: what others tell; the ship
    may be among them, for its distance from a mean that it has a part in. Raises numpy.linalg.LinAlgError if the
    covariance is not positive definite.
    """
    size, count = numbers.values.shape[1], len(numbers.values)
    against = -spread.weights
    against[:, ship * size : (ship + 1) * size] += np.eye(size)
    measured = numbers.covariance_of(against)
    built = against.reshape(size, count, size) @ numbers.building
    covariance = measured + np.einsum("pst,t,qst->pq", built, spread.scales, built)
    difference = numbers.values[ship] - spread.mean
    along = np.linalg.solve(covariance, numbers.directions)
    # what each tolerance adds to the variance of each score
    added = (np.einsum("pd,pst->dst", along, built) ** 2).sum(axis=1)
    return Departure(
        white=whitened(difference, covariance, numbers.directions),
        freedom=_freedom(np.einsum("pd,pd->d", along, numbers.directions), added, spread),
        difference=difference,
        covariance=covariance,
        measured=measured,
    )


def _freedom(variance: FloatArray, added: FloatArray, spread: Spread) -> FloatArray:
    """Return the degrees of freedom of variances that are in part estimated, by their own variances (Satterthwaite).

    ``variance``: the variances, shape (variances,). ``added``: what each tolerance, at a scale of 1, adds to them;
    shape (variances, tolerances). ``spread``: what the scales are, and how well they are known.
    """
    relative = np.einsum("dt,tu,du->d", added, spread.scale_covariance, added) / np.maximum(variance, 1e-300) ** 2
    # no fewer than if it were told by itself
    freedom: FloatArray = np.maximum(2.0 / np.maximum(relative, 2.0 / _MOST_FREEDOM), len(spread.ships) - 1.0)
    return freedom


def prediction(numbers: ClassNumbers, spread: Spread) -> tuple[FloatArray, FloatArray]:
    """Return variance and degrees of freedom of each true number of a new sister about the mean; shape (numbers,) each.

    ``numbers``: numbers of all ships of the class. ``spread``: what its ships tell.
    """
    count, size = numbers.values.shape
    mean = np.diag(numbers.covariance_of(spread.weights))
    built = spread.weights.reshape(size, count, size) @ numbers.building
    added = numbers.building**2 + (built**2).sum(axis=1)
    variance = mean + added @ spread.scales
    return variance, _freedom(variance, added, spread)


def shrunk(numbers: ClassNumbers, spread: Spread) -> FloatArray:
    """Return what each tolerance most likely did to each ship, in standard deviations of the tolerance.

    It is the expectation where the difference from the mean is known: drawn to the mean as far as tests are uncertain,
    and shared among the tolerances. Shape (ships, tolerances); times ``building`` it is in the numbers.
    """
    size = len(numbers.names)
    rows = []
    for ship in range(len(numbers.values)):
        departure = departure_of(numbers, ship, spread)
        own = np.linalg.solve(departure.covariance, departure.difference)
        # of a ship that has a part in the mean, the covariance of effect and difference is smaller by that part
        part = spread.weights[:, ship * size : (ship + 1) * size]
        rows.append(spread.scales * (numbers.building.T @ (np.eye(size) - part).T @ own))
    return np.array(rows)
