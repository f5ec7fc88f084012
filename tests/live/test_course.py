"""What is to come is changed while a test is played: by what is known, and by the operator."""

import threading
from dataclasses import replace

import numpy as np
import pytest
from tests.live.rehearsed import CAMPAIGN, ENVELOPE, TUG, VESSEL, played

import shaftprint as sp
from shaftprint.live._block import DeviceMode
from shaftprint.live._changes import Advice, begun_until, by_information, end_of_cut, followed_by
from shaftprint.live._engine import LiveTest
from shaftprint.live._outcome import Ask
from shaftprint.live._record import LiveRecord
from shaftprint.live._rehearse import simulated_ship_of
from shaftprint.live._timetable import rendered
from shaftprint.live.counterparts._faults import LinkFaults
from shaftprint.live.counterparts._simulated import SimulatedCounterpart

# Ramps of 2 s; M1 from 3 to 17.1 s with 4 periods of 3 s from 5 s on, M2 from 20 to 31.1 s with 3 from 22 s on.
M1, M2 = CAMPAIGN.legs
# Two sines without ramps, and nothing behind the last.
SINES = sp.campaign.Campaign.model_validate(
    {
        "name": "two sines",
        "duration_s": 16.0,
        "offset_v": -5.0,
        "sines": (
            {
                "name": "S1",
                "frequency_hz": 0.5,
                "amplitude_v": 0.3,
                "start_s": 1.0,
                "settled_s": 3.0,
                "stop_s": 9.0,
            },
            {
                "name": "S2",
                "frequency_hz": 1.0,
                "amplitude_v": 0.3,
                "start_s": 10.0,
                "settled_s": 11.0,
                "stop_s": 16.0,
            },
        ),
    }
)


def may(campaign):
    """Prove nothing: whatever is proposed may be played."""
    return ()


def changed(advice, leg=M1, *, played=2, soonest=3, most_s=CAMPAIGN.duration_s):
    return by_information(CAMPAIGN, leg, advice, played=played, soonest=soonest, fewest=2, most_s=most_s, like=CAMPAIGN)


def told(test, kind):
    return [event.sentence for event in test.record.events if event.kind == kind]


def asks_at(times):
    """Ask for things at times of the campaign [s]."""
    left = dict(times)

    def shown(test, sight):
        for at_s in [one for one in left if test.campaign_s >= one]:
            test.operator.asks.append(left.pop(at_s))

    return shown


def volts_of(ship):
    return np.array([row[:2] for row in ship.trace])


def test_a_leg_ends_where_nothing_more_is_wished_of_it_and_the_next_follows_for_longer():
    after = changed(Advice(more={"M1": 0, "M2": 4}, recorded={"M1": 2}))
    first, second = after.legs
    # three periods can be reached: 5 + 9 s; then the ramp of 2 s
    assert first.stop_s == pytest.approx(14.0)
    assert (second.start_s, second.periods) == (pytest.approx(16.0), 4)
    # as much time passes at the end as before: 36 - 31.1 s
    assert after.duration_s - second.stop_s == pytest.approx(4.9)
    # where all is known already each leg to come begins as it was asked for, or with two more than the fewest periods
    enough = changed(Advice(more={"M1": 0, "M2": 0}, recorded={"M1": 2}))
    assert [leg.periods for leg in enough.legs] == [3, 3]


def test_a_leg_goes_on_as_far_as_the_time_allows():
    advice = Advice(more={"M1": 9, "M2": 2}, recorded={"M1": 3})
    assert changed(advice, played=2) is None
    after = changed(advice, played=3, soonest=4)
    # twelve periods of M1 are wished; within 36 s there is room for 5: 5 + 15 + 2 + 2 + 6 + 4.9
    assert [leg.periods for leg in after.legs] == [5, 2]
    assert after.duration_s <= CAMPAIGN.duration_s
    assert [leg.periods for leg in changed(advice, played=3, soonest=4, most_s=80.0).legs] == [12, 3]


