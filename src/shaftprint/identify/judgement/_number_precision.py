"""Which numbers of a fit are known well enough to be used, and why the others are not: the one rule."""

import math
from collections.abc import Mapping, Sequence

from shaftprint.catalogue._roles import ShipRole
from shaftprint.distributions import NORMAL_95
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.judgement._phrases import number
from shaftprint.identify.judgement._requirements import Requirements
from shaftprint.identify.uncertainty._profile import Interval, Profile

WHOLE_PERCENT = 100.0
KNOWN_POORLY = "known to this share of the value only"
"""Doubt of several numbers whose shares stand beside their names."""
ADDS_NOTHING = "the test adds almost nothing to what was known before"
"""Doubt of a number that a prior knows; how much smaller its deviation became may follow."""
_KNOWN_TO, _ONLY = "it is known to ", " only"


def doubts_of(
    identification: Identification,
    numbers: Sequence[Estimate],
    profile: Profile | None,
    requirements: Requirements | None = None,
) -> dict[str, str]:
    """Return, by name, why numbers are not known well enough to be used; nothing of those that are.

    ``numbers``: parameters, combinations and what else was made of them. ``profile``: profile likelihood of the fit;
    its intervals are then asked instead of the standard deviations. ``requirements``: what a number must satisfy.
    """
    limits = requirements or Requirements()
    intervals = {} if profile is None else profile.intervals
    doubts = {
        estimate.name: _doubt(identification, estimate, intervals.get(estimate.name), limits) for estimate in numbers
    }
    doubts |= {
        number.name: doubts.get(parameter, "")
        for number in numbers
        if not doubts[number.name] and (parameter := _multiplied(identification, number))
    }
    return {name: doubt for name, doubt in doubts.items() if doubt}


def share_of(doubt: str) -> str:
    """Return to what share of its value a number is known, as its doubt says; nothing where that is another."""
    return doubt.removeprefix(_KNOWN_TO).removesuffix(_ONLY) if doubt.startswith(_KNOWN_TO) else ""


def _multiplied(identification: Identification, estimate: Estimate) -> str:
    """Return the parameter of which a physical value is a multiple: what was assumed of one is of the other.

    A gain on a logged rack is none: its physical value is multiplied by the slope of the rack, which is fitted too.
    """
    role = estimate.role
    if role is None or role.physical is None or role.physical.name != estimate.name:
        return ""
    by_role = {parameter.role: parameter.name for parameter in identification.objective.free_parameters}
    return "" if role.rack_power and ShipRole.ENGINE_RACK_SLOPE in by_role else by_role.get(role, "")


def _doubt(
    identification: Identification, estimate: Estimate, interval: Interval | None, requirements: Requirements
) -> str:
    """Return why a number may not be trusted; nothing where it may."""
    if estimate.at_bound:
        return f"it stopped at its bound {number(estimate.value, estimate.unit)}"
    if not math.isfinite(estimate.value):
        return "it has no value at the estimate"
    if interval is not None and (interval.lower_open or interval.upper_open):
        return f"the data set no {_sides(interval.lower_open, interval.upper_open)} end to it"
    if interval is not None and (interval.lower_failed or interval.upper_failed):
        sides = _sides(interval.lower_failed, interval.upper_failed)
        return f"the search for the {sides} end of its interval came to none"
    std = _deviation(estimate, interval)
    if not math.isfinite(std):
        return "the data say nothing about it"
    prior = identification.settings.priors.get(estimate.name)
    if prior is not None and std > requirements.largest_prior_share * prior.std:
        smaller = round(100.0 * (1.0 - std / prior.std))
        by_little = f": its standard deviation is {smaller} % smaller" if smaller > 0 else ""
        return f"{ADDS_NOTHING}{by_little}"
    size = _size(identification, estimate)
    if std > requirements.largest_std * size:
        share = _beyond(100.0 * std / size, 100.0 * requirements.largest_std) if size > 0.0 else ""
        return f"{_KNOWN_TO}{share} %{_ONLY}" if share else "it cannot be distinguished from 0"
    return ""


def _beyond(percent: float, limit: float) -> str:
    """Return a share that is beyond a limit, with as many digits as show that it is."""
    return f"{percent:.0f}" if round(percent) > limit else f"{percent:.4g}"


def _sides(lower: bool, upper: bool) -> str:
    if lower and upper:
        return "lower and upper"
    return "lower" if lower else "upper"


def _deviation(estimate: Estimate, interval: Interval | None) -> float:
    """Return the standard deviation: that of the wider side of the interval, where there is one."""
    if interval is None:
        return estimate.std
    return max(interval.upper - estimate.value, estimate.value - interval.lower) / NORMAL_95


def _size(identification: Identification, estimate: Estimate) -> float:
    """Return what a deviation is compared with.

    That is the value, the range of a parameter that may have either sign, or the whole of which a number is a share.
    """
    if estimate.unit == "%":
        return WHOLE_PERCENT
    if estimate.role == ShipRole.SET_POINT_LATENCY:
        # below nothing it is the clock's: nobody knows what is the governor's
        return max(estimate.value, 0.0)
    bounds: Mapping[str, tuple[float, float]] = {
        parameter.name: (parameter.lower, parameter.upper) for parameter in identification.objective.free_parameters
    }
    lower, upper = bounds.get(estimate.name, (0.0, 0.0))
    return max(abs(estimate.value), upper - lower if lower < 0.0 < upper else 0.0)
