"""The simulated Stan Tug as a plan sees it, and one plan of it that several tests look at."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.design import Effort, Wish, assumed_ship, design_campaign, limits_from_vessel
from shaftprint.survey import STAN_TUG_NOISE
from shaftprint.vessel import load_vessel

TRUTH = {
    "K_p": 5.7, "K_i": 4.27, "t_d": 0.0703, "omega_n": 10.3, "zeta": 0.47, "tau_dn": 0.32, "tau_up": 1.016,
    "k_q": 2.0, "g": 0.0, "t_sp": 0.0518, "c_set": 1.0, "t_gauge": 0.0,
}  # fmt: skip
# What it takes to turn the simulated engine without fuel: 300 N m at 1183.8 rpm, half of it proportional to the speed.
MOTORING = ((0.0, 150.0), (1183.8, 300.0), (2367.6, 450.0))
QUICK = Effort(steps=40, restarts=1, accuracy_draws=2, peak_draws=50, active_draws=4)


@pytest.fixture(scope="session")
def truth():
    """Parameters of the simulated tug, normalised at its working point."""
    return TRUTH


@pytest.fixture(scope="session")
def limits():
    """What the tug allows for 1 V of set point, with an idle speed of 540 rpm."""
    usual = limits_from_vessel(load_vessel("stan-tug-1205"), set_point_rpm=251.0)
    return replace(usual, lowest_speed_rpm=540.0, motoring=MOTORING)


@pytest.fixture(scope="session")
def tug():
    """The line of the tug, known exactly."""
    return assumed_ship(structure("GAUGE-CLOSED"), TRUTH, std={})


@pytest.fixture(scope="session")
def quick():
    """Little effort: what is tested holds for any plan, not only for the best one."""
    return QUICK


@pytest.fixture(scope="session")
def plan(tug, limits, quick):
    """Six minutes at two speeds."""
    return design_campaign(
        tug,
        Wish(),
        limits,
        STAN_TUG_NOISE,
        speeds=(1.15, 0.70),
        within_s=360.0,
        rng=np.random.default_rng(1),
        effort=quick,
    )