def test_the_last_leg_is_followed_by_one_that_tells_more_where_there_is_time():
    advice = Advice(more={"M1": 3, "M2": 0}, recorded={"M1": 4, "M2": 2})
    after = changed(advice, M2, played=2, soonest=3, most_s=60.0)
    assert [(leg.name, leg.periods, leg.level_v) for leg in after.legs] == (
        [("M1", 4, -5.0), ("M2", 3, -4.6), ("M1-2", 3, -5.0)]
    )
    # without the time for two periods of it the test ends
    after = changed(advice, M2, played=2, soonest=3)
    assert [leg.name for leg in after.legs] == ["M1", "M2"]


def test_legs_follow_by_what_they_tell():
    third = M2.model_copy(update={"name": "M3", "start_s": 35.0, "settled_s": 37.0, "stop_s": 46.1, "level_v": -5.4})
    three = CAMPAIGN.model_copy(update={"multisines": (*CAMPAIGN.multisines, third), "duration_s": 52.0})
    advice = Advice(more={"M1": 0, "M2": 2, "M3": 5}, recorded={"M1": 3})
    after = by_information(three, M1, advice, played=3, soonest=4, fewest=2, most_s=60.0, like=three)
    assert [(leg.name, leg.periods) for leg in after.legs] == [("M1", 4), ("M3", 5), ("M2", 3)]
    # what was made can be loaded
    sp.campaign.Campaign.model_validate(after.model_dump(exclude_none=True))


def test_steps_behind_the_legs_are_played_when_the_legs_have_ended_early():
    """A planned test ends with a staircase: nothing was ever changed by what is known where one was to come."""
    stairs = sp.campaign.Staircase(name="St1", levels_v=(-4.9, -5.1), dwell_s=4.0, start_s=34.0)
    planned = CAMPAIGN.model_copy(update={"staircases": (stairs,), "duration_s": 45.0})
    enough = Advice(more={"M1": 0, "M2": 0}, recorded={"M1": 4, "M2": 2})
    after = by_information(planned, M2, enough, played=2, soonest=2, fewest=2, most_s=45.0, like=planned)
    assert [(leg.name, leg.periods) for leg in after.legs] == [("M1", 4), ("M2", 2)]
    (moved,) = after.staircases
    # 28 s, when the second period of M2 ends, and the ramp of 2 s
    assert (moved.start_s, moved.stop_s - moved.start_s) == (pytest.approx(30.0), 8.0)
    assert after.duration_s == pytest.approx(41.0)
    # a leg behind the steps is where it was asked for
    between = CAMPAIGN.model_copy(update={"staircases": (stairs.model_copy(update={"start_s": 17.5, "dwell_s": 1.0}),)})
    assert by_information(between, M1, enough, played=3, soonest=3, fewest=2, most_s=45.0, like=between) is None


def test_a_ramp_that_is_under_way_goes_on_to_its_leg():
    begun, to_come = begun_until(CAMPAIGN, 18.5)
    assert [one.name for one in begun] == ["M1", "M2"]
    assert (begun[1].start_s, begun[1].stop_s, to_come) == (20.0, 20.0, ())
    begun, to_come = begun_until(CAMPAIGN, 17.5)
    assert ([one.name for one in begun], [one.name for one in to_come]) == (["M1"], ["M2"])
    after = followed_by(CAMPAIGN, begun, to_come, from_s=18.0, like=CAMPAIGN)
    assert after.legs[1].start_s == pytest.approx(20.0)


