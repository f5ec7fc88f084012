"""A live test on a simulated ship: what is played, what is refused, what is aborted and why."""

import math
import socket
import threading
import time
from dataclasses import replace

import numpy as np
import pytest
from tests.live.rehearsed import CAMPAIGN, ENVELOPE, TUG, VESSEL, played

import shaftprint as sp
from shaftprint.live._block import DeviceMode
from shaftprint.live._envelope import SPEED
from shaftprint.live._rehearse import simulated_ship_of
from shaftprint.live._watch import AbortRule
from shaftprint.live.counterparts._faults import LinkFaults, Spell
from shaftprint.live.counterparts._mqtt_device import expect_server, free_port

# The campaign is played from 13.3 s on.
IN_A_LEG = Spell(start_s=20.0)


def kinds(test):
    return [event.kind for event in test.record.events]


@pytest.mark.slow
def test_a_sound_ship_is_played_judged_and_given_back(tmp_path):
    outcome, test, ship = played(tmp_path)
    assert (outcome.word, outcome.reason, outcome.is_back) == ("played", "", True)
    assert [event.sentence for event in test.record.events if event.kind == "state"] == (
        ["armed", "ramp in", "settle", "leg", "ramp in", "settle", "leg", "ramp out", "idle"]
    )
    assert ship.device.mode is DeviceMode.LEVER
    # four periods of M1 and three of M2, three lines each
    assert [(one.line, one.periods) for one in outcome.judgements] == [
        *[(f"M1/{k}", 4) for k in (1, 3, 5)],
        *[(f"M2/{k}", 3) for k in (1, 3, 5)],
    ]
    left = test.record.finish(outcome.campaign)
    # the times of the recording are those of the campaign as it was played, to a sample
    with sp.recording.read_recording(left.recording) as recording:
        found = sp.signals.find_tests(recording, VESSEL, sp.campaign.load_campaign(left.campaign))
        assert len(found) == 2
        assert [abs(one.later_s) < 0.01 for one in found] == [True, True]


@pytest.mark.parametrize(
    ("faults", "rule", "words"),
    [
        (LinkFaults(frozen=Spell(start_s=20.0, stop_s=22.0)), AbortRule.DATA, "expected a block within 0.5 s"),
        (LinkFaults(silent=IN_A_LEG), AbortRule.DATA, "expected a block within 0.5 s"),
        (LinkFaults(stale=IN_A_LEG), AbortRule.DATA, "repeat their last block"),
        (LinkFaults(not_a_number=IN_A_LEG), AbortRule.DATA, "no numbers"),
        (LinkFaults(stuck_set_point=IN_A_LEG), AbortRule.SET_POINT, "not what is played"),
        (LinkFaults(deaf=IN_A_LEG), AbortRule.DEVICE, "back to the lever"),
        (LinkFaults(clock_step_at_s=20.0, clock_step_s=0.3), AbortRule.DATA, "clock of the counterpart has jumped"),
        (LinkFaults(lost=tuple(range(400, 420))), AbortRule.DATA, "expected a block within 0.5 s"),
        (LinkFaults(stuck_set_point=IN_A_LEG, ignores_abort=True), AbortRule.SET_POINT, "not what is played"),
    ],
)
@pytest.mark.slow
def test_each_fault_ends_in_an_abort_with_its_reason_and_the_lever(tmp_path, faults, rule, words):
    outcome, test, ship = played(tmp_path, faults)
    assert outcome.word == "aborted"
    assert outcome.breach.rule is rule
    assert words in outcome.reason
    assert ship.device.mode is DeviceMode.LEVER
    # who cannot see it does not claim it
    assert outcome.is_back is not math.isfinite(faults.silent.start_s)
    assert ("alarm" in kinds(test)) is math.isfinite(faults.silent.start_s)


@pytest.mark.parametrize(
    ("faults", "words"),
    [
        (LinkFaults(revert_s=3.0), "expected it to give the set point back to the lever within 1 s"),
        (LinkFaults(revert_s=math.inf), "expected it to give the set point back to the lever within 1 s"),
        (LinkFaults(deaf=Spell(start_s=0.0)), "expected the heartbeat back"),
        (LinkFaults(lost=(100,)), "expected every block"),
        (LinkFaults(stale=Spell(start_s=0.2)), "expected channel U_setpoint to be alive"),
    ],
)
def test_nothing_is_armed_that_was_not_seen_to_revert_or_is_not_alive(tmp_path, faults, words):
    outcome, _, ship = played(tmp_path, faults)
    assert outcome.word == "refused"
    assert words in outcome.reason
    assert ship.device.mode is DeviceMode.LEVER
    # the set point never left the lever
    assert np.ptp([volts for _, volts, *_ in ship.trace]) == 0.0
    assert outcome.campaign is None


def test_a_governor_that_hunts_is_not_armed(tmp_path):
    outcome, *_ = played(tmp_path, tug=replace(TUG, proportional_gain=12.0))
    assert outcome.word == "refused"
    assert "hunts" in outcome.reason


