"""A survey with the limits of its line."""

from dataclasses import replace

from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.fingerprint._line_with_limits import FoundBy
from shaftprint.limits._candidates import Kind
from shaftprint.limits._identify_limits import expect_engine, identify_limits
from shaftprint.limits._levels_beside import levels_beside
from shaftprint.limits._limit_fit import LimitFit
from shaftprint.survey._line_with_limits import expect_limitable, line_with_limits
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
    SettingsError
        If a motor drives the line.
    """
    expect_engine(survey.vessel)
    expect_limitable(survey.fingerprint)
    limits = identify_limits(survey.signals, survey.campaign, survey.vessel, progress=progress.tell)
    return with_levels_beside(survey, limits, survey.fingerprint, progress=progress)


def with_levels_beside(
    survey: Survey, limits: LimitFit, line_fit: Fingerprint, *, found_by: FoundBy = "limits", progress: Progress
) -> Survey:
    """Return a survey whose fingerprint has a line with the limits beside it.

    ``limits``: which limits act; the line gets those whose level is trusted. ``line_fit``: the fingerprint whose
    governor and inertias the line has; the levels are fitted beside them. ``found_by``: which fit that is.
    """
    progress.tell("Putting the limits into the line", "")
    levels = levels_beside(
        {quantity.name: quantity.value for quantity in line_fit.parameters} | line_fit.held,
        survey.signals,
        survey.campaign,
        survey.vessel,
        kinds=limits.trusted_kinds,
        start=limits.start,
    )
    line = line_with_limits(
        line_fit,
        levels,
        vessel=survey.vessel,
        working_point=survey.signals.working_point,
        found_by=found_by,
        numbers=[one for one in limits.numbers if Kind(one.limit) in limits.trusted_kinds],
        not_seen=list(limits.not_seen.values()),
    )
    return replace(
        survey,
        limit_fit=limits,
        remarks=(*survey.remarks, *untrusted(limits)),
        fingerprint=survey.fingerprint.model_copy(update={"with_limits": line}),
    )


def untrusted(limits: LimitFit) -> list[str]:
    """Return which limits a line does not get because their level is not trusted, in words."""
    return [
        f"A {kind.value} was named, but is not in the line with its limits: {doubt}."
        for kind, doubt in limits.doubts.items()
    ]
