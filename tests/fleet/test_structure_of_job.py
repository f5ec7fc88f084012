"""A job for which no structure was named gets that of its vessel and campaign, as in ``identify``."""

import pytest

from shaftprint.campaign import load_campaign
from shaftprint.fleet._arguments import job_arguments
from shaftprint.fleet.computing._identify import survey_of_job
from shaftprint.tug import sail
from shaftprint.vessel import load_vessel


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    """Five minutes of a ferry with an electric motor."""
    path = tmp_path_factory.mktemp("ferry") / "ferry.nc"
    sail(load_vessel("e-ferry-ellen"), load_campaign("5min"), path, seed=1)
    return path


@pytest.mark.slow
@pytest.mark.parametrize(
    ("asked", "structure"),
    [({}, "GAUGE-MOTOR"), pytest.param({"structure": "GAUGE-CLOSED"}, "GAUGE-CLOSED", marks=pytest.mark.long)],
)
def test_a_job_has_the_structure_of_its_line_where_none_was_named(asked, structure, recording):
    job = job_arguments(
        recording, "e-ferry-ellen", "5min", named="the test", tested_at="2026-03-31T09:30+02:00", **asked
    )
    assert survey_of_job(job, tell=lambda _: None).fingerprint.structure == structure
