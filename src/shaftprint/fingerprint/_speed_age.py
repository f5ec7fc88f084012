"""What the age of speed messages does to the delays: a speed that is shown late makes all behind the set point later.

The torque behind the speed as both are shown, ``t_gauge``, has the age in its prior. With a speed that is late by a
time, and a ``t_gauge`` that is smaller by it, speed and torque fit as before where ``t_sp`` is longer by the same time:
no fit can tell. What the vessel file does not state of it comes after the fit, as a source of ``t_sp`` and of the sums
that hold it.
"""

from dataclasses import replace

from shaftprint.catalogue._roles import ShipRole
from shaftprint.fingerprint._working_point_share import SPEED_AGE, widened
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.uncertainty._budget import Budget
from shaftprint.identify.uncertainty._profile import Profile

AGE_OF_SPEED = "age of speed messages"
"""Source of the prior of ``t_gauge``: standard deviation of how old the values of speed messages are [s]."""


def shifts_of_speed_age(identification: Identification) -> dict[str, dict[str, float]]:
    """Return the change of each parameter for one standard deviation of the age, by source and parameter.

    Nothing where the speed comes in no messages, or the structure has no time between set point and loop.
    """
    names = {parameter.role: parameter.name for parameter in identification.objective.free_parameters}
    prior = identification.settings.priors.get(names.get(ShipRole.TORQUE_LATENCY, ""))
    age_s = 0.0 if prior is None else prior.sources.get(AGE_OF_SPEED, 0.0)
    late = names.get(ShipRole.SET_POINT_LATENCY)
    return {SPEED_AGE: {late: age_s}} if age_s and late is not None else {}


def with_speed_age(found: Profile | None, stated: Budget) -> Profile | None:
    """Return the intervals by which numbers are judged, those that hold the age wider by it; ``stated``: the budget."""
    if found is None or SPEED_AGE not in stated.sources:
        return found
    intervals = dict(found.intervals)
    for row in stated.rows:
        one, further = intervals.get(row.name), row.variances.get(SPEED_AGE, 0.0) ** 0.5
        if one is not None and further:
            lower, upper = widened((one.lower, one.upper), row.value, further, (one.lower_open, one.upper_open))
            intervals[row.name] = replace(one, lower=lower, upper=upper)
    return replace(found, intervals=intervals)
