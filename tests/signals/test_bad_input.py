"""Recordings that cannot be right: one clear sentence, or a result with a finding."""

import re
from dataclasses import replace

import numpy as np
import pytest

from shaftprint.campaign import Campaign
from shaftprint.errors import SignalError
from shaftprint.recording import Recording
from shaftprint.signals import inspect_channels, prepare_signals
from shaftprint.signals._contradictions import contradictions
from shaftprint.signals._load_reasons import torque_beside_file


def refused(recording, vessel, campaign, match, **more):
    with pytest.raises(SignalError, match=match) as caught:
        prepare_signals(recording, vessel, campaign, **more)
    assert "\n" not in str(caught.value)


def without(recording: Recording, name: str) -> Recording:
    channels = {key: channel for key, channel in recording.channels.items() if key != name}
    return replace(recording, channels=channels)


def test_missing_channel_lists_those_that_exist(ship, vessel, campaign):
    refused(
        without(ship.recording(), "M_s"),
        vessel,
        campaign,
        r'ship\.nc: expected a channel "M_s" for the shaft torque, .*found PTM_e, PTM_1, PTM_4, U_setpoint; correct',
    )
    nothing = replace(ship.recording(), channels={})
    refused(nothing, vessel, campaign, "found no channel at all")


def with_gauge(vessel, **changes):
    gauge = vessel.sensors.shaft_torque.model_copy(update=changes)
    return vessel.model_copy(update={"sensors": vessel.sensors.model_copy(update={"shaft_torque": gauge})})


def test_a_gauge_of_the_wrong_sign_or_scale(ship, vessel, campaign):
    scale = vessel.sensors.shaft_torque.scale_nm_per_unit
    turned = with_gauge(vessel, scale_nm_per_unit=-scale)
    refused(
        ship.recording(), turned, campaign, r"channel M_s: expected a positive mean torque .*, found -1\d\d\d N m; turn"
    )
    # twice is not the load of another day
    doubled = with_gauge(vessel, scale_nm_per_unit=2.0 * scale)
    told = torque_beside_file((prepare_signals(ship.recording(), doubled, campaign).working_point,), doubled)
    assert f"{2.0 * scale:g} N m for one" in told
    # 1725 N m at the speed of the file, 1.1 % less here
    assert "expected a torque around 1687 N m at 1171 rpm" in told
    sound = prepare_signals(ship.recording(), vessel, campaign)
    assert not torque_beside_file((sound.working_point,), vessel)


def test_a_file_without_units_is_told_how_to_get_them(spoiled, vessel, campaign):
    refused(
        spoiled(units={"M_s": ""}),
        vessel,
        campaign,
        r'expected the unit "V" for the .*, found a file without it; say it with `shaftprint convert --unit "M_s=V"`',
    )


def test_a_file_without_units_whose_volts_are_too_large_is_not_told_to_say_volts(spoiled, vessel, campaign):
    recording = spoiled(units={"U_setpoint": ""}, U_setpoint=lambda counts: 1000.0 * counts.astype(float))
    sentence = r'and values around 4\d\d\d, too large for V; if they are mV, .*--unit "U_setpoint=mV"`\.$'
    refused(recording, vessel, campaign, sentence)


def test_another_unit_of_the_same_quantity_is_converted(ship, spoiled, vessel, campaign):
    def in_thousandths(counts):
        return 1000.0 * counts.astype(float)

    recording = spoiled(units={"U_setpoint": "mV", "M_s": "mV"}, U_setpoint=in_thousandths, M_s=in_thousandths)
    found, sound = (prepare_signals(one, vessel, campaign) for one in (recording, ship.recording()))
    assert found.shaft_torque_nm == pytest.approx(sound.shaft_torque_nm, rel=1e-6)
    assert found.calibration.slope_rev_s_per_v == pytest.approx(sound.calibration.slope_rev_s_per_v, rel=1e-6)
    assert {report.unit for report in inspect_channels(recording, vessel)} == {"V"}
    levels = {report.channel: report.lowest for report in inspect_channels(recording, vessel)}
    assert -7.0 < levels["U_setpoint"] < -5.0


def test_wrong_unit(spoiled, vessel, campaign):
    refused(
        spoiled(units={"U_setpoint": "mA"}),
        vessel,
        campaign,
        r'channel U_setpoint: expected the unit "V" for the set point, found "mA"',
    )
    # volts that are called mV
    refused(spoiled(units={"U_setpoint": "mV"}), vessel, campaign, "1/1000 as much, as with mV for V")


