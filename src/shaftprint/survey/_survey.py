"""The noun and the verb of the room: all that one recording gives, and the run that makes it."""

import copy
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._trial_conditions import TrialConditions
from shaftprint.catalogue._shipped import shipped_structure
from shaftprint.errors import IdentificationError, SettingsError, StructureError
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.fingerprint._leg_records import NoiseSpectrum, noise_spectra
from shaftprint.fingerprint._line_fingerprint import SourceFile
from shaftprint.fingerprint._take import take_fingerprint
from shaftprint.identify.comparison._black_box import BlackBox, black_boxes
from shaftprint.identify.comparison._comparison import StructureComparison
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.search._settings import Settings
from shaftprint.models._structure import Structure
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened
from shaftprint.reasons import Reason
from shaftprint.recording._recording import Recording
from shaftprint.signals._clock import Mode
from shaftprint.signals._signals import Signals
from shaftprint.spectra._spectra import Spectra
from shaftprint.survey._elastic_line import (
    ElasticOffer,
    begun_at_rigid,
    elastic_offer,
    elastic_structures,
    is_elastic,
    may_twist,
)
from shaftprint.survey._fits import comparisons_of, fit, priors_of
from shaftprint.survey._legs import LegTest, fitted_legs, leg_tests
from shaftprint.survey._legs_apart import LegAlone, apart_reasons, legs_alone
from shaftprint.survey._limit_hints import hints_of, reasons_of_limits
from shaftprint.survey._measurement import Measurement, measure, of_legs
from shaftprint.survey._noise import noise_at_speeds
from shaftprint.survey._of_vessel import at_speeds, default_structure, expect_one_speed, of_vessel
from shaftprint.survey._progress import SILENT, Progress, shown_here
from shaftprint.survey._ship_numbers import ship_numbers
from shaftprint.survey._stray_line import fits_beside_a_stray_line
from shaftprint.survey._trial import Trial, load_trial
from shaftprint.survey._twist import twist_reasons
from shaftprint.survey._validation_apart import with_validation
from shaftprint.survey._validations import failed_steps, validations_of, validations_with_limits
from shaftprint.vessel._vessel import Vessel

if TYPE_CHECKING:
    from shaftprint.limits._limit_fit import LimitFit
    from shaftprint.validation._validation import Validation

SettingsOf: TypeAlias = Callable[[Structure, Measurement, Trial], Settings]
"""Gives how a structure is fitted to a measurement of a trial."""


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Survey(Shown):
    """A recording, what was tested, and all that follows from both."""

    trial: Trial
    """Vessel, campaign, and their files."""
    measurement: Measurement
    """Signals, spectra and responses."""
    fits: tuple[Identification, ...]
    """The structures that were fitted, and the elastic line where it is offered; the fingerprint is of the first."""
    fingerprint: Fingerprint
    """What is kept."""
    comparisons: tuple[StructureComparison, ...] = ()
    """Which of several structures the data want."""
    leg_tests: tuple[LegTest, ...] = ()
    """How well the first structure explains each leg of the campaign."""
    legs_alone: tuple[LegAlone, ...] = ()
    """Each leg with a model of its own, where one model does not explain all."""
    limit_fit: "LimitFit | None" = None
    """Limits of governor and engine; None where they were not looked for."""
    validations: "tuple[Validation, ...]" = ()
    """The first structure, with its limits where they were looked for, held against records that it has not seen."""
    black_boxes: tuple[BlackBox, ...] = ()
    """What the data say without physics, of each leg or of the sines; where the fit can be trusted nothing."""
    remarks: tuple[str, ...] = ()
    """What could not be done, in words."""

    def summary(self) -> Summary:
        """Return what was tested, what was fitted and what came out."""
        verdict = self.fingerprint.verdict
        facts = {
            "vessel": self.vessel.name,
            "campaign": self.campaign.name,
            "structures": shortened(one.structure.name for one in self.fits),
            "verdict": verdict.reason,
            "known well enough": shortened(verdict.trusted),
            "validation": "; ".join(f"{one.model.name}: {one.headline}" for one in self.validations),
            "remarks": shortened(self.remarks),
        }
        return Summary(title=f"Survey of {self.signals.recording_name}", facts=facts)

    @property
    def vessel(self) -> Vessel:
        """The installation."""
        return self.trial.vessel

    @property
    def campaign(self) -> Campaign:
        """What was asked of it."""
        return self.trial.campaign

    @property
    def signals(self) -> Signals:
        """The prepared recording."""
        return self.measurement.signals

    @property
    def spectra(self) -> Spectra:
        """Responses of the test lines."""
        return self.measurement.spectra

    @property
    def identification(self) -> Identification:
        """The fit that the fingerprint is of."""
        return self.fits[0]

    @cached_property
    def limit_hints(self) -> tuple[str, ...]:
        """Whether sines, steps or legs hint at a limit, in words."""
        limits = self.limit_fit
        named = [f"{kind.value}{', not trusted' * (kind in limits.doubts)}" for kind in limits.kinds] if limits else []
        return hints_of(self.measurement, self.trial, failed_steps(self.validations), named=named)


