"""Whether the records of a joint fit agree with the sines that are part of it."""

import numpy as np

from shaftprint.distributions import chi_square_tail
from shaftprint.identify.fit._identification import Identification

DISAGREE_BELOW = 0.01
"""Below this p-value the records of a joint fit contradict its sines, as for a fit that is refused."""
_NAMED = 3


def contradiction(sines: Identification, joint: Identification) -> str:
    """Return in words how a joint fit contradicts the sines that are part of it; empty where it does not.

    What the sines, and what was known before, lose at the parameters of the joint fit is at most chi-square distributed
    with as many degrees of freedom as they have parameters, if all records are of one line: twice the difference of
    their costs (S. S. Wilks, The large-sample distribution of the likelihood ratio for testing composite hypotheses,
    Annals of Mathematical Statistics 9, 1938). The steps may move the sines along what these do not know, and nowhere
    else.

    ``sines``: fit to the sines alone. ``joint``: fit to sines and records together, of the same line with limits.
    """
    of_joint = {estimate.name: estimate.value for estimate in joint.parameters}
    moved = np.array([of_joint.get(estimate.name, estimate.value) for estimate in sines.parameters])
    residuals, _ = sines.objective.residuals(moved[None])
    lost = max(float(np.sum(residuals**2)) - 2.0 * sines.cost, 0.0)
    if chi_square_tail(lost, len(moved)) >= DISAGREE_BELOW:
        return ""
    far = sorted(sines.parameters, key=lambda one: -abs(of_joint.get(one.name, one.value) - one.value) / one.std)
    named = ", ".join(f"{one.name} {one.value:.3g} and {of_joint[one.name]:.3g}" for one in far[:_NAMED])
    return (
        f"The fit of everything was not used: its steps and sweeps contradict the sines (p below {DISAGREE_BELOW:g}), "
        f"which alone and with them give {named}. Line and levels are those of the sines with the limits beside them; "
        "something acts in the large moves that no limit describes, or the line was another one during them."
    )