def test_empty_channel(ship, vessel, campaign):
    recording = ship.recording()
    empty = replace(recording.channels["PTM_1"], count=0)
    refused(
        replace(recording, channels={**recording.channels, "PTM_1": empty}),
        vessel,
        campaign,
        "channel PTM_1: expected samples, found none",
    )


def test_recording_shorter_than_all_of_the_campaign(spoiled, vessel, campaign):
    refused(
        spoiled(M_s=lambda counts: counts[:40_000]),
        vessel,
        campaign,
        r"ship\.nc: expected at least one whole test .* 34\.7 and 230\.0 s, found a recording from 0\.0 to 20\.0",
    )


def test_channel_without_numbers(spoiled, vessel, campaign):
    refused(
        spoiled(U_setpoint=lambda counts: np.full(counts.size, np.nan)),
        vessel,
        campaign,
        r"channel U_setpoint: expected numbers, found none in 4 stretches of 32\.8 s",
    )


@pytest.mark.slow
def test_values_in_float_are_as_good_as_counts(spoiled, vessel, campaign):
    counted = prepare_signals(spoiled(), vessel, campaign)
    names = ("PTM_e", "PTM_1", "PTM_4", "M_s", "U_setpoint")
    floating = prepare_signals(spoiled(**dict.fromkeys(names, lambda counts: counts.astype(float))), vessel, campaign)
    assert floating.shaft_torque_nm == pytest.approx(counted.shaft_torque_nm, rel=1e-9)
    assert floating.engine_speed.speed_rev_s == pytest.approx(counted.engine_speed.speed_rev_s, rel=1e-9)
    assert len(floating.repairs) == len(counted.repairs)


@pytest.mark.parametrize(
    ("factor", "times"), [(1000.0, "1000 times as much, as with mV for V"), (0.001, "1/1000 as much, as with mV")]
)
def test_a_set_point_in_another_unit_is_named(factor, times, spoiled, vessel, campaign):
    refused(
        spoiled(U_setpoint=lambda counts: factor * counts.astype(float)),
        vessel,
        campaign,
        rf"a set point around -5 V that moves by 1\.5 V, found one around -.* V, {times}.*v_per_unit .* which is "
        rf"{1.0 / factor:g} times",
    )


def test_a_gauge_that_turns_its_sign_is_named_with_its_time(spoiled, vessel, campaign):
    # 2000 samples a second: from 180 s on
    turned = spoiled(M_s=lambda counts: np.where(np.arange(counts.size) < 360_000, counts, -counts))
    refused(turned, vessel, campaign, r"channel M_s: expected a torque of one sign .* turned round from 180 to 250 s")


def test_pulses_that_fade_are_too_low_and_no_gear_ratio(spoiled, vessel, campaign):
    """From 150 s on a third of their height: the other tests are measured, and the gap says why."""

    def faded(counts):
        low = int(np.percentile(counts, 5))
        weak = (low + (counts.astype(float) - low) / 3.0).astype(np.int16)
        return np.where(np.arange(counts.size) < 300_000, counts, weak)

    found = prepare_signals(spoiled(PTM_e=faded), vessel, campaign)
    (told,) = [finding for finding in found.findings if "PTM_e" in finding]
    assert told.startswith("channel PTM_e has pulses too low to be counted, of 3")
    assert told.endswith("left out for that: S1, S2, S3")
    assert not [finding for finding in found.findings if "gear ratio" in finding]


def test_pulses_of_too_few_samples_are_the_logger_s_fault(ship, vessel, campaign):
    """A strip of 19.8 degrees passes in 2.8 ms at 1183.8 rpm: half a sample at 200 Hz, four of them at 1500."""
    recording = ship.recording()
    slow = recording.channels["PTM_e"]
    counts = slow.read(0, slow.count)[::10].copy()
    slow = replace(slow, source=lambda first, stop: counts[first:stop], count=counts.size, rate_hz=200.0)
    refused(
        replace(recording, channels={**recording.channels, "PTM_e": slow}),
        vessel,
        campaign,
        r"channel PTM_e: .* the rate is too low for these pulses of about 2\.8 ms, 0\.56 samples each at 200 Hz; "
        "log at 1500 Hz or more",
    )


def test_set_point_that_never_moves(spoiled, vessel, campaign):
    refused(
        spoiled(U_setpoint=lambda counts: np.full_like(counts, -16_000)),
        vessel,
        campaign,
        r"channel U_setpoint: expected a set point that moves by 1\.5 V, found it between -5 and -5 V from start",
    )