def test_after_a_hold_the_set_point_goes_from_where_it_stands():
    # the ramp of a file begins where the leg stops: held since, it begins when somebody says so
    begun, _ = begun_until(CAMPAIGN, 27.3)
    after = followed_by(CAMPAIGN, begun, (), from_s=50.0, from_v=-4.2, like=CAMPAIGN)
    play = rendered(after, zero_s=100.0, from_s=50.0, from_v=-4.2)
    assert play.start_s == pytest.approx(150.0)
    assert play.value_at(np.array([150.0, 151.0, 152.0, 153.0])) == pytest.approx([-4.2, -4.6, -5.0, -5.0])
    # a leg that is played again out of the ramp back: it is there when it begins, by a ramp as fast as others
    fast = CAMPAIGN.model_copy(update={"ramp_s": None, "ramp_v_per_s": 0.1})
    after = followed_by(fast, (M1,), (M2,), from_s=18.0, from_v=-5.2, like=fast)
    play = rendered(after, zero_s=0.0, from_s=18.0, from_v=-5.2)
    first_v = float(M2.value_at(np.array([M2.start_s]))[0])
    assert after.legs[1].start_s - 18.0 == pytest.approx((first_v + 5.2) / 0.1)
    before = play.volts[play.start_s + np.arange(play.volts.size) / play.rate_hz < after.legs[1].start_s]
    assert np.diff(before) == pytest.approx(0.1 / play.rate_hz)
    assert (before[0], before[-1]) == (pytest.approx(-5.2), pytest.approx(first_v, abs=1e-3))


def test_a_sine_ends_where_it_passes_through_its_middle():
    (sine, _) = SINES.sines
    assert end_of_cut(sine, 3.3) == pytest.approx(4.0)
    assert end_of_cut(sine, 4.0) == pytest.approx(4.0)
    assert end_of_cut(sine, 0.2) == pytest.approx(1.0)
    assert end_of_cut(sine, 8.9) == pytest.approx(9.0)
    assert end_of_cut(sine.model_copy(update={"phase_rad": np.pi / 2.0}), 3.3) == pytest.approx(3.5)


@pytest.mark.slow
def test_what_is_known_changes_the_legs_and_leaves_the_campaign_as_it_was_played(tmp_path):
    async def advises(test):
        return Advice(more={"M1": 0, "M2": 1}, recorded={"M1": 2, "M2": 2})

    outcome, test, ship = played(tmp_path, advises=advises, proves=may, fewest_periods=2, waits=True)
    assert (outcome.word, ship.device.mode) == ("played", DeviceMode.LEVER)
    first, second = outcome.campaign.multisines
    # two periods are known at 11 s of the campaign; the change needs a second, so that the third ends at 14 s
    assert first.stop_s - first.start_s == pytest.approx(11.0)
    assert second.start_s - first.stop_s == pytest.approx(2.0)
    assert (first.periods, second.periods) == (3, 3)
    left = test.record.finish(outcome.campaign)
    with sp.recording.read_recording(left.recording) as recording:
        found = sp.signals.find_tests(recording, VESSEL, sp.campaign.load_campaign(left.campaign))
        assert [abs(one.later_s) < 0.01 for one in found] == [True, True]


@pytest.mark.slow
def test_what_is_known_is_asked_for_less_often_while_much_is_missing(tmp_path):
    """Of eight periods with eight missing after the second: after a quarter of them, and before the leg ends."""
    asked = []

    async def advises(test):
        (periods,) = {one.periods for one in test.judgements["M1"]}
        asked.append(periods)
        return Advice(more={"M1": 10 - periods}, recorded={"M1": periods})

    longer = M1.model_copy(update={"stop_s": M1.settled_s + 8.03 * M1.period_s})
    campaign = CAMPAIGN.model_copy(update={"multisines": (longer,)})
    outcome, _, _ = played(tmp_path, campaign=campaign, advises=advises, fewest_periods=2, waits=True)
    assert outcome.word == "played"
    assert asked == [2, 4, 6, 7]


@pytest.mark.slow
def test_nothing_is_played_that_was_not_proved(tmp_path):
    async def advises(test):
        return Advice(more={"M1": 0, "M2": 1}, recorded={"M1": 2, "M2": 2})

    def refuses(campaign):
        return ("engine speed: it would leave the envelope.",)

    outcome, test, _ = played(tmp_path, advises=advises, proves=refuses, fewest_periods=2, waits=True)
    assert outcome.word == "played"
    assert [leg.periods for leg in outcome.campaign.multisines] == [4, 3]
    assert "would leave the envelope" in told(test, "not done")[0]


