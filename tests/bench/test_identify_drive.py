"""A motor bench and a servo with dry friction: the program finds the truth, and says how well it knows it."""

import json

import numpy as np
import pytest
from tests import bench_truth
from tests.bench.conftest import MOTOR_TOML, SERVO_TOML, motor_files, servo_file

from shaftprint.errors import FingerprintError
from shaftprint.fingerprint import read_drive_fingerprint, read_fingerprint

# Standard deviations within which each of the numbers lies: 1 of 10000 is further.
FAR = 4.0


def expect_truth(fingerprint, truth, names):
    found = {quantity.name: quantity for quantity in fingerprint.parameters}
    assert set(names) <= set(found)
    for name in names:
        assert abs(found[name].value - truth[name]) < FAR * found[name].std, name
        assert found[name].std < 0.1 * abs(truth[name]), name


@pytest.mark.slow
def test_motor_is_identified_from_several_records(motor):
    folder, result = motor
    fingerprint = read_drive_fingerprint(folder / "result" / "fingerprint.json")
    expect_truth(fingerprint, bench_truth.MOTOR, ("R", "L", "K_m", "J", "T_C"))
    assert fingerprint.p_value > 0.001
    assert [record.name for record in fingerprint.records] == ["binary", "slow", "load"]
    assert result.output.startswith("Verdict: trustworthy\n")
    assert "engine" not in result.output


def test_saved_fingerprint_is_shown_as_it_was_printed(motor, run_program):
    folder, result = motor
    shown = run_program("show", folder / "result")
    assert shown.exit_code == 0, shown.output
    verdict = shown.output[: shown.output.index("bench motor; structure LOADED-MOTOR")].rstrip()
    assert result.output.startswith(verdict)
    assert "Not trusted" in verdict or "Trusted" in verdict


def test_page_shows_every_record_and_the_fingerprint(motor):
    folder, _ = motor
    page = (folder / "result" / "index.html").read_text(encoding="utf-8")
    for words in ("Fingerprint of bench motor", "slow", "LOADED-MOTOR", "binary.csv", "motor.toml"):
        assert words in page
    assert "engine" not in page
    assert "K_m^2" not in page
    assert page.count("The 95 % interval is that of the profile likelihood") == 1
    # the first page answers, before the verdict in the words of the fit
    cover = page[page.index('id="found"') : page.index('id="verdict"')]
    for words in ("Can the result be used?", "Does the model explain the records?", "What was found", "What to do:"):
        assert words in cover
    assert '<a href="#found">Page one</a>' in page


def test_noise_is_that_of_the_sensors(motor):
    folder, _ = motor
    records = read_drive_fingerprint(folder / "result" / "fingerprint.json").records
    for record in records:
        assert record.noise_std["omega"] == pytest.approx(0.4, rel=0.15)
        assert record.noise_std["i"] == pytest.approx(0.03, rel=0.15)


def test_fingerprint_of_a_drive_is_told_from_that_of_a_ship(motor):
    folder, _ = motor
    with pytest.raises(
        FingerprintError, match="expected the fingerprint of a ship, found that of a drive; show, compare"
    ):
        read_fingerprint(folder / "result" / "fingerprint.json")
    content = json.loads((folder / "result" / "fingerprint.json").read_text(encoding="utf-8"))
    content["covariance"][0][0] = -1.0
    (folder / "wrong.json").write_text(json.dumps(content), encoding="utf-8")
    with pytest.raises(FingerprintError, match="covariance"):
        read_drive_fingerprint(folder / "wrong.json")


@pytest.mark.long
def test_motor_bench_of_seven_kinds_of_records(tmp_path, run_program):
    paths = motor_files(tmp_path)
    assert len(paths) == 7
    (tmp_path / "motor.toml").write_text(MOTOR_TOML, encoding="utf-8")
    result = run_program("identify", *paths.values(), "--drive", tmp_path / "motor.toml", "-o", tmp_path / "result")
    assert result.exit_code == 0, result.output
    fingerprint = read_drive_fingerprint(tmp_path / "result" / "fingerprint.json")
    expect_truth(fingerprint, bench_truth.MOTOR, ("R", "L", "K_m", "J", "d", "T_C"))
    assert fingerprint.verdict.trustworthy
    assert fingerprint.starts_at_optimum >= 2


