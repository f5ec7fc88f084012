"""``identify --truth``: what was put into a simulated recording, beside what was found, at the same working point."""

import json
import re

import pytest


@pytest.fixture(scope="module")
def sailed(tmp_path_factory, invoke):
    """Two speeds of the tug, 1.15 and 0.78 of the speed of its working point."""
    path = tmp_path_factory.mktemp("sailed") / "test.nc"
    result = invoke("sail", "stan-tug-1205", "5min", "-o", path, "--seed", 4)
    assert result.exit_code == 0, result.output
    assert "`identify --truth` sets it beside what is found" in " ".join(result.output.split())
    return path


@pytest.mark.parametrize(("leg", "speed"), [("M1", 1.15), ("M2", 0.78)])
def test_true_gains_are_those_at_the_speed_of_the_test(invoke, sailed, tmp_path, leg, speed):
    """A governor gives the same rack for the same rpm: over torque and speed its gains go with 1 / n."""
    truth = sailed.with_suffix(".truth.json")
    of_test = ("--vessel", "stan-tug-1205", "--campaign", "5min", "--leg", leg, "--no-report")
    result = invoke("identify", sailed, *of_test, "--truth", truth, "-o", tmp_path / "result")
    assert result.exit_code == 0, result.output
    told = dict(re.findall(r"\((\w+)\):[^*]*?true value (\d+\.\d+|\d+)", " ".join(result.output.split())))
    stated = json.loads(truth.read_text(encoding="utf-8"))["normalised"]
    assert (stated["K_p"], stated["K_i"]) == (5.7, 4.27)
    # the load of the propeller drifts by a per cent or two
    assert float(told["K_p"]) == pytest.approx(5.7 / speed, rel=0.03)
    assert float(told["K_i"]) == pytest.approx(4.27 / speed, rel=0.03)
    assert float(told["I_dn"]) == pytest.approx(17.0, rel=0.01)


def test_truth_is_of_one_line(invoke, sailed, tmp_path):
    asked = ("identify", sailed, "--starboard", "stan-tug-1205", "--truth", "any.json", "-o", tmp_path / "result")
    refused = invoke(*asked, "--vessel", "stan-tug-1205", "--campaign", "5min")
    assert refused.exit_code == 2
    assert "--truth goes with neither --drive nor --starboard" in " ".join(refused.output.split())


def test_a_file_that_is_no_truth_is_told_before_the_fit(invoke, sailed, tmp_path):
    of_test = ("--vessel", "stan-tug-1205", "--campaign", "5min", "-o", tmp_path / "result")
    refused = invoke("identify", sailed, *of_test, "--truth", tmp_path / "none.json")
    assert refused.exit_code == 1
    assert "none.json: expected a truth file written beside a recording" in " ".join(refused.output.split())
    assert not (tmp_path / "result").exists()


def test_a_pick_up_that_the_truth_does_not_name_is_told_and_the_result_stays(invoke, sailed, tmp_path):
    """The pick-up on the shaft, four strips, has another title in the truth file: the rest has its truth."""
    stated = json.loads(sailed.with_suffix(".truth.json").read_text(encoding="utf-8"))
    (of_shaft,) = (strips for strips in stated["strips"] if len(strips["angle_deg"]) > 1)
    of_shaft["channel"] = "gear_teeth"
    truth = tmp_path / "other.truth.json"
    truth.write_text(json.dumps(stated), encoding="utf-8")
    of_test = ("--vessel", "stan-tug-1205", "--campaign", "5min", "--leg", "M1", "--no-report")
    result = invoke("identify", sailed, *of_test, "--truth", truth, "-o", tmp_path / "result")
    text = " ".join(result.output.split())
    assert result.exit_code == 0, text
    assert re.search(r"other\.truth\.json \* expected (\d+) strips of \w+, found [^;]*\b\1 of gear_teeth", text)
    assert "Take the truth file that was written beside this recording" in text
    assert "true value" in text
    assert (tmp_path / "result" / "fingerprint.json").is_file()