def test_another_campaign(ship, vessel, campaign):
    other = Campaign.model_validate(
        {
            "name": "other",
            "duration_s": 250.0,
            "offset_v": -5.0,
            "staircases": [{"name": "X", "levels_v": [-5.0, -4.0, -6.0], "dwell_s": 25.0, "start_s": 120.0}],
        }
    )
    refused(ship.recording(), vessel, other, r'the campaign "other", found another course in every slow test \(X\)')


def test_one_test_at_another_time_is_a_finding(ship, vessel, campaign):
    sines = [sine.model_dump() for sine in campaign.sines]
    sines[2] |= {"start_s": 232.0, "settled_s": 233.0, "stop_s": 249.0}
    moved = Campaign.model_validate({**campaign.model_dump(), "sines": sines})
    found = prepare_signals(ship.recording(), vessel, moved)
    assert any("does not follow the campaign during S3" in finding for finding in found.findings)


def test_dead_and_saturated_gauge(spoiled, vessel, campaign):
    def stands(counts):
        return np.full_like(counts, 321)

    def clips(counts):
        return np.minimum(counts, 13_504)

    refused(
        spoiled(M_s=stands),
        vessel,
        campaign,
        r"channel M_s: expected the torque to move during St, found it dead near 50 N m",
    )
    sensors = vessel.sensors.model_copy(
        update={"shaft_torque": vessel.sensors.shaft_torque.model_copy(update={"full_scale_nm": 2110.0})}
    )
    small = vessel.model_copy(update={"sensors": sensors})
    refused(
        spoiled(M_s=clips),
        small,
        campaign,
        r"channel M_s: expected a torque within full scale, found .*% of the samples",
    )


def test_a_full_scale_in_another_unit_is_no_gap(spoiled, vessel, campaign):
    """Nearly all samples are beyond 5 N m: that was "a recording with 1 gaps"."""
    refused(
        spoiled(),
        with_gauge(vessel, full_scale_nm=5.0),
        campaign,
        r"channel M_s: expected a full scale of the telemetry above the torque, 1\d{3} N m, found 5 N m, which in kN m "
        r"would be right: 5000 N m; correct sensors\.shaft_torque\.full_scale_nm",
    )


def test_crests_cut_off_below_the_stated_full_scale_are_no_dropouts(spoiled, vessel, campaign):
    refused(
        spoiled(M_s=lambda counts: np.minimum(counts, 13_504)),
        vessel,
        campaign,
        r"channel M_s: expected a torque within full scale, found .*% of the samples saturated .*; check full_scale_nm",
    )
    found = prepare_signals(spoiled(M_s=lambda counts: np.minimum(counts, 13_850)), vessel, campaign)
    assert found.findings[0].startswith("channel M_s reaches full scale from 4")
    assert {repair.kind for repair in found.repairs} == {"saturated"}


def test_a_few_clipped_crests_are_a_finding(spoiled, vessel, campaign):
    sensors = vessel.sensors.model_copy(
        update={"shaft_torque": vessel.sensors.shaft_torque.model_copy(update={"full_scale_nm": 2165.0})}
    )
    small = vessel.model_copy(update={"sensors": sensors})
    found = prepare_signals(spoiled(M_s=lambda counts: np.minimum(counts, 13_850)), small, campaign)
    assert found.findings[0].startswith("channel M_s reaches full scale from 4")
    assert {repair.kind for repair in found.repairs} == {"saturated"}


def test_first_pick_up_dead_is_an_error_another_a_finding(spoiled, vessel, campaign):
    def dead(counts):
        return np.full_like(counts, 1000)

    refused(
        spoiled(PTM_e=dead),
        vessel,
        campaign,
        r"channel PTM_e: expected pulses between two levels, found the channel dead",
    )
    found = prepare_signals(spoiled(PTM_1=dead), vessel, campaign)
    assert list(found.speeds) == ["n_e", "n_e4"]
    assert found.findings[0].startswith("n_e1 was left out: channel PTM_1: expected pulses between two levels")


def test_wrong_gear_ratio(ship, vessel, campaign):
    geared = vessel.model_copy(update={"gearbox": vessel.gearbox.model_copy(update={"ratio": 3.90})})
    refused(
        ship.recording(),
        geared,
        campaign,
        r"PTM_e and PTM_1: .* found n_e1 / n_e = 1\.0209, as with a gear ratio of 3\.8\d* instead of 3\.9; check",
    )
    nearly = vessel.model_copy(update={"gearbox": vessel.gearbox.model_copy(update={"ratio": 3.835})})
    found = prepare_signals(ship.recording(), nearly, campaign)
    assert len(found.findings) == 2
    assert "found n_e4 / n_e = 1.0039" in found.findings[1]


