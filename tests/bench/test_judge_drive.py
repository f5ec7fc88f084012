"""What was found of a drive, judged, compared, predicted and handed over from the command line alone."""

import json
import zipfile

import numpy as np
import pytest
from tests import bench_truth
from tests.bench.conftest import SHORT, motor_files

from shaftprint.bench import equipped
from shaftprint.bench._fingerprint import identified_drive
from shaftprint.drive import load_drive
from shaftprint.fingerprint import read_drive_fingerprint
from shaftprint.simulation import simulate

CHIRP = {"chirp": bench_truth.motor_tests(seconds=1.6)["chirp"]}


@pytest.mark.slow
def test_heavier_motor_differs_in_its_inertia_alone(motor, heavier, run_program):
    result = run_program("compare", motor[0] / "result", heavier[0] / "result", "--name", "before", "--name", "after")
    assert result.exit_code == 0, result.output
    rows = {line.split()[0]: line for line in result.output.splitlines() if line.strip()}
    assert "differs" in rows["J"]
    for name in ("R", "L", "K_m", "T_C"):
        assert "differs" not in rows[name]
    assert "Has the drive changed? Yes: a higher J, by" in result.output


def test_unseen_record_is_predicted_and_that_of_another_motor_is_not(motor, tmp_path, run_program):
    (seen,) = motor_files(tmp_path, seed=21, tests=CHIRP).values()
    other = tmp_path / "other"
    other.mkdir()
    (changed,) = motor_files(other, seed=22, tests=CHIRP, J=1.3 * bench_truth.MOTOR["J"]).values()
    options = ("--drive", motor[0] / "motor.toml", "--fingerprint", motor[0] / "result")
    assert "The model holds on all of 1 records." in run_program("validate", seen, *options).output
    assert "The model fails on 1 of 1 records: chirp." in run_program("validate", changed, *options).output


def test_record_of_the_identification_is_no_validation(motor, run_program):
    options = ("--drive", motor[0] / "motor.toml", "--fingerprint", motor[0] / "result")
    assert "A record was identified from too" in run_program("validate", motor[0] / "slow.csv", *options).output


def test_prediction_is_what_the_identification_then_states(motor, run_program):
    fingerprint = read_drive_fingerprint(motor[0] / "result" / "fingerprint.json")
    inputs = [word for name in SHORT for word in ("--input", motor[0] / f"{name}.csv")]
    noise = ("--noise", "omega=0.4", "--noise", "i=0.03", "--fingerprint", motor[0] / "result")
    result = run_program("predict", "--json", "--drive", motor[0] / "motor.toml", *inputs, *noise)
    assert result.exit_code == 0, result.output
    found = json.loads(result.output)["result"]["deviations"]
    for quantity in fingerprint.parameters:
        if quantity.name in ("R", "L", "K_m", "J", "T_C"):
            assert found[quantity.name] == pytest.approx(quantity.std, rel=0.2), quantity.name


@pytest.mark.slow
def test_records_want_the_dry_friction(motor, run_program):
    recordings = [motor[0] / "slow.csv", motor[0] / "binary.csv"]
    result = run_program(
        "compare-structures", *recordings, "--drive", motor[0] / "motor.toml", "--hold", "theta_y=2e-4",
        "--without", "T_C", "--starts", "1",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    assert result.output.startswith("Which structure: LOADED-MOTOR\n")
    assert "LOADED-MOTOR without T_C is worse by" in result.output


@pytest.mark.parametrize("kind", ["modelica", "ssp", "osp", "matlab"])
def test_exports_are_of_a_drive(motor, tmp_path, run_program, kind):
    suffix = {"modelica": ".mo", "ssp": ".ssv", "osp": ".xml", "matlab": ".mat"}[kind]
    path = tmp_path / f"motor{suffix}"
    result = run_program("export", kind, motor[0] / "result", "-o", path)
    assert result.exit_code == 0, result.output
    written = b"".join(file.read_bytes() for file in tmp_path.iterdir())
    if kind in ("modelica", "ssp"):
        assert b"K_m" in written
        assert b"engine" not in written


def test_fmu_does_what_the_simulation_does(motor, tmp_path, run_program):
    fmpy = pytest.importorskip("fmpy")
    path = tmp_path / "motor.fmu"
    result = run_program("export", "fmu", motor[0] / "result", "--platform", "linux64", "-o", path)
    assert result.exit_code == 0, result.output
    with zipfile.ZipFile(path) as archive:
        assert b"engine" not in archive.read("modelDescription.xml")
    time = np.arange(0.0, 1.0, 1e-3)
    voltage = np.clip((time - 0.1) / 0.02, 0.0, 1.0) * 5.0
    inputs = np.array(
        list(zip(time, voltage, 0.0 * time, strict=True)), dtype=[(name, float) for name in ("time", "u", "T_L")]
    )
    moved = fmpy.simulate_fmu(str(path), stop_time=0.999, input=inputs, output=["omega", "i"], output_interval=1e-3)
    one = equipped(load_drive(motor[0] / "motor.toml"))
    model = identified_drive(read_drive_fingerprint(motor[0] / "result" / "fingerprint.json"), one)
    ours = simulate(model.structure, model.values, time, {"u": voltage, "T_L": 0.0 * time}, hold=True)
    for name in ("omega", "i"):
        assert np.abs(moved[name][: time.size] - ours.outputs[name]).max() < 1e-3 * np.abs(ours.outputs[name]).max()


HOSTILE = 'x"></title><script>alert(1)</script>\n=cmd|*/ system("ls"); end \u202e'


@pytest.mark.parametrize("kind", ["modelica", "ssp", "fmu"])
def test_text_of_a_fingerprint_stands_for_itself_in_every_export(motor, tmp_path, run_program, kind):
    content = json.loads((motor[0] / "result" / "fingerprint.json").read_text(encoding="utf-8"))
    (tmp_path / "fingerprint.json").write_text(json.dumps(content | {"drive": HOSTILE}), encoding="utf-8")
    path = tmp_path / f"out.{kind}"
    options = ("--source-only",) if kind == "fmu" else ()
    result = run_program("export", kind, tmp_path / "fingerprint.json", *options, "-o", path)
    assert result.exit_code == 0, result.output
    files = [path.read_bytes()]
    if kind == "fmu":
        with zipfile.ZipFile(path) as archive:
            files = [archive.read(name) for name in archive.namelist()]
    for text in files:
        assert b"\n=cmd" not in text
        assert not (text.startswith(b"<?xml") and b"<script>" in text)
        assert b'"ls"' not in text
        assert "\u202e".encode() not in text


def test_structure_that_a_fingerprint_names_is_never_a_path(motor, tmp_path, run_program):
    (tmp_path / "evil.py").write_text("raise SystemExit('run')", encoding="utf-8")
    content = json.loads((motor[0] / "result" / "fingerprint.json").read_text(encoding="utf-8"))
    evil = json.dumps(content | {"structure": f"{tmp_path}/evil.py:motor"})
    (tmp_path / "fingerprint.json").write_text(evil, encoding="utf-8")
    result = run_program("export", "ssp", tmp_path / "fingerprint.json", "-o", tmp_path / "out.ssv")
    assert result.exit_code == 1
    assert "expected the name of a shipped structure" in " ".join(result.stderr.split())
    assert not (tmp_path / "out.ssv").exists()
