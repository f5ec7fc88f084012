"""Logs of a CAN bus as python-can writes them: the same values and times from each, and the date where it is stated."""

import gzip
import logging
import struct
import sys
import threading
import warnings
import zlib
from datetime import UTC, datetime, timedelta

import can
import numpy as np
import pytest
from tests.can_frames import DBC, EEC1, EEC2, eec1, eec2, raw_log

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording
from shaftprint.recording.readers._library_output import quiet
from shaftprint.recording.readers.can._blf import open_blf

BEGAN_S = 1_780_308_000.25
TIMES = 0.02 * np.arange(400) + 0.001 * np.sin(np.arange(400.0))
TORQUE = np.rint(40.0 + 9.0 * np.sin(TIMES))
RPM = 0.125 * np.rint(8.0 * (1200.0 + 100.0 * np.sin(TIMES)))
CONTENT = eec1(TORQUE, RPM)
CONTENT[7, 3:5] = 0xFF
# what each format can say of a time [s]
STEP = {".blf": 1e-9, ".asc": 1e-6, ".trc": 1e-3, ".log": 1e-6}


def frame(time_s, content, *, identifier=EEC1, channel=0, **more):
    return can.Message(
        timestamp=BEGAN_S + time_s,
        arbitration_id=identifier,
        is_extended_id=identifier > 0x7FF,
        data=None if more.get("is_remote_frame") else content,
        channel=channel,
        **more,
    )


def write(path, frames):
    with can.Logger(path) as logger:
        for one in sorted(frames, key=lambda one: one.timestamp):
            logger.on_message_received(one)
    return path


def plain(path):
    return write(path, [frame(t, c.tobytes()) for t, c in zip(TIMES, CONTENT, strict=True)])


@pytest.fixture
def dbc(tmp_path):
    (tmp_path / "engine.dbc").write_text(DBC, encoding="utf-8")
    return tmp_path / "engine.dbc"


def values(recording, name):
    channel = recording.channel(name)
    return channel.values(0, channel.count)


@pytest.mark.parametrize("ending", list(STEP))
def test_every_log_gives_the_same_values_at_the_times_of_its_frames(tmp_path, dbc, ending):
    with read_recording(plain(tmp_path / f"log{ending}"), dbc=dbc) as recording:
        speed = recording.channel("EngineSpeed")
        assert np.flatnonzero(np.isnan(values(recording, "EngineSpeed"))).tolist() == [7]
        kept = np.arange(400) != 7
        assert values(recording, "EngineSpeed")[kept] == pytest.approx(RPM[kept], abs=1e-9)
        assert values(recording, "ActualEnginePercentTorque") == pytest.approx(TORQUE, abs=1e-9)
        times = speed.stamps_s(0, 400)
        assert np.diff(times) == pytest.approx(np.diff(TIMES), abs=1.01 * STEP[ending] + 5e-7)
        assert recording.left_out == {
            "values of EngineSpeed": "1 of 400 values are none by SAE J1939-71: 1 not available."
        }
        began = datetime(2026, 6, 1, 10, 0, 0, 250_000, tzinfo=recording.began.tzinfo)
        if ending == ".asc":
            # by the clock of this computer
            began = datetime.fromtimestamp(BEGAN_S)  # noqa: DTZ006
        assert abs((recording.began - began).total_seconds() + times[0]) < 2e-3


def test_a_recording_that_was_converted_begins_when_the_log_did(tmp_path, dbc):
    """python-can writes the moment of the conversion into the header, and times before it."""
    path = plain(tmp_path / "log.mf4")
    with read_recording(path, dbc=dbc) as recording:
        speed = recording.channel("EngineSpeed")
        assert speed.stamps_s(0, 400) == pytest.approx(TIMES - TIMES[0], abs=1e-6)
        # the header is on the local clock of the conversion, which may be in summer time while the test was not
        utc = datetime(2026, 6, 1, 10, 0, 0, 250_000)  # noqa: DTZ001
        assert ((recording.began - utc).total_seconds() + 450.0) % 900.0 == pytest.approx(450.0, abs=1e-3)


