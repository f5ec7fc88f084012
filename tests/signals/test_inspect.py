from dataclasses import replace

import numpy as np
import pytest

from shaftprint.recording._level_watch import watch_levels
from shaftprint.signals import find_tests, inspect_channels, prepare_signals
from shaftprint.signals._channel_readings import read_channels
from shaftprint.signals._inspect import channel_reports


def test_what_each_channel_holds(ship, vessel):
    reports = {report.channel: report for report in inspect_channels(ship.recording(), vessel)}
    assert list(reports) == ["PTM_e", "PTM_1", "PTM_4", "M_s", "U_setpoint"]
    assert [report.use for report in reports.values()] == ["speed", "speed", "speed", "shaft torque", "set point"]
    for report in reports.values():
        assert (report.unit, report.rate_hz, report.start_s, report.duration_s) == ("V", 2000.0, 0.0, 250.0)
        assert report.problem is None
        assert report.faults == ()
    engine, four = reports["PTM_e"].pulses, reports["PTM_4"].pulses
    assert (engine.low, engine.high) == pytest.approx((0.3, 4.25), abs=0.1)
    assert engine.per_second == pytest.approx(np.mean(ship.speed_rev_s), rel=2e-3)
    assert engine.strip_angles_deg == (360.0,)
    assert sorted(four.strip_angles_deg) == pytest.approx(sorted(360.0 * np.array(ship.strips_rev)), abs=0.02)
    assert reports["M_s"].pulses is None
    assert reports["U_setpoint"].lowest == pytest.approx(-5.5, abs=0.01)
    assert reports["U_setpoint"].highest == pytest.approx(-4.0, abs=0.01)


def test_problems_are_told_channel_by_channel(spoiled, vessel):
    def dead(counts):
        return np.full_like(counts, 640)

    def silent(counts):
        counts[200_000:210_000] = 5
        return counts

    reports = {
        report.channel: report for report in inspect_channels(spoiled(PTM_1=dead, M_s=silent, PTM_e=silent), vessel)
    }
    assert reports["PTM_1"].problem.startswith("channel PTM_1: expected pulses between two levels")
    assert reports["PTM_1"].lowest == reports["PTM_1"].highest == pytest.approx(0.2)
    assert reports["PTM_1"].pulses is None
    assert reports["PTM_e"].pulses is not None
    (gap,) = reports["PTM_e"].gaps
    assert (gap.reason, gap.start_s, gap.stop_s) == (
        "has no pulses",
        pytest.approx(100, abs=0.1),
        pytest.approx(105, abs=0.1),
    )
    (gap,) = reports["M_s"].gaps
    assert gap.sentence == "channel M_s stands still from 100.00 to 105.00 s"
    assert [reports[name].problem for name in ("PTM_e", "M_s", "U_setpoint")] == [None, None, None]


def test_faults_are_listed(spoiled, vessel):
    def spike(counts):
        counts[[50_000, 90_001]] = 25_000
        return counts

    reports = {report.channel: report for report in inspect_channels(spoiled(U_setpoint=spike), vessel)}
    assert [(fault.kind, fault.time_s, fault.count) for fault in reports["U_setpoint"].faults] == [
        ("outlier", 25.0, 1),
        ("outlier", 45.0005, 1),
    ]


def test_a_channel_is_unpacked_once_for_levels_sensors_tests_and_signals(ship, vessel, campaign):
    read = dict.fromkeys(ship.recording().channels, 0)

    def counted(channel):
        def source(start, stop):
            read[channel.name] += stop - start
            return channel.source(start, stop)

        return replace(channel, source=source)

    raw = ship.recording()
    recording = replace(raw, channels={name: counted(channel) for name, channel in raw.channels.items()})
    watch = watch_levels(recording)
    readings = read_channels(watch.recording, vessel)
    reports = channel_reports(readings, watch.levels())
    tests = find_tests(recording, vessel, campaign, readings=readings)
    signals = prepare_signals(recording, vessel, campaign, readings=readings)
    # besides, four stretches of a thirtieth of a second to half a minute say what levels and noise there are
    stretches = 4 * 65_536
    for name, channel in recording.channels.items():
        assert channel.count <= read[name] <= channel.count + 3 * stretches, name
    assert tests == find_tests(raw, vessel, campaign)
    assert reports == inspect_channels(raw, vessel)
    apart = prepare_signals(raw, vessel, campaign)
    for name, signal in apart.channels.items():
        np.testing.assert_array_equal(signals.channels[name].values, signal.values)
    # what was read is still the voltage: another campaign may be tried on it
    assert find_tests(recording, vessel, campaign, readings=readings) == tests
