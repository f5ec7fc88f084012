"""Limits of raw recordings whose truth is drawn: lines of the Monte Carlo in ``benchmarks/limits.py``."""

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.limits import CAMPAIGN, VESSEL, drawn
from benchmarks.one_fit import CAMPAIGN as SHORT
from benchmarks.one_fit import ship

from shaftprint.limits import Kind, identify_limits
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.tug import Tug, sail

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def limits_of(tmp_path_factory):
    """Truth, and what the program finds, of the ship of a seed."""

    def look(seed, **changed):
        one = drawn(seed)
        one = replace(one, tug=replace(one.tug, **changed))
        path = tmp_path_factory.mktemp("limits") / f"{seed}.nc"
        sail(one.vessel, CAMPAIGN, path, tug=one.tug, seed=seed)
        with read_recording(path) as recording:
            signals = prepare_signals(recording, VESSEL, CAMPAIGN)
        return one, identify_limits(signals, CAMPAIGN, VESSEL)

    return look


@pytest.fixture(scope="module")
def both_torque_limits_of(tmp_path_factory):
    """Highest and lowest torque over the full-load torque, and what the program finds, of a ship of ``one_fit``."""

    def look(seed):
        tug, share = ship(seed)
        torques = tuple(share * torque for torque in VESSEL.engine.full_load_torque_nm)
        sailed = VESSEL.model_copy(update={"engine": VESSEL.engine.model_copy(update={"full_load_torque_nm": torques})})
        path = tmp_path_factory.mktemp("torque") / f"{seed}.nc"
        sail(sailed, SHORT, path, tug=tug, seed=seed)
        with read_recording(path) as recording:
            signals = prepare_signals(recording, VESSEL, SHORT)
        return share, -tug.motoring_torque_nm, identify_limits(signals, SHORT, VESSEL)

    return look


def number(found, name):
    return next(one for one in found.numbers if one.name == name)


@pytest.mark.long
def test_a_line_that_rests_near_its_torque_limit(limits_of):
    """Seed 24 has a second optimum, its level 10 % lower and with the limit acting at rest."""
    one, found = limits_of(24)
    share = number(found, "share")
    assert found.kinds == (Kind.TORQUE,)
    # 43 % below the curve of the vessel file, where a lack of air looks alike
    assert "below the full-load curve" in share.doubt
    assert share.ends_95[0] <= one.levels["share"] <= share.ends_95[1]
    assert np.ptp(share.ends_95) < 0.12 * one.levels["share"]


@pytest.mark.long
def test_a_cycle_whose_phase_drifts_from_jump_to_jump(limits_of):
    """Seed 17: messages of 89.5 ms, jumps every 30 s: each 4 ms later in the cycle than the one before."""
    one, found = limits_of(17)
    cycle = number(found, "T_set")
    assert Kind.HELD in found.kinds
    assert cycle.ends_95[0] <= one.levels["T_set"] <= cycle.ends_95[1]
    assert cycle.ends_95[1] < 0.25


@pytest.mark.long
def test_a_set_point_with_a_limited_rate(limits_of):
    """Seed 57: 403 rpm/s. On the grid of the simulation the rate came out four deviations too low."""
    one, found = limits_of(57)
    rate = number(found, "r_s_rpm")
    assert found.kinds == (Kind.RAMP,)
    assert not rate.doubt
    assert rate.ends_95[0] <= one.levels["r_s_rpm"] <= rate.ends_95[1]
    assert np.ptp(rate.ends_95) < 0.05 * one.levels["r_s_rpm"]


@pytest.mark.long
def test_a_set_point_that_goes_on_in_steps(limits_of):
    """The ship of seed 5 with a set point in steps of 16 rpm instead of messages."""
    _, found = limits_of(5, demand_cycle_s=None, demand_resolution_rpm=16.0)
    step = number(found, "q_rpm")
    assert found.kinds == (Kind.QUANTUM,)
    assert not step.doubt
    assert step.ends_95[0] <= 16.0 <= step.ends_95[1]
    assert np.ptp(step.ends_95) < 2.0


@pytest.mark.long
def test_two_limits_that_hold_each_other_in_place_of_the_true_ones(both_torque_limits_of):
    """Seed 103: a slow set point joins first, then messages; neither goes alone, 2 log L 680 worse than the truth."""
    share, lowest_nm, found = both_torque_limits_of(103)
    assert set(found.kinds) == {Kind.TORQUE, Kind.MOTORING}
    for name, true in (("share", share), ("M_min", lowest_nm)):
        lower, upper = number(found, name).ends_95
        assert lower <= true <= upper, name


@pytest.mark.long
def test_a_loaded_engine_without_air_gets_no_slow_set_point(tmp_path):
    """Half loaded, 0.455 of full load without boost, 1.2 s of lag: a free search ends at 0.37, or at 49 rpm/s."""
    share = 0.5
    torques = tuple(share * torque for torque in VESSEL.engine.full_load_torque_nm)
    vessel = VESSEL.model_copy(update={"engine": VESSEL.engine.model_copy(update={"full_load_torque_nm": torques})})
    tug = Tug(
        proportional_gain=5.4, unboosted_torque_share=0.455, turbocharger_lag_s=1.2, set_point_bend_per_v=0.002
    )  # fmt: skip
    path = tmp_path / "loaded.nc"
    sail(vessel, CAMPAIGN, path, tug=tug, seed=1)
    with read_recording(path) as recording:
        signals = prepare_signals(recording, vessel, CAMPAIGN)
    found = identify_limits(signals, CAMPAIGN, vessel)
    assert set(found.kinds) == {Kind.SMOKE, Kind.MOTORING}
    air = number(found, "a_0")
    assert air.ends_95[0] <= 0.455 <= air.ends_95[1]
    # the set point's line is hardly known beside a speed that falls behind it, and the interval says so
    assert "fell behind the set point" in air.doubt
    assert abs(air.value - 0.455) < 0.03
    assert min(found.gains.values()) > 25.0
    assert not any(estimate.at_bound for estimate in found.governor)