@pytest.mark.slow
def test_the_operator_holds_skips_and_repeats(tmp_path):
    # held in M1's third period, which leaves two whole ones; after the hold there are two of it to come, and M2
    asks = {11.5: Ask.HOLD, 16.0: Ask.REPEAT, 17.0: Ask.GO_ON, 30.0: Ask.SKIP}
    outcome, test, ship = played(tmp_path, proves=may, shown=asks_at(asks), waits=True)
    assert (outcome.word, ship.device.mode) == ("played", DeviceMode.LEVER)
    states = told(test, "state")
    assert states[3:6] == ["leg", "hold", "ramp in"]
    assert '"repeat" has no meaning while the test holds' in told(test, "not done")[0]
    # cut a second after it was asked for; M2 was skipped while its ramp was under way or its first period ran
    zero_s = outcome.campaign.legs[0].start_s - 3.0
    assert outcome.campaign.legs[0].stop_s - zero_s == pytest.approx(12.5, abs=0.11)
    assert [(leg.name, leg.periods) for leg in outcome.campaign.legs] == [("M1", 2), ("M1-2", 2)]
    # what was judged is what was played
    assert {one.line.partition("/")[0] for one in outcome.judgements} == {"M1", "M1-2"}
    # the set point stands still in the hold, and jumps nowhere
    volts = volts_of(ship)
    held = volts[(volts[:, 0] > zero_s + 13.0) & (volts[:, 0] < zero_s + 17.0), 1]
    assert np.ptp(held) < 1e-9
    assert np.abs(np.diff(volts[:, 1])).max() < 0.2


@pytest.mark.slow
def test_a_leg_is_played_again_after_itself_and_a_hold_ends_with_the_time_of_the_program(tmp_path):
    outcome, *_ = played(tmp_path, proves=may, shown=asks_at({8.0: Ask.REPEAT, 22.0: Ask.SKIP}), waits=True)
    assert [(leg.name, leg.periods) for leg in outcome.campaign.legs] == [("M1", 4), ("M2", 3)]
    folder = tmp_path / "held"
    folder.mkdir()
    short = replace(ENVELOPE, longest_s=20.0)
    outcome, _, ship = played(folder, proves=may, shown=asks_at({9.0: Ask.HOLD}), envelope=short)
    assert (outcome.word, ship.device.mode) == ("aborted", DeviceMode.LEVER)
    assert "may not rule for longer" in outcome.reason


@pytest.mark.slow
@pytest.mark.parametrize("plays_waveform", [True, False])
def test_a_leg_is_repeated_out_of_the_ramp_back_and_a_hold_of_the_last_one_ends(tmp_path, plays_waveform):
    # M2 ends at 31.1 s; from 32.2 s on the set point goes to it again, which begins at 34.2 s and is held from 43 s on
    asks = {31.15: Ask.REPEAT, 42.0: Ask.HOLD, 46.0: Ask.GO_ON}
    outcome, test, ship = played(tmp_path, proves=may, shown=asks_at(asks), waits=True, plays_waveform=plays_waveform)
    assert (outcome.word, outcome.reason, told(test, "not done")) == ("played", "", [])
    assert [(leg.name, leg.periods) for leg in outcome.campaign.legs] == [("M1", 4), ("M2", 3), ("M2-2", 2)]
    zero_s = outcome.campaign.legs[0].start_s - 3.0
    volts = volts_of(ship)
    assert np.abs(np.diff(volts[:, 1])).max() < 0.2
    # as it stands in the campaign, until the hold and from its beginning on
    inside = (volts[:, 0] > zero_s + 34.3) & (volts[:, 0] < zero_s + 42.8)
    again = outcome.campaign.legs[2]
    by_campaign = again.value_at(volts[inside, 0])
    assert np.abs(volts[inside, 1] - by_campaign).max() < 0.15
    held = volts[(volts[:, 0] > zero_s + 43.2) & (volts[:, 0] < zero_s + 46.8), 1]
    assert np.ptp(held) < 1e-9