@pytest.mark.parametrize("ending", [".blf", ".asc"])
def test_two_buses_stay_apart_and_unknown_frames_are_counted(tmp_path, dbc, ending):
    frames = [frame(t, c.tobytes()) for t, c in zip(TIMES, CONTENT, strict=True)]
    frames += [frame(t + 0.003, c.tobytes(), channel=1) for t, c in zip(TIMES, eec1(TORQUE - 20.0, RPM), strict=True)]
    frames += [frame(t + 0.001, bytes(8), identifier=0x18FF0021) for t in TIMES[:50]]
    frames += [frame(t + 0.002, bytes(2), identifier=0x123) for t in TIMES[:30]]
    frames += [frame(0.5, bytes(8), is_remote_frame=True), frame(0.6, bytes(8), is_error_frame=True)]
    with read_recording(write(tmp_path / f"log{ending}", frames), dbc=dbc) as recording:
        port, starboard = (f"CAN{bus} EEC1 of 0x0.ActualEnginePercentTorque" for bus in (1, 2))
        assert values(recording, port) == pytest.approx(TORQUE)
        assert values(recording, starboard) == pytest.approx(TORQUE - 20.0)
        left_out = recording.left_out
        assert left_out["CAN1 identifier 18FF0021 (group 65280, sender 0x21)"] == (
            "50 frames, which engine.dbc does not know."
        )
        assert left_out["CAN1 identifier 123"] == "30 frames, which engine.dbc does not know."
        assert left_out["error frames"] == left_out["remote frames"] == "1, which hold no values."


def test_names_of_buses_are_those_of_the_log(tmp_path, dbc):
    lines = [
        f"({BEGAN_S + t:.6f}) {bus} 0CF00400#{c.tobytes().hex()}"
        for t, c in zip(TIMES, CONTENT, strict=True)
        for bus in ("can0", "vcan1")
    ]
    (tmp_path / "log.log").write_text("\n".join(lines) + "\n(17803", encoding="utf-8")
    with read_recording(tmp_path / "log.log", dbc=dbc) as recording:
        assert {"can0 EEC1 of 0x0.EngineSpeed", "vcan1 EEC1 of 0x0.EngineSpeed"} < set(recording.channels)
        assert recording.left_out["rows at the cut end of the file"] == "1, which hold no values."


@pytest.mark.parametrize("flags", ["1", "9", "A", "f"])
def test_flags_of_can_fd_are_digits_of_base_16(tmp_path, dbc, flags):
    rows = (
        f"({BEGAN_S + t:.6f}) can0 0CF00400##{flags}{c.tobytes().hex()}" for t, c in zip(TIMES, CONTENT, strict=True)
    )
    (tmp_path / "log.log").write_text("\n".join(rows) + "\n", encoding="utf-8")
    with read_recording(tmp_path / "log.log", dbc=dbc) as recording:
        assert values(recording, "ActualEnginePercentTorque") == pytest.approx(TORQUE)


@pytest.mark.parametrize(
    "row", ["({t:.6f})  can0  0CF00400   [8]  {spaced}", "({t:.6f}) can0  RX - -  0CF00400   [8]  {spaced}"]
)
def test_what_candump_shows_is_read_as_what_it_logs(tmp_path, dbc, row):
    rows = [row.format(t=BEGAN_S + t, spaced=c.tobytes().hex(" ").upper()) for t, c in zip(TIMES, CONTENT, strict=True)]
    with gzip.open(tmp_path / "log.txt.gz", "wt") as file:
        file.write("\n".join(rows) + "\n")
    with read_recording(tmp_path / "log.txt.gz", dbc=dbc) as recording:
        assert values(recording, "ActualEnginePercentTorque") == pytest.approx(TORQUE)
        assert recording.channel("EngineSpeed").stamps_s(0, 400) == pytest.approx(TIMES - TIMES[0], abs=1e-6)
    (tmp_path / "log.txt").write_text("\n".join(one.partition(")")[2] for one in rows), encoding="utf-8")
    with pytest.raises(RecordingError, match="expected times in front of the frames"):
        read_recording(tmp_path / "log.txt", dbc=dbc)


