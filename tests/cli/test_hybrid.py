"""A diesel with an electric machine from the command line: both are moved, and the truth is in the intervals."""

import json

import pytest

pytestmark = pytest.mark.slow

FILES = ("--vessel", "foss-carolyn-dorothy", "--campaign", "machine")


@pytest.fixture(scope="module")
def sailed(invoke, tmp_path_factory):
    """A recording of the shipped tug and what was identified from it."""
    folder = tmp_path_factory.mktemp("hybrid")
    done = invoke("sail", "foss-carolyn-dorothy", "machine", "-o", folder / "test.nc", "--seed", 5)
    assert done.exit_code == 0, done.stderr
    done = invoke("identify", folder / "test.nc", *FILES, "-o", folder / "result")
    assert done.exit_code == 0, done.stderr
    return folder


def test_engine_and_machine_are_identified_with_the_truth_in_their_intervals(sailed):
    fingerprint = json.loads((sailed / "result" / "fingerprint.json").read_text(encoding="utf-8"))
    truth = json.loads((sailed / "test.truth.json").read_text(encoding="utf-8"))["normalised"]
    assert fingerprint["structure"] == "GAUGE-HYBRID"
    assert fingerprint["verdict"]["trustworthy"]
    # the converter follows fast sines less, which is no filter of its channel
    assert fingerprint["verdict"]["reasons"] == []
    assert {"K_p of the shaft", "t_d + t_sp", "K_p / K_i"} <= set(fingerprint["verdict"]["trusted"])
    numbers = {one["name"]: one for one in fingerprint["parameters"]}
    for name in ("K_p", "K_i", "c_m", "s_m", "t_d", "t_sp", "tau_up", "g"):
        low, high = numbers[name]["interval_95"]
        margin = 0.5 * (high - low)
        assert low - margin <= truth[name] <= high + margin, name
    assert (sailed / "result" / "index.html").is_file()


def test_the_plain_structure_is_fitted_to_the_sines_of_the_speed_beside_it(sailed, invoke, tmp_path):
    both = ("--structure", "GAUGE-HYBRID", "--structure", "GAUGE-CLOSED")
    done = invoke("identify", sailed / "test.nc", *FILES, *both, "--no-report", "-o", tmp_path / "both")
    assert done.exit_code == 0, done.stderr
