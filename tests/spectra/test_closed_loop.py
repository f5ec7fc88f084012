"""A plant in a loop: unbiased through the reference, with the covariance that noise around the loop gives."""

import numpy as np
import pytest
from scipy.signal import lfilter

from shaftprint.errors import ResponseError
from shaftprint.spectra import FrequencyResponse, Periodic, plant_from_closed_loop, response_from_arrays

RATE_HZ = 50.0
POLE, GAIN, CONTROLLER = 0.95, 0.1, 6.0


def truth(frequency_hz):
    plant = GAIN / (np.exp(2j * np.pi * frequency_hz / RATE_HZ) - POLE)
    return plant[np.newaxis, np.newaxis]


def loop(rng, r, noise=0.5):
    """``y = G u + v``, ``u = k (r - y)`` with noise that runs around the loop, and noise of the measured input."""
    v = noise * lfilter([1.0], [1.0, -0.8], rng.standard_normal(r.size))
    delayed = [0.0, GAIN * CONTROLLER]
    closed = [1.0, GAIN * CONTROLLER - POLE]
    y = lfilter(delayed, closed, r) + lfilter([1.0, -POLE], closed, v)
    u = CONTROLLER * (r - y)
    return {"u": u + 0.3 * rng.standard_normal(r.size), "y": y}


@pytest.mark.slow
def test_the_covariance_is_the_scatter_for_a_noisy_loop(expect_honest):
    rng = np.random.default_rng(1)
    found, direct = [], []
    for _ in range(200):
        r = 3.0 * rng.standard_normal(4200)
        channels = {name: values[200:] for name, values in loop(rng, r).items()}
        joint = response_from_arrays({"r": r[200:]}, channels, RATE_HZ)
        found.append(plant_from_closed_loop(joint, input="u", output="y"))
        direct.append(response_from_arrays({"u": channels["u"]}, {"y": channels["y"]}, RATE_HZ))
    assert found[0].inputs == ("u",)
    assert found[0].outputs == ("y",)
    expect_honest(found, truth)
    # the direct way, blind to the loop, is wrong, and so would be a method that confused the two
    with pytest.raises(AssertionError):
        expect_honest(direct, truth)


@pytest.mark.slow
def test_the_covariance_is_the_scatter_for_a_periodic_reference(expect_honest):
    rng = np.random.default_rng(2)
    found = []
    for _ in range(300):
        period = np.arange(100) / 100.0
        r = sum(np.cos(2.0 * np.pi * (k * period + rng.uniform())) for k in (1, 2, 3, 5, 8, 13, 21, 34))
        r = np.tile(3.0 * r, 12)
        joint = response_from_arrays({"r": r}, loop(rng, r), RATE_HZ, excitation=Periodic(period_s=2.0))
        found.append(plant_from_closed_loop(joint, output=("y",)))
    expect_honest(found, truth)


def joint_response(u=2.0, **changes):
    given = {
        "frequency_hz": np.array([1.0]),
        "response": np.array([[[u]], [[1.0j]], [[4.0]]]),
        "covariance": 1e-6 * np.eye(6)[np.newaxis],
        "inputs": ("r",),
        "outputs": ("u", "y", "z"),
        "lines": ("S1",),
        "remarks": {"S1": "noted before"},
    }
    return FrequencyResponse(**(given | changes))


def test_a_plant_of_two_outputs_by_hand():
    plant = plant_from_closed_loop(joint_response(), input="u", output=("z", "y"))
    assert plant.outputs == ("z", "y")
    assert plant.response[:, 0, 0].tolist() == [2.0, 0.5j]
    # (the second order, 2 * 2e-6 / 4 of it, is nothing here)
    # dz = (dz - 2 du) / 2, dy = (dy - 0.5j du) / 2: variances (1 + 4) / 4 and (1 + 0.25) / 4, covariance through du
    expected = 1e-6 * np.array([[1.25, 0.0, 0.0, 0.25], [0.0, 0.3125, -0.25, 0.0]])
    assert plant.covariance[0, :2] == pytest.approx(expected)
    assert plant.remarks == {"S1": "noted before"}
    assert plant.used.all()


def test_an_input_that_is_lost_in_noise_is_marked():
    # a standard deviation of 0.001 in each part, of 0.0014 as a complex number
    lost = plant_from_closed_loop(joint_response(u=0.009), input="u", output="y")
    assert not lost.used.any()
    assert lost.remarks["S1"] == "noted before; u is only 6.4 times its noise, too little to divide by"
    known = plant_from_closed_loop(joint_response(u=0.011), input="u", output="y")
    assert known.used.all()


def test_loops_that_cannot_be_opened_are_told():
    with pytest.raises(ResponseError, match="output 'force': the response has u, y, z"):
        plant_from_closed_loop(joint_response(), input="force", output="y")
    with pytest.raises(ResponseError, match="S1: expected u to differ from 0"):
        plant_from_closed_loop(joint_response(u=0.0))
    two = joint_response(inputs=("r", "q"), response=np.ones((3, 2, 1)), covariance=np.eye(12)[np.newaxis])
    with pytest.raises(ResponseError, match="closed loop: expected a response to one reference, found r, q"):
        plant_from_closed_loop(two)
