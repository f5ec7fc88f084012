"""Sines alone: the set point stands at one level, and the slow sines know its line."""

import numpy as np
import pytest

from shaftprint.campaign import load_campaign
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.tug import Tug, sail
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel import load_vessel

pytestmark = pytest.mark.slow


@pytest.mark.long
def test_the_line_of_the_set_point_is_that_of_the_tug(tmp_path):
    vessel, tug = load_vessel("stan-tug-1205"), Tug.stan_tug_1205()
    campaign = load_campaign("short").model_copy(update={"staircases": ()})
    away = []
    for seed in range(4):
        path = tmp_path / f"{seed}.nc"
        sail(vessel, campaign, path, tug=tug, seed=seed)
        with read_recording(path) as recording:
            signals = prepare_signals(recording, vessel, campaign)
        line = signals.calibration
        slope, std = line.slope_rev_s_per_v, float(np.sqrt(line.covariance[0, 0]))
        assert std < 0.005 * abs(slope)
        away.append((rpm_from_rev_s(slope) - tug.set_point_slope_rpm_per_v) / rpm_from_rev_s(std))
        assert any("rests on the slow sines" in finding for finding in signals.findings)
    # four normal numbers: none beyond 3.5, root mean square between 0.35 and 1.8 in 99 of 100 cases
    assert max(map(abs, away)) < 3.5
    assert np.sqrt(np.mean(np.square(away))) < 1.8