@pytest.mark.long
def test_servo_with_dry_friction_in_position_control(tmp_path, run_program):
    """The encoder's zero is anywhere: a constant is found with each record."""
    moves = servo_file(tmp_path / "moves.csv", zero=0.3)
    (tmp_path / "servo.toml").write_text(SERVO_TOML, encoding="utf-8")
    result = run_program("identify", moves, "--drive", tmp_path / "servo.toml", "-o", tmp_path / "result")
    assert result.exit_code == 0, result.output
    fingerprint = read_drive_fingerprint(tmp_path / "result" / "fingerprint.json")
    expect_truth(fingerprint, bench_truth.SERVO, ("J", "d", "T_C", "t_u"))
    assert fingerprint.verdict.trustworthy


@pytest.mark.long
def test_servo_without_its_friction_is_refused(tmp_path, run_program):
    moves = servo_file(tmp_path / "moves.csv")
    held = '\n[[known]]\nname = "T_C"\nvalue = 0.0\n'
    (tmp_path / "servo.toml").write_text(SERVO_TOML.split("[[searched]]")[0] + held, encoding="utf-8")
    result = run_program("identify", moves, "--drive", tmp_path / "servo.toml", "-o", tmp_path / "result")
    assert result.exit_code == 3, result.output
    assert result.output.startswith("Verdict: not trustworthy\n")


FREE = """\
name = "shaft"
structure = "TWO-MASS"

[[inputs]]
name = "T_m"
channel = "torque"
unit = "N m"

[[outputs]]
name = "omega_1"
channel = "motor"
unit = "rad/s"

[[outputs]]
name = "omega_2"
channel = "load"
unit = "rad/s"

[[known]]
name = "d_1"
value = 0.0

[[known]]
name = "d_2"
value = 0.0

[fit]
start = "found"
offset = "none"
"""


@pytest.mark.long
def test_masses_that_turn_freely_begin_in_states_that_are_found(tmp_path, run_program):
    """No friction at all: no steady running under a torque, and a record that begins in motion."""
    j_1, j_2, stiffness, damping, step = 1.2e-3, 2.6e-3, 24.0, 3e-3, 1e-5
    rng = np.random.default_rng(4)
    torque = np.repeat(rng.choice([-0.3, 0.3], 50), 20)
    state, rows = np.array([12.0, 12.5, 0.01]), []
    for value in torque:
        rows.append(state[:2])
        for _ in range(200):
            between = stiffness * state[2] + damping * (state[0] - state[1])
            state = state + step * np.array([(value - between) / j_1, between / j_2, state[0] - state[1]])
    motion = np.array(rows) + 0.05 * rng.standard_normal((torque.size, 2))
    bench_truth.write_csv(
        tmp_path / "free.csv",
        {"torque [N m]": torque, "motor [rad/s]": motion[:, 0], "load [rad/s]": motion[:, 1]},
    )
    (tmp_path / "shaft.toml").write_text(FREE + "inputs_hold = true\n", encoding="utf-8")
    # of four starts one arrives: nothing is trusted, though it is the truth
    result = run_program(
        "identify",
        tmp_path / "free.csv",
        "--drive",
        tmp_path / "shaft.toml",
        "--starts",
        "4",
        "-o",
        tmp_path / "result",
    )
    assert result.exit_code == 3, result.output
    fingerprint = read_drive_fingerprint(tmp_path / "result" / "fingerprint.json")
    truth = {"J_1": j_1, "J_2": j_2, "k_s": stiffness, "d_s": damping}
    expect_truth(fingerprint, truth, ("J_1", "J_2", "k_s"))
    assert fingerprint.p_value > 0.001
