"""The verb of the room: a drive's records to parameters and a verdict."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray
from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._hold import input_way
from shaftprint.bench._late_outputs import late_outputs
from shaftprint.bench._per_record import free_parameters, idle_labels, own_priors
from shaftprint.bench._record_reasons import REQUIREMENTS, held_outputs, large_offsets, starts_in_motion
from shaftprint.bench._search import AGREE, search_drive
from shaftprint.bench._time_settings import drive_time_settings
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.judgement._verdict import Verdict, assess
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.search._settings import Settings
from shaftprint.identify.search._starts import Draw, GivenStarts, LatinHypercube
from shaftprint.identify.uncertainty._profile import Interval, profile
from shaftprint.models._parameter import Parameter
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened
from shaftprint.reasons import Reason
from shaftprint.time_domain._record import Record

STARTS = 4
"""Starts of the search: a start in time costs a simulation of all records at each step."""
# Bounds further apart than this are searched by magnitude.
WIDE = 100.0
# By magnitude from a lower bound of zero: from this share of the upper bound on.
SMALLEST = 1e-5


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class DriveFit(Shown):
    """What was found of a drive, and whether it may be used."""

    equipped: EquippedDrive
    """The drive and its structure."""
    identification: Identification
    """The fit to all records."""
    intervals: Mapping[str, Interval]
    """95 % intervals by the profile likelihood."""
    verdict: Verdict
    """Which numbers may be used."""
    inputs_hold: bool
    """Whether inputs hold from sample to sample; else they go straight."""
    agreeing: int
    """How many starts of the search ended at the optimum."""
    responses: tuple[str, ...] = ()
    """Names of frequency responses, where it is a fit to these."""

    def summary(self) -> Summary:
        """Return the verdict, and which numbers may be used."""
        facts = {
            "verdict": self.verdict.reason,
            "trusted": shortened(self.verdict.trusted),
            "search": f"{self.agreeing} of {self.identification.settings.starts} starts reached it",
        }
        return Summary(title=f"Fit of the drive {self.equipped.drive.name}", facts=facts)


@refusing_none(IdentificationError)
def identify_drive(
    one: EquippedDrive,
    records: Sequence[Record],
    *,
    rng: np.random.Generator,
    priors: Mapping[str, Prior] | None = None,
    starts: int = STARTS,
) -> DriveFit:
    """Fit the structure of a drive to all its records, and judge the fit.

    Parameters
    ----------
    one
        The drive.
    records
        Its records, as ``read_records`` gives them.
    rng
        Source of the start values.
    priors
        What is known beside the drive file, by parameter; it replaces what that says.
    starts
        Starts of the search that are drawn at first; more follow until several agree.

    Raises
    ------
    IdentificationError
        If there are too few data, no start reached a model that stays within bounds, or an output counts the other way
        round.
    SettingsError
        If the start is known of a state that the equations do not have.
    """
    known = own_priors(one, records, {**one.priors, **(priors or {})})
    settings = drive_settings(free_parameters(one, records), known, starts)
    time = drive_time_settings(one, records)
    searched = search_drive(one, records, settings, rng=rng)
    way = input_way(one, searched.fit, records, settings=settings, time=time)
    if way.hold != records[0].hold:
        turned = [replace(record, hold=way.hold) for record in records]
        searched = search_drive(one, turned, settings, rng=rng)
    fit, agreeing = searched.fit, searched.agreeing
    profiled = profile(fit)
    remarks = [remark for record in records for remark in record.remarks]
    in_motion = tuple(starts_in_motion(one, fit))
    kept = tuple(held_outputs(one, records))
    # what keeps its values shows motion late as well
    late = () if kept else late_outputs(one, fit, records, settings=settings, time=time)
    of_records = late or (*kept, *way.reasons, *in_motion)
    reasons = (*alone(agreeing, fit.settings.starts), *of_records, *large_offsets(one, fit))
    verdict = assess(
        fit,
        profile=profiled,
        requirements=REQUIREMENTS,
        reasons=reasons,
        assumptions=(*remarks, *way.assumptions, *idle_labels(one, records)),
    )
    return DriveFit(
        equipped=one,
        identification=fit,
        intervals=profiled.intervals,
        verdict=_without_what_follows(verdict, in_motion),
        inputs_hold=way.hold,
        agreeing=agreeing,
    )


def _without_what_follows(verdict: Verdict, in_motion: Sequence[Reason]) -> Verdict:
    """Return a verdict without the contradictions of a record that other states at its start explain."""
    follow = [
        reason
        for reason in verdict.reasons
        if reason.kind == "contradicting data"
        and any(f" does not hold in record {start.where}: " in reason.sentence for start in in_motion)
    ]
    said = {reason.sentence for reason in follow}
    return replace(
        verdict,
        reasons=tuple(reason for reason in verdict.reasons if reason not in follow),
        sentences=tuple(sentence for sentence in verdict.sentences if sentence not in said),
    )


def alone(agreeing: int, starts: int) -> tuple[Reason, ...]:
    """Return that nobody knows whether an optimum is the only one, where too few starts ended there."""
    if agreeing >= AGREE:
        return ()
    return (
        Reason(
            kind="not unique",
            sentence=(
                f"Whether the optimum is the only one was not examined: of {starts} starts {agreeing or 'none'} ended "
                f"there, and {AGREE} are wanted; narrow the bounds, state what is known of parameters, or search from "
                "more starts with --starts."
            ),
        ),
    )


def drive_settings(free: Sequence[Parameter], priors: Mapping[str, Prior], starts: int) -> Settings:
    """Return how a drive is searched: from the usual values first, and by magnitude between wide bounds."""
    usual = np.array([[p.value for p in free]])
    return Settings(priors=dict(priors), starts=starts, draw=GivenStarts(usual, ByMagnitude()))


@dataclass(frozen=True, slots=True)
class ByMagnitude(Draw):
    """Latin hypercube that draws the logarithm where bounds are positive and wide: an inertia may be grams or tons."""

    def starts(self, lower: FloatArray, upper: FloatArray, count: int, rng: np.random.Generator) -> FloatArray:
        """Return one start in every cell of every parameter, in random combination."""
        wide = (lower >= 0.0) & (upper > 0.0) & (lower * WIDE <= upper)
        least = np.where(wide, np.maximum(lower, SMALLEST * upper), 1.0)
        low, high = np.where(wide, np.log(least), lower), np.where(wide, np.log(np.where(wide, upper, 1.0)), upper)
        drawn = LatinHypercube().starts(low, high, count, rng)
        return np.where(wide, np.exp(np.where(wide, drawn, 0.0)), drawn)
