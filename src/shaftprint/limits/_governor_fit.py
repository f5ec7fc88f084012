"""A governor with some limits at its best, and how well it explains a test."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.catalogue import GovernorSymbol
from shaftprint.identify import Identification, Prior, Settings, identify_jointly
from shaftprint.identify.search import Draw
from shaftprint.limits._candidates import IDLE, Kind, parameters_of
from shaftprint.limits.prediction import GovernorRecord, Messages, PredictionError
from shaftprint.models import Structure

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
# Iterations of a fit that is reported.
FINE = 15


@dataclass(frozen=True, slots=True, eq=False)
class SingleStart(Draw):
    """A single start."""

    values: FloatArray
    """Free parameters, shape (free,)."""

    def starts(self, lower: FloatArray, upper: FloatArray, count: int, rng: np.random.Generator) -> FloatArray:
        """Return it within the bounds."""
        return np.tile(np.clip(self.values, lower, upper), (count, 1))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Fitted:
    """A governor with some limits at its best."""

    kinds: tuple[Kind, ...]
    """Its limits, in the order in which they joined."""
    term: PredictionError
    """Its likelihood, in units of its own innovations."""
    values: Mapping[str, float]
    """Every parameter."""
    fit: Identification
    """The fit."""
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
        innovations = self.term.innovations(self.own)
        penalty = sum(((self.values[name] - prior.mean) / prior.std) ** 2 for name, prior in self.priors.items())
        penalty += 0.0 if self.messages is None else self.messages.cost
        return np.inf if innovations is None else innovations.count * float(np.log(innovations.squares)) + penalty

    @property
    def parameters(self) -> int:
        """Number of parameters that were fitted: of held messages the cycle."""
        return len(self.term.free) + (self.messages is not None)

    @property
    def known(self) -> FloatArray:
        """One over the prior deviation of each free parameter, 0 without prior, shape (free,)."""
        names = [p.name for p in self.term.structure.free]
        return np.array([1.0 / self.priors[name].std if name in self.priors else 0.0 for name in names])


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
    iterations: int = FINE,
    held: Sequence[str] = (),
    messages: Messages | None = None,
) -> Fitted:
    """Return the best governor with some limits, from given values on.

    Parameters
    ----------
    record
        The test; of a held set point with the jumps as late as the messages have them.
    priors
        What is known of the set point's scale and offset.
    held
        Names of parameters that stay although they would be free.
    """
    free = [name for name in (*GOVERNOR, *parameters_of(kinds)) if name not in held]
    term = PredictionError.of(whole, record, values, free)
    start_values = np.array([values[name] for name in whole.names])
    term = term.with_scale_at(start_values)
    draw = SingleStart(np.array([values[p.name] for p in term.structure.free]))
    settings = Settings(priors=priors, starts=1, draw=draw, max_iterations=iterations, stability="ignored")
    fit = identify_jointly([term], rng=np.random.default_rng(0), settings=settings)
    fitted_values = {**values, **{estimate.name: estimate.value for estimate in fit.parameters}}
    best = term.with_scale_at(np.array([fitted_values[name] for name in whole.names]))
    return Fitted(kinds=tuple(kinds), term=best, values=fitted_values, fit=fit, priors=priors, messages=messages)


def schwarz(one: Fitted) -> float:
    """Return minus twice the log-likelihood with Schwarz' penalty for each parameter."""
    return one.log_squares + one.parameters * float(np.log(one.term.data_count))
