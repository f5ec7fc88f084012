"""The search for the amplitudes that make a problem's criterion small."""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from shaftprint.arrays import FloatArray
from shaftprint.design.search._problem import Problem
from shaftprint.design.search._uses import held_draws
from shaftprint.notebook._shown import Shown


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class Effort(Shown):
    """How much a plan may cost."""

    powers: tuple[float, ...] = (10.0, 30.0, 100.0)
    """Powers of the norm of the uses, one stage each: the first are smooth, the last is near the largest use."""
    steps: int = 200
    """Most steps of a stage."""
    restarts: int = 4
    """Starts from random phases; the best plan is taken."""
    accuracy_draws: int = 6
    """Possible ships over which the criterion is averaged."""
    peak_draws: int = 200
    """Possible ships whose peaks are looked at."""
    active_draws: int = 8
    """Those of them with the highest peaks that are allowed for, which a stage holds."""


def random_start(problem: Problem, rng: np.random.Generator) -> FloatArray:
    """Return unknowns of random phases and of amplitudes that fall with the root of the frequency."""
    parts = []
    for use in problem.uses:
        harmonics = np.array(use.harmonics)
        size = 1.0 / np.sqrt(harmonics)
        phase = rng.uniform(0.0, 2.0 * np.pi, size=harmonics.size)
        parts += [size * np.cos(phase), size * np.sin(phase)]
    return np.concatenate(parts)


def search(problem: Problem, start: FloatArray, effort: Effort, *, share_held: float) -> tuple[float, FloatArray]:
    """Return the criterion and the unknowns after all stages from one start.

    ``problem``: what is made small, with the uses of all possible ships. ``start``: unknowns of the start. ``effort``:
    stages and steps. ``share_held``: share of the possible ships for which all legs keep their limits. Each stage holds
    those among them whose peaks were highest at the end of the stage before.
    """
    unknowns, value = start, np.inf
    for power in effort.powers:
        legs = problem.split(unknowns)
        held = held_draws(problem.uses, legs, share_held)
        active = tuple(use.highest(leg, held, effort.active_draws) for use, leg in zip(problem.uses, legs, strict=True))
        stage = replace(problem, uses=active, power=power)
        result = scipy.optimize.minimize(
            stage.value_and_gradient,
            unknowns,
            jac=True,
            method="L-BFGS-B",
            options={"maxiter": effort.steps, "maxcor": 20},
        )
        unknowns, value = result.x, float(result.fun)
    return value, unknowns
