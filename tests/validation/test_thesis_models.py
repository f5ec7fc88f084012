"""Steps of the thesis' sets against numbers that were found apart from the package (simulation of the printed sets)."""

import numpy as np
import pytest

from shaftprint.validation._prediction import linear_prediction
from shaftprint.validation._thesis_models import thesis_models
from shaftprint.validation.measures._step_numbers import STEP_NUMBERS, step_numbers

RATE_HZ = 200.0
TIME = np.arange(-10.0, 40.0, 1.0 / RATE_HZ)
# the jump lies between two samples
SET_POINT = np.where(TIME > -0.25 / RATE_HZ, 1.0, 0.0)
MODELS = {model.name: model for model in thesis_models()}


def speed(name):
    model = MODELS[name]
    return linear_prediction(model.structure, model.values, SET_POINT, rate_hz=RATE_HZ)[0][0]


@pytest.mark.parametrize(
    ("name", "t50_s"), [("CL4", 0.363), ("CL3", 0.336), ("OL1+OL4", 0.245), ("OL1+OL5", 0.322), ("benchmark", 0.235)]
)
def test_time_to_half_of_a_step(name, t50_s):
    response = speed(name)
    after = np.argmax((TIME > 0.0) & (response >= 0.5))
    before = after - 1
    part = (0.5 - response[before]) / (response[after] - response[before])
    assert TIME[before] + part / RATE_HZ == pytest.approx(t50_s, abs=0.004)


def by_hand(tau_n, k_p, k_i, t_d, omega_n, zeta, step_s=5e-4, until_s=20.0):
    """Return time and speed of the delayed loop after a step of 1, by Euler's rule with the delay as a list."""
    count, late = round(until_s / step_s), round(t_d / step_s)
    speed = integral = drive = rate = 0.0
    asked, shown = np.zeros(count), np.zeros(count)
    for k in range(count):
        shown[k] = speed
        error = 1.0 - speed
        asked[k] = k_p * error + k_i * integral
        given = asked[k - late] if k >= late else 0.0
        integral += step_s * error
        rate += step_s * (omega_n**2 * (given - drive) - 2.0 * zeta * omega_n * rate)
        drive += step_s * rate
        speed += step_s * (drive - 2.0 * speed) / tau_n
    return step_s * np.arange(count), shown


def test_the_recommended_set_of_the_thesis_rings():
    # OL1+OL5: overshoot 48 %, and the last of its peaks that is 5 % off comes 9.1 s after the step
    time, shown = by_hand(0.3897, 4.36, 4.2664, 0.1023, 8.202, 0.88)
    settled_s = time[np.flatnonzero(np.abs(shown - 1.0) > 0.05)[-1]]
    numbers = dict(zip(STEP_NUMBERS, step_numbers(speed("OL1+OL5")[None], TIME, settled_share=0.05)[:, 0], strict=True))
    assert numbers["overshoot"] == pytest.approx(48.0, abs=1.5)
    assert numbers["settling time"] == pytest.approx(settled_s, abs=0.05)


def test_nothing_is_stated_of_how_well_they_are_known():
    assert not any(model.has_uncertainty for model in MODELS.values())
