"""The verb of the room: fit a structure to a frequency response."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray, IntArray, frozen_float
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._covariance import estimate_covariance
from shaftprint.identify.fit._fit_test import tested_fit
from shaftprint.identify.fit._identification import Cluster, Identification
from shaftprint.identify.fit._measured_inputs import along_the_test, has_measured_inputs
from shaftprint.identify.fit._sensor import with_sensor
from shaftprint.identify.likelihood._build_objective import Source, build_joint_objective
from shaftprint.identify.likelihood._objective import Objective
from shaftprint.identify.likelihood._term import Term
from shaftprint.identify.search._levenberg_marquardt import Descent
from shaftprint.identify.search._search import polish, search
from shaftprint.identify.search._settings import Settings
from shaftprint.models._structure import Structure
from shaftprint.spectra._frequency_response import FrequencyResponse

# Starts belong to one optimum when their costs differ by no more than the search may have left undone, so many times
# its tolerance as a share of the cost, ...
UNDONE = 100.0
# ... or by this share of the cost of no model at all (for data without noise), ...
SAME_COST_OF_NOTHING = 1e-9
# ... when the information at the lower one makes their places differ by no more cost either: the width between the
# bounds says nothing of two optima, which may lie within a thousandth of it ...
# ... and when no parameter differs by more than this share of that width: a flat valley is several places.
SAME_PLACE = 0.02
# The noise of measured inputs is carried through the fit before, until no parameter moves by more than this share of
# its standard deviation; the weights change little, so that a few fits are enough.
STAYS = 0.02
MOST_FITS = 8


@refusing_none(IdentificationError)
def identify(
    structure: Structure,
    response: FrequencyResponse,
    *,
    rng: np.random.Generator,
    settings: Settings | None = None,
    lines: Sequence[str] | None = None,
) -> Identification:
    """Fit a structure to a frequency response from many starts; the lowest cost that is stable wins.

    Parameters
    ----------
    structure
        Structure with the response's input and outputs. Held parameters of a speed sensor take the response's values.
        Further inputs of the structure may be outputs of the response: they are taken as measured, such as the speed
        that a governor has.
    response
        Data with covariance.
    rng
        Source of the start values.
    settings
        How to search and weigh.
    lines
        Names of the lines to fit; those that the response marks as used by default.

    Raises
    ------
    IdentificationError
        If structure and response do not fit together, there are too few data, or no start reached a stable model.
    """
    chosen = settings or Settings()
    if has_measured_inputs(structure, response):
        return _identified_along(structure, response, rng, chosen, lines)
    return _identified([(structure, response)], rng, chosen, lines)


def _identified_along(
    structure: Structure,
    response: FrequencyResponse,
    rng: np.random.Generator,
    settings: Settings,
    lines: Sequence[str] | None,
) -> Identification:
    """Fit a structure of which some inputs were measured, with their noise through the model that comes out."""
    values = structure.vector({})
    for _ in range(MOST_FITS):
        fit = _identified([along_the_test(structure, response, values)], rng, settings, lines)
        moved = np.abs(fit.values - values)[list(fit.objective.free)]
        values = fit.values
        if np.all(moved <= STAYS * np.sqrt(np.diagonal(fit.covariance))):
            break
    return fit


def identify_jointly(
    pairs: Sequence[tuple[Structure, FrequencyResponse] | Term],
    *,
    rng: np.random.Generator,
    settings: Settings | None = None,
) -> Identification:
    """Fit structures to several responses and records at once: campaigns, repeats, working points.

    The data are independent of each other, and parameters of one name are one parameter.

    Parameters
    ----------
    pairs
        Each structure with the response it is fitted to, at the lines which that marks as used. A structure may stand
        there several times; for another working point it is ``Structure.scaled``, or has other names. Data of another
        kind, such as records in time, are terms, which hold their structure.
    rng
        Source of the start values.
    settings
        How to search and weigh.

    Raises
    ------
    IdentificationError
        If a structure and its response do not fit together, two structures describe a parameter differently, there are
        too few data, or no start reached stable models.
    """
    return _identified(pairs, rng, settings or Settings(), None)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Optima:
    """Where a search ended, not assessed."""

    objective: Objective
    """The problem."""
    clusters: tuple[Cluster, ...]
    """Optima of the search, lowest cost first."""
    winner: Cluster
    """The lowest that is stable."""


def searched_optima(
    pairs: Sequence[Source],
    *,
    rng: np.random.Generator,
    settings: Settings,
    lines: Sequence[str] | None = None,
) -> Optima:
    """Return the optima that ``identify_jointly`` finds, for a search that only goes on from there."""
    _expect_right_kinds(pairs, rng)
    objective = build_joint_objective(
        [pair if isinstance(pair, Term) else (with_sensor(*pair), pair[1]) for pair in pairs],
        weighting=settings.weighting,
        priors=settings.priors,
        regularisation=settings.regularisation,
        lines=lines,
    )
    descent = search(objective, settings, rng)
    sharp = bool(descent.converged[np.argmin(descent.cost)])
    clusters, winner = _judged(objective, _clustered(objective, descent, settings), settings, sharp=sharp)
    return Optima(objective=objective, clusters=clusters, winner=winner)


def _identified(
    pairs: Sequence[Source],
    rng: np.random.Generator,
    settings: Settings,
    lines: Sequence[str] | None,
) -> Identification:
    optima = searched_optima(pairs, rng=rng, settings=settings, lines=lines)
    objective, winner = optima.objective, optima.winner
    parts_and_tests = [term.assessed(winner.values, number) for number, term in enumerate(objective.terms)]
    return Identification(
        parts=tuple(part for part, _ in parts_and_tests),
        objective=objective,
        settings=settings,
        values=winner.values,
        covariance=frozen_float(estimate_covariance(objective, winner.values[list(objective.free)])),
        cost=winner.cost,
        fit_test=tested_fit(objective, winner.values, [test for _, test in parts_and_tests]),
        clusters=optima.clusters,
    )


def _expect_right_kinds(pairs: Sequence[Source], rng: np.random.Generator) -> None:
    for pair in pairs:
        if isinstance(pair, Term):
            continue
        if not isinstance(pair, tuple) or len(pair) != 2:
            raise IdentificationError(f"joint fit: expected pairs (structure, response), found {type(pair).__name__}.")
        kinds = tuple(type(item) for item in pair)
        if not (issubclass(kinds[0], Structure) and issubclass(kinds[1], FrequencyResponse)):
            raise IdentificationError(
                f"fit: expected a Structure and a FrequencyResponse, found {' and '.join(k.__name__ for k in kinds)}; "
                "catalogue.structure() gives a shipped structure by its name."
            )
    if not isinstance(rng, np.random.Generator):
        raise IdentificationError(f"rng: expected numpy.random.default_rng(seed), found {rng!r}.")


def _clustered(objective: Objective, descent: Descent, settings: Settings) -> list[tuple[FloatArray, float, IntArray]]:
    """Return parameters, cost and the starts of each distinct optimum, lowest cost first."""
    left = np.argsort(descent.cost, kind="stable")
    width = objective.upper - objective.lower
    clusters: list[tuple[FloatArray, float, IntArray]] = []
    while left.size:
        first = left[0]
        theta, cost = descent.theta[first], float(descent.cost[first])
        apart = descent.theta[left] - theta
        undone = UNDONE * settings.tolerance * cost + SAME_COST_OF_NOTHING * objective.null_cost
        close = descent.cost[left] - cost <= undone
        close &= 0.5 * np.vecdot(apart @ descent.information[first], apart) <= undone
        close &= np.all(np.abs(apart) <= SAME_PLACE * width, axis=1)
        close[0] = True
        clusters.append((theta, cost, left[close]))
        left = left[~close]
    return clusters


def _judged(
    objective: Objective, optima: list[tuple[FloatArray, float, IntArray]], settings: Settings, *, sharp: bool
) -> tuple[tuple[Cluster, ...], Cluster]:
    """Return all optima and the winner: the lowest cost that is stable, polished to the last digit.

    ``sharp`` says whether the first optimum already is.
    """
    clusters: list[Cluster] = []
    winner: Cluster | None = None
    for theta, cost, rows in optima:
        starts, which = rows.size, tuple(sorted(rows.tolist()))
        if winner is not None:
            values = frozen_float(objective.complete(theta))
            clusters.append(Cluster(values=values, cost=cost, starts=starts, stable=None, which=which))
            continue
        best, lowest = theta, cost
        if clusters or not sharp:
            polished = polish(objective, theta, settings)
            best, lowest = polished.theta[0], float(polished.cost[0])
        values = frozen_float(objective.complete(best))
        stable = bool(objective.stable(values[None, :])[0])
        cluster = Cluster(values=values, cost=lowest, starts=starts, stable=stable, which=which)
        clusters.append(cluster)
        if stable or settings.stability == "ignored":
            winner = cluster
    if winner is None:
        raise IdentificationError(
            f"structure {objective.name}: none of {settings.starts} starts reached a stable model; the lowest cost is "
            f"{clusters[0].cost:.4g}. Check the frequencies of the campaign, the data and the bounds, or allow "
            "unstable models."
        )
    return tuple(clusters), winner
