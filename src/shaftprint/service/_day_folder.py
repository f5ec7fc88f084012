"""Days of service in their folders: what each segment tells at one fingerprint, without the logs."""

import csv
import io
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import ServiceError
from shaftprint.escape import csv_cell
from shaftprint.files import reason
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.fingerprint._json_file import read_fingerprint
from shaftprint.service._model import FREE
from shaftprint.service._score import Score
from shaftprint.service._segment import Segment

SCORES, VALUES = "scores.csv", "values.json"
"""Files of a day beside the fingerprint: slope and curvature of each segment, and at which values."""
SCORES_AGAINST, VALUES_AGAINST = "scores-against.csv", "values-against.json"
"""The same at the fingerprint that its fit began from."""
_PAIRS = [(i, j) for i in range(len(FREE)) for j in range(i, len(FREE))]
_COLUMNS = ["log", "move_s", "noise", *(f"g_{n}" for n in FREE), *(f"H_{FREE[i]}_{FREE[j]}" for i, j in _PAIRS)]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Day:
    """What a day of service tells against an earlier fingerprint."""

    name: str
    """Name of its folder."""
    slopes: FloatArray
    """Slope of the likelihood of each segment at that fingerprint, shape (segments, free)."""
    information: FloatArray
    """Curvature of each, shape (segments, free, free)."""
    theta: FloatArray
    """The values of that fingerprint, shape (free,)."""
    fingerprint: Fingerprint
    """The day's own."""


def scores_text(segments: Sequence[Segment], scores: Sequence[Score]) -> str:
    """Return slope and upper half of the curvature of each segment, as a table of text."""
    text = io.StringIO(newline="")
    table = csv.writer(text, lineterminator="\n")
    table.writerow(_COLUMNS)
    for segment, score in zip(segments, scores, strict=True):
        numbers = [*score.slope.tolist(), *(float(score.information[i, j]) for i, j in _PAIRS)]
        table.writerow(
            [
                csv_cell(Path(segment.log).name),
                f"{segment.move_s:.2f}",
                f"{score.level:.6g}",
                *(f"{x:.9g}" for x in numbers),
            ]
        )
    return text.getvalue()


def theta_text(theta: FloatArray) -> str:
    """Return parameters as JSON."""
    return json.dumps(dict(zip(FREE, theta.tolist(), strict=True)), indent=1) + "\n"


def read_day(folder: Path) -> Day:
    """Return a day of service from the folder that ``service fit --fingerprint`` wrote.

    Raises ServiceError if there is none, or it was not fitted from a fingerprint; FingerprintError if its fingerprint
    cannot be read.
    """
    try:
        values = json.loads((folder / VALUES_AGAINST).read_text(encoding="utf-8"))
        rows = list(csv.reader(io.StringIO((folder / SCORES_AGAINST).read_text(encoding="utf-8"))))
    except OSError as error:
        raise ServiceError(
            f"{folder}: expected a day of service that was fitted from a fingerprint (shaftprint service fit SEGMENTS "
            f"--fingerprint F -o {folder.name}), found no {VALUES_AGAINST} and {SCORES_AGAINST}: {reason(error)}."
        ) from None
    except (ValueError, csv.Error, RecursionError):
        raise ServiceError(_damaged(folder)) from None
    try:
        theta = np.array([float(values[name]) for name in FREE])
        if rows[0] != _COLUMNS:
            raise ValueError(rows[0])
        numbers = np.array([[float(x) for x in row[3:]] for row in rows[1:]]).reshape(-1, len(_COLUMNS) - 3)
    except (ValueError, TypeError, KeyError, IndexError):
        raise ServiceError(_damaged(folder)) from None
    if not (np.all(np.isfinite(numbers)) and np.all(np.isfinite(theta)) and len(numbers)):
        raise ServiceError(_damaged(folder))
    information = np.zeros((len(numbers), len(FREE), len(FREE)))
    for column, (i, j) in enumerate(_PAIRS, start=len(FREE)):
        information[:, i, j] = information[:, j, i] = numbers[:, column]
    return Day(
        name=folder.name,
        slopes=numbers[:, : len(FREE)],
        information=information,
        theta=theta,
        fingerprint=read_fingerprint(folder / "fingerprint.json"),
    )


def _damaged(folder: Path) -> str:
    return (
        f"{folder}: expected slopes and curvatures as shaftprint service fit writes them in {SCORES_AGAINST} and "
        f"{VALUES_AGAINST}, found something else; fit the day again."
    )
