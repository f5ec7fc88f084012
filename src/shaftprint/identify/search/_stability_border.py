"""The lowest cost beside the border of stability: where a search that may not become unstable wants to go.

On the border the loop gain passes -1: ``1 + L(j omega) = 0`` at some frequency. The lowest cost there is found with the
frequency as one more parameter and the real and imaginary part of ``1 + L`` as two more residuals, whose weight grows
(penalty method: Nocedal and Wright, Numerical Optimization, section 17.1). From there the way leads inside, as little
as makes the model stable: against the derivative of the pole ``s`` on the axis, ``ds / dtheta = -(dL / dtheta) /
(dL / ds)``.
"""

from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from shaftprint.identify.likelihood._objective import Objective
from shaftprint.identify.search._levenberg_marquardt import Allowed, Descent, descend
from shaftprint.identify.search._settings import Settings
from shaftprint.models._structure import Structure

# The best stopped starts whose border is searched.
CHOSEN = 8
# Growing weight of 1 + L over the root of twice the cost.
WEIGHTS = (10.0, 1e2, 1e3, 1e4)
SWEEP_RAD_S = np.geomspace(1e-4, 1e4, 2000)
# Relative step of the derivative to the frequency, by central differences.
STEP = 1e-4
TOLERANCE = 1e-9
# Steps inside that are tried, in shares of the width between the bounds, the smallest first.
STEPS_INSIDE = np.geomspace(1e-12, 0.1, 45)


def stable_models(objective: Objective) -> Allowed:
    """Return a function that tells of free parameters, shape (rows, free), whether the models are stable."""

    def stable(theta: FloatArray) -> BoolArray:
        return objective.stable(objective.complete(theta))

    return stable


def border_minimum(objective: Objective, descent: Descent, settings: Settings, allowed: Allowed) -> Descent:
    """Return the starts that were stopped at the border of stability at the lowest cost beside it.

    ``descent``: where the starts of a search ended, all of them stable models. ``allowed``: tells which models are
    stable. Returns the same, with an infinite cost where nothing was found.
    """
    theta, cost = descent.theta.copy(), np.full(descent.cost.size, np.inf)
    stopped = np.flatnonzero(descent.refused)
    for row in stopped[np.argsort(descent.cost[stopped], kind="stable")][:CHOSEN]:
        border = _Border.nearest(objective, descent.theta[row])
        inside = None if border is None else border.lowest(descent.theta[row], settings, allowed)
        if inside is not None:
            residuals, _ = objective.residuals(inside[None, :])
            theta[row], cost[row] = inside, 0.5 * float(residuals[0] @ residuals[0])
    return replace(descent, theta=theta, cost=cost)


@dataclass(frozen=True, slots=True, eq=False)
class _Border:
    """The loop that is nearest to its border, and the frequency at which it is."""

    objective: Objective
    number: int
    loop: Structure
    omega_rad_s: float

    @classmethod
    def nearest(cls, objective: Objective, theta: FloatArray) -> "_Border | None":
        """Return the experiment whose loop gain comes closest to -1; None where there is no feedback."""
        least, nearest = np.inf, None
        values = objective.complete(theta)
        for number, experiment in enumerate(objective.terms):
            structure = experiment.structure
            if structure.loop is None:
                continue
            loop = replace(structure, outputs={"L": structure.loop}, input="u", inputs=("u",), combinations=())
            distance = np.abs(1.0 + loop.response(experiment.structure_values(values), 1j * SWEEP_RAD_S)[0])
            index = int(np.argmin(distance))
            if distance[index] < least:
                least, nearest = distance[index], cls(objective, number, loop, float(SWEEP_RAD_S[index]))
        return nearest

    def lowest(self, theta: FloatArray, settings: Settings, allowed: Allowed) -> FloatArray | None:
        """Return the free parameters of lowest cost beside the border, from some near it; None if it has no inside."""
        residuals, _ = self.objective.residuals(theta[None, :])
        scale = float(np.linalg.norm(residuals))
        lower = np.append(self.objective.lower, np.log(SWEEP_RAD_S[0]))
        upper = np.append(self.objective.upper, np.log(SWEEP_RAD_S[-1]))
        at = np.append(theta, np.log(self.omega_rad_s))
        for weight in WEIGHTS:

            def rows(trial: FloatArray, starts: IntArray, weight: float = weight) -> tuple[FloatArray, FloatArray]:
                return self._rows(trial, weight * scale)

            limit = settings.max_iterations
            at = descend(rows, at[None, :], lower, upper, tolerance=TOLERANCE, max_iterations=limit).theta[0]
        return self._inside(at, allowed)

    def _inside(self, at: FloatArray, allowed: Allowed) -> FloatArray | None:
        """Return the nearest stable model to one on the border."""
        _, slopes = self._gap(at)
        width = self.objective.upper - self.objective.lower
        # The last slope is that to the logarithm of the frequency, j omega dL / ds.
        growth = -(slopes[:-1] * 1j / slopes[-1]).real * width
        way = -growth / max(float(np.linalg.norm(growth)), np.finfo(np.float64).tiny)
        for step in STEPS_INSIDE:
            trial = np.clip(at[:-1] + step * width * way, self.objective.lower, self.objective.upper)
            if allowed(trial[None, :])[0]:
                return np.asarray(trial)
        return None

    def _rows(self, trial: FloatArray, weight: float) -> tuple[FloatArray, FloatArray]:
        """Return residuals and Jacobian of one start, those of ``1 + L`` last."""
        residuals, jacobian = self.objective.residuals(trial[:, :-1])
        gap, slopes = self._gap(trial[0])
        rows = weight * np.array([gap.real, gap.imag])
        more = np.zeros((1, trial.shape[1], 2))
        more[0, :, 0], more[0, :, 1] = weight * slopes.real, weight * slopes.imag
        wider = np.concatenate([jacobian, np.zeros((1, 1, jacobian.shape[2]))], axis=1)
        return np.concatenate([residuals, rows[None, :]], axis=1), np.concatenate([wider, more], axis=2)

    def _gap(self, trial: FloatArray) -> tuple[complex, ComplexArray]:
        """Return ``1 + L`` and its derivatives to the free parameters and to the logarithm of the frequency."""
        experiment = self.objective.terms[self.number]
        values = experiment.structure_values(self.objective.complete(trial[:-1]))
        s = 1j * np.exp(trial[-1] + np.array([0.0, STEP, -STEP]))
        stacked = self.loop.stacked(values, s)[:, 0]
        slopes = np.zeros(trial.size, dtype=np.complex128)
        slopes[list(experiment.columns)] = stacked[1:, 0]
        slopes[-1] = (stacked[0, 1] - stacked[0, 2]) / (2.0 * STEP)
        return 1.0 + complex(stacked[0, 0]), slopes
