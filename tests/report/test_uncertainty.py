import numpy as np
import pytest

from shaftprint.report._uncertainty import measured_points, model_band
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


def test_band_equals_propagation_by_finite_differences(identification):
    omega = np.geomspace(0.05, 60.0, 40)
    model, values = identification.structure, identification.values
    band = model_band(model, values, identification.covariance, omega)
    slopes = []
    for parameter in model.free:
        place = model.names.index(parameter.name)
        width = 1e-5 * max(abs(values[place]), 1e-2)
        table = np.stack([values, values])
        table[:, place] += (-width, width)
        behind, ahead = model.response(table, 1j * omega)
        db = 20.0 * np.log10(np.abs(ahead) / np.abs(behind)) / (2.0 * width)
        degrees = np.degrees(np.angle(ahead / behind)) / (2.0 * width)
        slopes.append(np.stack([db, degrees]))
    variance = np.einsum("ipow,ij,jpow->pow", slopes, identification.covariance, slopes)
    np.testing.assert_allclose(band.magnitude_db, 1.959964 * np.sqrt(variance[0]), rtol=1e-4, atol=1e-9)
    np.testing.assert_allclose(band.phase_deg, 1.959964 * np.sqrt(variance[1]), rtol=1e-4, atol=1e-8)


def test_band_covers_the_truth_as_often_as_it_says(identification):
    """Draws from the covariance leave the band of one frequency in 5 % of the cases."""
    omega = np.array([0.5])
    rng = np.random.default_rng(8)
    free = [identification.structure.names.index(p.name) for p in identification.structure.free]
    small = 1e-4 * identification.covariance
    table = np.tile(identification.values, (4000, 1))
    table[:, free] += rng.multivariate_normal(np.zeros(len(free)), small, size=4000)
    drawn = 20.0 * np.log10(np.abs(identification.structure.response(table, 1j * omega)[:, 0, 0]))
    middle = 20.0 * np.log10(np.abs(identification.structure.response(identification.values, 1j * omega)[0, 0]))
    half = model_band(identification.structure, identification.values, small, omega).magnitude_db[0, 0]
    assert np.mean(np.abs(drawn - middle) <= half) == pytest.approx(0.95, abs=0.012)


def test_a_parameter_of_infinite_variance_leaves_no_band_where_it_matters(fits):
    core = fits["OL1"]
    unknown = np.full_like(core.covariance, np.inf)
    band = model_band(core.structure, core.values, unknown, np.array([1.0]))
    assert np.isnan(band.magnitude_db).all()
    assert np.isnan(band.phase_deg).all()


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
