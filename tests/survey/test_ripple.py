"""What orders and noise put on top of the torque at the gauge, measured of raw recordings of the simulated tug."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.campaign import Campaign
from shaftprint.survey import Trial, measure
from shaftprint.tug import Noise, Tug, sail
from shaftprint.vessel import load_vessel

CAMPAIGN = Campaign.model_validate(
    {
        "name": "a leg",
        "duration_s": 60.0,
        "offset_v": -5.0,
        "ramp_s": 5.0,
        "multisines": [
            {
                "name": "M1", "level_v": -5.0, "period_s": 10.0, "harmonics": [1, 3, 7], "amplitudes_v": [0.2] * 3,
                "phases_rad": [0.0, 1.0, 2.0], "start_s": 10.0, "settled_s": 15.0, "stop_s": 55.0,
            }
        ],
    }
)  # fmt: skip


def measured(path, factor):
    """The ripple of a recording whose orders and gauge noise are so many times the usual ones, and the recording."""
    usual = Noise().without(faults=True, process=True)
    names = ("half_order", "shaft_order", "blade_order", "twice_blade_order", "firing_order", "torque_broadband_rms")
    noise = replace(usual, **{name: factor * getattr(usual, name) for name in names})
    vessel = load_vessel("stan-tug-1205")
    sail(vessel, CAMPAIGN, path, tug=replace(Tug.stan_tug_1205(), noise=noise), seed=4)
    return measure(path, Trial(vessel=vessel, campaign=CAMPAIGN)).torque_ripple


def passed_by_one_in_a_hundred():
    """Five sines of independent phase, and the noise that a low-pass of 500 Hz leaves of 0.06 at 2000 samples/s."""
    rng = np.random.default_rng(1)
    share = 1.0 - np.exp(-2.0 * np.pi * 500.0 / 2000.0)
    total = 0.06 * np.sqrt(share / (2.0 - share)) * rng.standard_normal(400_000)
    for amplitude in (0.13, 0.09, 0.035, 0.008, 0.30):
        total += amplitude * np.sin(2.0 * np.pi * rng.random(total.size))
    return np.quantile(total, 0.99)


@pytest.mark.slow
def test_ripple_is_what_one_sample_in_a_hundred_passes_of_orders_and_noise(tmp_path):
    truth = passed_by_one_in_a_hundred()
    assert truth == pytest.approx(0.49, abs=0.005)
    # of 20 s the orders of the shaft turn a hundred times: what is known is a tenth of the largest order
    assert measured(tmp_path / "usual.nc", 1.0) == pytest.approx(truth, abs=0.03)
    assert measured(tmp_path / "half.nc", 0.5) == pytest.approx(0.5 * truth, abs=0.03)
