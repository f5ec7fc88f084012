"""The verb ``replan``: the next test, with what a first one has found."""

from collections.abc import Mapping

import numpy as np

from shaftprint.design.inputs._assumed_ship import ship_of_fit
from shaftprint.design.plan._plan import Plan
from shaftprint.design.planning._design import design_campaign
from shaftprint.design.search._search import Effort
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.likelihood._fitted_response import FittedResponse
from shaftprint.identify.prediction._noise_levels import NoiseLevels


def replan(
    plan: Plan,
    fit: Identification,
    *,
    within_s: float,
    rng: np.random.Generator,
    noise: NoiseLevels | Mapping[float, NoiseLevels] | None = None,
    effort: Effort | None = None,
) -> Plan:
    """Return the plan of a further test with the same wishes, limits and speeds, after a first one was fitted.

    The ship is assumed as the fit found it, within its covariance; the responses of the first test count as data that
    will be fitted together with the next.

    Parameters
    ----------
    plan
        The plan of the first test.
    fit
        The fit of its legs, each at its working point.
    within_s
        Length of the further test [s].
    rng
        Draws the possible ships, and the starts of the search.
    noise
        Noise that the first test has shown; that of its plan where not given.
    effort
        What the search may cost.

    Raises
    ------
    DesignError
        As ``design_campaign``, or if the fit is one of another structure.
    """
    speeds = tuple(leg.speed_share for leg in plan.legs)
    return design_campaign(
        ship_of_fit(plan.ship.structure, fit),
        plan.wish,
        plan.limits,
        dict(zip(speeds, plan.noise, strict=True)) if noise is None else noise,
        speeds=speeds,
        within_s=within_s,
        rng=rng,
        priors=plan.priors,
        earlier=[(part.structure, part.response) for part in fit.parts if isinstance(part, FittedResponse)],
        timetable=plan.timetable,
        effort=effort,
    )
