"""The work of a job: from a recording to its fingerprint, as ``shaftprint identify --no-report`` does it."""

from collections.abc import Callable
from datetime import datetime

import numpy as np

from shaftprint.errors import RecordingError
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.fleet._arguments import JobArguments
from shaftprint.identify.search._settings import Settings
from shaftprint.models._structure import Structure
from shaftprint.survey._fits import priors_of
from shaftprint.survey._measurement import Measurement
from shaftprint.survey._progress import Silent
from shaftprint.survey._survey import Survey, run
from shaftprint.survey._trial import Trial


class Told(Silent):
    """Progress whose steps are told to somebody; amounts of work within a step are not."""

    def __init__(self, tell: Callable[[str], None]) -> None:
        self._tell = tell

    def begin(self, text: str, total: float | None = None) -> None:
        """Tell the next step."""
        self._tell(text)


def survey_of_job(
    arguments: JobArguments,
    *,
    tell: Callable[[str], None],
    now: datetime | None = None,
    rng: np.random.Generator | None = None,
) -> Survey:
    """Return the survey of the recording of a job, not judged yet.

    ``arguments``: what is identified. ``tell``: is told each step. ``now``: when the fingerprint is made. ``rng``: for
    the starts of the search; of the seed of the job where it is not given. Raises ShaftprintError if a file cannot be
    used, the recording does not give what the structure describes, or a file is not the one that was asked for.
    """
    survey = run(
        arguments.recording,
        arguments.vessel,
        arguments.campaign,
        structures=() if arguments.structure is None else (arguments.structure,),
        settings=_settings_of(arguments.starts),
        rng=np.random.default_rng(arguments.seed) if rng is None else rng,
        now=now,
        conditions=arguments.conditions,
        legs=arguments.legs,
        judge=False,
        progress=Told(tell),
    )
    _expect_same_files(survey.fingerprint, arguments)
    return survey


def _settings_of(starts: int) -> Callable[[Structure, Measurement, Trial], Settings]:
    def settings(structure: Structure, measurement: Measurement, trial: Trial) -> Settings:
        return Settings(starts=starts, priors=priors_of(structure, trial.vessel, measurement.signals))

    return settings


def _expect_same_files(fingerprint: Fingerprint, arguments: JobArguments) -> None:
    """Check that no file was changed since the job was asked for; its key would be that of another result."""
    for source in fingerprint.sources:
        expected = arguments.sha256.get(source.role)
        if expected is not None and source.sha256 != expected:
            raise RecordingError(
                f"{getattr(arguments, source.role)}: expected the {source.role} file as it was when the job was asked "
                "for, found it changed; ask for it once more with shaftprint fleet run."
            )
