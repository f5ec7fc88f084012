"""A survey with the limits of its line."""

from dataclasses import replace

from shaftprint.limits import identify_limits, levels_beside
from shaftprint.survey._line_with_limits import expect_limitable, limit_number, line_with_limits
from shaftprint.survey._progress import SILENT, Progress
from shaftprint.survey._survey import Survey


def with_limits(survey: Survey, *, progress: Progress = SILENT) -> Survey:
    """Return a survey whose fingerprint has the line with its limits; ``judged`` then validates with them.

    Raises
    ------
    SignalError
        If the recording does not hold the tests of the campaign, or the campaign has legs only.
    IdentificationError
        If no governor can be simulated on the measured speed.
    FingerprintError
        If the first structure is another than GAUGE-CLOSED.
    """
    expect_limitable(survey.fingerprint)
    fit = identify_limits(survey.signals, survey.campaign, survey.vessel, progress=progress.tell)
    progress.tell("Putting the limits into the line", "")
    levels = levels_beside(
        {quantity.name: quantity.value for quantity in survey.fingerprint.parameters} | survey.fingerprint.held,
        survey.signals,
        survey.campaign,
        survey.vessel,
        kinds=fit.kinds,
        start=fit.start,
    )
    line = line_with_limits(
        survey.fingerprint,
        levels,
        vessel=survey.vessel,
        working_point=survey.signals.working_point,
        numbers=[limit_number(one) for one in fit.numbers],
        not_seen=list(fit.not_seen.values()),
    )
    return replace(survey, limit_fit=fit, fingerprint=survey.fingerprint.model_copy(update={"with_limits": line}))
