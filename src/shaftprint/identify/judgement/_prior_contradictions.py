"""What was known before the test and the data contradict.

With a prior ``m +/- p`` the estimate ``x +/- s`` lies between the prior and what the data alone say. Its distance from
the prior has the variance ``p^2 - s^2`` where both are right, since ``x`` is the best mean of both.
"""

from collections.abc import Iterator

import numpy as np

from shaftprint.catalogue import ShipRole
from shaftprint.digits import stated
from shaftprint.identify.fit import Estimate, Identification
from shaftprint.identify.judgement._phrases import number
from shaftprint.models import Role
from shaftprint.reasons import Reason, ReasonKind

# So many standard deviations from what was known are no chance: once in 2000 tests.
PULLED = 3.5
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
    return tuple(_pulled(identification))


def _pulled(identification: Identification) -> Iterator[Reason]:
    priors = identification.settings.priors
    meanings = {parameter.name: parameter.meaning for parameter in identification.objective.free_parameters}
    for estimate in identification.parameters:
        if estimate.name in priors:
            prior = priors[estimate.name]
            spread = np.sqrt(max(prior.std**2 - estimate.std**2, (LEAST_SHARE * prior.std) ** 2))
            assumed = f"the prior is {stated(prior.mean, prior.std, estimate.unit)}"
            distance = abs(estimate.value - prior.mean) / spread
        elif estimate.role in NOMINAL and estimate.std > 0.0:
            nominal, std = NOMINAL[estimate.role]
            assumed = f"the nominal value is {number(nominal, estimate.unit)}"
            distance = abs(estimate.value - nominal) / np.hypot(estimate.std, std)
        else:
            continue
        if distance > PULLED:
            yield _reason(estimate, meanings[estimate.name], assumed, float(distance))


def _reason(estimate: Estimate, meaning: str, assumed: str, distance: float) -> Reason:
    return Reason(
        kind=KINDS.get(estimate.role, "prior"),
        where=estimate.name,
        sentence=(
            f"The data contradict what is assumed of {estimate.name} ({meaning}): {assumed}, the estimate is "
            f"{stated(estimate.value, estimate.std, estimate.unit)}, "
            f"{distance:.1f} standard deviations away; check the vessel file, and what else moves the estimate."
        ),
    )
