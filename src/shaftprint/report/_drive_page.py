"""The report of a drive that is no ship's: first page, verdict, numbers, records, files."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from shaftprint.arguments import refusing_none
from shaftprint.errors import ReportError
from shaftprint.fingerprint._drive_fingerprint import DriveFingerprint
from shaftprint.fingerprint._json_file import fingerprint_sha256
from shaftprint.forecast._simulation import SimulatedSignal
from shaftprint.plain_table import Table, texts
from shaftprint.report._drive_cover import drive_cover
from shaftprint.report._page import Page, write_page
from shaftprint.report.figures._left import left_chart, outside
from shaftprint.report.figures._simulation import simulation_chart
from shaftprint.report.sections._sections import Picture, Section, picture_name
from shaftprint.tables._drive import drive_assumed_table, drive_record_table, drive_response_table
from shaftprint.tables._fingerprint import combination_table, quantity_table
from shaftprint.time_domain._record_fit import RecordFit

if TYPE_CHECKING:
    from shaftprint.bench._fit import DriveFit
    from shaftprint.report.charts._chart import Chart

# So many of the correlations of a right model lie outside the band.
BY_CHANCE = 0.05


@refusing_none(ReportError)
def render_drive(
    directory: str | Path,
    fit: "DriveFit",
    fingerprint: DriveFingerprint,
    *,
    pictures: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Path:
    """Write the page of a drive, ``index.html`` with its charts; return its path.

    ``directory``: where the page goes; made if it does not exist. Other files there are left alone. ``fit``: what was
    found, with the records. ``fingerprint``: what is kept of it. ``pictures``: whether every chart is written as SVG,
    PDF and PNG too. ``progress``: is told the finished share, from 0 to 1. Raises FileExistsError if there is a page
    already; ReportError if plotly is not installed.
    """
    page = Page(
        title=f"Fingerprint of {fingerprint.drive}",
        subtitle=f"Structure {fingerprint.structure}, {_counted(fingerprint)}",
        created=fingerprint.created,
        version=fingerprint.shaftprint_version,
        cover=drive_cover(fingerprint),
        sections=(
            _verdict(fingerprint),
            _numbers(fingerprint),
            _records(fit, fingerprint),
            *_left(fit),
            _assumed(fingerprint),
        ),
        files=_files(fingerprint),
        ending=(
            f"shaftprint {fingerprint.shaftprint_version}, fingerprint schema {fingerprint.schema_version}. ± is one "
            "standard deviation throughout; intervals hold 95 %."
        ),
        fingerprint_sha256=fingerprint_sha256(fingerprint),
    )
    return write_page(directory, page, pictures=pictures, progress=progress)


def _counted(fingerprint: DriveFingerprint) -> str:
    responses = len(fingerprint.responses)
    count, noun = (responses, "frequency response") if responses else (len(fingerprint.records), "record")
    return f"{count} {noun}{'' if count == 1 else 's'}"


def _verdict(fingerprint: DriveFingerprint) -> Section:
    verdict = fingerprint.verdict
    title = f"Verdict: {verdict.words}"
    return Section(key="verdict", title=title, points=verdict.sentences)


def _numbers(fingerprint: DriveFingerprint) -> Section:
    tables = [quantity_table("Identified parameters", fingerprint.parameters)]
    if fingerprint.combinations:
        tables.append(combination_table(fingerprint))
    return Section(key="numbers", title="Numbers", tables=tables)


def _records(fit: "DriveFit", fingerprint: DriveFingerprint) -> Section:
    parts = [part for part in fit.identification.parts if isinstance(part, RecordFit)]
    drawn = [
        Picture(
            name=picture_name("record", str(number), part.record.name),
            caption=f"{part.record.name}: inputs and outputs as they were measured, and the model with its offset.",
            alt=f"Inputs, measured outputs and the model's outputs over time of the record {part.record.name}.",
            chart=partial(_chart, part, fingerprint),
        )
        for number, part in enumerate(parts, start=1)
    ]
    if fingerprint.responses:
        return Section(key="records", title="Frequency responses", tables=(drive_response_table(fingerprint),))
    return Section(key="records", title="Records", tables=(drive_record_table(fingerprint),), pictures=drawn)


def _left(fit: "DriveFit") -> list[Section]:
    """Return what the model leaves of each record; nothing where frequency responses were fitted."""
    parts = [part for part in fit.identification.parts if isinstance(part, RecordFit)]
    counts = [outside(part) for part in parts]
    told = [
        f"Record {part.record.name}: {beyond} of {count} correlations lie outside, of which chance makes about "
        f"{BY_CHANCE * count:.0f}."
        for part, (beyond, count) in zip(parts, counts, strict=True)
    ]
    pictures = [
        Picture(
            name=picture_name("left", str(number), part.record.name),
            caption=f"{part.record.name}: residuals, their autocorrelation, and their correlation with what inputs did "
            "before. Within the band lie 95 % of what a right model leaves.",
            alt=f"Residuals of each output over time and their correlations over the lag, record {part.record.name}.",
            chart=partial(left_chart, part),
        )
        for number, part in enumerate(parts, start=1)
    ]
    opening = (
        "Residuals are whitened: divided by the noise of their frequency. With themselves they are correlated where "
        "the noise is another than assumed; with an input where the model lacks something that the input moves."
    )
    section = Section(key="left", title="What the model leaves", paragraphs=(opening,), points=told, pictures=pictures)
    return [section] if parts else []


def _chart(part: RecordFit, fingerprint: DriveFingerprint) -> "Chart":
    record, names = part.record, tuple(part.structure.outputs)
    driving = [
        SimulatedSignal(title=name, unit=fingerprint.inputs[name], values=values, is_input=True)
        for name, values in record.inputs.items()
    ]
    measured = [
        SimulatedSignal(title=name, unit=fingerprint.outputs[name], values=record.outputs[name]) for name in names
    ]
    model = [SimulatedSignal(title=name, unit=fingerprint.outputs[name], values=part.model[name]) for name in names]
    return simulation_chart(record.time_s, [*driving, *measured], name="measured", beside={"model": model})


def _assumed(fingerprint: DriveFingerprint) -> Section:
    return Section(key="assumed", title="What was taken as known", tables=(drive_assumed_table(fingerprint),))


def _files(fingerprint: DriveFingerprint) -> Table:
    return Table(
        title="Files that went into this report",
        columns=texts("file", "what it is", "SHA-256"),
        rows=tuple((source.name, source.role, source.sha256) for source in fingerprint.sources),
    )
