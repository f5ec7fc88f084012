"""Limits of raw recordings whose truth is drawn: lines of the Monte Carlo in ``benchmarks/limits.py``."""

from dataclasses import replace

import pytest
from benchmarks.limits import CAMPAIGN, VESSEL, drawn

from shaftprint.limits import Kind, identify_limits
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.tug import sail

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


def number(found, name):
    return next(one for one in found.numbers if one.name == name)


def test_a_line_that_rests_near_its_torque_limit(limits_of):
    """Seed 24 has a second optimum, its level 10 % lower and with the limit acting at rest."""
    one, found = limits_of(24)
    share = number(found, "share")
    assert found.kinds == (Kind.TORQUE,)
    assert share.trusted
    assert share.lower <= one.levels["share"] <= share.upper
    assert share.upper - share.lower < 0.12 * one.levels["share"]


def test_a_cycle_whose_phase_drifts_from_jump_to_jump(limits_of):
    """Seed 17: messages of 89.5 ms, jumps every 30 s: each 4 ms later in the cycle than the one before."""
    one, found = limits_of(17)
    cycle = number(found, "T_set")
    assert Kind.HELD in found.kinds
    assert cycle.lower <= one.levels["T_set"] <= cycle.upper
    assert cycle.upper < 0.25


def test_a_set_point_with_a_limited_rate(limits_of):
    """Seed 57: 403 rpm/s. On the grid of the simulation the rate came out four deviations too low."""
    one, found = limits_of(57)
    rate = number(found, "r_s_rpm")
    assert found.kinds == (Kind.RAMP,)
    assert rate.trusted
    assert rate.lower <= one.levels["r_s_rpm"] <= rate.upper
    assert rate.upper - rate.lower < 0.05 * one.levels["r_s_rpm"]


def test_a_set_point_that_goes_on_in_steps(limits_of):
    """The ship of seed 5 with a set point in steps of 16 rpm instead of messages."""
    _, found = limits_of(5, demand_cycle_s=None, demand_resolution_rpm=16.0)
    step = number(found, "q_rpm")
    assert found.kinds == (Kind.QUANTUM,)
    assert step.trusted
    assert step.lower <= 16.0 <= step.upper
    assert step.upper - step.lower < 2.0
