"""An electric line from the command line: the structure follows from the vessel file, and no sentence has an engine."""

import json

import pytest

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def sailed(invoke, tmp_path_factory):
    """A recording of the shipped ferry and what was identified from it."""
    folder = tmp_path_factory.mktemp("electric")
    assert invoke("sail", "e-ferry-ellen", "short", "-o", folder / "test.nc", "--seed", 5).exit_code == 0
    done = invoke("identify", folder / "test.nc", *FILES, "-o", folder / "result", "-v")
    assert done.exit_code == 0, done.stderr
    return folder, done.output


FILES = ("--vessel", "e-ferry-ellen", "--campaign", "short")


def test_the_motors_loop_is_identified_with_the_truth_in_its_intervals(sailed):
    folder, output = sailed
    fingerprint = json.loads((folder / "result" / "fingerprint.json").read_text(encoding="utf-8"))
    truth = json.loads((folder / "test.truth.json").read_text(encoding="utf-8"))["normalised"]
    assert fingerprint["structure"] == "GAUGE-MOTOR"
    assert fingerprint["verdict"]["trustworthy"]
    numbers = {one["name"]: one for one in fingerprint["parameters"]}
    for name in ("K_p", "K_i", "T_m", "t_d", "t_sp"):
        low, high = numbers[name]["interval_95"]
        margin = 0.5 * (high - low)
        assert low - margin <= truth[name] <= high + margin, name
    assert "that does not change with speed" in " ".join(output.split())


def test_no_limit_of_a_governor_is_looked_for(sailed, invoke):
    folder, _ = sailed
    for words in (("limits", folder / "test.nc", *FILES), ("identify", folder / "test.nc", *FILES, "--with", "limits")):
        more = ("-o", folder / "limits") if words[0] == "identify" else ()
        done = invoke(*words, *more)
        assert done.exit_code == 1
        assert "its limits are set in the converter" in " ".join(done.stderr.split())


def test_predict_has_causes_of_a_motor(invoke):
    done = invoke("predict", *FILES)
    assert done.exit_code == 0
    assert "dead time of the converter" in done.output
    assert "injection" not in done.output
    assert "GAUGE-MOTOR" in done.output
