"""Limits of raw recordings whose truth is drawn: two of the Monte Carlo in ``benchmarks/limits.py``."""

import pytest
from benchmarks.limits import CAMPAIGN, VESSEL, drawn

from shaftprint.limits import Kind, identify_limits
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.tug import sail

pytestmark = pytest.mark.full_size


@pytest.fixture(scope="module")
def limits_of(tmp_path_factory):
    """Truth, and what the program finds, of the ship of a seed."""

    def look(seed):
        one = drawn(seed)
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