def test_times_of_candump_may_be_dates_or_the_steps_between_frames(tmp_path, dbc):
    """-t d showed times that go back, which no reader placed; -t A was no known format."""
    began = datetime.fromtimestamp(BEGAN_S, UTC).replace(tzinfo=None)
    dates = [f"{began + timedelta(seconds=round(float(t), 6)):%Y-%m-%d %H:%M:%S.%f}" for t in TIMES]
    for stamps, date in (([f"{step:010.6f}" for step in np.diff(TIMES, prepend=TIMES[0])], None), (dates, began)):
        rows = [
            f" ({stamp})  can0  0CF00400   [8]  {c.tobytes().hex(' ').upper()}\n"
            for stamp, c in zip(stamps, CONTENT, strict=True)
        ]
        (tmp_path / "log.log").write_text("".join(rows), encoding="utf-8")
        with read_recording(tmp_path / "log.log", dbc=dbc) as recording:
            assert recording.channel("EngineSpeed").stamps_s(0, 400) == pytest.approx(TIMES - TIMES[0], abs=2e-4)
            assert values(recording, "ActualEnginePercentTorque") == pytest.approx(TORQUE)
            assert recording.began == (date and date + timedelta(seconds=round(float(TIMES[0]), 6)))


ASC_ROW = "   {time:.6f} 1  CF00400x       Rx   d 8 {bytes}\n"


@pytest.mark.parametrize(
    ("stamps", "trigger", "first_s", "began"),
    [
        # Vector: both lines say when the measurement began, or the second when the block was triggered
        ("absolute", "Mon Jun 1 10:00:00.250 am 2026", 0.0, datetime(2026, 6, 1, 10, 0, 0, 250_000)),  # noqa: DTZ001
        ("absolute", "Mon Jun 1 10:05:00.250 am 2026", 300.0, datetime(2026, 6, 1, 10, 0, 0, 250_000)),  # noqa: DTZ001
        # others: the first line says when the file was written
        ("absolute", "Sun May 31 11:30:00.500 pm 2026", 0.0, datetime(2026, 5, 31, 23, 30, 0, 500_000)),  # noqa: DTZ001
        ("relative", "Mon Jun 1 10:00:00.250 am 2026", 0.0, datetime(2026, 6, 1, 10, 0, 0, 250_000)),  # noqa: DTZ001
    ],
)
def test_the_times_of_an_asc_file_count_from_where_they_say(tmp_path, dbc, stamps, trigger, first_s, began):
    times = first_s + TIMES
    printed = np.diff(times, prepend=0.0) if stamps == "relative" else times
    rows = "".join(
        ASC_ROW.format(time=t, bytes=c.tobytes().hex(" ").upper()) for t, c in zip(printed, CONTENT, strict=True)
    )
    (tmp_path / "log.asc").write_text(
        f"date Mon Jun 1 10:00:00.250 am 2026\nbase hex  timestamps {stamps}\ninternal events logged\n"
        f"Begin Triggerblock {trigger}\n   0.000000 Start of measurement\n{rows}End TriggerBlock\n",
        encoding="utf-8",
    )
    with read_recording(tmp_path / "log.asc", dbc=dbc) as recording:
        assert recording.began == began
        speed = recording.channel("EngineSpeed")
        assert speed.stamps_s(0, 400) == pytest.approx(times, abs=2e-4 if stamps == "relative" else 1e-6)


