"""A line with a controllable pitch from the command line: both inputs in one recording, GAUGE-PITCH by itself."""

import json

import pytest

from shaftprint.survey import run

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


def test_with_its_noise_and_its_numbers_what_the_recording_told_is_predicted(identified, invoke):
    """Lines of both inputs, each with its noise: the deviations of the fit but for what its estimated covariance costs.

    Those of the fingerprint hold the error of the mean torque besides.
    """
    fit = run(identified / "test.nc", FILES[1], FILES[3], judge=False).identification
    values = [f"--value={one.name}={one.value}" for one in fit.parameters]
    done = invoke("predict", *FILES, "--from", identified / "test.nc", *values, "--json")
    assert done.exit_code == 0, done.stderr
    told = json.loads(done.stdout)["result"]
    stds = {one["name"]: one["std"] for one in (*told["parameters"], *told["combinations"])}
    for one in (*fit.parameters, *fit.combinations):
        assert one.std == pytest.approx(stds[one.name], rel=0.15), one.name
