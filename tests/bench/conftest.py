"""A motor bench and a servo axis with known truth, in files."""

import numpy as np
import pytest
from click.testing import CliRunner
from tests import bench_truth

from shaftprint.cli import shaftprint

MOTOR_TOML = """\
name = "bench motor"
structure = "LOADED-MOTOR"

[[inputs]]
name = "u"
channel = "voltage"
unit = "V"

[[inputs]]
name = "T_L"
channel = "load"
unit = "mN m"

[[outputs]]
name = "omega"
channel = "speed"
unit = "rpm"

[[outputs]]
name = "i"
channel = "current"
unit = "A"

[[searched]]
name = "theta_y"
lower = 1e-5
upper = 2e-3
"""

SERVO_TOML = """\
name = "axis 2"
structure = "SERVO"

[[inputs]]
name = "theta_set"
channel = "reference"
unit = "deg"

[[outputs]]
name = "theta"
channel = "angle"
unit = "deg"

[[outputs]]
name = "T_m"
channel = "torque"
unit = "N m"

[[known]]
name = "K_x"
value = 18.0

[[known]]
name = "K_v"
value = 0.35

[[known]]
name = "K_iv"
value = 4.0

[[searched]]
name = "theta_y"
lower = 1e-5
upper = 2e-3
"""

RPM = 30.0 / np.pi
SPEED_NOISE, CURRENT_NOISE = 0.4, 0.03
ANGLE_NOISE, TORQUE_NOISE = 5e-4, 0.01


def motor_files(folder, seed=11, tests=None, **truth):
    """Write the seven records of the bench; return their paths by name."""
    rng, paths = np.random.default_rng(seed), {}
    for name, (voltage, load) in (tests or bench_truth.motor_tests()).items():
        speed, current = bench_truth.motor(voltage, load, **truth)
        paths[name] = bench_truth.write_csv(
            folder / f"{name}.csv",
            {
                "voltage [V]": voltage,
                "load [mN m]": 1e3 * load,
                "speed [rpm]": RPM * (speed + SPEED_NOISE * rng.standard_normal(speed.size)),
                "current [A]": current + CURRENT_NOISE * rng.standard_normal(current.size),
            },
        )
    return paths


def servo_reference(seconds=12.0, seed=5):
    """Return moves of an axis: slow sines that turn within the dry friction, and steps of a tenth of a turn."""
    time = np.arange(round(seconds * bench_truth.RATE_HZ)) / bench_truth.RATE_HZ
    moves = 0.4 * np.sin(2 * np.pi * 0.5 * time) + 0.2 * np.sign(np.sin(2 * np.pi * 0.3 * time))
    return np.convolve(np.where(time > 0.5, moves, 0.0), np.ones(25) / 25.0, "full")[: time.size]


def servo_file(path, reference=None, seed=12, zero=0.0, **truth):
    rng = np.random.default_rng(seed)
    reference = servo_reference() if reference is None else reference
    angle, torque = bench_truth.servo(reference, **truth)
    return bench_truth.write_csv(
        path,
        {
            "reference [deg]": np.degrees(reference),
            "angle [deg]": np.degrees(angle + zero + ANGLE_NOISE * rng.standard_normal(angle.size)),
            "torque [N m]": torque + TORQUE_NOISE * rng.standard_normal(torque.size),
        },
    )


@pytest.fixture
def drive_file(tmp_path):
    """Write a drive file."""

    def write(text, name="drive.toml"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write


@pytest.fixture(scope="session")
def run_program():
    """Run the program as from a terminal."""

    def run(*arguments):
        return CliRunner().invoke(shaftprint, [str(argument) for argument in arguments], catch_exceptions=False)

    return run


SHORT = ("binary", "slow", "load")


def identified(folder, run_program, **truth):
    """Identify the motor from three short records in a folder."""
    tests = bench_truth.motor_tests(seconds=1.6)
    paths = motor_files(folder, tests={name: tests[name] for name in SHORT}, **truth)
    (folder / "motor.toml").write_text(MOTOR_TOML, encoding="utf-8")
    result = run_program(
        "identify", *paths.values(), "--drive", folder / "motor.toml", "--starts", "1", "-o", folder / "result"
    )
    assert result.exit_code == 0, result.output
    return folder, result


@pytest.fixture(scope="session")
def motor(tmp_path_factory, run_program):
    """The motor as it was identified, and what the program said."""
    return identified(tmp_path_factory.mktemp("bench"), run_program)


@pytest.fixture(scope="session")
def heavier(tmp_path_factory, run_program):
    """The same motor on another day, with a flywheel that adds three hundredths of its inertia."""
    inertia = 1.03 * bench_truth.MOTOR["J"]
    return identified(tmp_path_factory.mktemp("heavier"), run_program, J=inertia)
