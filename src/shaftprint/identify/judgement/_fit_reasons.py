"""The reasons for which a fit is not trustworthy, each a sentence where it holds and nothing where it does not."""

from collections.abc import Mapping

from shaftprint.catalogue._roles import ShipRole
from shaftprint.digits import stated
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._optima import WITHIN
from shaftprint.identify.judgement._evidence import Evidence
from shaftprint.identify.judgement._line_quality import gap_at_crossing
from shaftprint.identify.judgement._misfit import explained, misfit_words
from shaftprint.identify.judgement._phrases import probability
from shaftprint.identify.judgement._search_words import rival_words
from shaftprint.models._role import Role
from shaftprint.reasons import Reason, ReasonKind
from shaftprint.spelling import listed

_LATE: Mapping[Role, tuple[ReasonKind, str]] = {
    ShipRole.SET_POINT_LATENCY: (
        "late set point",
        "The set point comes late: {one.name} is {found}, for speed and torque answer before the logged set point "
        "moves; look for what delays its channel, such as a gateway or its clock.",
    ),
    ShipRole.BLADE_LATENESS: (
        "late pitch feedback",
        "The pitch comes late: {one.name} is {found}, for the torque answers before the logged pitch moves; state by "
        "how much as latency_s of the pitch feedback, or look for what delays its channel, such as a filter.",
    ),
}
"""What a latency below nothing says of the channel behind which it is."""


def too_few_good_data(evidence: Evidence) -> str:
    """Return that lines are too few or too noisy for the parameters."""
    fit, needs = evidence.identification, evidence.requirements
    count = len(fit.parameters) - len(fit.settings.priors)
    wanted = needs.data_per_parameter * count
    lines = sum(experiment.s.size for experiment in fit.objective.experiments)
    need = f"for {count} parameters that the data must find at least {wanted:.0f} are wanted"
    if fit.objective.others and evidence.good_data >= wanted:
        return ""
    if fit.data_count < wanted:
        why = next(
            (
                f" {line} is left out: {why.removeprefix('left out: ')}."
                for part in fit.experiments
                for line, why in part.response.remarks.items()
            ),
            "",
        )
        return f"There are too few lines: {lines} lines give {fit.data_count} numbers, {need}; measure more lines.{why}"
    if evidence.good_data >= wanted:
        return ""
    return (
        f"The data are too noisy: of {lines} lines {evidence.good_lines or 'none'} are known to better than "
        f"{100.0 * needs.largest_line_std:.0f} % in some output, which gives {evidence.good_data} good numbers, "
        f"{need}; measure longer, or with a larger amplitude."
    )


def gap_where_it_matters(evidence: Evidence) -> str:
    """Return that no good line shows where the loop gain passes 1 or -1."""
    if evidence.identification.objective.others:
        # records tell of more frequencies than the lines do
        return ""
    gap = gap_at_crossing(evidence.identification, evidence.good_omega_rad_s, evidence.requirements)
    if gap is None:
        return ""
    low, high = gap
    return (
        f"There is a gap in the data: no good line lies between {low:.2g} and {high:.2g} rad/s, a factor "
        f"{high / low:.1f}, and there the loop decides on its stability; measure a line between."
    )


def not_explained(evidence: Evidence) -> str:
    """Return that the structure does not follow the data within their noise."""
    fit = evidence.identification
    if explained(fit, rejected=evidence.requirements.lowest_p_value):
        return ""
    name = fit.objective.name
    if not fit.is_likelihood:
        percent = "; ".join(
            f"{output} {value:.1f} % where a perfect model has {fit.fit_ceiling[output]:.1f} %"
            for output, value in fit.fit_percent.items()
        )
        return f"The structure {name} does not explain the data: FitPercent of {percent}."
    p_value = "" if fit.p_value is None else f", {probability(fit.p_value)}"
    return (
        f"The structure {name} does not explain the data within their noise (chi-square {fit.chi_square:.0f} for "
        f"{fit.degrees_of_freedom} degrees of freedom{p_value}); {misfit_words(fit)}.{_stopped(fit)}"
    )


def _stopped(fit: Identification) -> str:
    """Return which parameters of a misfit would go beyond their bounds: often a signal that comes late or early."""
    names = [estimate.name for estimate in fit.parameters if estimate.at_bound]
    if not names:
        return ""
    bounds = "its bound" if len(names) == 1 else "their bounds"
    return f" {listed(names)} stopped at {bounds}: the data would go on."


def late_channels(evidence: Evidence) -> tuple[Reason, ...]:
    """Return that the line answers before its set point, or its pitch, is shown to move: the channel comes late.

    Nothing but a delay behind that channel depends on it, and the sums that hold the delay. Its profile decides: a
    standard deviation tells little at the end of a valley.
    """
    intervals = {} if evidence.profile is None else evidence.profile.intervals
    return tuple(
        Reason(kind=kind, where=one.name, sentence=words.format(found=stated(one.value, one.std, one.unit), one=one))
        for role, (kind, words) in _LATE.items()
        for one in evidence.identification.parameters
        if one.role == role and (intervals[one.name].upper if one.name in intervals else one.limits_95[1]) < 0.0
    )


def better_when_unstable(evidence: Evidence) -> str:
    """Return that an unstable model fits better than the noise explains."""
    worst = min((optimum.distance for optimum in evidence.search.passed_over), default=0.0)
    if worst > -WITHIN:
        return ""
    return (
        "The best model is unstable and was passed over, though what was tested was not unstable: the stable one fits "
        f"worse by {-worst:.1f} of deviance, where {WITHIN:.2f} is the 95 % limit."
    )


def not_unique(evidence: Evidence) -> str:
    """Return that another optimum fits as well."""
    rivals = evidence.search.rivals
    return rival_words(evidence.identification, rivals[0]) if rivals else ""


def unstable(evidence: Evidence) -> str:
    """Return that the identified loop is unstable."""
    margins = evidence.margins
    if margins is None or margins.stable:
        return ""
    return (
        f"The identified loop is unstable, with {margins.unstable_poles} poles in the right half plane, though what "
        "was tested was not."
    )
