"""Margins with their standard deviations."""

import numpy as np
import pytest

from shaftprint.fingerprint._margins import margin_quantities
from shaftprint.models import margins

SAMPLES = 60


@pytest.mark.slow
def test_standard_deviations_are_the_scatter_over_the_covariance(gauge_fit):
    model, middle = gauge_fit.structure, gauge_fit.values
    free = [model.names.index(parameter.name) for parameter in model.free]
    # A hundredth of the covariance: margins bend over the valley along which delays and lag trade, and first order is
    # meant. The draws are made to have exactly that covariance, so that only the bending is left of the sampling error.
    covariance = gauge_fit.covariance / 100.0
    draws = np.random.default_rng(11).standard_normal((SAMPLES, len(free)))
    draws -= draws.mean(axis=0)
    draws = np.linalg.solve(np.linalg.cholesky(np.cov(draws.T)), draws.T).T
    table = np.tile(middle, (SAMPLES, 1))
    table[:, free] += draws @ np.linalg.cholesky(covariance).T
    found = [margins(model, values) for values in table]
    scatter = np.std([(m.gain_margin, np.degrees(m.phase_margin_rad), m.delay_margin_s) for m in found], axis=0, ddof=1)
    stated = [quantity.std for quantity in margin_quantities(gauge_fit)]
    assert [quantity.name for quantity in margin_quantities(gauge_fit)] == [
        "gain margin",
        "phase margin",
        "delay margin",
    ]
    # 3 %: what is left of the bending
    assert stated == pytest.approx(10.0 * scatter, rel=0.03)


def test_values_are_those_of_the_reference_line(gauge_fit):
    """At gain margin times the gain, or delay margin more delay, the loop gain passes through -1."""
    found = {quantity.name: quantity.value for quantity in margin_quantities(gauge_fit)}
    p = dict(zip(gauge_fit.structure.names, gauge_fit.values.tolist(), strict=True))

    def loop(s, gain=1.0, delay=0.0):
        lag = p["omega_n"] ** 2 / (s**2 + 2.0 * p["zeta"] * p["omega_n"] * s + p["omega_n"] ** 2)
        line = 1.0 / ((p["tau_up"] + p["tau_dn"]) * s + p["k_q"] - p["g"])
        return gain * (p["K_p"] + p["K_i"] / s) * np.exp(-s * (p["t_d"] + delay)) * lag * line

    s = 1j * np.linspace(0.5, 15.0, 200_001)
    assert np.abs(1.0 + loop(s, gain=found["gain margin"])).min() == pytest.approx(0.0, abs=1e-3)
    assert np.abs(1.0 + loop(s, delay=found["delay margin"])).min() == pytest.approx(0.0, abs=1e-3)
    crossover = s[np.argmin(np.abs(np.abs(loop(s)) - 1.0))]
    assert 180.0 + np.degrees(np.angle(loop(crossover))) == pytest.approx(found["phase margin"], abs=0.05)


def test_structure_without_feedback_has_none(fit):
    assert margin_quantities(fit("OL1", {"tau_n": 0.32})) == ()


def test_margin_that_does_not_exist_is_left_out(fit):
    """A PI governor on a shaft never turns by 180 degrees: no gain makes it hunt."""
    names = [q.name for q in margin_quantities(fit("CL1", {"tau_n": 0.39, "K_p": 3.0, "K_i": 4.0}))]
    assert names == ["phase margin", "delay margin"]


def test_margins_are_known_although_gains_and_inertias_are_not(fit, truth):
    """Without a prior of ``g``, gains and inertias may all grow together; the loop gain stays what it is."""
    free = fit("GAUGE-CLOSED", truth)
    assert next(e.std for e in free.parameters if e.name == "K_p") == np.inf
    gain = margin_quantities(free)[0]
    assert gain.value == pytest.approx(1.60, abs=0.01)
    assert 0.0 < gain.std < 0.05
