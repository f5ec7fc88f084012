"""The structures of drives against simulations by laws and steps of their own."""

import numpy as np
import pytest
from tests import bench_truth

from shaftprint.catalogue import shipped_structure
from shaftprint.catalogue._drives import DRIVES, SIGNAL_MEANINGS, SIGNAL_UNITS
from shaftprint.models import check_structure
from shaftprint.simulation import equilibrium, simulate

T = np.arange(2000) / bench_truth.RATE_HZ


@pytest.mark.parametrize("name", DRIVES)
def test_every_signal_has_a_unit_and_a_meaning(name):
    drive = shipped_structure(name.lower())
    assert drive.name == name
    assert {*drive.inputs, *drive.outputs} <= set(SIGNAL_UNITS)
    assert set(SIGNAL_UNITS) == set(SIGNAL_MEANINGS)
    check_structure(drive)


@pytest.mark.parametrize("kind", ["steps", "slow", "load", "binary"])
@pytest.mark.parametrize("yielding", [2e-4, 0.0])
def test_motor_moves_as_the_truth(kind, yielding):
    """With bristles that yield alike, and beside Coulomb's ideal law, to a few thousandths of the motion."""
    voltage, load = bench_truth.motor_tests()[kind]
    speed, current = bench_truth.motor(voltage, load, theta_y=yielding)
    drive = shipped_structure("LOADED-MOTOR")
    values = drive.vector({**bench_truth.MOTOR, "theta_y": yielding or 5e-5, "t_y": bench_truth.MICRO_DAMPING_S})
    moved = simulate(drive, values, T, {"u": voltage, "T_L": load}, longest_step_s=2.5e-4).outputs
    assert np.std(moved["omega"] - speed) < 4e-3 * np.abs(speed).max()
    assert np.std(moved["i"] - current) < 6e-3 * np.abs(current).max()


@pytest.mark.parametrize("yielding", [2e-4, 0.0])
def test_servo_sticks_and_slips_as_the_truth(yielding):
    asked = np.clip(T - 0.2, 0.0, 1.0) - np.clip(2.0 * (T - 2.0), 0.0, 0.5)
    angle, torque = bench_truth.servo(asked, theta_y=yielding)
    drive = shipped_structure("SERVO")
    values = drive.vector({**bench_truth.SERVO, "theta_y": yielding or 5e-5, "t_y": bench_truth.MICRO_DAMPING_S})
    moved = simulate(drive, values, T, {"theta_set": asked}, longest_step_s=2.5e-4).outputs
    assert np.std(moved["theta"] - angle) < 5e-4
    assert np.std(moved["T_m"] - torque) < 0.02 * np.abs(torque).max()


def test_motor_below_the_breakaway_voltage_stands_still():
    """K_m u / R below T_C: the rotor yields and stays."""
    drive = shipped_structure("MOTOR")
    values = drive.vector(bench_truth.MOTOR)
    most = bench_truth.MOTOR["T_C"] * bench_truth.MOTOR["R"] / bench_truth.MOTOR["K_m"]
    moved = simulate(drive, values, T, {"u": np.where(T > 0.1, 0.9 * most, 0.0)}).outputs["omega"]
    assert np.abs(np.mean(moved[T > 0.5])) < 1e-6


def test_motor_runs_steadily_where_its_torque_is_that_of_friction():
    drive, p = shipped_structure("MOTOR"), bench_truth.MOTOR
    steady = equilibrium(drive, drive.vector(p), {"u": 6.0}).outputs
    speed = (p["K_m"] * 6.0 / p["R"] - p["T_C"]) / (p["d"] + p["K_m"] ** 2 / p["R"])
    assert steady["omega"] == pytest.approx(speed, rel=1e-6)
    assert steady["i"] == pytest.approx((p["d"] * speed + p["T_C"]) / p["K_m"], rel=1e-6)


def test_two_masses_swing_at_their_natural_frequency_and_turn_as_one():
    drive = shipped_structure("TWO-MASS")
    at = dict(zip(drive.names, drive.vector({"d_1": 0.0, "d_2": 0.0}), strict=True))
    omega = (at["k_s"] * (1.0 / at["J_1"] + 1.0 / at["J_2"])) ** 0.5
    values = drive.vector(at)
    near = np.abs(drive.response(values, 1j * omega * np.array([0.97, 1.0, 1.03]))[0])
    assert near[1] > 2.0 * max(near[0], near[2])
    slow = drive.response(values, 1j * np.array([0.01 * omega]))[:, 0]
    assert np.allclose(slow * 1j * 0.01 * omega * (at["J_1"] + at["J_2"]), 1.0, atol=1e-2)