def test_pulses_that_point_the_other_way_are_a_finding(spoiled, vessel, campaign):
    found = prepare_signals(spoiled(PTM_4=lambda counts: 15_000 - counts), vessel, campaign)
    assert any("PTM_4 is high for" in finding and 'set edge = "falling"' in finding for finding in found.findings)


def test_one_level_only(vessel, ship, campaign, spoiled):
    """Three slow sines would know the line: two do not."""
    fields = campaign.model_dump()
    sines = Campaign.model_validate({**fields, "staircases": [], "sines": fields["sines"][:2]})

    def without_steps(counts):
        counts[30_000:180_000] = -16_000
        return counts

    refused(
        spoiled(U_setpoint=without_steps),
        vessel,
        sines,
        r"channel U_setpoint: expected at least two steady levels .*; record a staircase",
    )


def test_unknown_mode(ship, vessel, campaign):
    refused(ship.recording(), vessel, campaign, 'mode: expected "shaftprint" or "thesis", found "fast"', mode="fast")


@pytest.mark.parametrize(
    ("recorded", "stated", "factor", "far", "scale"),
    [
        *(("N m", unit, 0.5, "small: values in kN m that are called N m", 1000.0) for unit in ("N m", "kN m")),
        # half of it, as of another day: nothing else makes a thousand
        ("N m", "kN m", 0.25, "small: values in kN m that are called N m", 1000.0),
        *(("kN m", unit, 500.0, "large: values in N m that are called kN m", 0.001) for unit in ("N m", "kN m")),
    ],
)
def test_the_unit_of_a_torque_is_named_where_another_fits(
    spoiled, vessel, campaign, recorded, stated, factor, far, scale
):
    # the ship shows 500 N m a volt
    recording = spoiled(M_s=lambda counts: factor * counts.astype(np.float64), units={"M_s": recorded})
    refused(
        recording,
        with_gauge(vessel, unit=stated, scale_nm_per_unit={"N m": 1.0, "kN m": 1000.0}[stated]),
        campaign,
        rf"channel M_s: expected a torque around 1725 N m by working_point of the vessel file, found .* N m with the "
        rf"unit .* of the vessel file; that is about 1000 times too {far}.*; check whether the vessel file is of this "
        "ship too",
    )
    # what it says mends it
    mended = with_gauge(vessel, unit="N m", scale_nm_per_unit=scale)
    found = prepare_signals(recording, mended, campaign).working_point.shaft_torque_nm
    assert found == pytest.approx(1725.0 * factor / (0.5 if factor < 1.0 else 500.0), rel=0.1)


@pytest.mark.parametrize(("stated", "scale", "right"), [("N m", 1000.0, "1"), ("kN m", 1e6, "1000")])
def test_a_unit_that_is_converted_already_needs_no_scale(spoiled, vessel, campaign, stated, scale, right):
    # half a kN m a volt, as the ship shows and the recording says
    recording = spoiled(M_s=lambda counts: 0.5 * counts.astype(np.float64), units={"M_s": "kN m"})
    refused(
        recording,
        with_gauge(vessel, unit=stated, scale_nm_per_unit=scale),
        campaign,
        rf"about 1000 times too large: a torque is converted from the unit of the recording .*; write scale_nm_per"
        rf"_unit = {right} in sensors\.shaft_torque; check whether the vessel",
    )
    mended = with_gauge(vessel, unit=stated, scale_nm_per_unit=float(right))
    assert prepare_signals(recording, mended, campaign).working_point.shaft_torque_nm == pytest.approx(1725.0, rel=0.1)


def test_a_torque_of_another_ship_is_not_called_another_unit(spoiled, vessel, campaign):
    """Twenty times the torque, in N m as the recording says: 34,500 N m are no 34 % of anything."""
    recording = spoiled(M_s=lambda counts: 10.0 * counts.astype(np.float64), units={"M_s": "kN m"})
    refused(
        recording,
        with_gauge(vessel, unit="kN m", scale_nm_per_unit=1000.0),
        campaign,
        r"channel M_s: expected a torque around 1725 N m by working_point of the vessel file and within the full scale "
        r"of \d+ N m, found 3\d{4} N m; check whether the vessel file is of this ship, gearbox\.ratio and the scale",
    )


def test_a_torque_of_another_ship_that_the_gauge_cuts_off_in_part(spoiled, vessel, campaign):
    """Three times the torque, near a full scale of 5500 N m."""
    refused(
        spoiled(M_s=lambda counts: 1.5 * counts.astype(np.float64), units={"M_s": "kN m"}),
        with_gauge(vessel, unit="kN m", scale_nm_per_unit=1000.0, full_scale_nm=5500.0),
        campaign,
        r"channel M_s: .* of the samples saturated .*The torque is around 4\d{3} N m, 1725 N m at the working point of "
        r"the vessel file: check whether the vessel file is of this ship, gearbox\.ratio and the scale",
    )


