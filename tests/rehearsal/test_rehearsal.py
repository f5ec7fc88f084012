"""A plan rehearsed on the simulated tug: the tug has the assumed numbers, and raw recordings give them back."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.design import (
    Effort,
    PlannedTest,
    SetPointLine,
    Wish,
    assumed_ship,
    design_campaign,
    limits_from_vessel,
)
from shaftprint.errors import DesignError
from shaftprint.identify import STAN_TUG_NOISE
from shaftprint.rehearsal import rehearse_on_tug, simulated_truth, tug_of_plan
from shaftprint.tug import normalised_truth
from shaftprint.vessel import load_vessel

# Not the tug that is shipped: every number is another.
ASSUMED = {
    "K_p": 4.9, "K_i": 3.9, "t_d": 0.061, "omega_n": 11.5, "zeta": 0.55, "tau_dn": 0.36, "tau_up": 0.93,
    "k_q": 2.0, "g": -0.1, "t_sp": 0.043, "c_set": 1.0, "t_gauge": 0.0,
}  # fmt: skip
QUICK = Effort(steps=40, restarts=1, accuracy_draws=1, peak_draws=1, active_draws=1)


@pytest.fixture(scope="module")
def vessel():
    return load_vessel("stan-tug-1205")


@pytest.fixture(scope="module")
def test(vessel):
    """Three and a half minutes at two speeds, for a line whose set point rises with the voltage."""
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
        within_s=210.0,
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


def test_the_simulated_ship_has_the_assumed_numbers(test, vessel):
    tug = tug_of_plan(test, vessel)
    truth = normalised_truth(tug, vessel)
    for name in ("K_p", "K_i", "t_d", "omega_n", "zeta", "tau_dn", "tau_up", "g", "t_sp"):
        assert truth[name] == pytest.approx(ASSUMED[name], rel=1e-9), name
    assert tug.motoring_torque_nm == pytest.approx(280.0)
    assert tug.demand_cycle_s == 0.02


def test_what_holds_the_demand_is_part_of_the_latency(test):
    """Messages every 20 ms are 10 ms late on average."""
    truth = simulated_truth(test.plan)
    assert truth["t_sp"] == pytest.approx(0.053)
    assert truth["t_d + t_sp"] == pytest.approx(0.114)
    assert truth["K_p / K_i"] == pytest.approx(4.9 / 3.9)


def test_a_structure_that_cannot_be_simulated_is_named(test, vessel):
    ship = assumed_ship(structure("CL4"))
    other = replace(test.plan, ship=ship)
    with pytest.raises(DesignError, match="rehearsal of CL4: expected a closed loop such as GAUGE-CLOSED"):
        tug_of_plan(PlannedTest(**{name: getattr(test, name) for name in test.__slots__} | {"plan": other}), vessel)


def test_a_rehearsal_needs_a_test(test, vessel):
    with pytest.raises(DesignError, match="at least one"):
        rehearse_on_tug(test, vessel, count=0)


@pytest.mark.slow
def test_raw_recordings_give_the_assumed_numbers_back(test, vessel):
    rehearsal = rehearse_on_tug(test, vessel, count=2)
    assert rehearsal.failures == ()
    assert {"K_p", "t_d", "tau_dn", "tau_up", "t_d + t_sp"} <= set(rehearsal.names)
    z = rehearsal.errors / rehearsal.stated
    assert np.abs(z).max() < 4.5
    assert np.sqrt(np.mean(z**2)) < 1.8
    errors = dict(zip(rehearsal.names, np.abs(rehearsal.errors).max(axis=0), strict=True))
    # the wrong sign of the line, or the working point of a leg as that of the plan, would be off by tens of percent
    assert errors["tau_dn"] < 0.01 * 0.36
    assert errors["K_p / K_i"] < 0.2 * 4.9 / 3.9
