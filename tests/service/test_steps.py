"""A step of the fit to segments: as far as the curvature of one point is a guide."""

import numpy as np
import pytest

from shaftprint.service import _fit
from shaftprint.service._model import FREE

HERE = {
    "K_p": 6.01, "K_i": 4.72, "omega_n": 13.4, "zeta": 0.65, "t_d": 0.09, "t_sp": 0.043, "tau_dn": 0.326,
    "tau_up": 1.02, "g": -0.17, "c_set": 0.997, "t_gauge": -0.003,
}  # fmt: skip


@pytest.mark.parametrize("share", [0.1, 0.5, 3.0])
def test_a_step_goes_its_way_but_no_farther_than_a_quarter_of_a_gain_or_lag(monkeypatch, share):
    """From usual values to a ship of its own a whole step halved the lag, and the next met a line that hunts."""
    monkeypatch.setattr(_fit, "simulated", lambda records, model, theta: [])
    monkeypatch.setattr(_fit, "scores", lambda runs, whitening: [])
    monkeypatch.setattr(_fit, "_misfit", lambda each, sums, model, theta: 0.0)
    theta = np.array([HERE[name] for name in FREE])
    asked = 0.01 * theta
    asked[FREE.index("omega_n")] *= -100.0 * share
    tried, _, _ = _fit._stepped([], [], None, asked, None, theta, None, guided=False)
    assert (tried - theta) / asked == pytest.approx(min(1.0, 0.25 / share))


def test_what_stands_at_its_bound_stays_there_and_no_other_number_makes_up_for_it():
    """A delay at zero that the slope pulls further down drew the latency of the set point with it."""
    theta = np.array([HERE[name] for name in FREE])
    delay, latency = FREE.index("t_d"), FREE.index("t_sp")
    theta[delay] = 0.0
    information = np.eye(len(FREE))
    information[delay, latency] = information[latency, delay] = 0.95
    slope = np.zeros(len(FREE))
    slope[delay] = -1.0
    sums = _fit.Sums(slope=slope, information=information, prior=np.zeros_like(information))
    assert sums.step[latency] > 5.0
    assert np.all(sums.step_from(theta) == 0.0)
    theta[delay] = 0.1
    assert sums.step_from(theta) == pytest.approx(sums.step)
