"""From segments to a day: a fingerprint of service, and slope and curvature of each segment beside it."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray
from shaftprint.errors import ServiceError
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary
from shaftprint.service._day_folder import SCORES, SCORES_AGAINST, VALUES, VALUES_AGAINST, scores_text, theta_text
from shaftprint.service._delays import expect_one_clock, with_delays_known
from shaftprint.service._fingerprint import Load, fingerprint_of_service
from shaftprint.service._fit import ServiceFit, fit_segments
from shaftprint.service._model import ServiceModel, service_model
from shaftprint.service._progress import progress_of
from shaftprint.service._segment import LeverLine, Segment
from shaftprint.service._segment_file import read_segments
from shaftprint.service._ship_numbers import value_and_slope
from shaftprint.service._start import begun
from shaftprint.time_domain._record import Record

if TYPE_CHECKING:
    from shaftprint.campaign._trial_conditions import TrialConditions
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.vessel._vessel import Vessel


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class ServiceDay(Shown):
    """What some service told of a line."""

    given: tuple[Segment, ...]
    """The segments that the tables gave."""
    segments: tuple[Segment, ...]
    """Those that were used."""
    model: ServiceModel
    """The model, with the values that the fit began from."""
    fit: ServiceFit
    """The fit, normalised at the working point of the vessel file."""
    fingerprint: "Fingerprint"
    """The fingerprint, normalised at the mean load."""

    def summary(self) -> Summary:
        """Return how much was used, and the verdict."""
        facts = {
            "used": f"{len(self.segments)} segments of {sum(one.seconds for one in self.segments):.0f} s",
            "verdict": self.fingerprint.verdict.reason,
        }
        return Summary(title=f"Service of {self.fingerprint.conditions.vessel}", facts=facts)

    def scores_text(self, *, at_start: bool = False) -> str:
        """Return slope and upper half of the curvature of each segment, as a table of text.

        What days tell together is the sum of both; nothing of it needs the logs again.

        ``at_start``: at the values that the fit began from, against which days are held; else at the fit.
        """
        counts, scores = (
            (self.fit.counts_at_start, self.fit.at_start) if at_start else (self.fit.counts, self.fit.scores)
        )
        return scores_text([one for one, does in zip(self.given, counts, strict=True) if does], scores, self.model.free)

    def theta_text(self, *, at_start: bool = False) -> str:
        """Return at which values the slopes were taken, as JSON."""
        return theta_text(self.model.theta if at_start else self.fit.theta, self.model.free)

    def files(self, *, against: bool) -> dict[str, str]:
        """Return what goes beside the fingerprint in the folder of a day, by the name of the file.

        ``against``: whether days are held against the values that the fit began from, those of a fingerprint.
        """
        files = {SCORES: self.scores_text(), VALUES: self.theta_text()}
        if against:
            files |= {SCORES_AGAINST: self.scores_text(at_start=True), VALUES_AGAINST: self.theta_text(at_start=True)}
        return files


@refusing_none(ServiceError)
def fit_service(
    tables: str | Path | Sequence[str | Path],
    vessel: "Vessel",
    *,
    fingerprint: "Fingerprint | None" = None,
    progress: str | Path | None = None,
    tested_at: datetime | None = None,
    conditions: "TrialConditions | None" = None,
    now: datetime,
) -> ServiceDay:
    """Fit a line to the segments of tables that ``Scan.write`` wrote, as edited since.

    Parameters
    ----------
    tables
        The table of segments, or those of several days; segments marked "no" are left out.
    vessel
        The installation.
    fingerprint
        One to begin from; none of its numbers counts.
    progress
        File that keeps what each step has reached. A fit that was stopped goes on from there and ends with the same
        numbers to the last bit. Delete it when the result is written.
    tested_at
        When the service began, with time zone; by default as the first log says.
    conditions
        Draught and water, where somebody states them.
    now
        Time of making, with time zone.

    Raises
    ------
    ServiceError
        If a file cannot be used, the scan refused the logs, there are too few segments, or the fit does not end.
    """
    paths = [Path(tables)] if isinstance(tables, str | Path) else [Path(one) for one in tables]
    if not paths:
        raise ServiceError("service fit: expected at least one table of segments, found none.")
    model = service_model(vessel, fingerprint)
    days = [_of_table(path, vessel) for path in paths]
    given = tuple(one for segments, *_ in days for one in segments if not one.reason)
    records = [
        record
        for segments, line, *_ in days
        for record in model.records([one for one in segments if not one.reason], line)
    ]
    model = begun(model, records)
    kept = None if progress is None else progress_of(Path(progress), paths, model)
    fit = fit_segments(records, model, progress=kept)
    used = tuple(one for one, counts in zip(given, fit.counts, strict=True) if counts)
    expect_one_clock(fit, model.free, paths[0])
    told = with_delays_known(fit, model.free)
    made = fingerprint_of_service(
        told,
        model,
        vessel,
        line=days[0][1],
        segments=used,
        of=sum(len(segments) for segments, *_ in days),
        load=_load_of(
            told,
            model,
            [one for one, counts in zip(records, fit.counts, strict=True) if counts],
            [load for _, _, load, _ in days],
        ),
        tables=paths,
        now=now,
        tested_at=tested_at or days[0][3],
        trial=conditions,
    )
    return ServiceDay(given=given, segments=used, model=model, fit=fit, fingerprint=made)


def _of_table(
    path: Path, vessel: "Vessel"
) -> tuple[tuple[Segment, ...], LeverLine, tuple[float, float], datetime | None]:
    """Return the segments of a table, the line of the lever, mean load with its standard deviation, and its beginning.

    Raises ServiceError if the table cannot be used.
    """
    segments, line, facts = read_segments(path)
    refused = str(facts.get("refused", ""))
    if refused:
        raise ServiceError(f"{path}: nothing is fitted to these segments, since {refused}")
    if facts.get("vessel") != vessel.name:
        raise ServiceError(
            f"{path}: expected segments of {vessel.name}, found some of {facts.get('vessel')}; name the vessel file "
            "with which the logs were scanned."
        )
    began = facts.get("began")
    return (
        segments,
        line,
        (float(str(facts["load"])), float(str(facts["load_std"]))),
        None if not isinstance(began, str) else _moment(began, path),
    )


def _moment(text: str, path: Path) -> datetime:
    """Return a date and time of the facts beside a table. Raises ServiceError if it is none."""
    try:
        return datetime.fromisoformat(text)
    except ValueError:
        raise ServiceError(
            f"{path}: expected when its first log began, found {text[:40]!r}; scan the logs again."
        ) from None


def _load_of(
    fit: ServiceFit, model: ServiceModel, records: Sequence[Record], loads: Sequence[tuple[float, float]]
) -> Load:
    """Return the mean load; underway without what the ship's speed does to it, by the fit.

    ``records``: the segments that count. ``loads``: those of the still stretches of each day, with their standard
    deviations.
    """
    if not model.sails:
        value, std = _mean_load(loads)
        return Load(value=value, std=std, slope=np.zeros(fit.theta.size))
    speeds = np.array([float(np.mean(record.outputs["n"])) for record in records])
    shown = np.array([record.load for record in records]) * model.taken(speeds)

    def found(theta: FloatArray) -> FloatArray:
        return np.asarray(shown / model.at(theta).taken(speeds))

    value, slope = value_and_slope(lambda table: np.array([found(theta).mean() for theta in table]), fit.theta)
    return Load(value=value, std=float(found(fit.theta).std(ddof=1) / np.sqrt(speeds.size)), slope=slope)


def _mean_load(loads: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """Return the mean load of several days and its standard deviation, that of days that differ included."""
    if len(loads) == 1:
        return loads[0]
    values, std = np.array(loads).T
    weight = 1.0 / np.maximum(std, 1e-6) ** 2
    mean = float(weight @ values / weight.sum())
    within = 1.0 / weight.sum()
    return mean, float(np.sqrt(max(within, np.var(values, ddof=1) / values.size)))