@pytest.mark.slow
def test_sines_are_held_skipped_and_repeated(tmp_path):
    # S1 is cut at 6 s, where it passes through its middle; S2 follows a second after 9 s, and again a second after 17 s
    campaign = SINES.model_copy(update={"duration_s": 17.0})
    asks = {4.3: Ask.HOLD, 7.0: Ask.SKIP, 8.0: Ask.GO_ON, 16.1: Ask.REPEAT, 19.3: Ask.SKIP}
    outcome, test, ship = played(tmp_path, campaign=campaign, proves=may, shown=asks_at(asks), waits=True)
    assert (outcome.word, outcome.reason, told(test, "not done")) == ("played", "", [])
    assert [(sine.name, sine.periods) for sine in outcome.campaign.sines] == [("S1", 1), ("S2", 5), ("S2-2", 1)]
    volts = volts_of(ship)[:, 1]
    assert np.abs(np.diff(volts)).max() < 0.2
    # a change that ends the campaign where its last test was cut
    folder = tmp_path / "cut"
    folder.mkdir()
    outcome, *_ = played(folder, campaign=SINES, proves=may, shown=asks_at({12.2: Ask.SKIP}), waits=True)
    assert (outcome.word, outcome.reason, outcome.is_back) == ("played", "", True)


@pytest.mark.slow
def test_a_proof_that_takes_long_skips_no_other_leg(tmp_path):
    proved = threading.Event()

    def may_late(campaign):
        proved.wait(60.0)
        return ()

    def shown(test, sight):
        asks(test, sight)
        if test.campaign_s > 22.0:
            proved.set()

    # asked for a second and a half before M1 ends; the answer is there when M2 is played
    asks = asks_at({15.5: Ask.SKIP})
    outcome, test, _ = played(tmp_path, proves=may_late, shown=shown)
    assert [(leg.name, leg.periods) for leg in outcome.campaign.legs] == [("M1", 4), ("M2", 3)]
    assert told(test, "not done") == ["Nothing is changed: it is too late."]


def test_what_was_asked_before_there_was_a_test_is_left_out_but_a_hold(tmp_path):
    ship = simulated_ship_of(VESSEL, CAMPAIGN, seed=1, faults=LinkFaults(), tug=TUG)
    counterpart, said = SimulatedCounterpart(ship), []
    record = LiveRecord(tmp_path / "test.nc", counterpart.channels, {})
    test = LiveTest(
        counterpart=counterpart, vessel=VESSEL, campaign=CAMPAIGN, envelope=ENVELOPE, record=record, told=said.append
    )
    test.operator.asks.extend([Ask.SKIP, Ask.HOLD, Ask.REPEAT])
    test._forget_early_asks()
    record.close()
    assert list(test.operator.asks) == [Ask.HOLD]
    assert [event.sentence.split()[0] for event in said] == ['"skip"', '"repeat"']


@pytest.mark.slow
def test_a_test_that_begins_at_once_is_played_and_nothing_is_skipped_that_was_asked_for_before(tmp_path):
    first, _ = SINES.sines
    at_once = SINES.model_copy(
        update={"sines": (first.model_copy(update={"start_s": 0.0, "settled_s": 2.0}),), "duration_s": 12.0}
    )

    def shown(test, sight):
        if not test.is_ruling and not test.operator.asks:
            test.operator.asks.append(Ask.SKIP)

    outcome, test, ship = played(tmp_path, campaign=at_once, proves=may, shown=shown, waits=True)
    assert (outcome.word, outcome.reason, ship.device.mode) == ("played", "", DeviceMode.LEVER)
    assert told(test, "state") == ["armed", "settle", "leg", "ramp out", "idle"]
    assert [(sine.name, sine.periods) for sine in outcome.campaign.sines] == [("S1", 3)]
    assert told(test, "not done") == ['"skip" has no meaning before the test is played.']
