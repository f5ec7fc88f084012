"""A job for which no structure was named, of a line that a motor drives: refused before its recording is read."""

import pytest

from shaftprint.errors import StructureError
from shaftprint.fleet import JobArguments
from shaftprint.fleet.computing import survey_of_job


def test_the_closed_loop_of_a_diesel_is_refused_for_a_motor():
    asked = JobArguments(recording="nowhere.nc", vessel="e-ferry-ellen", campaign="short")
    with pytest.raises(StructureError, match=r"found GAUGE-CLOSED; ask for --structure GAUGE-MOTOR\."):
        survey_of_job(asked, tell=lambda _: None)