@pytest.mark.slow
def test_a_swing_that_grows_at_another_speed_is_aborted(tmp_path):
    # the gain goes with the fifth power of the speed: sound at the first level, unstable 13 % above it
    second = CAMPAIGN.multisines[1].model_copy(update={"level_v": -5.7, "amplitudes_v": (0.02, 0.02, 0.02)})
    campaign = CAMPAIGN.model_copy(update={"multisines": (CAMPAIGN.multisines[0], second)})
    outcome, *_ = played(tmp_path, tug=replace(TUG, governor_gain_exponent=8.0), campaign=campaign)
    assert outcome.word == "aborted"
    assert outcome.breach.rule is AbortRule.OSCILLATION


@pytest.mark.slow
def test_lost_and_doubled_blocks_are_named_and_leave_the_rest(tmp_path):
    outcome, test, _ = played(tmp_path, LinkFaults(lost=(500,), doubled=(450,)))
    assert outcome.word == "played"
    assert {"lost", "doubled", "spoilt"} <= set(kinds(test))
    left = test.record.finish(outcome.campaign)
    with sp.recording.read_recording(left.recording) as recording:
        torque = recording.channel("M_s")
        values = torque.values(0, torque.count)
        # one block of 50 ms, where it was
        assert np.flatnonzero(np.isnan(values)).tolist() == list(range(499 * 100, 500 * 100))


@pytest.mark.slow
def test_across_lost_blocks_there_is_no_speed_and_no_oscillation(tmp_path):
    shown = []
    # four in a row, again and again: the pulses before and after a hole are no interval
    lost = tuple(first + k for first in (420, 470, 520, 570) for k in range(4))
    outcome, _, ship = played(
        tmp_path, LinkFaults(lost=lost), shown=lambda _, sight: shown.append((sight.block.counter, sight.speed_rpm))
    )
    assert (outcome.word, outcome.reason) == ("played", "")
    known = [(counter, rpm) for counter, rpm in shown if counter > 410 and math.isfinite(rpm)]
    # the shaft turns in less than three blocks, and its speed is there again a turn later
    assert len(known) > 300
    truth = np.array([row[2] for row in ship.trace])
    for counter, rpm in known:
        near = truth[counter - 5 : counter]
        assert near.min() * 0.98 < rpm < near.max() * 1.02


@pytest.mark.slow
def test_a_device_without_tables_gets_a_set_point_with_every_block(tmp_path):
    outcome, _, ship = played(tmp_path, plays_waveform=False)
    assert outcome.word == "played"
    assert ship.device.mode is DeviceMode.LEVER
    assert min(volts for _, volts, *_ in ship.trace) == pytest.approx(CAMPAIGN.multisines[0].extremes_v[0], abs=0.05)
    fast = CAMPAIGN.multisines[0].model_copy(update={"harmonics": (1, 3, 25)})
    folder = tmp_path / "fast"
    folder.mkdir()
    campaign = CAMPAIGN.model_copy(update={"multisines": (fast,)})
    outcome, *_ = played(folder, plays_waveform=False, campaign=campaign)
    assert (outcome.word, "up to 5 Hz" in outcome.reason) == ("refused", True)


def test_a_limit_is_aborted_within_its_persistence(tmp_path):
    low = replace(ENVELOPE.bound_of(SPEED), lowest=1170.0, highest=1200.0)
    outcome, *_ = played(tmp_path, envelope=replace(ENVELOPE, bounds=(low,)))
    assert outcome.breach.rule is AbortRule.LIMIT
    assert outcome.breach.persistence_s == 0.5
    assert outcome.breach.channel == SPEED


def test_the_operator_stops_it_at_once(tmp_path):
    def stop(test, sight):
        if sight.time_s > 16.0:
            test.operator.stops = "the bridge said stop"

    outcome, _, ship = played(tmp_path, shown=stop)
    assert outcome.breach.rule is AbortRule.OPERATOR
    assert outcome.is_back
    # back at the lever on a cosine of two seconds: the set point never moves faster than pi/2 times its mean rate
    volts = np.array([one[1] for one in ship.trace if one[0] > outcome.breach.time_s])
    assert np.abs(np.diff(volts)).max() <= 1.1 * math.pi / 2.0 * 0.5 / 2.0 * 0.05


def test_a_device_hears_no_heartbeat_over_a_silent_link():
    # it is silent from its first second on: the heartbeat that is sent then is not given back
    ship = simulated_ship_of(VESSEL, CAMPAIGN, seed=1, faults=LinkFaults(silent=Spell(start_s=0.0)), tug=TUG)
    ship.hear(1)
    assert ship.device.heartbeat == 0
    ship = simulated_ship_of(VESSEL, CAMPAIGN, seed=1, faults=LinkFaults(silent=Spell(start_s=60.0)), tug=TUG)
    ship.hear(1)
    assert ship.device.heartbeat == 1


def test_a_server_that_begins_a_little_later_is_waited_for():
    port = free_port()

    def begins():
        time.sleep(0.3)
        with socket.create_server(("127.0.0.1", port)) as server:
            server.accept()[0].close()

    thread = threading.Thread(target=begins)
    thread.start()
    expect_server(port, within_s=20.0)
    thread.join()
