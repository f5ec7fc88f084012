"""Where a fit begins that no fingerprint of the line helps: a few governors and actuators are tried on a few moves.

Usual values of one ship let the loop of another hunt, and from there no step leads back.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.catalogue._gauge import GAUGE_K_I, GAUGE_K_P, GAUGE_OMEGA_N, T_D, TAU_DN, TAU_UP
from shaftprint.service._model import ServiceModel
from shaftprint.time_domain._record import Record
from shaftprint.time_domain._simulator import ExactDelays, Simulator, on_record

# Gain over the inertia time of the line, about the frequency at which the loop crosses over [rad/s].
_CROSSOVERS = (1.0, 1.7, 2.8, 4.5, 7.0)
# Integral over proportional gain [1/s].
_RATIOS = (0.4, 1.0)
# Delay [s] and natural frequency [rad/s] of governor and fuel: a fast and a slow one.
_ACTUATORS = ((0.03, 20.0), (0.08, 10.0))
# Moves on which they are tried: of those that are larger than most, so many.
_MOVES, _LARGER_THAN = 10, 0.5


def begun(model: ServiceModel, records: Sequence[Record], simulator: Simulator | None = None) -> ServiceModel:
    """Return a model that begins from the best of a few governors, or as it is where it begins from a fingerprint.

    ``model``: the model. ``records``: the segments. ``simulator``: how it is simulated.
    """
    if model.is_of_fingerprint or not records:
        return model
    swings = np.array([float(np.ptp(record.drive["n_set"])) for record in records])
    # the largest meet limits, the smallest are noise
    chosen = np.argsort(swings)[round(_LARGER_THAN * swings.size) :][: 4 * _MOVES : 4]
    some = [records[int(k)] for k in chosen]
    inertia = model.values[TAU_UP.name] + model.values[TAU_DN.name]
    own = {name: model.values[name] for name in (GAUGE_K_P.name, GAUGE_K_I.name, T_D.name, GAUGE_OMEGA_N.name)}
    tried = [
        own,
        *(
            {
                GAUGE_K_P.name: crossover * inertia,
                GAUGE_K_I.name: ratio * crossover * inertia,
                T_D.name: delay,
                GAUGE_OMEGA_N.name: frequency,
            }
            for crossover, ratio, (delay, frequency) in product(_CROSSOVERS, _RATIOS, _ACTUATORS)
        ),
    ]
    models = [replace(model, values={**model.values, **values}) for values in tried]
    return min(models, key=lambda one: _left_of_speed(one, some, simulator or ExactDelays()))


def _left_of_speed(model: ServiceModel, records: Sequence[Record], simulator: Simulator) -> float:
    """Return the sum of the logarithms of what is left of the speed of each record, beside its mean."""
    place = tuple(model.structure.outputs).index("n")
    total = 0.0
    for record in records:
        run = on_record(simulator, model.structure, model.vector(model.theta, record.load), record, ())
        if run is None:
            return np.inf
        left: FloatArray = record.outputs["n"] - run[0, :, place]
        total += float(np.log(np.var(left)))
    return total
