"""A plan of three and a half minutes for a ship that is not the shipped tug, which all tests of the room sail."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.design import Effort, PlannedTest, SetPointLine, Wish, assumed_ship, design_campaign, limits_from_vessel
from shaftprint.survey import STAN_TUG_NOISE
from shaftprint.vessel import load_vessel

# Not the tug that is shipped: every number is another.
ASSUMED = {
    "K_p": 4.9, "K_i": 3.9, "t_d": 0.061, "omega_n": 11.5, "zeta": 0.55, "tau_dn": 0.36, "tau_up": 0.93,
    "k_q": 2.0, "g": -0.1, "t_sp": 0.043, "c_set": 1.0, "t_gauge": 0.0,
}  # fmt: skip
QUICK = Effort(steps=40, restarts=1, accuracy_draws=1, peak_draws=1, active_draws=1)


@pytest.fixture(scope="session")
def assumed():
    """Its numbers."""
    return ASSUMED


@pytest.fixture(scope="session")
def vessel():
    """The installation."""
    return load_vessel("stan-tug-1205")


@pytest.fixture(scope="session")
def test(vessel):
    """Three and a half minutes at two speeds, for a line whose set point rises with the voltage."""
    return planned(vessel, within_s=210.0)


@pytest.fixture(scope="session")
def longer_test(vessel):
    """Five and a half minutes: with fewer periods the noise is known from too few samples for stated deviations."""
    return planned(vessel, within_s=330.0)


def planned(vessel, *, within_s):
    limits = replace(
        limits_from_vessel(vessel, set_point_rpm=200.0),
        motoring=((0.0, 140.0), (1183.8, 280.0), (2367.6, 420.0)),
        demand_cycle_s=0.02,
    )
    plan = design_campaign(
        assumed_ship(structure("GAUGE-CLOSED"), ASSUMED, std={}),
        Wish(),
        limits,
        STAN_TUG_NOISE,
        speeds=(1.15, 0.78),
        within_s=within_s,
        rng=np.random.default_rng(1),
        effort=QUICK,
    )
    return PlannedTest(
        name="rehearsed",
        vessel=vessel.name,
        plan=plan,
        line=SetPointLine(slope_rpm_per_v=180.0, offset_v=2.0),
        created=datetime(2026, 11, 23, tzinfo=UTC),
        noise_source="assumed",
    )
