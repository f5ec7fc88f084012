"""A towboat with an elastic coupling, from the command line: at the lines of the short check the rigid line holds."""

import pytest

from shaftprint.fingerprint import read_fingerprint


@pytest.mark.long
@pytest.mark.slow
def test_a_towboat_is_identified_as_its_page_says(run, tmp_path):
    recording, result = tmp_path / "towboat.nc", tmp_path / "towboat"
    assert run("sail", "pt-may", "short", "-o", recording, "--seed", 3).exit_code == 0
    done = run("identify", recording, "--vessel", "pt-may", "--campaign", "short", "-o", result)
    assert done.exit_code == 0, done.output
    found = read_fingerprint(result / "fingerprint.json")
    assert found.structure == "GAUGE-CLOSED"
    assert found.verdict.trustworthy
