"""A leg ends early where what is known is enough for the wishes of its plan."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest
from tests.live.rehearsed import ENVELOPE, VESSEL

import shaftprint as sp
from shaftprint.design import Effort, PlannedTest, SetPointLine, Wish, assumed_ship, design_campaign, limits_from_vessel
from shaftprint.live._rehearse import rehearse

# Not the tug that is shipped: every number is another.
ASSUMED = {
    "K_p": 4.9, "K_i": 3.9, "t_d": 0.061, "omega_n": 11.5, "zeta": 0.55, "tau_dn": 0.36, "tau_up": 0.93,
    "k_q": 2.0, "g": -0.1, "t_sp": 0.043, "c_set": 1.0, "t_gauge": 0.0,
}  # fmt: skip
QUICK = Effort(steps=40, restarts=1, accuracy_draws=1, peak_draws=1, active_draws=1)


def planned(wish):
    plan = design_campaign(
        assumed_ship(sp.catalogue.structure("GAUGE-CLOSED"), ASSUMED, std={}),
        Wish(),
        replace(limits_from_vessel(VESSEL, set_point_rpm=200.0), demand_cycle_s=0.02),
        sp.survey.STAN_TUG_NOISE,
        speeds=(1.15, 0.78),
        within_s=210.0,
        rng=np.random.default_rng(1),
        effort=QUICK,
    )
    return PlannedTest(
        name="rehearsed",
        vessel=VESSEL.name,
        plan=replace(plan, wish=wish),
        line=SetPointLine(slope_rpm_per_v=180.0, offset_v=2.0),
        created=datetime(2026, 11, 23, tzinfo=UTC),
        noise_source="assumed",
    )


@pytest.mark.long
def test_wishes_that_are_met_end_both_legs_and_those_that_are_not_end_none(tmp_path):
    periods = {}
    for name, share in (("modest", 0.9), ("never", 1e-6)):
        test = planned(Wish(relative={"K_p": share}))
        outcome, left = rehearse(
            VESSEL,
            test.campaign,
            ENVELOPE,
            tmp_path / f"{name}.nc",
            planned=test,
            proves=lambda changed: sp.live.prove(changed, VESSEL, ENVELOPE).refusals,
        )
        assert outcome.word == "played"
        periods[name] = [leg.periods for leg in sp.campaign.load_campaign(left.campaign).legs]
    whole = [leg.periods for leg in planned(Wish()).campaign.legs]
    assert periods["never"] == whole
    # three periods are played at least, and the change reaches the device in the fourth
    assert all(3 <= few <= 4 for few in periods["modest"])
