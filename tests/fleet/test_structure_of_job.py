"""A job for which no structure was named, of a line with an electric machine: refused before its recording is read."""

import pytest

from shaftprint.errors import StructureError
from shaftprint.fleet import JobArguments
from shaftprint.fleet.computing import survey_of_job


@pytest.mark.parametrize(
    ("vessel", "structure"), [("e-ferry-ellen", "GAUGE-MOTOR"), ("foss-carolyn-dorothy", "GAUGE-HYBRID")]
)
def test_the_closed_loop_of_a_diesel_is_refused_for_another_line(vessel, structure):
    asked = JobArguments(recording="nowhere.nc", vessel=vessel, campaign="short")
    with pytest.raises(StructureError, match=rf"found GAUGE-CLOSED; ask for --structure {structure}\."):
        survey_of_job(asked, tell=lambda _: None)
