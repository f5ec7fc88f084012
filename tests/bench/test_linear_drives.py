"""Motors and servos whose signals are ways and forces: units, bounds, the motion of the same axis behind a pinion."""

import numpy as np
import pytest

from shaftprint.bench import equipped
from shaftprint.drive import Drive
from shaftprint.errors import SettingsError
from shaftprint.simulation import simulate

RADIUS_M = 0.05


def servo(**units):
    units = {"theta_set": "mm", "theta": "mm", "T_m": "kN"} | units
    rows = {name: {"name": name, "channel": name, "unit": unit} for name, unit in units.items()}
    return Drive.model_validate(
        {"name": "axis", "structure": "SERVO", "inputs": [rows.pop("theta_set")], "outputs": list(rows.values())}
    )


def test_a_servo_along_a_line_has_ways_forces_and_a_mass():
    one = equipped(servo())
    assert dict(one.units) == {"theta_set": "m", "theta": "m", "T_m": "N"}
    assert dict(one.factors) == {"theta_set": 1e-3, "theta": 1e-3, "T_m": 1e3}
    units = {parameter.name: parameter.unit for parameter in one.structure.parameters}
    assert units == {
        "J": "kg", "d": "N s/m", "T_C": "N", "theta_y": "m", "t_y": "s",
        "K_x": "1/s", "K_v": "N s/m", "K_iv": "N/m", "t_u": "s",
    }  # fmt: skip
    # an axis of 95 kg with 20 N of dry friction lies within the bounds
    mass, _, dry, *_ = one.structure.parameters
    assert (mass.lower < 95.0 < mass.upper, dry.lower < 20.0 < dry.upper) == (True, True)
    assert mass.meaning == "mass of the slide and what is fixed to it"
    turning = equipped(servo(theta_set="deg", theta="rad", T_m="N m")).structure
    assert (turning.parameters[0].unit, turning.parameters[0].upper) == ("kg m2", 1.0)


def test_behind_a_pinion_the_axis_moves_as_the_one_that_turns():
    """x = r theta, F = T / r: m = J / r^2, d, K_v and K_iv as well, F_C = T_C / r, the yielding r theta_y."""
    turning = {"J": 2e-3, "d": 4e-3, "T_C": 0.05, "theta_y": 5e-4, "K_v": 0.3, "K_iv": 3.0, "K_x": 15.0, "t_u": 2e-3}
    powers = {"J": -2, "d": -2, "K_v": -2, "K_iv": -2, "T_C": -1, "theta_y": 1}
    straight = {name: value * RADIUS_M ** powers.get(name, 0) for name, value in turning.items()}
    time_s = 2e-3 * np.arange(500)
    asked = 0.5 * np.sin(2.0 * np.pi * 1.5 * time_s)
    units = {"theta_set": "rad", "theta": "rad", "T_m": "N m"}
    rotary, linear = (equipped(one).structure for one in (servo(**units), servo()))
    angle = simulate(rotary, rotary.vector(turning), time_s, {"theta_set": asked}).outputs
    way = simulate(linear, linear.vector(straight), time_s, {"theta_set": RADIUS_M * asked}).outputs
    assert way["theta"] == pytest.approx(RADIUS_M * angle["theta"], abs=1e-6)
    assert way["T_m"] == pytest.approx(angle["T_m"] / RADIUS_M, abs=1e-3)


def test_ways_beside_torques_are_refused():
    with pytest.raises(SettingsError, match="found theta_set in mm and T_m in N m; convert one of them"):
        equipped(servo(T_m="N m"))
