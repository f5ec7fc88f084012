"""python-control and xarray: exact where there is no delay, and the stated error of Pade where there is."""

import math
import sys

import numpy as np
import pytest

from shaftprint.catalogue import STRUCTURES, structure
from shaftprint.errors import ExportError
from shaftprint.export import to_control, to_xarray

control = pytest.importorskip("control", reason="python-control gets the models")
OMEGA = np.geomspace(0.1, 30.0, 25)


def is_late(exported, name):
    try:
        to_control(exported(structure(name)))
    except ExportError:
        return True
    return False


def test_which_structures_are_without_delays(exported):
    exact = {name for name in STRUCTURES if not is_late(exported, name)}
    assert exact == {
        "OL1",
        "OL2",
        "OL4",
        "OL-PID",
        "CL1",
        "CL3",
        "CL4-PADE5",
        "INITIAL",
        "BENCHMARK",
        "GAUGE-CORE",
        "FREE-CORE",
        "FREE-SHIP",
    }


@pytest.mark.parametrize("name", ["OL1", "OL-PID", "CL3", "CL4-PADE5", "INITIAL", "FREE-SHIP"])
def test_without_delays_it_is_exact(exported, name):
    chosen = structure(name)
    model = exported(chosen)
    found = to_control(model)
    expected = chosen.response(model.values, 1j * OMEGA)
    np.testing.assert_allclose(found.system(1j * OMEGA, squeeze=False)[:, 0], expected, rtol=1e-9)
    assert found.pade_order == 0
    assert max(found.largest_error.values()) < 1e-9
    assert "exact" in found.remark


def test_a_delay_outside_of_the_loop_is_a_factor(exported):
    model = exported(structure("OL3"), {"t_d": 0.0731})
    bare = to_control(exported(structure("OL2")))
    found = to_control(model, pade_order=7, band_rad_s=(0.1, 30.0))
    factor = np.exp(-1j * OMEGA * 0.0731)
    expected = bare.system(1j * OMEGA, squeeze=False) * factor
    np.testing.assert_allclose(found.exact(1j * OMEGA[[0, -1]], squeeze=False), expected[..., [0, -1]], rtol=1e-9)
    np.testing.assert_allclose(found.system(1j * OMEGA, squeeze=False), expected, rtol=1e-6)


def test_the_loop_that_pade_closes_is_that_of_control_itself(exported):
    model = exported(structure("CL4"), {"t_d": 0.09})
    p = dict(zip(model.structure.names, model.values, strict=True))
    s = control.tf("s")
    numerator, denominator = control.pade(0.09, 5)
    engine = (p["K_p"] + p["K_i"] / s) * control.tf(numerator, denominator)
    engine *= p["omega_n"] ** 2 / (s**2 + 2 * p["zeta"] * p["omega_n"] * s + p["omega_n"] ** 2)
    loop = control.feedback(engine * 1 / (p["tau_n"] * s + p["k_q"]), 1)
    found = to_control(model, pade_order=5)
    np.testing.assert_allclose(found.system(1j * OMEGA, squeeze=False)[0, 0], loop(1j * OMEGA), rtol=1e-8)


def test_the_stated_error_is_the_distance_from_the_exact_response(exported):
    chosen = structure("GAUGE-CLOSED")
    model = exported(chosen, {"t_d": 0.12, "t_sp": 0.05})
    found = to_control(model, pade_order=2, band_rad_s=(0.1, 30.0))
    omega = np.geomspace(0.1, 30.0, 3001)
    exact = chosen.response(model.values, 1j * omega)
    distance = np.abs(found.system(1j * omega, squeeze=False)[:, 0] - exact).max(axis=-1) / np.abs(exact).max(axis=-1)
    assert list(found.largest_error) == ["n / n_set", "M_s / n_set"]
    np.testing.assert_allclose(list(found.largest_error.values()), distance, rtol=0.05)
    assert distance.min() > 1e-3
    assert "order 2" in found.remark
    assert "0.1 to 30 rad/s" in found.remark
    better = to_control(model, pade_order=6, band_rad_s=(0.1, 30.0))
    assert max(better.largest_error.values()) < 0.01 * max(found.largest_error.values())


@pytest.mark.parametrize("order", [1, 2, 5, 10])
def test_the_approximation_is_that_of_the_textbook(exported, order):
    bare = to_control(exported(structure("OL2"))).system
    late = to_control(exported(structure("OL3"), {"t_d": 0.3}), pade_order=order).system
    for s in (0.7j, 4.0 - 2.0j):
        x = 0.3 * s
        weights = [
            math.factorial(2 * order - k) / math.factorial(k) / math.factorial(order - k) for k in range(order + 1)
        ]
        expected = sum(w * (-x) ** k for k, w in enumerate(weights)) / sum(w * x**k for k, w in enumerate(weights))
        assert late(s) / bare(s) == pytest.approx(expected, rel=1e-9)


def test_an_output_ahead_of_its_time_comes_late_and_says_so(exported):
    found = to_control(exported(structure("GAUGE-CORE"), {"t_gauge": 0.013}))
    assert found.lateness_s == {"n": pytest.approx(0.013)}
    assert "n comes 0.013 s late" in found.remark
    assert found.largest_error["n / M_s"] > 0.01


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({}, "give pade_order=5"),
        ({"pade_order": 0}, "order from 1 to 15"),
        ({"pade_order": 5, "band_rad_s": (3.0, 1.0)}, "two ascending frequencies"),
    ],
)
def test_nothing_is_guessed(exported, more, message):
    with pytest.raises(ExportError, match=message):
        to_control(exported(structure("CL4")), **more)


@pytest.mark.parametrize(("verb", "package"), [(to_control, "control"), (to_xarray, "xarray")])
def test_a_missing_package_is_named(exported, monkeypatch, verb, package):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(ExportError, match=rf'pip install "shaftprint\[{package}\]"'):
        verb(exported(structure("OL1")))


def test_labelled_arrays(exported):
    pytest.importorskip("xarray", reason="xarray gets the models")
    chosen = structure("FREE-PITCH")
    covariance = np.array([[0.04, 0.001], [0.001, 0.0004]])
    model = exported(chosen, uncertain=("K_p", "t_d"), covariance=covariance, not_known=("e",))
    found = to_xarray(model, OMEGA)
    response = chosen.response(model.values, 1j * OMEGA).reshape(3, 2, -1)
    np.testing.assert_array_equal(found["response"].sel(output="M_s", input="theta_set"), response[1, 1])
    assert float(found["value"].sel(parameter="K_p")) == 5.0
    assert float(found["std"].sel(parameter="K_p")) == pytest.approx(0.2)
    assert np.isnan(found["std"].sel(parameter="q"))
    assert float(found["covariance"].sel(uncertain="K_p", uncertain_too="t_d")) == 0.001
    assert found["unit"].sel(parameter="t_d") == "s"
    assert found.attrs["not_known"] == ["e"]


def test_the_deviation_of_gain_and_phase_is_that_of_a_gain_and_a_delay(exported):
    pytest.importorskip("xarray", reason="xarray gets the models")
    # of K e^(-s t) the size goes with K alone and the phase with t alone
    model = exported(
        structure("OL3"), {"K_i": 0.0, "K_p": 4.0}, uncertain=("K_p", "t_d"), covariance=np.diag([0.04, 1e-4])
    )
    found = to_xarray(model, OMEGA)
    np.testing.assert_allclose(found["magnitude_std"][0, 0], 20.0 / np.log(10.0) * 0.2 / 4.0)
    np.testing.assert_allclose(found["phase_std"][0, 0], np.degrees(OMEGA * 0.01))
