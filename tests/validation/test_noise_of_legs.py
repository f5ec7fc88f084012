"""The noise of a leg, which never stands still, from what differs between its periods."""

from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.campaign import load_campaign
from shaftprint.signals import LegState
from shaftprint.validation.measures._noise_pieces import quiet_noise

RATE_HZ, PERIOD_S, PERIODS, STD = 50.0, 20.013, 8, 0.03


def test_what_repeats_itself_is_no_noise():
    """White noise of 0.03 on lines of ten times that; the period is no whole number of samples."""
    rng = np.random.default_rng(2)
    time = np.arange(round(PERIODS * PERIOD_S * RATE_HZ)) / RATE_HZ
    lines = 0.3 * np.sin(2.0 * np.pi * 5.0 * time / PERIOD_S) + 0.1 * np.sin(2.0 * np.pi * 41.0 * time / PERIOD_S)
    outputs = np.stack([lines, 0.2 + 2.0 * lines]) + STD * rng.normal(size=(2, time.size))
    state = LegState(name="M1", start_s=0.0, period_s=PERIOD_S, periods=PERIODS, working_point=None)
    signals = SimpleNamespace(
        rate_hz=RATE_HZ,
        start_s=0.0,
        shaft_torque_nm=outputs[1],
        legs=(state,),
        coverage=SimpleNamespace(touching=lambda begin, end: False),
    )
    # the shipped campaign is still for no time at all of what is recorded here
    noise = quiet_noise(lambda there: outputs[:, there], load_campaign("5min"), signals, rest_s=12.0)
    (stretch,), (load,) = noise.stretches, noise.loads
    assert stretch.shape[1] == pytest.approx((PERIODS - 1) * PERIOD_S * RATE_HZ, abs=2)
    # between two samples the noise is a mean of both, which takes up to a quarter of the variance of one period
    assert stretch.std(axis=1) == pytest.approx([STD, STD], rel=0.15)
    assert load == pytest.approx(1.2, abs=0.02)
