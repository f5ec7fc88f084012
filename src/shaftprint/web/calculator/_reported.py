"""The report of one test, made when somebody asks for it: the recording is identified once more, as its job did."""

from pathlib import Path
from typing import Any

import numpy as np

from shaftprint.fleet._arguments import arguments_of
from shaftprint.fleet.computing._identify import survey_of_job
from shaftprint.recording._read import read_recording
from shaftprint.report._render import render_report
from shaftprint.survey._survey import judged


def reported(arguments: dict[str, Any], folder: str) -> dict[str, Any]:
    """Write the report of a test into a folder.

    ``arguments``: those of its job. ``folder``: where the report goes.
    """
    job = arguments_of(arguments, named="report")
    rng = np.random.default_rng(job.seed)
    survey = judged(survey_of_job(job, tell=lambda _: None, rng=rng), rng=rng)
    with read_recording(Path(job.recording)) as opened:
        page = render_report(folder, survey, recording=opened, overwrite=True)
    return {"page": page.name}
