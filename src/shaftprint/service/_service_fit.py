"""From segments to a day: a fingerprint of service, and slope and curvature of each segment beside it."""

import csv
import io
import json
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from shaftprint.arguments import refusing_none
from shaftprint.catalogue._gauge import T_SP
from shaftprint.errors import ServiceError
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary
from shaftprint.service._fingerprint import fingerprint_of_service
from shaftprint.service._fit import ServiceFit, fit_segments
from shaftprint.service._model import FREE, ServiceModel, service_model
from shaftprint.service._segment import Segment
from shaftprint.service._segment_file import read_segments

if TYPE_CHECKING:
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.vessel._vessel import Vessel

LATEST_T_SP_S, EARLIEST_T_SP_S = 0.5, -0.02
"""Latency of the set point beyond which the lever is not on the clock of the others [s]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class ServiceDay(Shown):
    """What some service told of a line."""

    segments: tuple[Segment, ...]
    """The segments that were used."""
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

    def scores_text(self) -> str:
        """Return slope and upper half of the curvature of each segment at the fit, as a table of text.

        What days tell together is the sum of both; nothing of it needs the logs again.
        """
        text = io.StringIO(newline="")
        table = csv.writer(text, lineterminator="\n")
        pairs = [(i, j) for i in range(len(FREE)) for j in range(i, len(FREE))]
        table.writerow(
            ["log", "move_s", "noise", *(f"g_{n}" for n in FREE), *(f"H_{FREE[i]}_{FREE[j]}" for i, j in pairs)]
        )
        for segment, score in zip(self.segments, self.fit.scores, strict=True):
            numbers = [*score.slope.tolist(), *(float(score.information[i, j]) for i, j in pairs)]
            table.writerow(
                [Path(segment.log).name, f"{segment.move_s:.2f}", f"{score.level:.6g}", *(f"{x:.9g}" for x in numbers)]
            )
        return text.getvalue()

    def theta_text(self) -> str:
        """Return at which values the slopes were taken, as JSON."""
        return json.dumps(dict(zip(FREE, self.fit.theta.tolist(), strict=True)), indent=1) + "\n"


@refusing_none(ServiceError)
def fit_service(
    table: str | Path, vessel: "Vessel", *, fingerprint: "Fingerprint | None" = None, now: datetime
) -> ServiceDay:
    """Fit a line to the segments of a table that ``Scan.write`` wrote, as edited since.

    Parameters
    ----------
    table
        The table of segments; those marked "no" are left out.
    vessel
        The installation.
    fingerprint
        One to begin from; none of its numbers counts.
    now
        Time of making, with time zone.

    Raises
    ------
    ServiceError
        If a file cannot be used, the scan refused the logs, there are too few segments, or the fit does not end.
    """
    segments, line, facts = read_segments(table)
    refused = str(facts.get("refused", ""))
    if refused:
        raise ServiceError(f"{table}: nothing is fitted to these segments, since {refused}")
    used = tuple(one for one in segments if not one.reason)
    model = service_model(vessel, fingerprint)
    if facts.get("vessel") != vessel.name:
        raise ServiceError(
            f"{table}: expected segments of {vessel.name}, found some of {facts.get('vessel')}; name the vessel file "
            "with which the logs were scanned."
        )
    fit = fit_segments(model.records(used, line), model)
    latency = float(fit.theta[FREE.index(T_SP.name)])
    if not EARLIEST_T_SP_S - 3.0 * _std(fit, T_SP.name) <= latency <= LATEST_T_SP_S:
        raise ServiceError(
            f"{table}: expected a speed that follows the lever within {LATEST_T_SP_S:g} s, found a latency of "
            f"{1e3 * latency:.0f} ms: lever, speed and torque do not share one clock; log all three with one logger or "
            "bring its files onto one clock (shaftprint merge)."
        )
    load, load_std = (float(str(facts[name])) for name in ("load", "load_std"))
    made = fingerprint_of_service(
        fit,
        model,
        vessel,
        line=line,
        segments=used,
        of=len(segments),
        load=(load, load_std),
        table=Path(table),
        now=now,
    )
    return ServiceDay(segments=used, model=model, fit=fit, fingerprint=made)


def _std(fit: ServiceFit, name: str) -> float:
    return float(fit.std[FREE.index(name)])
