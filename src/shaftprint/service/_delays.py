"""What is known of delays before any log: nothing follows the lever before it is moved, or long after.

Service tells the delay of the loop and the latency of the set point together, and hardly apart. Where the noise leaves
one of them below zero, gains, damping and margins go with it, and a fit that knows of no sign ends beyond what any line
can be. What is known then is the likelihood, a normal distribution, above the bound; its mean and variance are those of
a truncated normal distribution, and what is correlated follows by regression (Simon and
Simon, Constrained Kalman filtering via density function truncation for turbofan engine health estimation,
International Journal of Systems Science 41, 2010).
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.catalogue._gauge import T_D, T_SP
from shaftprint.distributions import normal_cdf
from shaftprint.errors import ServiceError
from shaftprint.service._fit import ServiceFit

LATEST_T_SP_S, EARLIEST_S = 0.5, -0.02
"""Latency of the set point, and delay of all, beyond which the lever is not on the clock of the others [s]."""
# A lever on a clock of its own is taken for one with the others up to 20 ms.
_LEAST_S: Mapping[str, float] = MappingProxyType({T_D.name: 0.0, T_SP.name: EARLIEST_S})
# Standard deviations beyond a bound from which on the log contradicts it.
_CONTRADICTED = 4.0


def expect_one_clock(fit: ServiceFit, free: Sequence[str], path: Path) -> None:
    """Refuse a speed that comes before the lever, or long after it.

    What the delay of the loop and that of the set point have of it a log hardly tells; their sum it does. Raises
    ServiceError if it is so.
    """
    delays = np.array([float(name in _LEAST_S) for name in free])
    whole, std = float(delays @ fit.theta), float(np.sqrt(delays @ fit.covariance @ delays))
    if EARLIEST_S - 3.0 * std <= whole and fit.theta[free.index(T_SP.name)] <= LATEST_T_SP_S:
        return
    raise ServiceError(
        f"{path}: expected a speed that follows the lever within {LATEST_T_SP_S:g} s, found a delay of "
        f"{1e3 * whole:.0f} +/- {1e3 * std:.0f} ms: lever, speed and torque do not share one clock; log all three with "
        "one logger or bring its files onto one clock (shaftprint merge)."
    )


def with_delays_known(fit: ServiceFit, free: Sequence[str]) -> ServiceFit:
    """Return a fit whose numbers are those of a line that follows its lever; ``free`` are their names.

    Its scores stay those at the greatest likelihood.
    """
    theta, covariance, turn = fit.theta, fit.covariance, np.eye(fit.theta.size)
    for name, least in _LEAST_S.items():
        theta, covariance, more = above(theta, covariance, free.index(name), least)
        turn = more @ turn
    return replace(
        fit,
        theta=frozen_float(theta),
        covariance=frozen_float(covariance),
        of_prior={name: frozen_float(turn @ change) for name, change in fit.of_prior.items()},
    )


def above(
    theta: FloatArray, covariance: FloatArray, column: int, least: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return mean and covariance where one number is not below a bound, and how they move with those without it.

    As they were where the log contradicts the bound. ``theta``: mean, shape (free,). ``covariance``: shape (free,
    free). ``column``, ``least``: the number and its bound. The last that is returned has shape (free, free).
    """
    variance = covariance[column, column]
    beyond = float((least - theta[column]) / np.sqrt(variance))
    if beyond > _CONTRADICTED:
        return theta, covariance, np.eye(theta.size)
    density = math.exp(-0.5 * beyond**2) / math.sqrt(2.0 * math.pi)
    more = density / float(1.0 - normal_cdf(beyond))
    taken = more**2 - beyond * more
    along: FloatArray = covariance[:, column] / variance
    turn = np.eye(theta.size)
    turn[:, column] -= taken * along
    return (
        theta + along * more * np.sqrt(variance),
        covariance - np.outer(along, along) * variance * taken,
        turn,
    )
