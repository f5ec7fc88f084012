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
from shaftprint.service._model import FREE, FREE_UNDERWAY
from shaftprint.service._score import Score
from shaftprint.service._segment import Segment

SCORES, VALUES = "scores.csv", "values.json"
"""Files of a day beside the fingerprint: slope and curvature of each segment, and at which values."""
SCORES_AGAINST, VALUES_AGAINST = "scores-against.csv", "values-against.json"
"""The same at the fingerprint that its fit began from."""


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


def _pairs(free: Sequence[str]) -> list[tuple[int, int]]:
    """Return the places of the upper half of a curvature."""
    return [(i, j) for i in range(len(free)) for j in range(i, len(free))]


def _columns(free: Sequence[str]) -> list[str]:
    """Return the titles of a table of scores."""
    curvatures = (f"H_{free[i]}_{free[j]}" for i, j in _pairs(free))
    return ["log", "move_s", "noise", *(f"g_{name}" for name in free), *curvatures]


def scores_text(segments: Sequence[Segment], scores: Sequence[Score], free: Sequence[str]) -> str:
    """Return slope and upper half of the curvature of each segment, as a table of text.

    ``free``: names of the parameters.
    """
    text = io.StringIO(newline="")
    table = csv.writer(text, lineterminator="\n")
    table.writerow(_columns(free))
    for segment, score in zip(segments, scores, strict=True):
        numbers = [*score.slope.tolist(), *(float(score.information[i, j]) for i, j in _pairs(free))]
        table.writerow(
            [
                csv_cell(Path(segment.log).name),
                f"{segment.move_s:.2f}",
                f"{score.level:.6g}",
                *(f"{x:.9g}" for x in numbers),
            ]
        )
    return text.getvalue()


def theta_text(theta: FloatArray, free: Sequence[str]) -> str:
    """Return parameters as JSON, with their names ``free``."""
    return json.dumps(dict(zip(free, theta.tolist(), strict=True)), indent=1) + "\n"


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
        free = FREE_UNDERWAY if FREE_UNDERWAY[-1] in values else FREE
        theta = np.array([float(values[name]) for name in free])
        if rows[0] != _columns(free):
            raise ValueError(rows[0])
        numbers = np.array([[float(x) for x in row[3:]] for row in rows[1:]]).reshape(-1, len(rows[0]) - 3)
    except (ValueError, TypeError, KeyError, IndexError):
        raise ServiceError(_damaged(folder)) from None
    if not (np.all(np.isfinite(numbers)) and np.all(np.isfinite(theta)) and len(numbers)):
        raise ServiceError(_damaged(folder))
    information = np.zeros((len(numbers), len(free), len(free)))
    for column, (i, j) in enumerate(_pairs(free), start=len(free)):
        information[:, i, j] = information[:, j, i] = numbers[:, column]
    return Day(
        name=folder.name,
        slopes=numbers[:, : len(free)],
        information=information,
        theta=theta,
        fingerprint=read_fingerprint(folder / "fingerprint.json"),
    )


def _damaged(folder: Path) -> str:
    return (
        f"{folder}: expected slopes and curvatures as shaftprint service fit writes them in {SCORES_AGAINST} and "
        f"{VALUES_AGAINST}, found something else; fit the day again."
    )