@pytest.mark.parametrize(
    ("head", "is_decimal"),
    [
        # converters leave out lines of the head that the library needs, or write the day as it is in German
        ("date Mon Jun 1 10:00:00.250 am 2026\nbase hex  timestamps absolute\n", False),
        ("base hex  timestamps absolute\n", False),
        ("base dec  timestamps absolute\nno internal events logged\n", True),
        ("date Mo. Jun 1 10:00:00.250 2026\nbase dec  timestamps absolute\n// version 13.0.0\n", True),
    ],
)
def test_an_asc_file_with_parts_of_a_head_has_its_first_frame_and_its_base(tmp_path, dbc, head, is_decimal):
    identifier, form = (f"{EEC1}", "d") if is_decimal else (f"{EEC1:X}", "02X")
    rows = "".join(
        f"   {t:.6f} 1  {identifier}x       Rx   d 8 {' '.join(format(byte, form) for byte in c)}\n"
        for t, c in zip(TIMES, CONTENT, strict=True)
    )
    (tmp_path / "log.asc").write_text(head + rows, encoding="utf-8")
    with read_recording(tmp_path / "log.asc", dbc=dbc) as recording:
        assert recording.began == (datetime(2026, 6, 1, 10, 0, 0, 250_000) if "date" in head else None)  # noqa: DTZ001
        speed = recording.channel("EngineSpeed")
        assert speed.stamps_s(0, 400) == pytest.approx(TIMES, abs=1e-6)
        assert values(recording, "EngineSpeed") == pytest.approx(
            np.where(np.arange(400) == 7, np.nan, RPM), nan_ok=True
        )


def test_long_frames_and_other_objects_of_a_blf_file(tmp_path):
    """CAN FD frames of 64 bytes, and marks between the frames."""
    text = (
        'VERSION ""\nBU_: X\nBO_ 291 Long: 64 X\n SG_ First : 7|16@0+ (0.5,-10) [0|0] "V" X\n'
        ' SG_ Last : 488|24@1- (0.001,0) [0|0] "N m" X\n'
    )
    (tmp_path / "long.dbc").write_text(text, encoding="utf-8")
    torque = np.rint(1000.0 * 2000.0 * np.sin(TIMES)).astype(int)
    with can.BLFWriter(tmp_path / "log.blf") as logger:
        for number, t in enumerate(TIMES):
            content = number.to_bytes(2, "big") + bytes(59) + int(torque[number]).to_bytes(3, "little", signed=True)
            logger.on_message_received(frame(t, content, identifier=0x123, is_fd=True))
            if number % 100 == 50:
                logger.log_event("mark", BEGAN_S + t)
    with read_recording(tmp_path / "log.blf", dbc=tmp_path / "long.dbc") as recording:
        assert values(recording, "First") == pytest.approx(0.5 * np.arange(400) - 10.0)
        assert values(recording, "Last") == pytest.approx(0.001 * torque, abs=1e-9)
        assert recording.left_out["objects of other kinds"] == "4, which hold no values."


def blf_object(kind, body, ticks, *, version=1, unit=2):
    """An object of Vector's programs: head, times, body, filled up as they do."""
    head = struct.pack("<LHHQ", unit, 0, 0, ticks) if version == 1 else struct.pack("<LBxHQ8x", unit, 0, 0, ticks)
    size = 16 + len(head) + len(body)
    return struct.pack("<4sHHLL", b"LOBJ", 16 + len(head), version, size, kind) + head + body + bytes(size % 4)


def random_object(rng, number):
    """Frames of each kind that a BLF file has, and what is none, with what python-can reads of it."""
    kind, channel, identifier = int(rng.choice([1, 86, 100, 101, 73, 6])), int(rng.integers(1, 4)), 0x123
    length = int(rng.integers(0, 9 if kind in (1, 86) else 65))
    content, remote = rng.bytes(length), int(rng.random() < 0.1)
    if kind in (1, 86):
        body = struct.pack("<HBBL8s", channel, 0x80 * remote, length, identifier, content)
        body += rng.bytes(int(rng.integers(0, 7))) if kind == 86 else b""
    elif kind == 100:
        body = struct.pack(
            "<HBBLLBBB5x64s", channel, 0x80 * remote, 9, identifier, 0, 0, 1, length, content.ljust(64, b"\0")
        )
    elif kind == 101:
        flags = 0x1000 | 0x10 * remote
        body = struct.pack("<BBBBLLLLLLLHBBL", channel, 9, length, 0, identifier, 0, flags, 0, 0, 0, 0, 0, 0, 0, 0)
        body += content
    elif kind == 73:
        body = struct.pack("<HHLBBBxLLH2x8s", channel, 0, 0, 0, 0, 8, 0, 1, 0, bytes(8))
    else:
        body = rng.bytes(int(rng.integers(5, 40)))
    unit = int(rng.integers(1, 3))
    ticks = number * (1000 if unit == 1 else 10_000_000)
    return blf_object(kind, body, ticks, version=int(rng.integers(1, 3)), unit=unit)


