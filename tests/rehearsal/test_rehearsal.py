"""A plan rehearsed on the simulated tug: the tug has the assumed numbers, and raw recordings give them back."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.design import PlannedTest, assumed_ship
from shaftprint.errors import DesignError
from shaftprint.rehearsal import rehearse_on_tug
from shaftprint.rehearsal._simulated_ship import simulated_truth, tug_of_plan
from shaftprint.survey import of_vessel
from shaftprint.tug import normalised_truth
from shaftprint.vessel import load_vessel


def test_the_simulated_ship_has_the_assumed_numbers(test, vessel, assumed):
    tug = tug_of_plan(test, vessel)
    truth = normalised_truth(tug, vessel)
    for name in ("K_p", "K_i", "t_d", "omega_n", "zeta", "tau_dn", "tau_up", "g", "t_sp"):
        assert truth[name] == pytest.approx(assumed[name], rel=1e-9), name
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


@pytest.fixture
def test_underway(test):
    """The plan of the quay, of a ship that sails free."""
    underway = load_vessel("stan-tug-1205-underway")
    chosen = of_vessel(structure("FREE-LOG"), underway)
    ship = assumed_ship(chosen, {"b": -0.6, "e": 2.5, "k_q": 2.02})
    limits = replace(
        test.plan.limits, engine_speed_rpm=1600.0, brake_torque_nm=2570.0 / (3.82 * 0.97), demand_cycle_s=None
    )
    plan = replace(test.plan, ship=ship, limits=limits)
    line = replace(test.line, offset_v=-6.66, slope_rpm_per_v=-251.0)
    changed = {"plan": plan, "line": line}
    return PlannedTest(**{name: getattr(test, name) for name in test.__slots__} | changed), underway


def test_underway_the_ship_of_the_vessel_file_sails_free(test_underway):
    test, underway = test_underway
    tug = tug_of_plan(test, underway)
    sailed = normalised_truth(tug, underway)
    assert tug.sailing.wake_fraction == underway.hull.wake_fraction
    truth = simulated_truth(test.plan, sailed)
    # slopes and times are those of the ship that sails, whatever the plan assumed; its gauge has no zero
    for name in ("a", "b", "e", "tau_u"):
        assert truth[name] == pytest.approx(sailed[name])
    assert truth["(2 - a) / tau_u"] == pytest.approx((2.0 - sailed["a"]) / sailed["tau_u"])
    assert (truth["k_q"], truth["t_log"]) == (2.0, 0.0)
    assert "c_set" not in truth
    assert truth["K_p"] == test.plan.ship.by_name["K_p"]


@pytest.mark.slow
def test_raw_recordings_give_the_assumed_numbers_back(longer_test, vessel):
    rehearsal = rehearse_on_tug(longer_test, vessel, count=2)
    assert rehearsal.failures == ()
    assert {"K_p", "t_d", "tau_dn", "tau_up", "t_d + t_sp"} <= set(rehearsal.names)
    z = rehearsal.errors / rehearsal.stated
    assert np.abs(z).max() < 4.5
    assert np.sqrt(np.mean(z**2)) < 1.8
    errors = dict(zip(rehearsal.names, np.abs(rehearsal.errors).max(axis=0), strict=True))
    # the wrong sign of the line, or the working point of a leg as that of the plan, would be off by tens of percent
    assert errors["tau_dn"] < 0.01 * 0.36
    assert errors["K_p / K_i"] < 0.2 * 4.9 / 3.9
