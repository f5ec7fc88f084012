"""Derivatives that are carried along a descent lead where their own lead, for fewer simulations."""

from dataclasses import replace

import numpy as np
import pytest
from tests.limits.conftest import made_record

from shaftprint.arrays import frozen_float
from shaftprint.catalogue import limited_governor
from shaftprint.identify import Prior
from shaftprint.limits._candidates import Kind
from shaftprint.limits._governor_fit import fitted, values_without_limits
from shaftprint.limits.prediction._prediction_error import PredictionError

pytestmark = pytest.mark.slow
WHOLE = limited_governor("torque", "rate", "deadband", "ramp", "smoke")
TRUE = {**values_without_limits(WHOLE), "K_p": 6.2, "K_i": 4.4, "t_d": 0.08, "m_max": 1.18}
PRIORS = {"c_set": Prior(1.0, 1e-3), "e_set": Prior(0.0, 1e-3)}
NOISE = 1e-3


@pytest.fixture
def record():
    """A minute of a set point that jumps, and the torque of a limited governor with a little noise."""
    made = made_record(
        750,
        lambda time: {
            "M_b": np.zeros(time.size),
            "c": np.zeros(time.size),
            "n": 0.02 * np.sin(1.7 * time) + 0.01 * np.sin(5.1 * time),
            "n_set": np.where(np.sin(0.9 * time) > 0.0, 0.04, -0.04),
        },
    )
    rng = np.random.default_rng(5)
    torque = PredictionError.of(WHOLE, made, TRUE, ()).predicted(np.array([TRUE[name] for name in WHOLE.names]))
    return replace(made, outputs={"y": frozen_float(torque + NOISE * rng.standard_normal(750))})


def test_a_fit_ends_at_the_truth_with_few_derivatives(record, monkeypatch):
    asked, anew = [], PredictionError._simulated_anew
    monkeypatch.setattr(
        PredictionError, "_simulated_anew", lambda term, v, wanted: asked.append(len(wanted)) or anew(term, v, wanted)
    )
    start = {**TRUE, "K_p": 5.0, "t_d": 0.065, "m_max": 1.12}
    found = fitted(WHOLE, record, start, (Kind.TORQUE,), priors=PRIORS, iterations=60)
    with_derivatives, without = (sum((count > 0) is wanted for count in asked) for wanted in (True, False))
    assert found.term.scale == pytest.approx(NOISE, rel=0.1)
    for name, within in (("K_p", 0.1), ("K_i", 0.1), ("t_d", 3e-3), ("m_max", 2e-3)):
        assert found.values[name] == pytest.approx(TRUE[name], abs=within)
    # each step costs a simulation without, and would cost one with derivatives of its own
    assert 2 * with_derivatives <= without
    # from there with what is known there: derivatives are found once at most, and nothing moves
    asked.clear()
    again = fitted(
        WHOLE, record, found.values, (Kind.TORQUE,), priors=PRIORS, iterations=60, near=found, recent=found.term.recent
    )
    assert sum(count > 0 for count in asked) <= 1
    assert again.log_squares == pytest.approx(found.log_squares, abs=0.05)