@pytest.mark.parametrize("seed", range(3))
def test_objects_of_all_kinds_are_read_as_another_library_reads_them(tmp_path, seed):
    rng = np.random.default_rng(seed)
    data = b"".join(random_object(rng, number) for number in range(600))
    header = struct.pack("<4sLBBBBBBBBQQLL8H8H", b"LOGG", 144, *[0] * 12, *[2026, 6, 1, 1, 10, 0, 0, 250], *[0] * 8)
    with (tmp_path / "log.blf").open("wb") as file:
        file.write(header.ljust(144, b"\0"))
        while data:
            part, data = data[:3000], data[3000:]
            packed = zlib.compress(part)
            size = 32 + len(packed)
            file.write(struct.pack("<4sHHLL", b"LOBJ", 16, 1, size, 10) + struct.pack("<H6xL4x", 2, len(part)))
            file.write(packed + bytes(size % 4))
    frames = [one for one in can.BLFReader(tmp_path / "log.blf") if not one.is_error_frame and not one.is_remote_frame]
    with (tmp_path / "log.blf").open("rb") as file:
        blocks = list(open_blf(tmp_path / "log.blf", file).blocks)
    length = np.concatenate([block.length for block in blocks])
    content = [row.tobytes() for block in blocks for row in block.content]
    assert [row[:size] for row, size in zip(content, length, strict=True)] == [bytes(one.data) for one in frames]
    assert all(set(row[size:]) <= {0xFF} for row, size in zip(content, length, strict=True))
    assert np.concatenate([block.bus for block in blocks]).tolist() == [one.channel + 1 for one in frames]
    times = np.concatenate([block.time_s for block in blocks])
    assert times == pytest.approx([one.timestamp - 1_780_308_000.25 for one in frames], abs=1e-6)


