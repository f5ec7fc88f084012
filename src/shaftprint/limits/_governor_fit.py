"""A governor with some limits at its best, and how well it explains a test."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.catalogue._limited_governor import GovernorSymbol
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._identify import identify_jointly
from shaftprint.identify.likelihood._build_objective import build_joint_objective
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.likelihood._weighting import MaximumLikelihood
from shaftprint.identify.search._levenberg_marquardt import descend
from shaftprint.identify.search._settings import Settings
from shaftprint.identify.search._starts import GivenStarts
from shaftprint.limits._candidates import IDLE, Kind, parameters_of
from shaftprint.limits.prediction._carried import CarriedError
from shaftprint.limits.prediction._held_set_point import Messages
from shaftprint.limits.prediction._prediction_error import PredictionError
from shaftprint.limits.prediction._recent_simulations import RecentSimulations
from shaftprint.limits.prediction._set_point import GovernorRecord
from shaftprint.models._structure import Structure

GOVERNOR: Mapping[str, float] = {
    GovernorSymbol.PROPORTIONAL_GAIN: 5.0,
    GovernorSymbol.INTEGRAL_GAIN: 4.0,
    GovernorSymbol.LOOP_DELAY: 0.07,
    GovernorSymbol.ACTUATOR_FREQUENCY: 11.0,
    GovernorSymbol.ACTUATOR_DAMPING: 0.55,
    GovernorSymbol.SET_POINT_LATENCY: 0.05,
    GovernorSymbol.SET_POINT_SCALE: 1.0,
    GovernorSymbol.SET_POINT_OFFSET: 0.0,
}
"""What is always free, and where the search begins."""
# Fall of minus twice the log-likelihood that is not worth a step: less than any end of an interval asks for.
NEGLIGIBLE_FALL = 0.02
# Iterations of the last steps of a fit that is reported.
LAST = 2


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Fitted:
    """A governor with some limits at its best."""

    kinds: tuple[Kind, ...]
    """Its limits, in the order in which they joined."""
    term: PredictionError
    """Its likelihood, in units of its own innovations."""
    values: Mapping[str, float]
    """Every parameter."""
    priors: Mapping[str, Prior]
    """What was known beforehand."""
    messages: Messages | None = None
    """Delays of the set point's jumps, where it is held between messages."""

    @property
    def own(self) -> FloatArray:
        """All parameters in the structure's order, shape (parameters,)."""
        return np.array([self.values[name] for name in self.term.whole.names])

    @property
    def log_squares(self) -> float:
        """``N log`` of the squared innovations, and the priors: minus twice the log-likelihood but for a constant."""
        penalty = sum(((self.values[name] - prior.mean) / prior.std) ** 2 for name, prior in self.priors.items())
        penalty += 0.0 if self.messages is None else self.messages.cost
        # the unit of the innovations is their own deviation
        count = self.term.innovation_count
        return count * float(np.log(count * self.term.scale**2)) + penalty

    @property
    def parameters(self) -> int:
        """Number of parameters that were fitted: of held messages the cycle."""
        return len(self.term.free) + (self.messages is not None)

    @property
    def known(self) -> FloatArray:
        """One over the prior deviation of each free parameter, 0 without prior, shape (free,)."""
        names = [p.name for p in self.term.structure.free]
        return np.array([1.0 / self.priors[name].std if name in self.priors else 0.0 for name in names])


def scaled_information(slopes: FloatArray, known: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return information over the roots of its diagonal, shape (free, free), and these roots, shape (free,).

    What the data say nothing of has a root of 1: it follows nothing. ``slopes``: derivatives of the residuals, shape
    (free, residuals). ``known``: one over the prior deviation of each, shape (free,).
    """
    information = slopes @ slopes.T + np.diag(known**2)
    size = np.sqrt(np.diag(information))
    size = np.where(size > 0.0, size, 1.0)
    return information / np.outer(size, size), size


def values_without_limits(whole: Structure) -> dict[str, float]:
    """Return the value of every parameter of a governor that nothing limits."""
    default = {p.name: p.value for p in whole.parameters}
    # a slope of zero is a small one: a round zero would be another simulation
    return {**default, **GOVERNOR, **IDLE, GovernorSymbol.ENGINE_SPEED_SLOPE: 1e-12}


def fitted(
    whole: Structure,
    record: GovernorRecord,
    values: Mapping[str, float],
    kinds: Sequence[Kind],
    *,
    priors: Mapping[str, Prior],
    iterations: int,
    negligible: float = NEGLIGIBLE_FALL,
    held: Sequence[str] = (),
    messages: Messages | None = None,
    near: Fitted | None = None,
    recent: RecentSimulations | None = None,
    checked: bool = True,
) -> Fitted:
    """Return the best governor with some limits, from given values on.

    ``record``: the test; of a held set point with the jumps as late as the messages have them. ``priors``: what is
    known of the set point's scale and offset. ``iterations``: limit of steps and of derivatives that are found anew.
    ``negligible``: fall of minus twice the log-likelihood that is not worth a step. ``held``: names of parameters that
    stay although they would be free. ``near``: a governor near the start, whose derivatives are the first that are
    carried along. ``recent``: simulations that others have kept; none if not given. ``checked``: whether it ends with
    derivatives that were found there.
    """
    free = [name for name in (*GOVERNOR, *parameters_of(kinds)) if name not in held]
    term = PredictionError.of(whole, record, values, free)
    term = term if recent is None else replace(term, recent=recent)
    term = term.with_scale_at(np.array([values[name] for name in whole.names]))
    carried = CarriedError.along(term, None if near is None else near.own)
    objective = build_joint_objective([carried], weighting=MaximumLikelihood(), priors=priors, regularisation={})
    start = np.array([[values[p.name] for p in objective.free_parameters]])
    descent = descend(
        objective.following(1),
        np.clip(start, objective.lower, objective.upper),
        objective.lower,
        objective.upper,
        # half the squared innovations are about half their number
        tolerance=negligible / term.data_count,
        max_iterations=iterations,
        anew=objective.of_starts,
        checked=checked,
    )
    moved = {p.name: float(value) for p, value in zip(objective.free_parameters, descent.theta[0], strict=True)}
    return _at(Fitted(kinds=tuple(kinds), term=term, values=values, priors=priors, messages=messages), moved)


def identified(fit: Fitted) -> tuple[Fitted, Identification]:
    """Return a governor to the last digit, and the fit with its covariance."""
    draw = GivenStarts(np.array([[fit.values[p.name] for p in fit.term.structure.free]]))
    settings = Settings(priors=fit.priors, starts=1, draw=draw, max_iterations=LAST, stability="ignored")
    identification = identify_jointly([fit.term], rng=np.random.default_rng(0), settings=settings)
    return _at(fit, {estimate.name: estimate.value for estimate in identification.parameters}), identification


def _at(fit: Fitted, moved: Mapping[str, float]) -> Fitted:
    """Return a governor with other values, in units of the innovations there."""
    values = {**fit.values, **moved}
    term = fit.term.with_scale_at(np.array([values[name] for name in fit.term.whole.names]))
    return replace(fit, term=term, values=values)


def schwarz(one: Fitted) -> float:
    """Return minus twice the log-likelihood with Schwarz' penalty for each parameter."""
    return one.log_squares + one.parameters * float(np.log(one.term.data_count))