@refusing_none(
    SettingsError,
    recording='recording="log.csv": a logger file, or one that sp.read has opened',
    vessel='vessel="mine.toml": the file of the ship, which "shaftprint start" writes, or a shipped one by its name',
    campaign='campaign="test.toml": the file of the test, which "shaftprint plan" writes, or "shaftprint new campaign '
    '--from log.csv" from the recording, or a shipped one by its name',
)
def run(
    recording: str | Path | Recording,
    vessel: str | Path | Vessel,
    campaign: str | Path | Campaign,
    *,
    structures: Sequence[str | Structure] = (),
    settings: SettingsOf | None = None,
    mode: Mode = "shaftprint",
    sources: Sequence[SourceFile] = (),
    rng: np.random.Generator | None = None,
    now: datetime | None = None,
    tested_at: datetime | None = None,
    conditions: str | Path | TrialConditions | None = None,
    legs: Sequence[str] = (),
    judge: bool = True,
    hints: Mapping[str, Any] | None = None,
    progress: Progress | None = None,
) -> Survey:
    """Identify a line from a recording: all that ``shaftprint identify`` does, before anything is written.

    Parameters
    ----------
    recording
        Path of the raw recording in any format that is read, or an open one; ``hints`` say what the file does not.
    vessel, campaign
        What was tested and what was asked of it: paths, shipped names, or loaded.
    structures
        Structures, or names of shipped ones; the fingerprint is of the first. ``default_structure`` without any.
    settings
        Gives how a structure is fitted; with the priors of the vessel file where it is not given.
    mode
        How signals and lines are prepared; the thesis' way is there to compare.
    sources
        Further files that the result rests on, such as that of a structure of the user's own.
    rng
        For the starts of the searches; seed 1, as in the program, where it is not given.
    now
        When the fingerprint is made.
    tested_at
        When the recording began; where it is not given, as the conditions or the logger's clock say.
    conditions
        When, where and in what water the test was made: a path, or loaded.
    legs
        Names of the legs of the campaign to use; all when not given.
    judge
        Whether structures are compared and the model is held against other records; ``judged`` does it later.
    progress
        Is told of each step; a line below the cell of a notebook where it is not given.

    Raises
    ------
    ShaftprintError
        If a file cannot be used, or the recording does not give what a structure describes.
    """
    rng = np.random.default_rng(1) if rng is None else rng
    progress = shown_here() if progress is None else progress
    trial = load_trial(vessel, campaign, conditions)
    trial = replace(trial, sources=(*trial.sources, *sources))
    chosen = tuple(
        one if isinstance(one, Structure) else of_vessel(shipped_structure(one), trial.vessel)
        for one in structures or (default_structure(trial.vessel, trial.campaign),)
    )
    expect_one_speed(trial.campaign, trial.vessel, legs)
    measurement = of_legs(measure(recording, trial, mode=mode, hints=hints or {}, progress=progress), legs)
    measurement = replace(measurement, began=trial.began(tested_at, measurement.began))
    speeds = [point.engine_speed_rev_s for point in measurement.working_points.values()]
    chosen = tuple(at_speeds(one, speeds) for one in chosen)
    by_name = settings_by_name(chosen, measurement, trial, settings or _with_priors)
    fits, measurement = fits_beside_a_stray_line(
        partial(fit, chosen, settings=by_name, rng=rng, progress=progress), measurement
    )
    alone = legs_alone(fits[0], measurement, settings=by_name, rng=rng)
    offer = _offer(fits, measurement, trial, settings or _with_priors, rng=rng, progress=progress)
    survey = _of_fits(fits, measurement, trial, now=now, progress=progress, alone=alone, offer=offer)
    survey = judged(survey, rng=rng, progress=progress) if judge else survey
    progress.end()
    return survey


def _offer(
    fits: Sequence[Identification],
    measurement: Measurement,
    trial: Trial,
    settings: SettingsOf,
    *,
    rng: np.random.Generator,
    progress: Progress,
) -> ElasticOffer | None:
    """Return the elastic line where the first structure is a rigid one that it beats; None where it was asked for."""
    elastic = elastic_structures(fits[0].structure, trial.vessel)
    if not elastic or any(is_elastic(one.structure) for one in fits):
        return None
    if not may_twist(fits[0], trial.vessel):
        return None
    progress.begin("Asking whether the line twists")
    return elastic_offer(
        fits[0], elastic, measurement, trial, settings=lambda one: settings(one, measurement, trial), rng=rng
    )


def fingerprint_of(
    identification: Identification, measurement: Measurement, trial: Trial, *, now: datetime | None = None
) -> Fingerprint:
    """Return the fingerprint of one fit."""
    return _fingerprint(
        identification, measurement, trial, leg_tests(identification, measurement.working_points), now=now
    )


