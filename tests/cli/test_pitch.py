"""A line with a controllable pitch from the command line: two inputs in one recording, or one lever for both."""

import json

import pytest

from shaftprint.survey import run

pytestmark = pytest.mark.slow
SHIPS = {
    "GAUGE-PITCH": ("nifs-research-vessel", "pitch", ("K_p", "K_i", "t_d", "q", "tau_th", "t_th", "c_th", "c_pitch")),
    "GAUGE-COMBINATOR": (
        "nifs-research-vessel-combinator",
        "combinator",
        ("K_p", "K_i", "t_d", "q", "tau_th", "t_th", "c_comb", "c_pitch"),
    ),
}


@pytest.fixture(scope="module", params=["GAUGE-PITCH", pytest.param("GAUGE-COMBINATOR", marks=pytest.mark.long)])
def structure(request):
    """The structure that is taken where none is named."""
    return request.param


@pytest.fixture(scope="module")
def files(structure):
    """Vessel and campaign as words of a command."""
    vessel, campaign, _ = SHIPS[structure]
    return "--vessel", vessel, "--campaign", campaign


@pytest.fixture(scope="module")
def identified(invoke, files, tmp_path_factory):
    """A recording of the shipped research vessel and what was identified from it."""
    folder = tmp_path_factory.mktemp("pitch")
    assert invoke("sail", files[1], files[3], "-o", folder / "test.nc", "--seed", 3).exit_code == 0
    done = invoke("identify", folder / "test.nc", *files, "-o", folder / "result")
    assert done.exit_code == 0, done.stderr
    return folder


def test_line_and_pitch_are_identified_with_the_truth_in_their_intervals(identified, structure):
    fingerprint = json.loads((identified / "result" / "fingerprint.json").read_text(encoding="utf-8"))
    truth = json.loads((identified / "test.truth.json").read_text(encoding="utf-8"))["normalised"]
    assert fingerprint["structure"] == structure
    assert fingerprint["verdict"]["trustworthy"]
    # what the check of the torque's latency knew nothing of, a pitch that comes with the speed, took most of them
    assert {"K_p", "K_i", "tau_dn", "q", "I_dn", "K_Q"} <= set(fingerprint["verdict"]["trusted"])
    numbers = {one["name"]: one for one in fingerprint["parameters"]}
    for name in SHIPS[structure][2]:
        low, high = numbers[name]["interval_95"]
        margin = 0.5 * (high - low)
        assert low - margin <= truth[name] <= high + margin, name
    assert (identified / "result" / "index.html").exists()


def test_its_model_is_exported(identified, invoke):
    for form, name in (("csv", "tables"), ("json", "model.json")):
        done = invoke("export", form, identified / "result" / "fingerprint.json", "-o", identified / name)
        assert done.exit_code == 0, done.stderr


def test_the_line_of_the_speed_explains_a_pitch_that_moves_on_other_lines(identified, structure, files, invoke):
    """With a combinator the pitch moves on the lines of the speed, and a fixed propeller explains nothing."""
    more = ("--structure", "GAUGE-CLOSED", "--no-report", "-o", identified / "closed")
    done = invoke("identify", identified / "test.nc", *files, *more)
    assert done.exit_code == (0 if structure == "GAUGE-PITCH" else 3), done.stderr
    fingerprint = json.loads((identified / "closed" / "fingerprint.json").read_text(encoding="utf-8"))
    assert fingerprint["verdict"]["trustworthy"] is (structure == "GAUGE-PITCH")


def test_with_its_noise_and_its_numbers_what_the_recording_told_is_predicted(identified, files, invoke):
    """Lines of both inputs, each with its noise: the deviations of the fit but for what its estimated covariance costs.

    Those of the fingerprint hold the error of the mean torque besides.
    """
    fit = run(identified / "test.nc", files[1], files[3], judge=False).identification
    values = [f"--value={one.name}={one.value}" for one in fit.parameters]
    done = invoke("predict", *files, "--from", identified / "test.nc", *values, "--json")
    assert done.exit_code == 0, done.stderr
    told = json.loads(done.stdout)["result"]
    stds = {one["name"]: one["std"] for one in (*told["parameters"], *told["combinations"])}
    for one in (*fit.parameters, *fit.combinations):
        # the slowest lines of the lever tell the scale of the set point, and have the fewest bins of noise beside them
        assert one.std == pytest.approx(stds[one.name], rel=0.3 if one.name == "c_set" else 0.15), one.name
