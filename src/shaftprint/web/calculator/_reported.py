"""The report of one test, made when somebody asks for it: the recording is identified once more, as it was."""

from datetime import datetime
from pathlib import Path
from typing import Any

from shaftprint.errors import ServerError
from shaftprint.recording import read_recording
from shaftprint.report import render_report
from shaftprint.survey import run


def reported(
    recording: str,
    vessel: str,
    campaign: str,
    conditions: str | None,
    structure: str,
    tested_at: str | None,
    folder: str,
) -> dict[str, Any]:
    """Write the report of a test into a folder.

    Parameters
    ----------
    recording, vessel, campaign, conditions
        Files of the test.
    structure
        Name of a structure that comes with the program.
    tested_at
        When the recording began, where somebody stated it.
    folder
        Where the report goes.
    """
    began = None if tested_at is None else datetime.fromisoformat(tested_at)
    survey = run(Path(recording), vessel, campaign, structures=(structure,), conditions=conditions, tested_at=began)
    with read_recording(Path(recording)) as opened:
        page = render_report(folder, survey, recording=opened, overwrite=True)
    if not page.exists():
        raise ServerError("The report was not written.")
    return {"page": page.name}
