"""The verb ``identify_files``: from files of a drive, records or frequency responses, to its fit."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._estimated import estimated_responses
from shaftprint.bench._fit import STARTS, DriveFit, identify_drive
from shaftprint.bench._records import read_records
from shaftprint.bench._responses import RESPONSE_STARTS, identify_responses, read_responses
from shaftprint.survey._progress import SILENT, Progress


def identify_files(
    one: EquippedDrive,
    paths: Sequence[Path],
    *,
    rng: np.random.Generator,
    starts: int | None = None,
    hints: Mapping[str, Any] = MappingProxyType({}),
    progress: Progress = SILENT,
) -> DriveFit:
    """Return the fit to records, or to frequency responses where the drive file says that the files hold these.

    ``one``: the drive. ``paths``: its files. ``rng``: draws the starts of the search. ``starts``: their number; as many
    as are usual where not given. ``hints``: what the files do not say themselves. ``progress``: is told what is being
    done. Raises ShaftprintError if a file cannot be read, or the fit has no acceptable result.
    """
    if one.drive.responses:
        progress.begin("Reading the responses")
        responses = read_responses(paths, one)
        progress.begin("Fitting the responses")
        return identify_responses(one, responses, rng=rng, starts=starts or RESPONSE_STARTS)
    progress.begin("Reading the records")
    records = read_records(paths, one, **hints)
    if one.drive.frequency_response is not None:
        progress.begin("Estimating and fitting the responses")
        files = estimated_responses(one, records)
        return identify_responses(one, files, rng=rng, starts=starts or RESPONSE_STARTS)
    progress.begin("Fitting the records")
    return identify_drive(one, records, rng=rng, starts=starts or STARTS)
