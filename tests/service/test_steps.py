"""A step of the fit to segments: as far as the curvature of one point is a guide."""

from types import SimpleNamespace

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
    tried, _, _ = _fit._stepped([], [], None, asked, SimpleNamespace(free=FREE), theta, None, guided=False)
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
    sums = _fit.Sums(slope=slope, information=information, prior=np.zeros_like(information), free=FREE)
    assert sums.step[latency] > 5.0
    assert np.all(sums.step_from(theta) == 0.0)
    theta[delay] = 0.1
    assert sums.step_from(theta) == pytest.approx(sums.step)


def test_segments_that_meet_a_limit_at_the_start_only_have_no_score_there_and_one_at_the_end(monkeypatch):
    """Where a segment came back, the scores at the start stood beside other segments."""
    start = np.array([HERE[name] for name in FREE])
    target = 1.1 * start

    def simulated(records, model, theta):
        return [SimpleNamespace(record=one, theta=theta, meets_limit=one == 3 and theta is start) for one in records]

    def scores(runs, whitening):
        size = np.diag(np.abs(100.0 / start) ** 2)
        return [
            _fit.Score(slope=size @ (target - one.theta), information=size, count=1, level=1.0, meets_limit=False)
            for one in runs
        ]

    monkeypatch.setattr(_fit, "simulated", simulated)
    monkeypatch.setattr(_fit, "scores", scores)
    monkeypatch.setattr(_fit, "noise_of", lambda runs: None)
    monkeypatch.setattr(_fit, "misfit_of", lambda *_: SimpleNamespace(spread=0.0))
    monkeypatch.setattr(_fit, "clustered", lambda each, prior, of_noise: (of_noise, np.ones(len(FREE))))
    model = SimpleNamespace(theta=start, theta_known=start, prior_std={}, free=FREE, sails=False)
    fit = _fit.fit_segments(list(range(20)), model)
    assert np.flatnonzero(~fit.counts_at_start).tolist() == [3]
    assert len(fit.at_start) == 19
    assert fit.counts.all()
    assert len(fit.scores) == 20
    assert fit.theta == pytest.approx(target)