def test_a_current_loop_that_was_entered_as_a_voltage(spoiled, vessel, campaign):
    # 4 to 20 mA for 0 to 5000 N m
    recording = spoiled(M_s=lambda counts: 4.0 * 3200.0 + 1.6 * counts.astype(np.float64))
    refused(recording, vessel, campaign, "mA would fit, with scale_nm_per_unit = 312.5 and reading_at_zero = 4 in")


def with_set_point(vessel, **fields):
    content = vessel.model_dump()
    content["sensors"]["set_point"] |= fields
    return type(vessel).model_validate(content)


def test_the_unit_of_a_set_point_is_named_where_another_fits(spoiled, vessel, campaign):
    # the demanded speed in a channel that was entered as volts
    recording = spoiled(U_setpoint=lambda counts: -250.0 * counts.astype(np.float64))
    sentence = r"channel U_setpoint: expected a set point in V, found 1\d\d\d.*; rpm would fit, if recording and "
    sentence += (
        r"sensors\.set_point state it, with v_per_unit for one rpm, or V with v_per_unit = 0\.001 where these are mV"
    )
    refused(recording, vessel, campaign, sentence)
    # what is advised is read
    in_mv = spoiled(U_setpoint=lambda counts: 1000.0 * counts.astype(np.float64))
    found = prepare_signals(in_mv, with_set_point(vessel, v_per_unit=0.001), campaign)
    of_volts = prepare_signals(spoiled(), vessel, campaign).working_point
    assert found.working_point.engine_speed_rev_s == pytest.approx(of_volts.engine_speed_rev_s, rel=1e-6)


def test_a_table_that_does_not_reach_the_working_point(ship, vessel, campaign):
    fields = {"table_rpm": [[-3.0, 670.0], [0.0, -80.0]]}
    refused(ship.recording(), with_set_point(vessel, **fields), campaign, "expected table_rpm of the vessel file to re")


def test_a_lever_whose_table_is_turned_round_is_told_first(ship, vessel, campaign):
    """The speed falls by 250.8 rpm a volt; the table has as much where it rises, and the same speed at -5 V."""
    turned = with_set_point(vessel, table_rpm=[[-10.0, -83.4], [0.0, 2424.6]])
    recording = ship.recording()
    signals = prepare_signals(recording, turned, campaign)
    said = "expected a speed that rises with it, as table_rpm of sensors.set_point says, found one that falls; turn"
    assert any(said in finding for finding in signals.findings)
    reports = inspect_channels(recording, turned)
    assert said in contradictions(reports, turned, signals=signals, campaign=campaign)[0]


def test_a_table_that_asks_for_another_speed_is_a_finding(ship, vessel, campaign):
    # the ship runs at -250.8 rpm a volt and -83.4 rpm: 1170.6 rpm at -5 V
    right = {"table_rpm": [[-10.0, 2424.6], [0.0, -83.4]]}
    wrong = {"table_rpm": [[-10.0, 2924.6], [0.0, -83.4]]}
    told = [prepare_signals(ship.recording(), with_set_point(vessel, **one), campaign) for one in (right, wrong)]
    findings = [[line for line in one.findings if "asks for" in line] for one in told]
    assert findings[0] == []
    assert "asks for 1421 rpm at the working point, where the engine runs at 11" in findings[1][0]


@pytest.mark.parametrize(("shift_rpm", "told"), [(-20.0, False), (-120.0, True), (90.0, True)])
def test_a_table_that_is_some_per_cent_off_is_said_first_with_the_speeds_that_fit(
    ship, vessel, campaign, shift_rpm, told
):
    """A droop is two per cent, and no governor's is ten; the line is -250.8 rpm a volt through -83.4 rpm."""
    table = [[-10.0, 2424.6 + shift_rpm], [0.0, -83.4 + shift_rpm]]
    wrong, recording = with_set_point(vessel, table_rpm=table), ship.recording()
    signals = prepare_signals(recording, wrong, campaign)
    reports = inspect_channels(recording, wrong)
    said = contradictions(reports, wrong, signals=signals, campaign=campaign)
    assert bool(said) == told == any("asks for" in one for one in signals.findings)
    if told:
        ends = [float(one) for one in re.findall(r"V for (-?\d+) rpm", said[0])]
        assert ends == pytest.approx([2424.6, -83.4], abs=25.0)
