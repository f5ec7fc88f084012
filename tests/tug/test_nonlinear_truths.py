"""Deadband, rate limit of the rack and smoke limiter of the simulated tug, against what they must do."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals

from shaftprint.errors import SettingsError
from shaftprint.tug import Tug, read_truth, sail, truth_path
from shaftprint.vessel import Vessel

Make = Callable[..., Any]
UP_AND_DOWN = {"name": "St", "levels_v": [-4.0, -6.0, -4.0], "dwell_s": 20.0, "start_s": 5.0}


def test_a_governor_does_nothing_inside_its_deadband(vessel: Vessel, quiet_tug: Tug, ask: Make, sine: Make) -> None:
    # 0.03 V ask for 7.5 rpm
    tug = replace(quiet_tug, governor_deadband_rpm=8.0)
    signals = simulate_signals(vessel, ask(25.0, sines=[sine(0.5, 0.03)]), tug=tug)
    assert np.ptp(signals.engine_speed_rev_s) < 1e-9
    moved = simulate_signals(vessel, ask(25.0, sines=[sine(0.5, 0.03)]), tug=quiet_tug)
    assert 60.0 * np.ptp(moved.engine_speed_rev_s) > 10.0


def test_speed_stops_at_the_edge_of_the_deadband(vessel: Vessel, quiet_tug: Tug, ask: Make) -> None:
    tug = replace(quiet_tug, governor_deadband_rpm=8.0)
    levels = {"name": "St", "levels_v": [-4.0, -5.0, -4.0], "dwell_s": 60.0, "start_s": 0.0}
    signals = simulate_signals(vessel, ask(180.0, staircases=[levels]), tug=tug)
    error = 60.0 * (signals.set_point_rev_s - signals.engine_speed_rev_s)
    ends = error[[60 * 200 - 10, 120 * 200 - 10, 180 * 200 - 10]]
    assert np.abs(ends).max() < 8.0 * 1.001
    # a creep towards the edge, from the side of the last move
    assert abs(ends[1]) == pytest.approx(8.0, rel=0.02)


def test_the_rack_moves_no_faster_than_its_limit(vessel: Vessel, quiet_tug: Tug, ask: Make) -> None:
    campaign = ask(70.0, staircases=[UP_AND_DOWN])
    free = simulate_signals(vessel, campaign, tug=quiet_tug, rate_hz=2000.0)
    slow = simulate_signals(vessel, campaign, tug=replace(quiet_tug, rack_rate_limit_per_s=1.5), rate_hz=2000.0)
    change = 2000.0 * np.diff(slow.rack_given)
    assert np.abs(change).max() == pytest.approx(1.5, rel=1e-9)
    assert change.min() == pytest.approx(-1.5, rel=1e-9)
    assert 2000.0 * np.abs(np.diff(free.rack_given)).max() > 100.0
    assert slow.limited.mean() > free.limited.mean()


def test_torque_waits_for_the_boost(vessel: Vessel, quiet_tug: Tug, ask: Make) -> None:
    share, lag_s = 0.5, 1.2
    tug = replace(quiet_tug, unboosted_torque_share=share, turbocharger_lag_s=lag_s)
    signals = simulate_signals(vessel, ask(70.0, staircases=[UP_AND_DOWN]), tug=tug, rate_hz=2000.0)
    rpm = 60.0 * signals.engine_speed_rev_s
    full_load = np.interp(rpm, vessel.engine.full_load_speed_rpm, vessel.engine.full_load_torque_nm)
    used = signals.brake_torque_nm / full_load
    boost = np.empty_like(used)
    boost[0] = used[0]
    for k in range(used.size - 1):
        boost[k + 1] = used[k] + (boost[k] - used[k]) * np.exp(-1.0 / (2000.0 * lag_s))
    allowed = share + (1.0 - share) * boost
    assert np.all(used <= allowed + 1e-3)
    up = slice(round(25.0 * 2000.0), round(27.0 * 2000.0))
    # the torque rests on the limit for longer than a tenth of a second
    assert np.count_nonzero(used[up] > 0.99 * allowed[up]) > 0.1 * 2000.0
    # steady running is not limited: the level of -4 V is reached before the staircase stops
    assert rpm[round(64.9 * 2000.0)] == pytest.approx(1183.8 - 250.97, rel=1e-4)


def test_up_is_slower_than_down_behind_a_smoke_limiter(vessel: Vessel, quiet_tug: Tug, ask: Make) -> None:
    tug = replace(quiet_tug, unboosted_torque_share=0.45, motoring_torque_nm=5000.0)
    signals = simulate_signals(vessel, ask(70.0, staircases=[UP_AND_DOWN]), tug=tug)
    rpm = 60.0 * signals.engine_speed_rev_s
    middle = 1183.8
    up = np.flatnonzero(rpm[25 * 200 :] > middle)[0] / 200.0
    down = np.flatnonzero(rpm[45 * 200 :] < middle)[0] / 200.0
    assert up > 1.3 * down


def test_a_smoke_limiter_without_effect_changes_nothing(vessel: Vessel, quiet_tug: Tug, ask: Make) -> None:
    campaign = ask(70.0, staircases=[UP_AND_DOWN])
    plain = simulate_signals(vessel, campaign, tug=quiet_tug)
    idle = simulate_signals(
        vessel,
        campaign,
        tug=replace(quiet_tug, unboosted_torque_share=1.0, turbocharger_lag_s=0.6, rack_rate_limit_per_s=1e9),
    )
    assert np.array_equal(plain.engine_speed_rev_s, idle.engine_speed_rev_s)


def test_the_truth_is_told(vessel: Vessel, quiet_tug: Tug, ask: Make, tmp_path) -> None:
    tug = replace(quiet_tug, governor_deadband_rpm=6.0, rack_rate_limit_per_s=2.0, unboosted_torque_share=0.5)
    path = tmp_path / "a.nc"
    sail(vessel, ask(3.0), path, tug=tug, seed=1)
    told = read_truth(truth_path(path)).physical
    assert told["deadband_rev_s"] == pytest.approx(0.1)
    assert told["rack_rate_limit_per_s"] == 2.0
    assert told["unboosted_torque_share"] == 0.5
    assert told["turbocharger_lag_s"] == 1.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"governor_deadband_rpm": -1.0}, "governor_deadband_rpm of at least 0, found -1"),
        ({"rack_rate_limit_per_s": 0.0}, "rack_rate_limit_per_s above 0, found 0"),
        ({"unboosted_torque_share": 1.2}, "unboosted_torque_share of at most 1, found 1.2"),
        ({"rack_rate_limit_per_s": 1.0, "governor_delay_s": 0.0}, "expected a governor_delay_s with rack_rate_limit"),
    ],
)
def test_unphysical_truths_are_refused(
    vessel: Vessel, quiet_tug: Tug, ask: Make, change: dict[str, float], message: str
) -> None:
    with pytest.raises(SettingsError, match=message):
        simulate_signals(vessel, ask(), tug=replace(quiet_tug, **change))
