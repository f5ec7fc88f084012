"""A short test on a simulated ship, in the same program, for all tests of the room."""

import asyncio

import shaftprint as sp
from shaftprint.live._engine import LiveTest
from shaftprint.live._envelope import envelope_of
from shaftprint.live._record import LiveRecord
from shaftprint.live._rehearse import simulated_ship_of
from shaftprint.live.counterparts._faults import LinkFaults
from shaftprint.live.counterparts._simulated import SimulatedCounterpart

VESSEL = sp.vessel.load_vessel("stan-tug-1205")
TUG = sp.tug.like_stan_tug_1205(VESSEL, offset_v=-5.0)
ENVELOPE = envelope_of(VESSEL, is_rehearsed=True)


def leg(name, *, level_v, start_s, settled_s, stop_s, period_s):
    return {
        "name": name,
        "level_v": level_v,
        "start_s": start_s,
        "settled_s": settled_s,
        "stop_s": stop_s,
        "period_s": period_s,
        "harmonics": (1, 3, 5),
        "amplitudes_v": (0.2, 0.2, 0.1),
        "phases_rad": (0.0, 1.0, 2.0),
    }


CAMPAIGN = sp.campaign.Campaign.model_validate(
    {
        "name": "two legs",
        "duration_s": 36.0,
        "offset_v": -5.0,
        "ramp_s": 2.0,
        "multisines": (
            leg("M1", level_v=-5.0, start_s=3.0, settled_s=5.0, stop_s=17.1, period_s=3.0),
            leg("M2", level_v=-4.6, start_s=20.0, settled_s=22.0, stop_s=31.1, period_s=3.0),
        ),
    }
)


def played(
    folder, faults=None, *, tug=TUG, seed=1, envelope=ENVELOPE, campaign=CAMPAIGN, plays_waveform=True, **options
):
    """Play the test; return the outcome, the test, and the ship."""
    ship = simulated_ship_of(VESSEL, campaign, seed=seed, faults=faults or LinkFaults(), tug=tug)
    counterpart = SimulatedCounterpart(ship, plays_waveform=plays_waveform)
    test = LiveTest(
        counterpart=counterpart,
        vessel=VESSEL,
        campaign=campaign,
        envelope=envelope,
        record=LiveRecord(folder / "test.nc", counterpart.channels, {"vessel": VESSEL.name}),
        slope_rpm_per_v=tug.set_point_slope_rpm_per_v,
        **options,
    )
    try:
        return asyncio.run(test.run()), test, ship
    finally:
        test.record.close()