def _fingerprint(
    identification: Identification,
    measurement: Measurement,
    trial: Trial,
    tests: Sequence[LegTest],
    *,
    now: datetime | None,
    reasons: Sequence[Reason] = (),
    cautions: Sequence[str] = (),
    explained_share: float = 0.0,
) -> Fingerprint:
    return take_fingerprint(
        identification,
        signals=measurement.signals,
        signal_to_noise=measurement.signal_to_noise,
        vessel=trial.vessel,
        campaign=trial.campaign,
        settings_files=trial.sources,
        now=now or datetime.now(UTC),
        tested_at=measurement.began,
        trial_conditions=trial.conditions,
        legs=fitted_legs(measurement.signals, measurement.legs, tests),
        reasons=reasons,
        cautions=cautions,
        noise=_measured_noise(measurement, trial),
        torque_ripple=measurement.torque_ripple,
        ship=_ship(identification, measurement, trial),
        explained_share=explained_share,
    )


def _ship(identification: Identification, measurement: Measurement, trial: Trial) -> tuple[Estimate, ...]:
    """Return what the test says of a ship underway; nothing where its propellers do not pull at the measured speeds."""
    try:
        # a stream of its own: what a line is found to be does not depend on whether its ship is looked at
        return ship_numbers(identification, measurement.signals, trial.vessel, rng=np.random.default_rng(1))
    except (StructureError, IdentificationError):
        return ()


def _measured_noise(measurement: Measurement, trial: Trial) -> tuple[NoiseSpectrum, ...]:
    """Return the noise at each speed; none where the recording does not show it, as in the thesis' mode."""
    try:
        return noise_spectra(noise_at_speeds(measurement, trial.campaign))
    except IdentificationError:
        return ()


def survey_of(
    fits: Sequence[Identification],
    measurement: Measurement,
    trial: Trial,
    *,
    rng: np.random.Generator,
    now: datetime | None = None,
    progress: Progress = SILENT,
) -> Survey:
    """Return what follows from fits: fingerprint, comparisons, validation."""
    return judged(_of_fits(fits, measurement, trial, now=now, progress=progress), rng=rng, progress=progress)


def _of_fits(
    fits: Sequence[Identification],
    measurement: Measurement,
    trial: Trial,
    *,
    now: datetime | None,
    progress: Progress,
    alone: Sequence[LegAlone] = (),
    offer: ElasticOffer | None = None,
) -> Survey:
    progress.begin("Finding the intervals")
    tests = leg_tests(fits[0], measurement.working_points)
    twisted = () if is_elastic(fits[0].structure) else twist_reasons(measurement.speed_ratios, trial.vessel)
    at_limits, cautions = reasons_of_limits(fits[0], measurement, trial)
    fingerprint = _fingerprint(
        fits[0],
        measurement,
        trial,
        tests,
        now=now,
        reasons=(
            *at_limits,
            *apart_reasons(fits[0], alone),
            *([] if offer is None else [offer.reason]),
            *twisted,
        ),
        cautions=cautions,
        # a twist between two sensors is measured, and no other cause explains more
        explained_share=1.0 if twisted else 0.0 if offer is None else offer.share,
    )
    return Survey(
        trial=trial,
        measurement=measurement,
        fits=(*fits, *([] if offer is None else [offer.fit])),
        fingerprint=fingerprint,
        leg_tests=tests,
        legs_alone=tuple(alone),
    )


def judged(survey: Survey, *, rng: np.random.Generator, progress: Progress = SILENT) -> Survey:
    """Return a survey with its structures compared and its model held against records that it has not seen.

    ``rng``: for the starts of the fits without a line, and for the parameter sets that bands are drawn from.
    """
    beside_rng, measurement = copy.deepcopy(rng), survey.measurement
    validated = (
        partial(validations_of, survey.identification, measurement, survey.trial)
        if survey.limit_fit is None
        else partial(validations_with_limits, survey.fingerprint, measurement, survey.trial)
    )
    validated = partial(validated, rng=beside_rng, progress=progress)
    comparisons: tuple[StructureComparison, ...] = ()
    if len(survey.fits) == 1:
        validations, remarks = validated()
    else:
        # a validation is Fourier transforms, a comparison of structures small fits: neither waits for the other
        with ThreadPoolExecutor(max_workers=1) as beside:
            validating = beside.submit(validated)
            comparisons = comparisons_of(survey.fits, rng=rng, progress=progress)
            validations, remarks = validating.result()
    return replace(
        survey,
        fingerprint=with_validation(survey.fingerprint, validations),
        comparisons=comparisons,
        validations=validations,
        black_boxes=()
        if survey.fingerprint.verdict.trustworthy
        else black_boxes(survey.identification, [*measurement.working_points] if measurement.legs else []),
        remarks=(*survey.remarks, *remarks),
    )


def settings_by_name(
    structures: Sequence[Structure], measurement: Measurement, trial: Trial, settings: SettingsOf
) -> dict[str, Settings]:
    """Return how each structure is fitted, by its name."""
    return {one.name: begun_at_rigid(one, measurement, settings(one, measurement, trial)) for one in structures}


def _with_priors(structure: Structure, measurement: Measurement, trial: Trial) -> Settings:
    return Settings(priors=priors_of(structure, trial.vessel, measurement.signals))
