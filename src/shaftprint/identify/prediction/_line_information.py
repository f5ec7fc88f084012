"""What each planned line adds to the Fisher information: the terms that a design chooses among.

Lines are independent, so the information of a test is the sum of those of its lines and of the priors,
``sum_k J_k^T C_k^-1 J_k`` (Kay, Fundamentals of Statistical Signal Processing: Estimation Theory, 1993, section 3.9).
A line's covariance falls with its length and the square of its amplitude, so its term grows with both.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.identify.likelihood._experiment import Experiment
from shaftprint.identify.likelihood._objective import Objective
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.prediction._planned_objective import assumed_values, planned_objective, value_and_slopes
from shaftprint.models._structure import Structure
from shaftprint.spectra._frequency_response import FrequencyResponse


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LineInformation:
    """Fisher information of planned lines, line by line, and the numbers that it is wanted for."""

    names: tuple[str, ...]
    """Free parameters, in whose units the information is."""
    of_lines: tuple[FloatArray, ...]
    """Information of each used line, one array for each response, shape (used lines, free, free)."""
    of_priors: FloatArray
    """Information of the priors, shape (free, free)."""
    values: Mapping[str, float]
    """Assumed value of every free parameter and combination, by name."""
    units: Mapping[str, str]
    """Unit of each, by name."""
    slopes: Mapping[str, FloatArray]
    """Derivatives of each to the free parameters, by name, shape (free,)."""
    ranges: FloatArray
    """Widths of the free parameters' bounds, shape (free,)."""


def line_information(
    pairs: Sequence[tuple[Structure, FrequencyResponse]],
    *,
    values: Mapping[str, float] | None = None,
    priors: Mapping[str, Prior] | None = None,
) -> LineInformation:
    """Return what each line of several tests tells of the parameters; see ``predict_joint_accuracy``.

    ``pairs``: each structure with its lines; for another working point it is ``at_working_point`` of it. ``values``:
    assumed parameter values by name; the structure's own where not given. ``priors``: priors of free parameters by
    name. Raises IdentificationError as ``predict_joint_accuracy``.
    """
    objective = planned_objective(pairs, priors or {})
    theta = assumed_values(objective, values or {})[list(objective.free)]
    size = theta.size
    combinations = {c.name: value_and_slopes(objective, theta, c) for c in objective.combinations}
    free = objective.free_parameters
    own = {p.name: (float(value), row) for p, value, row in zip(free, theta, np.eye(size), strict=True)}
    numbers = own | {name: pair for name, pair in combinations.items() if np.all(np.isfinite(pair[1]))}
    prior_rows = objective.prior_rows
    of_priors = np.zeros((size, size))
    np.add.at(of_priors, (prior_rows[:, 0].astype(int),) * 2, prior_rows[:, 2] ** 2)
    return LineInformation(
        names=tuple(p.name for p in free),
        of_lines=tuple(frozen_float(_of_lines(objective, term, theta)) for term in objective.experiments),
        of_priors=frozen_float(of_priors),
        values={name: value for name, (value, _) in numbers.items()},
        units={p.name: p.unit for p in free} | {c.name: c.unit for c in objective.combinations},
        slopes={name: frozen_float(slopes) for name, (_, slopes) in numbers.items()},
        ranges=frozen_float(objective.upper - objective.lower),
    )


def _of_lines(objective: Objective, term: Experiment, theta: FloatArray) -> FloatArray:
    """Return the information of each line of a term, shape (lines, free, free)."""
    rows, _ = objective.sensitivity_to(term, theta, expected=True)
    lines, size = term.data.shape
    of_line = rows.reshape(theta.size, size, lines)
    information: FloatArray = np.einsum("fal,gal->lfg", of_line, of_line)
    return information
