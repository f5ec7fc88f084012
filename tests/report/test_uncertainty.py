import numpy as np
import pytest

from shaftprint.report.figures._uncertainty import measured_points
from shaftprint.spectra import FrequencyResponse


def single(value, covariance, dof=np.inf):
    return FrequencyResponse(
        frequency_hz=np.array([1.0]),
        response=np.array([[[value]]]),
        covariance=np.array([covariance]),
        inputs=("e",),
        outputs=("M_s",),
        degrees_of_freedom=np.array([dof]),
    )


def test_interval_along_and_across_the_response():
    """H = 10 j with a standard deviation of 1 along it (imaginary axis) and 2 across (real axis)."""
    points = measured_points(single(10j, np.diag([4.0, 1.0])), 0)
    assert points.magnitude_db[0] == pytest.approx(20.0)
    assert points.phase_deg[0] == pytest.approx(90.0)
    assert points.above_db[0] == pytest.approx(20.0 * np.log10(1.195996), rel=1e-5)
    assert points.below_db[0] == pytest.approx(-20.0 * np.log10(0.804004), rel=1e-5)
    assert points.phase_half_deg[0] == pytest.approx(np.degrees(np.arcsin(0.391993)), rel=1e-5)


def test_noise_as_large_as_the_response_has_no_lower_end_and_no_phase():
    points = measured_points(single(1.0, np.diag([1.0, 1.0])), 0)
    assert points.below_db[0] == np.inf
    assert points.above_db[0] == pytest.approx(20.0 * np.log10(2.959964), rel=1e-6)
    assert points.phase_half_deg[0] == 180.0


def test_few_degrees_of_freedom_widen_the_interval():
    """Student's t for 10 degrees of freedom is 2.2281 (published table)."""
    points = measured_points(single(100.0, np.diag([1.0, 1.0]), dof=10.0), 0)
    assert points.above_db[0] == pytest.approx(20.0 * np.log10(1.022281), rel=1e-4)


def test_the_right_block_of_the_covariance_is_taken():
    covariance = np.diag([1.0, 4.0, 9.0, 16.0])
    response = FrequencyResponse(
        frequency_hz=np.array([1.0]),
        response=np.array([[[100.0]], [[100.0j]]]),
        covariance=covariance[None],
        inputs=("n_set",),
        outputs=("n", "M_s"),
    )
    speed, torque = measured_points(response, 0), measured_points(response, 1)
    assert speed.above_db[0] == pytest.approx(20.0 * np.log10(1.0 + 1.959964 * 1.0 / 100.0), rel=1e-5)
    assert torque.above_db[0] == pytest.approx(20.0 * np.log10(1.0 + 1.959964 * 4.0 / 100.0), rel=1e-5)
