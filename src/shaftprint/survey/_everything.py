"""Everything of a test in one fit: sines, staircases and chirps, the line and its limits.

A quarter of an hour of sines knows the governor to 10 %; its one staircase knows it better. The joint fit of
``time_domain`` takes both, with levels that begin where ``limits`` finds them and are held near by what it states.
Disturbances of the ship reach a limit that no step alone would, and its simulation has none: so the levels that are
kept are those that the measured speed asks for beside the governor of the joint fit.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from shaftprint.arrays import FloatArray, block_of
from shaftprint.catalogue._limited import limited
from shaftprint.distributions import chi_square_tail
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.limits._identify_limits import expect_engine, identify_limits
from shaftprint.limits._limit_fit import LimitFit
from shaftprint.survey._fits import priors_of
from shaftprint.survey._limits import with_levels_beside
from shaftprint.survey._line_with_limits import expect_limitable
from shaftprint.survey._progress import SILENT, Progress
from shaftprint.survey._survey import Survey
from shaftprint.time_domain.nonlinear._fit import identify_nonlinear
from shaftprint.time_domain.nonlinear._settings import NonlinearSettings
from shaftprint.time_domain.nonlinear._structure import LimitedModel, structure_for

ONE_START = NonlinearSettings(starts=1, better=1, kept=1)
"""The line and its limits are known already: there is nothing to search for."""
RECORDS_OFF = 1.8
"""How many times further off steps are than their stationary noise model states, root mean square over 77 drawn ships.

Disturbances meet the limit in the middle of a step, which moves all of its answer: that is no noise beside the answer,
and no scatter between blocks of it. Without disturbances the same fits are right within their deviations. With it a
hundred other ships are as far off as stated (benchmarks/one_fit.py)."""


def with_everything(survey: Survey, *, rng: np.random.Generator, progress: Progress = SILENT) -> Survey:
    """Return a survey whose fingerprint has the line with its limits, found from all of the test in one fit.

    Where steps and sweeps contradict the sines, or a limit is named whose level is not trusted, the line is that of the
    sines, as ``with_limits`` gives it, and the survey's remarks say so.

    ``rng``: for the runs with noise that show where a chirp jumps. Raises SignalError if the recording does not hold
    the tests of the campaign, or the campaign has legs only; IdentificationError if the campaign has neither staircase
    nor chirp, or no start reached a stable model; FingerprintError if the first structure is another than GAUGE-CLOSED;
    SettingsError if a motor drives the line.
    """
    expect_engine(survey.vessel)
    expect_limitable(survey.fingerprint)
    signals, campaign, vessel = survey.signals, survey.campaign, survey.vessel
    limits = identify_limits(signals, campaign, vessel, progress=progress.tell)
    if limits.doubts:
        # steps that meet a limit whose level nobody knows would bend all of the fit
        return with_levels_beside(survey, limits, survey.fingerprint, progress=progress)
    progress.tell("Fitting everything at once", "")
    model = _model(survey, limits)
    joint = identify_nonlinear(
        signals,
        campaign,
        vessel,
        model,
        rng=rng,
        linear=survey.identification,
        priors=_priors(survey, model, limits),
        settings=ONE_START,
    )
    apart = contradiction(survey.identification, joint.identification)
    if apart:
        return with_levels_beside(
            replace(survey, remarks=(*survey.remarks, apart)), limits, survey.fingerprint, progress=progress
        )
    line_fit = of_joint_fit(survey.fingerprint, survey.identification, joint.identification)
    return with_levels_beside(survey, limits, line_fit, found_by="joint fit", progress=progress)


def of_joint_fit(fingerprint: Fingerprint, sines: Identification, joint: Identification) -> Fingerprint:
    """Return a fingerprint with the parameters of a joint fit in place of those of its sines.

    What the working point adds to the covariance, by which all data are divided, is the same for both fits.

    ``fingerprint``: that of the sines. ``sines``, ``joint``: the fit that it is of, and the one that takes all of the
    test.
    """
    names = [quantity.name for quantity in fingerprint.parameters]
    of_sines = _of(sines, names)
    added = _finite(fingerprint.covariance_of(names)) - _finite(of_sines)
    of_joint = _as_far_off_as_records(_of(joint, names), of_sines)
    lost = ~np.isfinite(np.diag(of_joint))
    covariance = np.where(lost[:, None] | lost[None, :], 0.0, of_joint + added) + np.diag(np.where(lost, np.inf, 0.0))
    found = {estimate.name: estimate for estimate in joint.parameters}
    return fingerprint.model_copy(
        update={
            "parameters": tuple(
                _quantity(quantity, found[quantity.name].value, float(variance), at_bound=found[quantity.name].at_bound)
                for quantity, variance in zip(fingerprint.parameters, np.diag(covariance), strict=True)
            ),
            "covariance": tuple(tuple(row) for row in covariance.tolist()),
        }
    )


def _as_far_off_as_records(of_joint: FloatArray, of_sines: FloatArray) -> FloatArray:
    """Return the covariance of a joint fit with what its records add to the sines worth as much as it was shown to be.

    Each variance is that of two sources: the sines alone, and the records with their stated deviation times
    ``RECORDS_OFF``. Correlations stay.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.nan_to_num(np.clip(np.diag(of_joint) / np.diag(of_sines), 0.0, 1.0))
    factor = 1.0 / np.sqrt(share + (1.0 - share) / RECORDS_OFF**2)
    return np.asarray(of_joint * np.outer(factor, factor))


def _quantity(before: Estimate, value: float, variance: float, *, at_bound: bool) -> Estimate:
    """Return a number with another value; its interval, of the profile of another likelihood, goes."""
    std = float(np.sqrt(variance))
    return replace(before, value=value, std=std, interval_95=None, interval_open=(False, False), at_bound=at_bound)


def _of(fit: Identification, names: list[str]) -> FloatArray:
    """Return the covariance of some parameters of a fit, shape (names, names)."""
    return block_of(fit.covariance, [estimate.name for estimate in fit.parameters], names)


def _finite(covariance: FloatArray) -> FloatArray:
    return np.where(np.isfinite(covariance), covariance, 0.0)


def _model(survey: Survey, limits: LimitFit) -> LimitedModel:
    """Return the limited structure; what the fit of the sines held stays."""
    point, chosen = survey.signals.working_point, limits.structure_limits
    if chosen:
        model = structure_for(chosen, survey.vessel, point, start=limits.start)
    else:
        model = LimitedModel(
            structure=limited(curve=survey.vessel.machine.full_load_shape(point.engine_speed_rev_s)),
            limits=(),
            start={},
        )
    held = {name: value for name, value in survey.fingerprint.held.items() if name in model.structure.names}
    return replace(model, structure=model.structure.held_at(**held))


def _priors(survey: Survey, model: LimitedModel, limits: LimitFit) -> Mapping[str, Prior]:
    """Return what vessel file, user and ``limits`` know before."""
    stated = {one.name: Prior(one.value, one.std) for one in limits.numbers if one.name in model.names}
    known = dict(survey.identification.settings.priors)
    return priors_of(model.structure, survey.vessel, survey.signals, known) | stated


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
