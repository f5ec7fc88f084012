"""What was known before the test and the data contradict.

With a prior ``m +/- p`` the estimate ``x +/- s`` lies between the prior and what the data alone say. Its distance from
the prior has the variance ``p^2 - s^2`` where both are right, since ``x`` is the best mean of both.
"""

from collections.abc import Iterator

import numpy as np

from shaftprint.catalogue._roles import ShipRole
from shaftprint.digits import stated
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.judgement._phrases import number
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.models._role import Role
from shaftprint.reasons import Reason, ReasonKind

# So many standard deviations from what was known are no chance: once in 2000 tests. From the first of them, once in 80,
# they are worth a word.
STRANGE, PULLED = 2.5, 3.5
# A prior that the data hardly sharpen leaves nothing to divide by: the rest is rounding and curvature.
LEAST_SHARE = 0.3
# What a sensor is expected at without a prior, and how far its line may be off: that of the set point is drawn through
# levels far from the lines, where a lever that bends by 0.3 % a volt has another slope.
NOMINAL = {ShipRole.SET_POINT_SCALE: (1.0, 0.004)}
KINDS: dict[Role | None, ReasonKind] = {
    ShipRole.TORQUE_LATENCY: "gauge latency",
    ShipRole.SET_POINT_SCALE: "set-point scale",
}


def contradicted_priors(identification: Identification) -> tuple[Reason, ...]:
    """Return a reason for each parameter that the data pull from what was assumed of it by more than 3.5 deviations."""
    return tuple(
        Reason(kind=KINDS.get(one.role, "prior"), where=one.name, sentence=_sentence("The data contradict", *said))
        for one, distance, *said in _distances(identification)
        if distance > PULLED
    )


def beyond_priors(identification: Identification) -> bool:
    """Return whether a misfit is larger than all priors that the data pull would explain, were they let go.

    What is pulled then is pulled by a wrong structure, and says little of the prior.
    """
    pulls = sum(distance**2 for _, distance, *_ in _distances(identification) if distance > PULLED)
    return identification.chi_square - identification.degrees_of_freedom > pulls


def strange_priors(identification: Identification) -> tuple[str, ...]:
    """Return a sentence for each parameter that the data pull by 2.5 to 3.5 deviations."""
    return tuple(
        _sentence("The data hardly agree with", *said)
        for one, distance, *said in _distances(identification)
        if STRANGE < distance <= PULLED and one.role not in NOMINAL
    )


def off_nominal(identification: Identification) -> tuple[Estimate, ...]:
    """Return the scales of sensors that are off their nominal value by more than their own deviation explains."""
    return tuple(
        one
        for one in identification.parameters
        if one.role in NOMINAL and abs(one.value - NOMINAL[one.role][0]) > PULLED * one.std > 0.0
    )


def from_prior(value: float, std: float, prior: Prior) -> float:
    """Return how many standard deviations an estimate is above what was known of it, with its sign."""
    return float((value - prior.mean) / np.sqrt(max(prior.std**2 - std**2, (LEAST_SHARE * prior.std) ** 2)))


def _distances(identification: Identification) -> Iterator[tuple[Estimate, float, str, str, str]]:
    """Return each parameter of which something is assumed, how many deviations it is away, and that in words."""
    priors = identification.settings.priors
    meanings = {parameter.name: parameter.meaning for parameter in identification.objective.free_parameters}
    for estimate in identification.parameters:
        if estimate.name in priors:
            prior = priors[estimate.name]
            assumed = f"the prior is {stated(prior.mean, prior.std, estimate.unit)}"
            distance = abs(from_prior(estimate.value, estimate.std, prior))
        elif estimate.role in NOMINAL and estimate.std > 0.0:
            nominal, std = NOMINAL[estimate.role]
            assumed = f"the nominal value is {number(nominal, estimate.unit)}"
            distance = abs(estimate.value - nominal) / np.hypot(estimate.std, std)
        else:
            continue
        what = f"{estimate.name} ({meanings[estimate.name]})"
        found = f"{stated(estimate.value, estimate.std, estimate.unit)}, {distance:.1f} standard deviations away"
        yield estimate, float(distance), what, assumed, found


def _sentence(begin: str, what: str, assumed: str, found: str) -> str:
    return (
        f"{begin} what is assumed of {what}: {assumed}, the estimate is {found}; check the vessel file, and what else "
        "moves the estimate."
    )
