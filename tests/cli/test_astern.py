"""A test astern from the command line: the same numbers as ahead, the sign of the gauge checked, model and report."""

import csv
import json

import numpy as np
import pytest

from shaftprint.export._fmu_build import host_platform

pytestmark = pytest.mark.slow

FILES = ("--vessel", "stan-tug-1205-astern", "--campaign", "short")


@pytest.fixture(scope="module")
def sailed(invoke, tmp_path_factory):
    """A recording of the shipped ship astern and what was identified from it."""
    folder = tmp_path_factory.mktemp("astern")
    assert invoke("sail", "stan-tug-1205-astern", "short", "-o", folder / "test.nc", "--seed", 5).exit_code == 0
    done = invoke("identify", folder / "test.nc", *FILES, "-o", folder / "result", "-v")
    assert done.exit_code == 0, done.stderr
    return folder, done.output


def test_numbers_have_the_meaning_that_they_have_ahead(sailed):
    folder, output = sailed
    fingerprint = json.loads((folder / "result" / "fingerprint.json").read_text(encoding="utf-8"))
    truth = json.loads((folder / "test.truth.json").read_text(encoding="utf-8"))["normalised"]
    assert fingerprint["structure"] == "GAUGE-CLOSED"
    assert fingerprint["verdict"]["trustworthy"]
    numbers = {one["name"]: one for one in (*fingerprint["parameters"], *fingerprint["physical"])}
    for name in ("K_p", "K_i", "omega_n", "zeta", "t_d", "t_sp", "tau_dn"):
        low, high = numbers[name]["interval_95"]
        margin = 0.5 * (high - low)
        assert low - margin <= truth[name] <= high + margin, name
    assert numbers["I_dn"]["value"] == pytest.approx(17.0, rel=0.03)
    assert numbers["K_Q"]["value"] == pytest.approx(0.04943, rel=0.02)
    assert (numbers["K_Q"]["expected"], numbers["K_Q"]["expected_std"]) == (0.04943, 0.001)
    assert fingerprint["conditions"]["shaft_torque"]["value"] == pytest.approx(1725.0, rel=0.02)
    assert fingerprint["vessel_fields"]["working_point.direction"] == "astern"
    words = " ".join(output.split())
    assert "shaft torque of the working point, which drives astern" in words
    assert "torque coefficient of the propeller, mean of the test, astern" in words
    assert (folder / "result" / "index.html").stat().st_size > 10_000


def test_a_file_that_says_ahead_is_contradicted(sailed, invoke):
    folder, _ = sailed
    ahead = ("--vessel", "stan-tug-1205", "--campaign", "short")
    done = invoke("identify", folder / "test.nc", *ahead, "-o", folder / "ahead")
    assert done.exit_code == 1
    words = " ".join(done.stderr.split())
    assert "expected a positive mean torque at the working point, found -17" in words
    assert 'state direction = "astern" of its working point where the shaft turned so' in words
    done = invoke("inspect", folder / "test.nc", *ahead)
    assert 'state direction = "astern"' in " ".join((done.output + done.stderr).split())


def test_model_of_the_line_astern_moves_as_it_is_simulated(sailed, invoke, tmp_path):
    """The FMU counts speed and torque as they drive, like all numbers of the test."""
    fmpy = pytest.importorskip("fmpy")
    result = sailed[0] / "result" / "fingerprint.json"
    done = invoke("export", "fmu", result, "--platform", host_platform(), "-o", tmp_path / "line.fmu")
    assert done.exit_code == 0, done.stderr
    time = np.arange(0.0, 6.0, 0.01)
    asked = np.where(time >= 1.0 - 1e-9, 0.04, 0.0)
    rows = "".join(f"{second:.4f},{value}\n" for second, value in zip(time, asked, strict=True))
    (tmp_path / "input.csv").write_text(f"time [s],n_set [-]\n{rows}", encoding="utf-8")
    files = ("--hold", "--input", tmp_path / "input.csv", "-o", tmp_path / "output.csv")
    done = invoke("simulate", "--fingerprint", result, *files)
    assert done.exit_code == 0, done.stderr
    with (tmp_path / "output.csv").open(encoding="utf-8", newline="") as file:
        own = list(csv.DictReader(file))
    conditions = json.loads(result.read_text(encoding="utf-8"))["conditions"]
    speed_rpm, torque_nm = (conditions[name]["value"] for name in ("engine_speed", "shaft_torque"))
    name = "engine_speed_set_point"
    held = np.array(list(zip(time, speed_rpm * (1.0 + asked), strict=True)), dtype=[("time", float), (name, float)])
    moved = fmpy.simulate_fmu(
        str(tmp_path / "line.fmu"),
        stop_time=float(time[-1]),
        step_size=0.01,
        output_interval=0.01,
        input=held,
        output=["engine_speed", "shaft_torque"],
        fmi_type="CoSimulation",
    )
    for column, output, size in (
        ("engine speed [rpm]", "engine_speed", speed_rpm),
        ("shaft torque [N m]", "shaft_torque", torque_nm),
    ):
        deviation = np.interp(time, moved["time"], moved[output]) / size - 1.0
        assert np.abs(deviation).max() > 0.03
        np.testing.assert_allclose([float(row[column]) / size - 1.0 for row in own], deviation, atol=1e-5)
