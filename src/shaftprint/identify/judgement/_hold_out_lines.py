"""Lines that could have been fitted and were not, held against the fit.

A structure that does not explain a line can be made to look right by leaving the line out. So the lines that were left
out are taken in again, from the optimum: twice the rise of the lowest cost is their distance from what the other lines
say, in units of the noise of the lines and of the model together. It is the square ``r^T (C + G P G^T)^-1 r`` of the
residual ``r`` of lines with covariance ``C``, slopes ``G`` of the model and covariance ``P`` of its parameters, and
holds too where the model is not linear in its parameters between here and there.
"""

import numpy as np

from shaftprint.distributions import chi_square_tail
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.judgement._evidence import Evidence
from shaftprint.identify.judgement._phrases import probability, spans
from shaftprint.identify.judgement._requirements import Requirements
from shaftprint.identify.likelihood._build_objective import build_joint_objective
from shaftprint.identify.likelihood._experiment import Experiment
from shaftprint.identify.likelihood._fitted_response import channels_of
from shaftprint.identify.search._search import polish

# Other optima of the search from which the lines are taken in again, too.
_STARTS = 4


def not_predicted(evidence: Evidence) -> str:
    """Return that usable lines that were left out are not predicted within their noise, and where the model holds.

    It is asked of a fit to one response that was weighted by the covariance.
    """
    identification = evidence.identification
    experiments = identification.objective.experiments
    if len(identification.parts) != 1 or len(experiments) != 1 or not identification.is_likelihood:
        return ""
    (experiment,) = experiments
    names = _usable(experiment, evidence.requirements)
    if not names:
        return ""
    rise, count = _rise(identification, experiment, names), 2 * len(names) * len(experiment.structure.channels)
    chance = chi_square_tail(max(rise, 0.0), float(count))
    if chance >= evidence.requirements.lowest_p_value:
        return ""
    omega = experiment.response.omega_rad_s[experiment.fitted]
    return (
        "Lines were left out that the model does not predict within their noise: "
        f"{spans(names, experiment.response.lines)} ({probability(chance)}). It holds at the lines that were fitted, "
        f"from {omega[0]:.2g} to {omega[-1]:.2g} rad/s, and not beside them; find another structure."
    )


def _usable(experiment: Experiment, requirements: Requirements) -> list[str]:
    """Return the lines that were left out although they are usable and known well in some channel."""
    response = experiment.response
    noise = np.diagonal(response.covariance, axis1=1, axis2=2).T
    half = noise.shape[0] // 2
    share = np.sqrt(noise[:half] + noise[half:]) / np.abs(channels_of(response))
    good = np.any(share <= requirements.largest_line_std, axis=0)
    held_out = response.used & ~experiment.fitted & good
    return [name for name, one in zip(response.lines, held_out, strict=True) if one]


def _rise(identification: Identification, experiment: Experiment, names: list[str]) -> float:
    """Return twice the rise of the lowest cost when the lines are taken in."""
    response, settings = experiment.response, identification.settings
    fitted = [name for name, one in zip(response.lines, experiment.fitted, strict=True) if one]
    objective = build_joint_objective(
        [(experiment.structure, response)],
        weighting=settings.weighting,
        priors=settings.priors,
        regularisation=settings.regularisation,
        lines=[*fitted, *names],
    )
    free = list(objective.free)
    starts = [identification.values, *(cluster.values for cluster in identification.clusters[:_STARTS])]
    lowest = min(float(polish(objective, values[free], settings).cost[0]) for values in starts)
    return 2.0 * (lowest - identification.cost)