def test_a_blf_file_that_is_cut_is_read_to_there(tmp_path, dbc):
    path = write(tmp_path / "log.blf", [frame(t, c.tobytes()) for t, c in zip(TIMES, CONTENT, strict=True)])
    path.write_bytes(path.read_bytes()[: -path.stat().st_size // 2])
    with read_recording(path, dbc=dbc) as recording:
        speed = values(recording, "EngineSpeed")
        assert 20 < speed.size < 380
        assert np.nanmax(np.abs(speed - RPM[: speed.size])) < 1e-9
        assert "containers at the cut end of the file" in recording.left_out


def test_a_log_of_nothing_that_is_known_says_what_to_give(tmp_path):
    path = write(tmp_path / "log.blf", [frame(t, bytes(8), identifier=0x123) for t in TIMES])
    with pytest.raises(RecordingError, match=r"--dbc.*The log has CAN1 identifier 123: 400 frames, which"):
        read_recording(path)


def test_raw_frames_of_two_buses_in_mdf_stay_apart(tmp_path, dbc):
    """The same control unit on the bus of each of two engines."""
    frames = [frame(t, c.tobytes(), channel=1) for t, c in zip(TIMES, CONTENT, strict=True)]
    frames += [frame(t, c.tobytes(), channel=2) for t, c in zip(TIMES, eec1(TORQUE - 9.0, RPM), strict=True)]
    with read_recording(write(tmp_path / "log.mf4", frames), dbc=dbc) as recording:
        assert values(recording, "CAN2 EEC1 of 0x0.ActualEnginePercentTorque") == pytest.approx(TORQUE - 9.0)


def test_what_a_library_says_reaches_nobody_and_other_threads_go_on_printing(capsys, caplog):
    other = logging.getLogger("nobody.knows")
    printed, go_on = threading.Event(), threading.Event()

    def print_beside():
        go_on.wait(10.0)
        sys.stdout.write("beside\n")
        printed.set()

    thread = threading.Thread(target=print_beside)
    thread.start()
    with quiet() as said:
        sys.stdout.write("error with line no: 8\n")
        sys.stderr.write("b'SG_'\n")
        warnings.warn("odd", stacklevel=1)
        go_on.set()
        assert printed.wait(10.0)
    thread.join()
    assert said.getvalue() == "error with line no: 8\nb'SG_'\n"
    assert capsys.readouterr() == ("beside\n", "")
    # a library that another test has loaded may have silenced the root
    with caplog.at_level(logging.WARNING, logger=other.name):
        other.warning("heard")
    assert "heard" in caplog.text


def test_the_pedal_of_another_message_is_not_mixed_in(tmp_path, dbc):
    frames = [frame(t, c.tobytes()) for t, c in zip(TIMES, CONTENT, strict=True)]
    frames += [
        frame(t + 0.004, c.tobytes(), identifier=EEC2)
        for t, c in zip(TIMES, eec2(np.full(400, 40.0), np.full(400, 60.0)), strict=True)
    ]
    damaged = DBC.replace("BO_ 2364539902 EEC2", f"BO_ {2364539902 - (1 << 31)} EEC2")
    dbc.write_text(damaged, encoding="utf-8")
    with read_recording(write(tmp_path / "log.blf", frames), dbc=dbc) as recording:
        assert "AcceleratorPedalPosition1" not in recording.channels
        assert recording.left_out["EEC2"].startswith("identifier 217056254 has more than 11 bits and lacks bit 31")
        assert recording.left_out["CAN1 identifier 0CF00300 (group 61443, sender 0x0)"].startswith("400 frames")


def test_a_long_log_is_not_mixed_up_where_blocks_end(tmp_path, dbc):
    times = 0.01 * np.arange(3000)
    content = eec1(np.arange(3000) % 100 - 50, 0.125 * np.arange(3000))
    with can.BLFWriter(tmp_path / "log.blf", max_container_size=1024) as logger:
        for t, c in zip(times, content, strict=True):
            logger.on_message_received(frame(t, c.tobytes()))
    with read_recording(tmp_path / "log.blf", dbc=dbc) as recording:
        assert values(recording, "EngineSpeed") == pytest.approx(0.125 * np.arange(3000))


def test_raw_log_without_bus_numbers(tmp_path, dbc):
    path = raw_log(tmp_path / "log.mf4", [(TIMES, EEC1, CONTENT)])
    with read_recording(path, dbc=dbc) as recording:
        assert np.nanmax(np.abs(values(recording, "EngineSpeed") - RPM)) < 1e-9


@pytest.mark.parametrize("ending", [".asc", ".trc", ".log"])
def test_a_row_that_is_cut_anywhere_is_left_out_and_counted(tmp_path, dbc, ending):
    """The library takes some of them for a shorter frame, or for a byte of one figure, and passes over others."""
    whole = write(tmp_path / f"log{ending}", [frame(t, c.tobytes()) for t, c in zip(TIMES[:4], CONTENT, strict=False)])
    rows = [row for row in whole.read_text(encoding="utf-8").splitlines(keepends=True) if "TriggerBlock" not in row]
    begin = "".join(rows[:-1])
    last = rows[-1].rstrip()
    for length in range(len(last) - len(last.lstrip()) + 3, len(last)):
        whole.write_text(begin + last[:length], encoding="utf-8")
        with read_recording(whole, dbc=dbc) as recording:
            assert values(recording, "EngineSpeed") == pytest.approx(RPM[:3]), last[:length]
            assert recording.left_out.get("rows at the cut end of the file") == "1, which hold no values.", last[
                :length
            ]
    whole.write_text(begin + rows[-1], encoding="utf-8")
    with read_recording(whole, dbc=dbc) as recording:
        assert values(recording, "EngineSpeed") == pytest.approx(RPM[:4])
        assert "rows at the cut end of the file" not in recording.left_out
