"""A drive whose structure is the user's own Python, which comes by the command alone."""

import numpy as np
import pytest
from tests import bench_truth

from shaftprint.fingerprint import read_drive_fingerprint

FAN = """\
name = "fan"

[[inputs]]
name = "voltage"
channel = "voltage"
unit = "V"

[[outputs]]
name = "speed"
channel = "speed"
unit = "rad/s"

[fit]
inputs_hold = true
"""
OWN = """\
from shaftprint.models import FirstOrderLag, Gain, Parameter, Structure

K = Parameter("K", "rad/s/V", 1.0, 100.0, 10.0, "gain of the fan")
T = Parameter("T", "s", 0.05, 10.0, 1.0, "time constant of the fan")
fan = Structure(name="FAN", title="fan", input="voltage", outputs={"speed": Gain(K) * FirstOrderLag(T)})
"""


@pytest.fixture
def fan(tmp_path):
    """Files of a fan with gain 12 rad/s/V and time constant 0.8 s, begun in steady running."""
    rng = np.random.default_rng(7)
    voltage = np.repeat(rng.choice([4.0, 6.0], size=60), 20)
    speed = np.full(voltage.size, 12.0 * voltage[0])
    for i in range(1, voltage.size):
        speed[i] = speed[i - 1] + (12.0 * voltage[i - 1] - speed[i - 1]) * (1.0 - np.exp(-0.02 / 0.8))
    columns = {"voltage [V]": voltage, "speed [rad/s]": speed + 0.2 * rng.standard_normal(voltage.size)}
    bench_truth.write_csv(tmp_path / "fan.csv", columns, interval=0.02)
    (tmp_path / "fan.toml").write_text(FAN, encoding="utf-8")
    (tmp_path / "own.py").write_text(OWN, encoding="utf-8")
    return tmp_path


@pytest.mark.slow
def test_own_structure_is_fitted_and_exported(fan, run_program):
    own = ("--drive", fan / "fan.toml", "--structure", f"{fan}/own.py:fan")
    result = run_program("identify", fan / "fan.csv", *own, "-o", fan / "result")
    assert result.exit_code == 0, result.output
    fingerprint = read_drive_fingerprint(fan / "result" / "fingerprint.json")
    for quantity, truth in zip(fingerprint.parameters, (12.0, 0.8), strict=True):
        assert abs(quantity.value - truth) < 4.0 * quantity.std
    assert [source.role for source in fingerprint.sources] == ["recording", "drive", "structure"]
    result = run_program("export", "ssp", fan / "result", *own, "-o", fan / "fan.ssv")
    assert result.exit_code == 0, result.output


def test_without_a_structure_it_is_said_how_to_come_by_one(fan, run_program):
    result = run_program("identify", fan / "fan.csv", "--drive", fan / "fan.toml", "-o", fan / "result")
    assert result.exit_code == 1
    message = " ".join(result.stderr.split())
    assert (
        "drive fan, structure: expected one of MOTOR, LOADED-MOTOR, SERVO, TWO-MASS, [[blocks]] in the file" in message
    )
    assert not (fan / "result").exists()


def test_options_of_ships_are_refused_beside_a_drive(fan, run_program):
    drive = ("--drive", fan / "fan.toml", "-o", fan / "result")
    result = run_program("identify", fan / "fan.csv", *drive, "--vessel", "stan-tug-1205")
    assert result.exit_code == 2
    assert "--vessel is for ships; leave it out beside --drive" in result.stderr
    result = run_program(
        "identify", "a.nc", "b.nc", "--vessel", "stan-tug-1205", "--campaign", "thesis", "-o", fan / "r"
    )
    assert result.exit_code == 2
    assert "expected one recording of a ship, found 2" in " ".join(result.stderr.split())
