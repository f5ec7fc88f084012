"""What a result says of itself: estimates, derived numbers, correlation, margins."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import Estimate, Settings, Unweighted, identify
from shaftprint.models import margins


@pytest.fixture
def linear(make_response):
    response = make_response("OL2", noise=0.05, correlation=0.4, rng=np.random.default_rng(2))
    return identify(structure("OL2"), response, rng=np.random.default_rng(1))


@pytest.fixture
def closed(make_response):
    response = make_response("CL4", noise=0.02, rng=np.random.default_rng(2))
    return identify(structure("CL4"), response, rng=np.random.default_rng(1))


def test_interval_of_an_estimate_is_its_value_and_1_96_deviations():
    lower, upper = Estimate(name="K_p", unit="-", value=5.0, std=0.5).limits_95
    assert (lower, upper) == pytest.approx((4.0200180077, 5.9799819923))


def test_estimates_carry_unit_value_and_deviation(linear):
    assert [(p.name, p.unit) for p in linear.parameters] == [("K_p", "-"), ("K_i", "1/s")]
    assert [p.value for p in linear.parameters] == linear.values.tolist()
    assert [p.std for p in linear.parameters] == pytest.approx(np.sqrt(np.diag(linear.covariance)))


def test_deviation_of_a_quotient_by_hand(linear):
    """``(q / K_i)^2 (var K_p / q^2 - 2 cov / q + var K_i)`` for ``q = K_p / K_i``."""
    (k_p, k_i), c = linear.values, linear.covariance
    q = k_p / k_i
    found = linear.derived("K_p / K_i", "s", lambda p: p["K_p"] / p["K_i"])
    assert (found.name, found.unit, found.value) == ("K_p / K_i", "s", pytest.approx(q))
    expected = np.sqrt(c[0, 0] - 2.0 * q * c[0, 1] + q**2 * c[1, 1]) / k_i
    assert found.std == pytest.approx(expected, rel=1e-6)


def test_deviation_of_a_sum_and_of_a_constant_by_hand(linear):
    total = linear.derived("sum", "-", lambda p: 2.0 * p["K_p"] - p["K_i"])
    c = linear.covariance
    assert total.std == pytest.approx(np.sqrt(4.0 * c[0, 0] - 4.0 * c[0, 1] + c[1, 1]), rel=1e-6)
    assert linear.derived("two", "-", lambda p: 2.0).std == 0.0


def test_held_parameters_add_no_uncertainty(make_response):
    found = identify(structure("OL1"), make_response("OL1"), rng=np.random.default_rng(1))
    assert found.derived("k_q", "-", lambda p: p["k_q"]).std == 0.0
    assert found.derived("tau k_q", "s", lambda p: p["tau_n"] * p["k_q"]).std == pytest.approx(
        2.0 * found.parameters[0].std, rel=1e-6
    )


def test_a_quotient_by_a_parameter_at_zero_is_infinite_not_an_error(make_response):
    """Data that draw ``K_i`` to its bound 0 from below."""
    shipped = structure("BENCHMARK").held_at(v=1.0)
    truth = {"tau_n": 0.4, "K_p": 4.0, "K_i": -0.002, "g": -0.5}
    response = make_response(shipped, truth, noise=0.01)
    found = identify(shipped, response, rng=np.random.default_rng(1))
    assert {p.name for p in found.parameters if p.at_bound} == {"K_i"}
    quotient, product, _ = found.combinations
    assert (quotient.value, quotient.std) == (np.inf, np.inf)
    assert product.std == pytest.approx({p.name: p.std for p in found.parameters}["K_p"], rel=1e-6)


def test_correlation_is_covariance_over_deviations(linear):
    c = linear.covariance
    expected = c[0, 1] / np.sqrt(c[0, 0] * c[1, 1])
    assert linear.correlation == pytest.approx(np.array([[1.0, expected], [expected, 1.0]]))


def test_combinations_are_those_of_the_structure(make_response):
    shipped = structure("BENCHMARK").held_at(v=1.0)
    truth = {"tau_n": 0.4, "K_p": 4.0, "K_i": 5.0, "g": -0.5}
    found = identify(shipped, make_response(shipped, truth), rng=np.random.default_rng(1))
    assert {c.name: (c.unit, pytest.approx(c.value)) for c in found.combinations} == {
        "K_p / K_i": ("s", 0.8),
        "v K_p": ("-", 4.0),
        "v K_i": ("1/s", 5.0),
    }


def test_value_of_a_foreign_parameter_is_refused(closed):
    assert closed.value("k_q") == 2.0
    with pytest.raises(IdentificationError, match=r"structure CL4 has no parameter K_d; it has tau_n, k_q, K_p, K_i,"):
        closed.value("K_d")


def test_margins_are_those_of_the_fitted_model_and_none_without_feedback(closed, linear):
    expected = margins(closed.structure, closed.values)
    assert closed.margins.gain_margin == expected.gain_margin
    assert closed.margins.delay_margin_s == expected.delay_margin_s
    assert linear.margins is None


def test_model_is_the_fitted_response(closed):
    (speed,), (torque,) = closed.model(np.array([1.637]))
    s = 2j * np.pi * 1.637
    values = dict(zip(closed.structure.names, closed.values, strict=True))
    square = values["omega_n"] ** 2
    engine = (values["K_p"] + values["K_i"] / s) * np.exp(-s * values["t_d"])
    engine *= square / (s**2 + 2.0 * values["zeta"] * values["omega_n"] * s + square)
    core = 1.0 / (values["tau_n"] * s + 2.0)
    assert torque == pytest.approx(engine / (1.0 + engine * core), rel=1e-12)
    assert speed == pytest.approx(torque * core, rel=1e-12)


def test_only_a_fit_weighted_by_the_covariance_is_a_likelihood(make_response, closed):
    assert closed.is_likelihood
    plain = identify(
        structure("OL1"),
        make_response("OL1"),
        rng=np.random.default_rng(1),
        settings=Settings(weighting=Unweighted()),
    )
    assert not plain.is_likelihood


def test_results_cannot_be_changed(closed):
    for array in (closed.values, closed.covariance, closed.fitted, closed.clusters[0].values):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0
