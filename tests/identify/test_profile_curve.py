"""Profiles as curves: parabolas of linear structures, refits, bounds."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import Settings, Unweighted, identify, profile_intervals
from shaftprint.identify.uncertainty._profile_curve import profile_curve
from shaftprint.models import Combination, Gain, Parameter, Structure


def test_of_a_linear_structure_is_its_parabola(make_response):
    response = make_response("OL2", noise=0.05, correlation=0.5, rng=np.random.default_rng(2))
    found = identify(structure("OL2"), response, rng=np.random.default_rng(1))
    curve = profile_curve(found, "K_i", points=9)
    parameter = found.parameters[1]
    assert (curve.name, curve.unit, curve.value) == ("K_i", "1/s", parameter.value)
    assert curve.std == pytest.approx(parameter.std, rel=1e-6)
    roots = np.linspace(-1.3 * 1.959964, 1.3 * 1.959964, 9)
    np.testing.assert_allclose(curve.values, parameter.value + roots * parameter.std, rtol=1e-6)
    np.testing.assert_allclose(curve.rise, 0.5 * roots**2, atol=1e-6)
    np.testing.assert_allclose(curve.parabola, 0.5 * roots**2, atol=1e-6)
    assert curve.limit == pytest.approx(1.9207294)


def test_each_point_is_the_best_fit_with_the_parameter_held(make_response):
    response = make_response("CL4", noise=0.08, rng=np.random.default_rng(5))
    found = identify(structure("CL4"), response, rng=np.random.default_rng(1))
    curve = profile_curve(found, "zeta", points=7)
    assert curve.rise[3] == 0.0
    for value, rise in zip(curve.values, curve.rise, strict=True):
        held = structure("CL4").held_at(zeta=float(value))
        again = identify(held, response, rng=np.random.default_rng(1), settings=Settings(stability="ignored"))
        assert again.cost - found.cost == pytest.approx(rise, rel=0.01, abs=1e-6)
    # skewed: what the parabola does not see
    assert abs(curve.rise[-1] / curve.parabola[-1] - curve.rise[0] / curve.parabola[0]) > 0.02


def test_passes_the_limit_at_the_ends_of_the_interval(make_response):
    response = make_response("OL5", noise=0.08, rng=np.random.default_rng(5))
    found = identify(structure("OL5"), response, rng=np.random.default_rng(1))
    interval = profile_intervals(found)["K_p"]
    curve = profile_curve(found, "K_p", points=41)
    assert np.interp(interval.lower, curve.values, curve.rise) == pytest.approx(curve.limit, rel=0.02)
    assert np.interp(interval.upper, curve.values, curve.rise) == pytest.approx(curve.limit, rel=0.02)


def test_ends_at_a_bound(make_response):
    """A gain of 1 known to 0.1 within bounds of 0.9 and 10: at the lower one the cost has risen by a half."""
    gain = Structure(
        name="GAIN", title="a gain", input="u", outputs={"y": Gain(Parameter("k", "-", 0.9, 10.0, 1.0, "gain"))}
    )
    response = make_response(gain, {"k": 1.0}, frequency_hz=np.array([1.0]), names=("one",), noise=0.1)
    found = identify(gain, response, rng=np.random.default_rng(1))
    curve = profile_curve(found, "k", points=11)
    assert curve.values[0] == 0.9
    assert curve.rise[0] == pytest.approx(0.5, rel=1e-6)
    # the estimate, five points above, one below, and the bound
    assert curve.values.size == 8
    assert np.all(np.diff(curve.values) > 0.0)


def test_of_a_combination_and_of_a_number_of_ones_own(make_response):
    truth = {"tau_n": 0.4, "K_p": 4.0, "K_i": 5.0, "g": -0.5, "v": 1.0}
    shipped = structure("BENCHMARK")
    found = identify(shipped, make_response(shipped, truth, noise=0.02), rng=np.random.default_rng(0))
    interval = profile_intervals(found)["v K_p"]
    for number in ("v K_p", Combination(name="own", unit="-", of=lambda p: p["v"] * p["K_p"], meaning="product")):
        curve = profile_curve(found, number, points=41)
        assert np.interp(interval.upper, curve.values, curve.rise) == pytest.approx(curve.limit, rel=0.02)


def test_refusals(make_response):
    response = make_response("OL1")
    found = identify(structure("OL1"), response, rng=np.random.default_rng(1))
    with pytest.raises(IdentificationError, match="profile curve: structure OL1 has no number K_p; it has tau_n"):
        profile_curve(found, "K_p")
    for points in (1, 8):
        with pytest.raises(IdentificationError, match=f"expected an odd number of points from 3 on, found {points}"):
            profile_curve(found, "tau_n", points=points)
    infinite = Combination(name="inverse", unit="-", of=lambda p: 1.0 / (0.0 * p["tau_n"]), meaning="infinite")
    with pytest.raises(IdentificationError, match="profile curve: inverse is infinite at the estimate"):
        profile_curve(found, infinite)
    settings = Settings(weighting=Unweighted())
    unweighted = identify(structure("OL1"), response, rng=np.random.default_rng(1), settings=settings)
    with pytest.raises(IdentificationError, match="a profile likelihood needs a fit weighted by the covariance"):
        profile_curve(unweighted, "tau_n")
