"""FitPercent and its ceiling by numbers worked by hand and by simulation."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.identify import fit_percent, identify
from shaftprint.identify.likelihood._fit_percent import fit_ceiling


def test_fit_percent_by_hand():
    """Mean 2, spread ``sqrt 2``, misfit 1: ``100 (1 - 1 / sqrt 2)``."""
    assert fit_percent(np.array([1.0 + 0j, 3.0]), np.array([1.0 + 0j, 2.0])) == pytest.approx(29.28932188134524)


def test_fit_percent_of_complex_values_by_hand():
    """Values 3, 3j, -3, -3j about mean 0: spread 6; misfit 1 at each of four: 2; ``100 (1 - 2 / 6)``."""
    measured = np.array([3.0, 3.0j, -3.0, -3.0j])
    assert fit_percent(measured, measured + 1j) == pytest.approx(66.66666666666667)


def test_the_mean_fits_to_0_and_the_data_to_100_percent():
    measured = np.array([1.0 + 2j, -0.5j, 3.0])
    assert fit_percent(measured, measured) == 100.0
    assert fit_percent(measured, np.full(3, measured.mean())) == pytest.approx(0.0, abs=1e-12)


def test_a_model_can_be_worse_than_the_mean():
    assert fit_percent(np.array([1.0 + 0j, -1.0]), np.array([-1.0 + 0j, 1.0])) == pytest.approx(-100.0)


def test_one_line_has_no_spread_to_compare_with():
    one = np.array([1.0 + 1j])
    assert np.isnan(fit_percent(one, one))
    assert np.isnan(fit_ceiling(one, np.array([0.1])))


def test_ceiling_by_hand():
    """Spread 2, variances 0.02 and 0.02: ``100 (1 - 0.2 / 2)``."""
    measured = np.array([2.0**0.5, -(2.0**0.5)], dtype=complex)
    assert fit_ceiling(measured, np.array([0.02, 0.02])) == pytest.approx(90.0)


def test_ceiling_is_the_fit_percent_of_the_true_model_over_many_tests():
    rng = np.random.default_rng(8)
    truth = np.exp(1j * np.linspace(0.0, 5.0, 40)) * np.linspace(3.0, 0.3, 40)
    std = 0.1 + 0.1 * rng.random(40)
    found, ceiling = [], []
    for _ in range(400):
        measured = truth + std * (rng.normal(size=40) + 1j * rng.normal(size=40))
        found.append(fit_percent(measured, truth))
        ceiling.append(fit_ceiling(measured, 2.0 * std**2))
    assert np.mean(found) == pytest.approx(np.mean(ceiling), abs=0.2)


def test_an_identification_gives_both_for_each_output_over_the_fitted_lines(make_response):
    response = make_response("CL4", noise=0.03, rng=np.random.default_rng(1))
    exact = make_response("CL4").response[:, 0, :11]
    found = identify(structure("CL4"), response, rng=np.random.default_rng(2), lines=response.lines[:11])
    model = found.model(response.frequency_hz[:11])
    for i, output in enumerate(("n", "M_s")):
        data = response.response[i, 0, :11]
        spread = np.linalg.norm(data - data.mean())
        assert found.fit_percent[output] == pytest.approx(100.0 * (1.0 - np.linalg.norm(data - model[i]) / spread))
        noise = 0.03 * np.sqrt(2.0) * np.linalg.norm(exact[i])
        assert found.fit_ceiling[output] == pytest.approx(100.0 * (1.0 - noise / spread))
    assert found.fitted.tolist() == [True] * 11 + [False] * 2
