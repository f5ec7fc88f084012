"""Frequency responses of a drive, as an analyser or a sweep of another program left them, to parameters."""

import csv
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._fit import DriveFit, alone, drive_settings
from shaftprint.bench._per_record import free_parameters, idle_labels, own_priors, with_structures
from shaftprint.bench._records import expect_different_names
from shaftprint.bench._search import AGREE, MOST, agreeing_starts
from shaftprint.drive._responses import ResponseColumns
from shaftprint.errors import IdentificationError, RecordingError, ResponseError
from shaftprint.identify.fit._identify import identify_jointly
from shaftprint.identify.judgement._verdict import assess
from shaftprint.identify.uncertainty._profile import profile
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._plain_covariance import circular_covariance, coherence_covariance
from shaftprint.spelling import meant

RESPONSE_STARTS = 8
"""Starts of the search: a start costs little where nothing is simulated."""
FEWEST = 3
"""Least number of lines of a response."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ResponseFile:
    """A file's frequency response."""

    name: str
    """Name of the file without its ending."""
    response: FrequencyResponse
    """The response, of the inputs and outputs of the drive in its units."""
    remarks: tuple[str, ...] = ()
    """What was left out, in a sentence."""


def read_responses(paths: Sequence[Path], one: EquippedDrive) -> tuple[ResponseFile, ...]:
    """Return the frequency response of each file; lines in which something is no number are left out and counted.

    Raises RecordingError if a file cannot be read or lacks a column, or fewer than three lines are left.
    """
    files = tuple(_read(path, one) for path in paths)
    expect_different_names("responses", [file.name for file in files])
    return files


@refusing_none(IdentificationError)
def identify_responses(
    one: EquippedDrive, files: Sequence[ResponseFile], *, rng: np.random.Generator, starts: int = RESPONSE_STARTS
) -> DriveFit:
    """Fit the structure of a drive, for small motions, to its frequency responses, and judge the fit.

    ``starts``: starts of the search that are drawn at first; more follow until several agree. Raises
    IdentificationError if there are too few lines, or no start reached a model that is stable.
    """
    pairs = [(structure, file.response) for structure, file in with_structures(one, files)]
    free, known = free_parameters(one, files), own_priors(one, files, one.priors)
    fit = identify_jointly(pairs, rng=rng, settings=drive_settings(free, known, starts))
    while (agreeing := agreeing_starts(fit)) < AGREE and 2 * starts <= MOST:
        starts *= 2
        fit = identify_jointly(pairs, rng=rng, settings=drive_settings(free, known, starts))
    profiled = profile(fit)
    remarks = (remark for file in files for remark in file.remarks)
    verdict = assess(
        fit,
        profile=profiled,
        reasons=alone(agreeing, fit.settings.starts),
        assumptions=(*remarks, *idle_labels(one, files)),
    )
    return DriveFit(
        equipped=one,
        identification=fit,
        intervals=profiled.intervals,
        verdict=verdict,
        inputs_hold=False,
        agreeing=agreeing,
        responses=tuple(file.name for file in files),
    )


def _read(path: Path, one: EquippedDrive) -> ResponseFile:
    rows, inputs, outputs = one.drive.responses, one.structure.inputs, tuple(one.structure.outputs)
    columns = _columns(path, tuple(dict.fromkeys(name for row in rows for name in row.columns)))
    frequencies = {(row.frequency, row.frequency_unit) for row in rows}
    if len(frequencies) > 1:
        raise RecordingError(f"{path}: expected one column of frequencies for all responses, found {len(frequencies)}.")
    hertz = columns[rows[0].frequency] / (2.0 * math.pi if rows[0].frequency_unit == "rad/s" else 1.0)
    usable = np.all([np.isfinite(column) for column in columns.values()], axis=0) & (hertz > 0.0)
    order = np.flatnonzero(usable)[np.argsort(hertz[usable], kind="stable")]
    if order.size < FEWEST:
        raise RecordingError(
            f"{path}: expected {FEWEST} lines or more with numbers in every column, found {order.size}."
        )
    kept = {name: column[order] for name, column in columns.items()}
    by_pair = {(row.output, row.input or inputs[0]): row for row in rows}
    values = np.empty((len(outputs), len(inputs), order.size), dtype=np.complex128)
    std, coherence = np.empty(values.shape), np.empty(values.shape)
    for (i, output), (j, source) in product(enumerate(outputs), enumerate(inputs)):
        row, factor = by_pair[output, source], one.factors[output] / one.factors[source]
        values[i, j] = factor * _values(row, kept)
        std[i, j] = _std(row, kept, values[i, j], abs(factor))
        coherence[i, j] = 0.0 if row.coherence is None else kept[row.coherence]
    averages = {row.averages for row in rows}
    try:
        if averages == {None}:
            covariance = circular_covariance(std)
        elif len(averages) == 1:
            covariance = coherence_covariance(values, coherence, averages=float(rows[0].averages or 0.0))
        else:
            raise ResponseError("expected coherence with the same averages of all responses, or of none.")
        response = FrequencyResponse(
            frequency_hz=hertz[order], response=values, covariance=covariance, inputs=inputs, outputs=outputs
        )
    except ResponseError as error:
        raise RecordingError(f"{path}: {error}") from None
    lost = hertz.size - order.size
    remark = f"in {path.name} {lost} of {hertz.size} lines, in which something is no number, are left out."
    return ResponseFile(name=path.stem, response=response, remarks=(remark,) if lost else ())


def _values(row: ResponseColumns, columns: Mapping[str, FloatArray]) -> ComplexArray:
    """Return the response of a row, as the file has it."""
    if row.real is not None and row.imaginary is not None:
        return np.asarray(columns[row.real] + 1j * columns[row.imaginary])
    magnitude, phase = columns[row.magnitude or ""], columns[row.phase or ""]
    ratio = 10.0 ** (magnitude / 20.0) if row.magnitude_unit == "dB" else magnitude
    return np.asarray(ratio * np.exp(1j * (np.radians(phase) if row.phase_unit == "deg" else phase)))


def _std(
    row: ResponseColumns, columns: Mapping[str, FloatArray], values: ComplexArray, factor: float
) -> FloatArray | float:
    if row.std is not None:
        return factor * columns[row.std]
    return np.nan if row.relative_std is None else row.relative_std * np.abs(values)


def _columns(path: Path, names: Sequence[str]) -> dict[str, FloatArray]:
    """Return columns of a text table with a line of titles; what is no number is NaN."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise RecordingError(f"{path}: expected a text table of a frequency response, found {error}.") from None
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    delimiter = max(",;\t", key=(lines[0] if lines else "").count)
    table = list(csv.reader(lines, delimiter=delimiter))
    titles = [title.strip() for title in table[0]] if table else []
    for name in names:
        if titles.count(name) != 1:
            raise RecordingError(f"{path}: expected one column {name}, found {', '.join(titles)}.{meant(name, titles)}")
    return {name: np.array([_number(row, titles.index(name)) for row in table[1:]]) for name in names}


def _number(row: Sequence[str], column: int) -> float:
    try:
        return float(row[column])
    except (IndexError, ValueError):
        return math.nan
