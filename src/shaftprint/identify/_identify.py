"""The verb of the room: fit a structure to a frequency response."""

from collections.abc import Sequence

import numpy as np

from shaftprint.arrays import FloatArray, frozen_bool, frozen_float
from shaftprint.errors import IdentificationError
from shaftprint.identify._covariance import estimate_covariance
from shaftprint.identify._fit_percent import fit_ceiling, fit_percent
from shaftprint.identify._identification import Cluster, Identification, Settings
from shaftprint.identify._levenberg_marquardt import Descent, descend
from shaftprint.identify._objective import Objective, build_objective, load_factors
from shaftprint.models import Structure, is_stable
from shaftprint.spectra import FrequencyResponse

# Starts belong to one optimum when their costs differ by less than this share, ...
SAME_COST = 1e-3
# ... or by less than this share of the cost of no model at all (for data without noise).
SAME_COST_OF_NOTHING = 1e-9
# ... and no parameter differs by more than this share of the width between its bounds.
SAME_PLACE = 0.02
POLISH_TOLERANCE = 1e-14


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
    sensed = _with_sensor(structure, response)
    objective = build_objective(
        sensed,
        response,
        weighting=chosen.weighting,
        priors=chosen.priors,
        regularisation=chosen.regularisation,
        lines=lines,
    )
    start = chosen.draw.starts(objective.lower, objective.upper, chosen.starts, rng)
    descent = descend(
        objective.of_starts,
        start,
        objective.lower,
        objective.upper,
        tolerance=chosen.tolerance,
        max_iterations=chosen.max_iterations,
        leader_tolerance=POLISH_TOLERANCE,
    )
    sharp = bool(descent.converged[np.argmin(descent.cost)])
    clusters, winner = _judged(objective, _clustered(objective, descent), chosen, sharp=sharp)
    return _outcome(response, objective, clusters, winner, chosen)


def _outcome(
    response: FrequencyResponse,
    objective: Objective,
    clusters: tuple[Cluster, ...],
    winner: Cluster,
    settings: Settings,
) -> Identification:
    """Return what was found, with its covariance and how well it fits."""
    structure = objective.structure
    theta = winner.values[list(objective.free)]
    fitted = np.isin(response.omega_rad_s, objective.s.imag)
    model = structure.response(winner.values, 1j * response.omega_rad_s, factors=load_factors(response))
    outputs = {name: i for i, name in enumerate(response.outputs)}
    measured = response.response[:, 0]
    variance = np.diagonal(response.covariance, axis1=1, axis2=2).T
    return Identification(
        structure=structure,
        response=response,
        fitted=frozen_bool(fitted),
        objective=objective,
        settings=settings,
        values=winner.values,
        covariance=frozen_float(estimate_covariance(objective, theta)),
        cost=winner.cost,
        degrees_of_freedom=objective.data.size + len(settings.priors) - theta.size,
        data_count=objective.data.size,
        fit_percent={n: fit_percent(measured[i, fitted], model[i, fitted]) for n, i in outputs.items()},
        fit_ceiling={
            n: fit_ceiling(measured[i, fitted], (variance[i] + variance[len(outputs) + i])[fitted])
            for n, i in outputs.items()
        },
        clusters=clusters,
    )


def _with_sensor(structure: Structure, response: FrequencyResponse) -> Structure:
    """Return the structure with the pick-up's held parameters at the values of the data."""
    sensor = {
        "T_average": response.averaging_s,
        "T_hold": response.hold_s,
        "t_pickup": response.pick_up_delay_s,
    }
    held = {p.name: sensor[p.name] for p in structure.parameters if p.held and p.name in sensor}
    return structure.held_at(**held) if held else structure


def _clustered(objective: Objective, descent: Descent) -> list[tuple[FloatArray, float, int]]:
    """Return parameters, cost and number of starts of each distinct optimum, lowest cost first."""
    order = np.argsort(descent.cost, kind="stable")
    theta, cost = descent.theta[order], descent.cost[order]
    nothing = 0.5 * float(np.sum((objective.weights @ objective.data[:, :, None]) ** 2))
    width = objective.upper - objective.lower
    found: list[tuple[FloatArray, float, int]] = []
    while cost.size:
        close = cost - cost[0] <= SAME_COST * cost[0] + SAME_COST_OF_NOTHING * nothing
        close &= np.all(np.abs(theta - theta[0]) <= SAME_PLACE * width, axis=1)
        close[0] = True
        found.append((theta[0], float(cost[0]), int(close.sum())))
        theta, cost = theta[~close], cost[~close]
    return found


def _judged(
    objective: Objective, found: list[tuple[FloatArray, float, int]], settings: Settings, *, sharp: bool
) -> tuple[tuple[Cluster, ...], Cluster]:
    """Return all optima and the winner: the lowest cost that is stable, polished to the last digit.

    ``sharp`` says whether the first optimum already is.
    """
    clusters: list[Cluster] = []
    winner: Cluster | None = None
    for theta, cost, starts in found:
        if winner is not None:
            values = frozen_float(objective.complete(theta))
            clusters.append(Cluster(values=values, cost=cost, starts=starts, stable=None))
            continue
        place, lowest = theta, cost
        if clusters or not sharp:
            polished = descend(
                objective.of_starts,
                theta[None, :],
                objective.lower,
                objective.upper,
                tolerance=POLISH_TOLERANCE,
                max_iterations=settings.max_iterations,
            )
            place, lowest = polished.theta[0], float(polished.cost[0])
        values = frozen_float(objective.complete(place))
        stable = is_stable(objective.structure, values)
        cluster = Cluster(values=values, cost=lowest, starts=starts, stable=stable)
        clusters.append(cluster)
        if stable or not settings.require_stable:
            winner = cluster
    if winner is None:
        raise IdentificationError(
            f"structure {objective.structure.name}: none of {settings.starts} starts reached a stable model; the "
            f"lowest cost is {clusters[0].cost:.4g}. Check the data and bounds, or allow unstable models."
        )
    return tuple(clusters), winner
