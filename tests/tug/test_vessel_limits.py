"""What the simulated engine and its control unit obey of the limits in a vessel file, by hand."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals

from shaftprint.tug import Tug, build_plant, sail
from shaftprint.tug.plant._demand import Demand
from shaftprint.tug.plant._plant import torque_limits
from shaftprint.vessel import OperatingLimits, Vessel

Make = Callable[..., Any]


def with_limits(vessel: Vessel, **limits: object) -> Vessel:
    return vessel.model_copy(update={"limits": OperatingLimits.model_validate(limits)})


def test_control_unit_obeys_the_vessel_file(vessel: Vessel, quiet_tug: Tug, ask: Make) -> None:
    # 1183.8 rpm, then 430.9 rpm asked: below idle
    levels = {"name": "St", "levels_v": [-5.0, -2.0], "dwell_s": 60.0, "start_s": 0.0}
    campaign = ask(120.0, staircases=[levels])
    idle = with_limits(vessel, lowest_speed_rpm=620.0, demand_rate_limit_rpm_per_s=20.0)
    rpm = 60.0 * simulate_signals(idle, campaign, tug=quiet_tug).engine_speed_rev_s
    assert rpm[-1] == pytest.approx(620.0, rel=1e-6)
    # 10 s after the step, by then steady, the ramp is straight
    assert rpm[14_000] - rpm[16_000] == pytest.approx(200.0, rel=0.02)
    # a step of 50 rpm; what the truth says of a ship goes before the file
    coarse = with_limits(vessel, demand_resolution_rpm=50.0)
    assert 60.0 * simulate_signals(coarse, ask(), tug=quiet_tug).engine_speed_rev_s[0] == pytest.approx(1200.0)
    fine = replace(quiet_tug, demand_resolution_rpm=1.0)
    assert 60.0 * simulate_signals(coarse, ask(), tug=fine).engine_speed_rev_s[0] == pytest.approx(1184.0)


def test_messages_of_the_vessel_file_are_held(vessel: Vessel, quiet_tug: Tug, ask: Make) -> None:
    sine = {"name": "S", "frequency_hz": 0.5, "amplitude_v": 0.1, "start_s": 0.0, "settled_s": 2.0, "stop_s": 20.0}
    held = with_limits(vessel, demand_cycle_s=0.04)
    campaign = ask(20.0, sines=[sine])
    demand = Demand(quiet_tug, held, campaign, start_s=0.0, step_s=0.005).next(400, np.zeros(401))
    # nodes and middles: 16 of 2.5 ms in each message
    changes = np.flatnonzero(np.diff(demand))
    assert np.all(np.diff(changes) % 16 == 0)
    # 48 messages of 40 ms within 2 s less the latency of 52 ms; beside both crests two are alike
    assert changes.size == 48 - 2


def test_motoring_curve_of_the_vessel_file(vessel: Vessel, quiet_tug: Tug, ask: Make) -> None:
    levels = {"name": "St", "levels_v": [-7.0, -5.0], "dwell_s": 20.0, "start_s": 0.0}
    flat = with_limits(vessel, motoring_speed_rpm=[600.0, 1800.0], motoring_torque_nm=[80.0, 80.0])
    brake_nm = simulate_signals(flat, ask(40.0, staircases=[levels]), tug=quiet_tug).brake_torque_nm
    assert brake_nm.min() == pytest.approx(-80.0)
    # one number of the truth goes before the file: half of it independent of the speed, half proportional
    plant = build_plant(replace(quiet_tug, motoring_torque_nm=200.0), flat)
    assert torque_limits.py_func(0.5 * 1183.8 / 60.0, plant)[0] == pytest.approx(-150.0)
    # and a file without a curve leaves the usual torque
    usual = build_plant(quiet_tug, with_limits(vessel))
    assert torque_limits.py_func(1183.8 / 60.0, usual)[0] == pytest.approx(-300.0)


def test_truth_tells_what_the_control_unit_does(vessel: Vessel, ask: Make, tmp_path: Path) -> None:
    slow = with_limits(vessel, demand_rate_limit_rpm_per_s=600.0, lowest_speed_rpm=650.0)
    truth = sail(slow, ask(2.0), tmp_path / "trip.nc", seed=1).physical
    assert (truth["demand_rate_rpm_per_s"], truth["demand_lowest_rpm"]) == (600.0, 650.0)
    assert truth["motoring_torque_nm"] == pytest.approx(300.0)
