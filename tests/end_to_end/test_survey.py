"""A survey made in a program is that of the command line, byte by byte but for the time."""

import pytest
from click.testing import CliRunner

import shaftprint as sp
from shaftprint.cli import shaftprint
from shaftprint.fingerprint import read_fingerprint, write_fingerprint

pytestmark = pytest.mark.slow


def test_library_and_program_write_the_same_fingerprint(short_trip, tmp_path):
    ship = ["--vessel", "stan-tug-1205", "--campaign", "short"]
    result = CliRunner().invoke(
        shaftprint, ["identify", str(short_trip.path), *ship, "-o", str(tmp_path / "out"), "--no-progress"]
    )
    assert result.exit_code == 0, result.output
    written = tmp_path / "out" / "fingerprint.json"
    made = read_fingerprint(written).created
    survey = sp.open_survey(short_trip.path, "stan-tug-1205", "short", now=made)
    write_fingerprint(survey.fingerprint, tmp_path / "mine.json")
    assert (tmp_path / "mine.json").read_bytes() == written.read_bytes()
    assert survey.limit_hints[0].split()[0] in result.output
    assert survey.identification is survey.fits[0]
    assert survey.validations
