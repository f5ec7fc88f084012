"""A line with a controllable pitch from the command line: both inputs in one recording, GAUGE-PITCH by itself."""

import json

import pytest

pytestmark = pytest.mark.slow
FILES = ("--vessel", "nifs-research-vessel", "--campaign", "pitch")


@pytest.fixture(scope="module")
def identified(invoke, tmp_path_factory):
    """A recording of the shipped research vessel and what was identified from it."""
    folder = tmp_path_factory.mktemp("pitch")
    assert invoke("sail", "nifs-research-vessel", "pitch", "-o", folder / "test.nc", "--seed", 3).exit_code == 0
    done = invoke("identify", folder / "test.nc", *FILES, "-o", folder / "result")
    assert done.exit_code == 0, done.stderr
    return folder


def test_line_and_pitch_are_identified_with_the_truth_in_their_intervals(identified):
    fingerprint = json.loads((identified / "result" / "fingerprint.json").read_text(encoding="utf-8"))
    truth = json.loads((identified / "test.truth.json").read_text(encoding="utf-8"))["normalised"]
    assert fingerprint["structure"] == "GAUGE-PITCH"
    assert fingerprint["verdict"]["trustworthy"]
    numbers = {one["name"]: one for one in fingerprint["parameters"]}
    for name in ("K_p", "K_i", "t_d", "q", "tau_th", "t_th", "c_th", "c_pitch"):
        low, high = numbers[name]["interval_95"]
        margin = 0.5 * (high - low)
        assert low - margin <= truth[name] <= high + margin, name
    assert (identified / "result" / "index.html").exists()


def test_its_model_is_exported(identified, invoke):
    for form, name in (("csv", "tables"), ("json", "model.json")):
        done = invoke("export", form, identified / "result" / "fingerprint.json", "-o", identified / name)
        assert done.exit_code == 0, done.stderr


def test_the_line_of_the_speed_alone_is_identified_from_the_same_recording(identified, invoke):
    more = ("--structure", "GAUGE-CLOSED", "--no-report", "-o", identified / "closed")
    done = invoke("identify", identified / "test.nc", *FILES, *more)
    assert done.exit_code == 0, done.stderr
