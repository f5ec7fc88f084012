"""The fit problem that planned lines will give, at assumed values of its parameters."""

from collections.abc import Mapping, Sequence

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._sensor import with_sensor
from shaftprint.identify.likelihood._build_objective import build_joint_objective
from shaftprint.identify.likelihood._objective import Objective
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.likelihood._weighting import MaximumLikelihood
from shaftprint.models._combination import Combination
from shaftprint.models._structure import Structure
from shaftprint.spectra._frequency_response import FrequencyResponse

# Share of a parameter's range over which slopes are taken.
STEP = 1e-6


def planned_objective(
    pairs: Sequence[tuple[Structure, FrequencyResponse]],
    priors: Mapping[str, Prior],
    lines: Sequence[str] | None = None,
) -> Objective:
    """Return the fit problem of structures with their planned lines, each line weighted by its covariance."""
    return build_joint_objective(
        [(with_sensor(structure, response), response) for structure, response in pairs],
        weighting=MaximumLikelihood(),
        priors=priors,
        regularisation={},
        lines=lines,
    )


def assumed_values(objective: Objective, values: Mapping[str, float]) -> FloatArray:
    """Return the values of all parameters, shape (parameters,): those given by name, else the structure's own.

    Raises IdentificationError if a name is no parameter, or a value is outside its bounds.
    """
    unknown = [name for name in values if name not in objective.names]
    if unknown:
        raise IdentificationError(
            f"accuracy of {objective.name}: {', '.join(unknown)} is no parameter of it; it has "
            f"{', '.join(objective.names)}."
        )
    for parameter in objective.parameters:
        value = values.get(parameter.name, parameter.value)
        if not parameter.lower <= value <= parameter.upper:
            raise IdentificationError(
                f"accuracy of {objective.name}: expected {parameter.name} from {parameter.lower:g} to "
                f"{parameter.upper:g} {parameter.unit}, found {value:g}."
            )
    return np.array([values.get(p.name, held) for p, held in zip(objective.parameters, objective.held, strict=True)])


def value_and_slopes(objective: Objective, theta: FloatArray, combination: Combination) -> tuple[float, FloatArray]:
    """Return a combination and its derivatives to the free parameters, shape (free,); nan where it cannot be formed."""
    step = STEP * (objective.upper - objective.lower)
    moves = np.diag(step)
    table = np.concatenate([theta[None, :], theta + moves, theta - moves])
    with np.errstate(all="ignore"):
        values_of_rows = np.broadcast_to(combination.of(objective.named(objective.complete(table))), table.shape[:1])
        slopes = (values_of_rows[1 : 1 + theta.size] - values_of_rows[1 + theta.size :]) / (2.0 * step)
    return float(values_of_rows[0]), slopes
