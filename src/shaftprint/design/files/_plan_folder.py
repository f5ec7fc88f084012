"""The files of a planned test that ships, generators and later commands read."""

from pathlib import Path
from typing import TYPE_CHECKING

from shaftprint.campaign._file_text import campaign_text
from shaftprint.design.files._plan_json import PLAN, write_plan
from shaftprint.design.files._set_point_files import write_set_point
from shaftprint.design.files._set_point_samples import set_point_samples
from shaftprint.files import written_whole

if TYPE_CHECKING:
    from shaftprint.design.planned_test._planned_test import PlannedTest

CAMPAIGN = "campaign.toml"
"""Name of the campaign file in a folder of ``shaftprint plan``."""


def write_plan_files(test: "PlannedTest", folder: Path, *, rate_hz: float) -> None:
    """Write campaign, set point and plan into a folder that is made whole by who calls.

    Parameters
    ----------
    test
        What is planned.
    folder
        An existing folder.
    rate_hz
        Samples a second of the set point [Hz].

    Raises
    ------
    DesignError
        If the rate does not suit the lines, or a file cannot be written.
    """
    samples = set_point_samples(test, rate_hz=rate_hz)
    remarks = f"Planned by shaftprint {test.version} for {test.vessel}.\n{_rehearsed(test)}"
    with written_whole(folder / CAMPAIGN, overwrite=True) as part:
        part.write_text(campaign_text(test.campaign, remarks=remarks), encoding="utf-8", newline="\n")
    write_set_point(samples, folder)
    write_plan(test, folder / PLAN)


def _rehearsed(test: "PlannedTest") -> str:
    return "The plan was not rehearsed." if test.rehearsal is None else test.rehearsal.sentences[0]
