"""A gap costs the windows that it touches, and no more: held against the same recording without the gap."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.arrays import runs_of
from shaftprint.campaign import Campaign, load_campaign
from shaftprint.recording import ClockJump
from shaftprint.signals import Gap, prepare_signals
from shaftprint.signals._gaps import Coverage, bridge, gap_findings, joined, merged
from shaftprint.signals.excitation._match import left_out

RATE_HZ = 2000.0


@pytest.fixture(scope="module")
def whole(ship, vessel, campaign):
    return prepare_signals(ship.recording(), vessel, campaign)


def without(start_s, stop_s, value=np.nan):
    """Return a change of counts that puts a value in place of a stretch."""

    def change(counts):
        values = counts.astype(float) if np.isnan(value) else counts
        values[round(start_s * RATE_HZ) : round(stop_s * RATE_HZ)] = value
        return values

    return change


def time_of(signals):
    return signals.start_s + np.arange(signals.samples) / signals.rate_hz


def unchanged(found, whole, name):
    """Return whether a signal is what it was wherever no gap reaches, to the rounding of counts held as floats."""
    arrays = {
        "M_s": lambda signals: signals.shaft_torque_nm,
        "U_setpoint": lambda signals: signals.set_point_rev_s,
        "PTM_e": lambda signals: signals.engine_speed.speed_rev_s,
    }[name]
    outside = ~found.coverage.lost(time_of(found))
    return np.allclose(arrays(found)[outside], arrays(whole)[outside], rtol=1e-9, atol=0.0)


def test_thirty_seconds_of_torque_cost_one_sine(spoiled, vessel, campaign, whole):
    found = prepare_signals(spoiled(M_s=without(165.0, 195.0)), vessel, campaign)
    (gap,) = found.gaps
    assert (gap.channel, gap.reason) == ("M_s", "has no values")
    # the telemetry is late by 5 ms
    assert (gap.start_s, gap.stop_s) == pytest.approx((164.995, 194.995))
    assert found.findings[0] == "channel M_s has no values from 165.00 to 195.00 s; left out for that: S2"
    assert unchanged(found, whole, "M_s")
    assert found.calibration.level_v == pytest.approx(whole.calibration.level_v)
    # the mean load is that of the rest: another one, but by no more than it is known
    point = whole.working_point
    assert found.working_point.shaft_torque_nm == pytest.approx(point.shaft_torque_nm, abs=point.shaft_torque_std_nm)
    missing = found.coverage.missing
    assert missing(118.0, 158.0) == ""
    assert missing(173.0, 193.0) == "channel M_s has no values from 165.00 to 195.00 s"
    assert missing(210.0, 251.0) == "the recording lasts from 0.0 to 250.0 s"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start_s", "stop_s", "lost"),
    [
        (0.0, 3.0, "no test is touched"),
        (100.0, 103.0, "no test is touched"),
        (120.0, 150.0, "left out for that: S1"),
        (140.0, 180.0, "left out for that: S1, S2"),
        (226.0, 250.0, "left out for that: S3"),
    ],
)
@pytest.mark.parametrize("value", [np.nan, 1000.0], ids=["nan", "dead"])
def test_pulses_are_not_counted_over_a_gap(spoiled, vessel, campaign, whole, start_s, stop_s, lost, value):
    found = prepare_signals(spoiled(PTM_e=without(start_s, stop_s, value)), vessel, campaign)
    (gap,) = found.gaps
    assert (gap.channel, gap.reason) == ("PTM_e", "has no pulses")
    # the last and first pulse beside it: 19.5 a second
    assert (gap.start_s, gap.stop_s) == pytest.approx((start_s, stop_s), abs=0.06)
    assert found.findings[0].endswith(lost)
    outside = ~found.coverage.lost(time_of(found))
    speed, true = found.engine_speed.speed_rev_s, whole.engine_speed.speed_rev_s
    assert speed[outside] == pytest.approx(true[outside], rel=2e-4)
    assert found.engine_speed.pulse_rate_hz == pytest.approx(np.mean(true[outside]), rel=1e-3)
    assert not found.repairs


@pytest.mark.slow
def test_strips_are_found_again_behind_a_gap(spoiled, vessel, campaign, whole):
    """All channels lose 3.3 s in a moving part: the count over the gap is a guess, the strips are up to 8 % uneven."""
    lost = dict.fromkeys(("PTM_e", "PTM_1", "PTM_4", "M_s", "U_setpoint"), without(171.0, 174.3))
    found = prepare_signals(spoiled(**lost), vessel, campaign)
    assert list(found.speeds) == ["n_e", "n_e1", "n_e4"]
    assert found.strips[0].angle_rev == pytest.approx(whole.strips[0].angle_rev, abs=2e-5)
    outside = ~found.coverage.lost(time_of(found))
    speed, true = found.speeds["n_e4"].speed_rev_s, whole.speeds["n_e4"].speed_rev_s
    # a wrong strip would be wrong by 8 %
    assert speed[outside] == pytest.approx(true[outside], rel=2e-3)
    assert len([finding for finding in found.findings if "left out for that: S2" in finding]) == 1
    assert "likewise" in found.findings[0]


def test_strips_behind_a_gap_that_cannot_be_placed_belong_to_it(spoiled, vessel, campaign):
    """Half a second of pulses between two gaps: eight strips of a shaft that turns 5.1 times a second."""

    def twice(counts):
        return without(182.5, 185.0)(without(179.0, 182.0)(counts))

    lost = dict.fromkeys(("PTM_e", "PTM_1", "PTM_4", "M_s", "U_setpoint"), twice)
    found = prepare_signals(spoiled(**lost), vessel, campaign)
    assert "n_e4" in found.speeds or any(
        "n_e4 was left out: channel PTM_4 has too few pulses" in f for f in found.findings
    )
    assert "n_e1" in found.speeds


def test_gap_of_another_pick_up_costs_that_pick_up_only(spoiled, vessel, campaign):
    found = prepare_signals(spoiled(PTM_1=without(120.0, 150.0)), vessel, campaign)
    assert list(found.speeds) == ["n_e", "n_e4"]
    assert found.gaps == ()
    assert any(f.startswith("n_e1 was left out: channel PTM_1 has no pulses from 1") for f in found.findings)


def test_nothing_is_taken_from_a_gap(spoiled, vessel, campaign):
    """What stands in the file inside a gap changes nothing, not even the last bit."""

    def dead(value):
        return {"M_s": without(120.0, 140.0, value), "PTM_e": without(175.0, 180.0, value)}

    first, second = (prepare_signals(spoiled(**dead(value)), vessel, campaign) for value in (1000.0, 700.0))
    assert np.array_equal(first.shaft_torque_nm, second.shaft_torque_nm)
    assert first.working_point == second.working_point
    assert first.dc_scale == second.dc_scale
    assert first.step_delays == second.step_delays


@pytest.mark.parametrize("mode", ["shaftprint", "thesis"])
def test_gaps_give_the_same_bits_for_any_chunk(spoiled, vessel, campaign, mode):
    changes = {
        "M_s": without(120.0, 140.0),
        "U_setpoint": without(201.0, 203.5),
        "PTM_e": without(60.0, 66.0),
        "PTM_4": without(60.0, 66.0),
    }
    whole = prepare_signals(spoiled(**changes), vessel, campaign, mode=mode)
    assert [gap.channel for gap in whole.gaps] == ["PTM_e", "M_s", "U_setpoint"]
    for chunk_s in (0.1, 3.3333):
        cut = prepare_signals(spoiled(**changes), vessel, campaign, mode=mode, chunk_s=chunk_s)
        assert cut.gaps == whole.gaps
        assert cut.repairs == whole.repairs
        assert cut.findings == whole.findings
        assert np.array_equal(cut.set_point_rev_s, whole.set_point_rev_s)
        assert np.array_equal(cut.shaft_torque_nm, whole.shaft_torque_nm)
        for name, speed in whole.speeds.items():
            assert np.array_equal(cut.speeds[name].speed_rev_s, speed.speed_rev_s)


def test_dead_from_the_middle_on(spoiled, vessel, campaign):
    found = prepare_signals(spoiled(M_s=without(160.0, 250.0, 321.0)), vessel, campaign)
    assert found.findings[0] == "channel M_s stands still from 160.00 to 250.00 s; left out for that: S2, S3"


def test_one_value_that_is_no_number_is_an_outlier(spoiled, vessel, campaign, whole):
    found = prepare_signals(spoiled(U_setpoint=without(61.728, 61.7285)), vessel, campaign)
    assert found.gaps == ()
    assert [(repair.kind, repair.time_s, repair.count) for repair in found.repairs] == [("outlier", 61.728, 1)]
    assert found.set_point_rev_s == pytest.approx(whole.set_point_rev_s, rel=1e-4)


def test_recording_that_ends_early_uses_what_is_there(spoiled, vessel, campaign, whole):
    found = prepare_signals(spoiled(M_s=lambda counts: counts[:400_000]), vessel, campaign)
    assert found.findings[0] == (
        "the recording lasts from 0.0 to 200.0 s, the campaign to 230.0 s; left out for that: S3"
    )
    assert found.samples == 40_000
    # beyond the end the filter sees the last value
    assert found.shaft_torque_nm[:39_980] == pytest.approx(whole.shaft_torque_nm[:39_980], rel=1e-12)


def test_recording_that_begins_late_uses_what_is_there(ship, vessel, campaign):
    recording = ship.recording()
    late = {
        name: replace(
            channel,
            start_s=38.0,
            count=channel.count - 76_000,
            source=lambda first, stop, channel=channel: channel.read(first + 76_000, stop + 76_000),
        )
        for name, channel in recording.channels.items()
    }
    found = prepare_signals(replace(recording, channels=late), vessel, campaign)
    assert found.start_s == 38.0
    assert found.findings[0].startswith("the recording lasts from 38.0 to 250.0 s")
    assert found.findings[0].endswith("left out for that: step 1 of St")
    assert found.coverage.missing(118.0, 158.0) == ""


def test_clock_jump_costs_the_window_around_it(ship, vessel, campaign, whole):
    recording = ship.recording()
    torque = replace(recording.channels["M_s"], clock_jumps=(ClockJump(sample=260_000, jump_s=0.0002),))
    found = prepare_signals(replace(recording, channels={**recording.channels, "M_s": torque}), vessel, campaign)
    assert found.findings[0] == "channel M_s has a clock that jumps by 0.0002 s at 130.00 s; left out for that: S1"
    assert unchanged(found, whole, "M_s")


def test_what_a_window_misses():
    gaps = (
        Gap(channel="A", start_s=10.0, stop_s=12.0, reason="has no values", reach_s=0.5),
        Gap(channel="B", start_s=11.0, stop_s=20.0, reason="stands still"),
    )
    coverage = Coverage(start_s=0.0, stop_s=100.0, step_s=0.01, gaps=gaps)
    assert coverage.missing(0.0, 9.5) == ""
    assert coverage.missing(20.0, 100.005) == ""
    assert coverage.missing(0.0, 9.6) == "channel A has no values from 10.00 to 12.00 s"
    assert coverage.missing(12.0, 30.0) == "channel A has no values from 10.00 to 12.00 s, as 1 more"
    assert coverage.missing(13.0, 30.0) == "channel B stands still from 11.00 to 20.00 s"
    assert coverage.missing(13.0, 30.0, channel="A") == ""
    assert coverage.missing(50.0, 101.0) == "the recording lasts from 0.0 to 100.0 s"
    assert merged(gaps, 0.0, 100.0) == [(9.5, 20.0)]
    assert coverage.lost(np.array([9.4, 9.6, 19.0, 21.0])).tolist() == [False, True, True, False]


def test_straight_lines_over_gaps():
    values = np.arange(20.0)
    spoilt = values.copy()
    spoilt[5:9] = 1e6
    bridge(spoilt, [Gap(channel="A", start_s=2.5, stop_s=4.0, reason="")], start_s=0.0, rate_hz=2.0)
    assert spoilt == pytest.approx(values)
    ends = values.copy()
    both = [
        Gap(channel="A", start_s=-9.0, stop_s=1.0, reason=""),
        Gap(channel="A", start_s=9.0, stop_s=99.0, reason=""),
    ]
    bridge(ends, both, start_s=0.0, rate_hz=2.0)
    assert ends[:3].tolist() == [3.0, 3.0, 3.0]
    assert ends[-3:].tolist() == [17.0, 17.0, 17.0]
    assert joined(np.array([1.0, np.nan, 3.0, np.nan])).tolist() == [1.0, 2.0, 3.0, 3.0]
    assert runs_of(np.array([True, False, True, True])) == [(0, 1), (2, 4)]


def test_many_gaps_are_one_sentence():
    gaps = [Gap(channel="A", start_s=10.0 * k, stop_s=10.0 * k + 0.25, reason="has no values") for k in range(20)]
    assert gap_findings(gaps, (("S1", 91.0, 99.0), ("S2", 95.0, 101.0))) == (
        "channel A has no values from 0.00 to 190.25 s in 20 places, 5.00 s together; left out for that: S2",
    )


def test_campaign_of_sines_only_is_judged_by_those_that_are_there(spoiled, vessel, campaign):
    """A test whose set point is another is still refused when the others are lost."""
    sines = [
        sine.model_dump() | {"frequency_hz": 0.11} if sine.name == "S2" else sine.model_dump()
        for sine in campaign.sines
    ]
    other = Campaign.model_validate({**campaign.model_dump(), "sines": sines})
    found = prepare_signals(spoiled(M_s=without(120.0, 150.0)), vessel, other)
    assert any("S1" in finding and "left out" in finding for finding in found.findings)


@pytest.mark.parametrize(
    ("gaps", "stop_s", "lost"),
    [
        # M2 has ten periods of 33.77 s from 378.5 s on: 3.6 before the gap and 5.5 behind it
        (
            (Gap(channel="M_s", start_s=500.0, stop_s=530.0, reason="has no values"),),
            741.0,
            "5 of the 10 periods of M2",
        ),
        # 6.3 of them are there
        ((), 592.7, "4 of the 10 periods of M2"),
        ((), 430.0, "M2"),
        # between the legs
        ((Gap(channel="M_s", start_s=360.0, stop_s=365.0, reason="has no values"),), 741.0, "no test is touched"),
    ],
)
def test_what_a_gap_costs_of_a_leg_is_told_in_periods(gaps, stop_s, lost):
    coverage = Coverage(start_s=0.0, stop_s=stop_s, step_s=0.005, gaps=gaps)
    (told,) = left_out(load_campaign("12min"), coverage, name="log.nc")
    assert told.endswith(f"; {lost}" if lost.startswith("no") else f"; left out for that: {lost}")
