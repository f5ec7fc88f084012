"""Logs in a row: what follows on each other, what is refused, and what the ship was doing."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

import shaftprint.vessel
from shaftprint.errors import RecordingError, ServiceError, SettingsError
from shaftprint.recording import Channel, write_recording
from shaftprint.service._gather import StillMeans, gather, lever_line
from shaftprint.service._log import blocks, expect_lever_at_once, expect_no_deadband
from shaftprint.service._scan import scan
from shaftprint.service._segment import LeverLine, Segment
from shaftprint.service._segment_file import read_segments, write_segments
from shaftprint.service._states import STATES, state_of_seconds
from shaftprint.tug import sail_service
from shaftprint.vessel import load_vessel

VESSEL_FILES = Path(shaftprint.vessel.__file__).parent / "shipped"


@pytest.fixture(scope="module")
def vessel():
    return load_vessel("stan-tug-1205-service")


def log(path, *, seconds, rate_hz, start_s=0.0, held=1):
    """Write a log of a lever that stands still, each value of speed and torque kept for so many samples."""
    rng = np.random.default_rng(7)
    count = round(seconds * rate_hz)
    noise = np.repeat(rng.standard_normal((2, count // held + 1)), held, axis=1)[:, :count]
    channels = {
        "LeverSpeed": ("rpm", np.full(count, 1183.75)),
        "EngineSpeed": ("rpm", 1183.8 + 5.0 * noise[0]),
        "M_s": ("V", 3.45 + 0.05 * noise[1]),
    }
    write_recording(
        path,
        [
            Channel(
                name=name,
                unit=unit,
                rate_hz=rate_hz,
                start_s=start_s,
                count=count,
                source=lambda start, stop, values=values: values[start:stop],
            )
            for name, (unit, values) in channels.items()
        ],
    )
    return path


def constant(name, rate_hz, count):
    """Return a channel that stands still."""
    return Channel(
        name=name, unit="V", rate_hz=rate_hz, start_s=0.0, count=count, source=lambda start, stop: np.ones(stop - start)
    )


def test_files_that_follow_on_each_other_are_one(tmp_path, vessel):
    files = [log(tmp_path / f"{k}.nc", seconds=100.0, rate_hz=100.0, start_s=100.0 * k) for k in (0, 1, 3)]
    first, second, third = blocks(files, vessel, keep_s=30.0, told=pytest.fail)
    assert (first.goes_on, second.goes_on, third.goes_on) == (True, False, False)
    assert second.lever_v.size == 13_000
    assert second.new == third.new == 10_000
    assert second.start_s == pytest.approx(70.0, abs=0.02)
    assert np.array_equal(second.speed_rev_s[:3000], first.speed_rev_s[-3000:])


def test_one_value_a_second_is_refused_with_what_to_change(tmp_path, vessel):
    with pytest.raises(ServiceError, match=r"20 times a second .*, found 1 values a second; .* historian to"):
        scan([log(tmp_path / "slow.nc", seconds=900.0, rate_hz=1.0)], vessel)


def test_a_historian_that_keeps_its_last_value_is_refused(tmp_path, vessel):
    with pytest.raises(ServiceError, match=r"the last kept for 0\.2 s at a time .* deadband and compression"):
        scan([log(tmp_path / "held.nc", seconds=300.0, rate_hz=100.0, held=20)], vessel)


def test_a_lever_that_never_moves_gives_no_line_but_an_answer(tmp_path, vessel):
    found = scan([log(tmp_path / "still.nc", seconds=300.0, rate_hz=100.0)], vessel)
    assert found.line is None
    assert found.headline.startswith("Your logger saw 0 useful moves of the lever in 5 minutes, but nothing may be")
    assert "with the ship ahead, found 1; give more logs" in found.headline
    assert found.seconds == {"ahead": 300.0}


def test_a_lever_that_stands_at_one_speed_only_is_asked_for_others():
    still = StillMeans(
        lever_v=np.full(20, -5.0),
        speed_rev_s=np.full(20, 20.0),
        load=np.ones(20),
        stretch=np.repeat(np.arange(10.0), 2),
    )
    with pytest.raises(ServiceError, match=r"found 10 between 1200 and 1200 rpm; give logs of hours in which"):
        lever_line(still)


def test_one_file_of_a_week_that_cannot_be_used_costs_no_other(tmp_path, vessel):
    files = [log(tmp_path / f"{k}.nc", seconds=100.0, rate_hz=100.0, start_s=100.0 * k) for k in (0, 2)]
    other = tmp_path / "1.nc"
    write_recording(other, [constant("Ballast", 100.0, 10_000)])
    told = []
    seen = list(blocks([files[0], other, files[1]], vessel, keep_s=30.0, told=told.append))
    assert [one.log for one in seen] == [str(file) for file in files]
    assert [one.goes_on for one in seen] == [False, False]
    assert [one.log for one in told] == [str(other)]
    assert 'expected a channel "EngineSpeed"' in told[0].reason
    left_out = scan([*files, other], vessel).left_out
    assert len(left_out) == 1
    assert left_out[0].count(str(other)) == 1
    with pytest.raises(ServiceError, match=r"Nothing of the logs can be used\. .*1\.nc: expected a channel"):
        scan([other, other], vessel)
    with pytest.raises(RecordingError, match=r"lost\.nc: expected a log, found no such file"):
        scan([files[0], tmp_path / "lost.nc"], vessel)


def test_a_log_of_which_nothing_can_be_read_is_refused_with_the_reason(tmp_path, vessel):
    text = (VESSEL_FILES / "stan_tug_1205_service.toml").read_text(encoding="utf-8")
    begin, end = text.index("[sensors.set_point]"), text.index("[logger]")
    pulses = '[sensors.set_point]\nchannel = "Pulse"\nunit = "%"\nv_per_unit = 0.1\nv_at_zero = 0.0\n\n'
    file = tmp_path / "pulses.toml"
    file.write_text(text[:begin] + pulses + text[end:], encoding="utf-8")
    rng = np.random.default_rng(3)
    times = np.cumsum(rng.uniform(0.02, 0.03, 2000))
    rows = np.column_stack([times, np.linspace(1e4, 2e4, 2000), 1183.8 + rng.standard_normal(2000), 3.45 + times])
    head = "time [s],Pulse [%],EngineSpeed [rpm],M_s [V]"
    np.savetxt(tmp_path / "a.csv", rows, delimiter=",", header=head, comments="", fmt="%.4f")
    with pytest.raises(ServiceError, match=r"Nothing .*a\.csv: .*Pulse: .* at most 101 %, .* 1e\+04 to"):
        scan([tmp_path / "a.csv"], load_vessel(str(file)))


def test_no_logs_are_refused(vessel):
    with pytest.raises(ServiceError, match="expected at least one log, found none"):
        scan([], vessel)


@pytest.mark.parametrize(
    ("speed_rpm", "torque_nm", "state"),
    [
        (0.0, 0.0, "standing"),
        (600.0, 3.0, "clutch out"),
        (600.0, 443.0, "idle"),
        (1183.8, 1725.0, "ahead"),
        (1183.8, -1100.0, "astern"),
        (1183.8, np.nan, "not told"),
    ],
)
def test_states_are_told_by_speed_and_torque(vessel, speed_rpm, torque_nm, state):
    (found,) = state_of_seconds(np.array([speed_rpm / 60.0]), np.array([torque_nm]), vessel)
    assert STATES[found] == state


def test_lines_without_a_model_are_refused():
    with pytest.raises(ServiceError, match="found that the pitch is controllable"):
        scan(["log.nc"], load_vessel("nifs-research-vessel"))


def test_shipped_tug_in_service_is_the_same_tug(vessel):
    other = load_vessel("stan-tug-1205")
    same = {"name": other.name, "sensors": other.sensors, "logger": other.logger}
    assert vessel.model_copy(update=same) == other
    assert vessel.sensors.set_point.volts(1183.8) == pytest.approx(-5.0, abs=1e-6)
    moving, underway = load_vessel("stan-tug-1205-service-underway"), load_vessel("stan-tug-1205-underway")
    assert moving.model_copy(update={one: getattr(underway, one) for one in same}) == underway
    assert (moving.sensors, moving.logger) == (vessel.sensors, vessel.logger)


def test_a_ship_whose_sensors_no_service_log_shows_is_told_of_one_that_has_them(tmp_path):
    with pytest.raises(SettingsError, match=r"expected a speed in rpm.* stan-tug-1205-service has such sensors"):
        sail_service(load_vessel("stan-tug-1205"), tmp_path / "logs", hours=1.0, seed=1)
    assert not (tmp_path / "logs").exists()


@pytest.fixture
def written(tmp_path, vessel):
    """A table of one segment, with its channels beside it."""
    segment = Segment(
        log="log-01.nc",
        state="ahead",
        reason="",
        every=1,
        start_s=0.0,
        move_s=2.0,
        move_end_s=3.0,
        rate_hz=100.0,
        lever_v=np.zeros(10),
        speed_rev_s=np.ones(10),
        torque_nm=np.ones(10),
    )
    line = LeverLine(**{one.name: 1.0 for one in dataclasses.fields(LeverLine)})
    write_segments(tmp_path / "segments.csv", [segment], line, [{"used": "yes", "reason": ""}], {})
    return tmp_path / "segments.csv"


def test_segments_come_back(written):
    (segment,), _, facts = read_segments(written)
    assert (segment.log, segment.move_s, segment.lever_v.size, facts) == ("log-01.nc", 2.0, 10, {})


@pytest.mark.parametrize("kept", [0, 10, 100, 0.5, 0.9, -1])
def test_channels_that_are_cut_are_damaged_in_a_sentence(written, kept):
    beside = written.with_suffix(".npz")
    content = beside.read_bytes()
    beside.write_bytes(content[: int(kept * len(content)) if isinstance(kept, float) else kept])
    with pytest.raises(ServiceError, match=r"segments\.npz: expected the channels .*, found a damaged file; scan"):
        read_segments(written)


def test_a_changed_byte_of_the_channels_is_told_or_changes_nothing_else(written):
    beside = written.with_suffix(".npz")
    content, said = beside.read_bytes(), []
    for place in range(0, len(content), 37):
        beside.write_bytes(content[:place] + bytes([content[place] ^ 0x55]) + content[place + 1 :])
        try:
            read_segments(written)
        except ServiceError as error:
            said.append(str(error))
    assert len(said) > 20
    assert all("segments.npz: expected" in one for one in said)


def test_channels_that_are_not_there_are_missing(written):
    written.with_suffix(".npz").unlink()
    with pytest.raises(ServiceError, match="found none: No such file or directory; scan the logs again"):
        read_segments(written)


def test_channels_larger_than_any_log_are_not_unpacked(written, monkeypatch):
    monkeypatch.setattr("shaftprint.service._segment_file._LARGEST", 100)
    with pytest.raises(ServiceError, match="expected at most 0 MiB of channels, found 0 MiB; scan fewer logs"):
        read_segments(written)


def held(values, period_s, rate_hz=100.0):
    every = round(period_s * rate_hz)
    return values[np.arange(values.size) // every * every]


def hand(rng, seconds=3600.0, rate_hz=100.0):
    """Return a lever that a hand moves at any time [rpm], steps of 0.125 rpm."""
    corners, levels, at = [0.0], [1200.0], 0.0
    while at < seconds:
        at += rng.uniform(10.0, 120.0)
        level = rng.uniform(700.0, 1600.0)
        corners += [at, at + abs(level - levels[-1]) / rng.uniform(100.0, 1500.0) + 0.01]
        levels += [levels[-1], level]
        at = corners[-1]
    time = np.arange(round(seconds * rate_hz)) / rate_hz
    return np.round(8.0 * np.interp(time, corners, levels)) / 8.0


@pytest.mark.parametrize("period_s", [0.1, 0.2, 1.0, 2.0])
def test_a_lever_that_is_asked_for_now_and_then_is_refused(period_s):
    lever = held(hand(np.random.default_rng(3)), period_s)
    with pytest.raises(ServiceError, match=rf"changes once in {period_s:g} s: .* 20 times a second or more often"):
        expect_lever_at_once(lever, 100.0, Path("log.nc"))


@pytest.mark.parametrize("seed", range(5))
def test_a_hand_moves_at_any_time(seed):
    lever = hand(np.random.default_rng(seed))
    expect_lever_at_once(lever, 100.0, Path("log.nc"))
    # a lever of push buttons goes in steps, each at a time of its own
    expect_lever_at_once(np.round(lever / 12.0) * 12.0, 100.0, Path("log.nc"))


def channel(values):
    return Channel(
        name="EngineSpeed", unit="rpm", rate_hz=100.0, start_s=0.0, count=values.size,
        source=lambda start, stop: values[start:stop],
    )  # fmt: skip


def test_a_channel_with_a_deadband_is_refused_and_one_of_coarse_steps_is_not():
    rng = np.random.default_rng(5)
    speed = 1183.8 + 6.0 * np.convolve(rng.standard_normal(30_050), np.ones(51) / np.sqrt(51.0), mode="valid")
    fine = np.round(8.0 * speed) / 8.0
    banded = fine.copy()
    for k in range(1, banded.size):
        banded[k] = fine[k] if abs(fine[k] - banded[k - 1]) > 3.0 else banded[k - 1]
    with pytest.raises(ServiceError, match=r"stays until it is 3\.\d+ rpm off \(\d+% of the samples repeat the last\)"):
        expect_no_deadband(channel(banded), Path("log.nc"))
    expect_no_deadband(channel(fine), Path("log.nc"))
    expect_no_deadband(channel(np.round(speed / 3.0) * 3.0), Path("log.nc"))


def test_a_gauge_that_shows_nothing_without_load_has_no_deadband():
    """Half an hour at the quay with the clutch out, now and then: exactly zero, for minutes."""
    rng = np.random.default_rng(7)
    torque = np.round(3.0 + 0.3 * rng.standard_normal(30_000), 4)
    torque[3_000:20_000] = 0.0
    expect_no_deadband(channel(torque), Path("log.nc"))
    for k in range(20_000, torque.size):
        torque[k] = torque[k] if abs(torque[k] - torque[k - 1]) > 1.0 else torque[k - 1]
    for k in range(1, 3_000):
        torque[k] = torque[k] if abs(torque[k] - torque[k - 1]) > 1.0 else torque[k - 1]
    with pytest.raises(ServiceError, match="a historian with a deadband"):
        expect_no_deadband(channel(torque), Path("log.nc"))


MOVES_S = (40.0, 90.0, 140.0, 200.0, 260.0)


def moved_log(path, *, times_s, missing=()):
    """Write a log in text whose speed follows a lever that moves every minute, without some seconds."""
    clean_s = np.arange(30_000) / 100.0
    lever = 1000.0 + 200.0 * (np.searchsorted(MOVES_S, clean_s) % 2)
    rng = np.random.default_rng(9)
    speed = lever + 2.0 * rng.standard_normal(clean_s.size)
    torque = 3.0 * (speed / 1183.8) ** 2
    kept = np.ones(clean_s.size, dtype=bool)
    for first, last in missing:
        kept &= (clean_s < first) | (clean_s >= last)
    rows = zip(times_s[kept], lever[kept], speed[kept], torque[kept], strict=True)
    lines = [f"{t:.3f},{a:.4g},{b:.5g},{c:.5g}" for t, a, b, c in rows]
    path.write_text("time [s],LeverSpeed [rpm],EngineSpeed [rpm],M_s [V]\n" + "\n".join(lines) + "\n")
    return path


def used_moves_s(found):
    return [pytest.approx(one.move_s, abs=0.1) for one in found.segments if not one.reason]


def test_holes_and_clock_steps_cost_the_moves_that_they_meet_and_no_other(tmp_path, vessel):
    clean_s = np.arange(30_000) / 100.0
    whole = gather([moved_log(tmp_path / "whole.csv", times_s=clean_s)], vessel)
    assert used_moves_s(whole) == list(MOVES_S)
    holes = [(95.0, 99.0), (227.0, 240.0)]
    found = gather([moved_log(tmp_path / "holes.csv", times_s=clean_s, missing=holes)], vessel)
    assert used_moves_s(found) == [40.0, 140.0, 200.0, 260.0]
    assert {one.reason for one in found.segments if one.reason} == {"a channel is missing there"}
    for step_s in (-2.37, 2.37):  # the second clock may count on from either
        stepped_s = clean_s + step_s * (clean_s >= 145.0)
        found = gather([moved_log(tmp_path / "step.csv", times_s=stepped_s)], vessel)
        assert [round(one.move_s / 10.0) for one in found.segments if not one.reason] == [4, 9, 20, 26]


def test_a_logger_that_begins_anew_costs_the_move_that_it_meets(tmp_path, vessel):
    clean_s = np.arange(30_000) / 100.0
    first = moved_log(tmp_path / "1.csv", times_s=clean_s, missing=[(205.0, 400.0)])
    second = moved_log(tmp_path / "2.csv", times_s=clean_s - 206.0, missing=[(-1.0, 206.0)])
    found = gather([first, second], vessel)
    assert used_moves_s(found) == [40.0, 90.0, 140.0, 54.0]
    assert [one.reason for one in found.segments if one.reason] == ["the log begins or ends there"]


def test_memory_does_not_hold_the_hours_between_moves(tmp_path, vessel):
    found = gather([moved_log(tmp_path / "whole.csv", times_s=np.arange(30_000) / 100.0)], vessel)
    for one in found.segments:
        base = one.lever_v
        while base.base is not None:
            base = base.base
        assert base.nbytes < 2 * one.lever_v.nbytes
