"""A ship that is stepped block by block is the ship that is sailed at once."""

import numpy as np
import pytest

import shaftprint as sp
from shaftprint.tug._stepped import SteppedTug


@pytest.mark.slow
def test_blocks_hold_the_counts_of_a_voyage(tmp_path):
    vessel = sp.vessel.load_vessel("stan-tug-1205")
    short = sp.campaign.load_campaign("short")
    campaign = short.model_copy(update={"duration_s": 230.0, "sines": ()})
    tug = sp.tug.like_stan_tug_1205(vessel, offset_v=-5.0)
    ship = SteppedTug(tug, vessel, first_v=-5.0, duration_s=230.0, seed=3)
    # blocks of a length that divides nothing
    blocks = [ship.step(117, lambda time_s: sp.campaign.setpoint(campaign, time_s))[1] for _ in range(600)]
    sp.tug.sail(vessel, campaign, tmp_path / "sailed.nc", tug=tug, seed=3)
    with sp.recording.read_recording(tmp_path / "sailed.nc") as recording:
        assert set(recording.channels) == {one.name for one in ship.channels}
        for name, channel in recording.channels.items():
            counts = np.concatenate([one[name] for one in blocks])
            assert np.array_equal(channel.read(0, counts.size), counts)
