"""What is written as other loggers write it, as the formats' own libraries and our readers see it."""

import io
from datetime import UTC, datetime
from itertools import pairwise

import can
import canmatrix.formats
import nptdms
import numpy as np
import pytest
import pyuff

from shaftprint.errors import RecordingError
from shaftprint.recording import RecordingWriter, Samples, read_recording, recording_from_arrays, write_by_ending

# logs of a bus, LabVIEW's text and universal files have no zone
BEGAN = datetime(2026, 6, 1, 12, 0, 0, 250_000)  # noqa: DTZ001
RPM = np.rint(8.0 * (1200.0 + 300.0 * np.sin(np.arange(1500) / 20.0))).astype(np.int16)
SENT_S = 0.013 + 0.02 * np.arange(1500) + np.random.default_rng(3).uniform(-0.003, 0.003, 1500)


@pytest.fixture
def source(tmp_path):
    """Voltages of a logger, speed in messages, and slow values of which one is missing."""
    path = tmp_path / "source.nc"
    slow = np.linspace(-1.0, 3.0, 30)
    slow[5] = np.nan
    with RecordingWriter(path) as writer:
        for name, offset in (("M_s", 0.0), ("U", 0.5)):
            writer.declare(name, unit="V", rate_hz=100.0, scale=10.0 / 32768.0, offset=offset, long_name="a voltage")
            writer.append(name, np.arange(-15_000, 15_000, 10, dtype=np.int16))
        writer.declare("n_e", unit="rpm", rate_hz=50.0, start_s=0.013, scale=0.125, times="beside the rate",
                       long_name="speed of the engine shaft")  # fmt: skip
        writer.append("n_e", RPM, SENT_S)
        writer.declare("slow", unit="kN", rate_hz=1.0, start_s=0.5, dtype="float64")
        writer.append("slow", slow)
    with read_recording(path) as recording:
        yield recording


def _made(tmp_path, *samples):
    path = tmp_path / "source.csv"
    path.write_text("x")
    return recording_from_arrays(path, samples, format="test")


@pytest.mark.parametrize(
    ("name", "step_of_slow", "step_of_time"),
    # 4 kN over 64255 counts: steps of 2^-13 kN; LabVIEW, ASC and candump print microseconds, the last since 1970
    [("log.blf", 2.0**-13, 1e-9), ("log.asc", 2.0**-13, 1e-6), ("log.log", 2.0**-13, 1.5e-6),
     ("log.lvm", 1e-6, 1e-6), ("log.uff", 0.0, 0.0)],
)  # fmt: skip
def test_values_and_times_within_what_the_format_loses(source, tmp_path, name, step_of_slow, step_of_time):
    path = tmp_path / name
    write_by_ending(path, source.channels.values(), began=BEGAN)
    hints = {"dbc": tmp_path / f"{name}.dbc"} if path.suffix in (".blf", ".asc", ".log") else {}
    with read_recording(path, **hints) as recording:
        # universal files hold whole seconds
        assert recording.began.replace(tzinfo=None) == BEGAN.replace(microsecond=0 if name == "log.uff" else 250_000)
        for channel in source.channels.values():
            again = recording.channel(channel.name)
            assert (again.unit, again.count) == (channel.unit, channel.count)
            off = again.values(0, channel.count) - channel.values(0, channel.count)
            step = step_of_slow if channel.name == "slow" or name == "log.lvm" else 0.0
            assert np.nanmax(np.abs(off)) <= 0.5 * step + 1e-12
            assert np.flatnonzero(np.isnan(off)).tolist() == ([5] if channel.name == "slow" else [])
            off_s = again.stamps_s(0, channel.count) - channel.stamps_s(0, channel.count)
            assert np.max(np.abs(off_s)) <= 0.51 * step_of_time + 1e-12
        assert recording.channel("M_s").rate_hz == pytest.approx(100.0, rel=1e-8)


def test_frames_as_another_library_takes_them_apart(source, tmp_path):
    remarks = write_by_ending(tmp_path / "log.blf", source.channels.values())
    assert "slow is rounded to steps of 0.00012207 kN, counts of 16 bits." in remarks
    (matrix,) = canmatrix.formats.load(io.BytesIO((tmp_path / "log.blf.dbc").read_bytes()), "dbc").values()
    with can.BLFReader(tmp_path / "log.blf") as reader:
        messages = list(reader)
    # both voltages share a frame: 3000 of them, 1500 of the speed, 30 slow ones, in order of time
    assert len(messages) == 4530
    assert all(one.timestamp <= other.timestamp for one, other in pairwise(messages))
    frames = {frame.arbitration_id.id: frame for frame in matrix.frames}
    first = frames[messages[0].arbitration_id].decode(bytes(messages[0].data))
    assert float(first["M_s"].phys_value) == -15_000 * 10.0 / 32768.0
    assert float(first["U"].phys_value) == -15_000 * 10.0 / 32768.0 + 0.5
    speed = next(one for one in messages if "n_e" in {s.name for s in frames[one.arbitration_id].signals})
    assert int.from_bytes(speed.data, "little") == RPM[0]
    assert speed.timestamp == pytest.approx(SENT_S[0], abs=1e-9)
    # groups that makers may use as they like, J1939-21: PDU format 255
    assert {identifier >> 16 & 0xFF for identifier in frames} == {0xFF}


def _moved(path):
    """A file in another folder, where it is beside no log."""
    folder = path.parent / "elsewhere"
    folder.mkdir(exist_ok=True)
    return path.rename(folder / path.name)


def test_messages_of_nmea_2000(source, tmp_path):
    remarks = write_by_ending(tmp_path / "log.log", source.channels.values(), format="nmea2000")
    assert "n_e is sent 300 times for 1500 samples, unfiltered." in remarks
    with can.CanutilsLogReader(tmp_path / "log.log") as reader:
        messages = [one for one in reader if one.arbitration_id >> 8 & 0x1FFFF == 127488]
    assert [round(one.timestamp, 6) for one in messages[:3]] == [0.013, 0.113, 0.213]
    # 0.25 rpm a bit in bytes 1 and 2, the newest message of the sender; instance 0
    newest = RPM[np.searchsorted(SENT_S, [one.timestamp + 1e-9 for one in messages], side="right") - 1] * 0.125
    counts = [int.from_bytes(one.data[1:3], "little") for one in messages]
    assert np.max(np.abs(0.25 * np.array(counts) - newest)) <= 0.125
    assert {one.data[0] for one in messages} == {0}
    # without the DBC file the standard says what the speed is
    elsewhere = _moved(tmp_path / "log.log.dbc")
    with read_recording(tmp_path / "log.log") as recording:
        assert recording.channel("Engine speed").rate_hz == pytest.approx(10.0)
    with read_recording(tmp_path / "log.log", dbc=elsewhere) as recording:
        assert set(recording.channels) == {"M_s", "U", "n_e", "slow"}
        # ten times a second: every tenth sample
        assert np.array_equal(
            recording.channel("U").values(0, 300), source.channel("U").values(0, 3000)[::10], equal_nan=True
        )


def test_a_fast_packet_of_nmea_2000(tmp_path):
    torque = Samples(name="percent torque", values=np.arange(120.0) % 100.0, unit="%", rate_hz=10.0)
    with _made(tmp_path, torque) as recording:
        write_by_ending(tmp_path / "log.blf", recording.channels.values(), format="nmea2000")
    with can.BLFReader(tmp_path / "log.blf") as reader:
        frames = [bytes(one.data) for one in reader]
    # 127489 has 26 bytes: 6 in the first frame, 7 in each other; every half a second of 12
    assert len(frames) == 24 * 4
    assert [frame[0] for frame in frames[:5]] == [0x00, 0x01, 0x02, 0x03, 0x20]
    assert frames[0][1] == 26
    # the last byte of the packet, the sixth of its fourth frame, is the torque: 0 %, then 5 % half a second later
    assert [frames[3][6], frames[7][6]] == [0, 5]
    elsewhere = _moved(tmp_path / "log.blf.dbc")
    for hints in ({}, {"dbc": elsewhere}):
        with read_recording(tmp_path / "log.blf", **hints) as recording:
            channel = recording.channel("percent_torque" if hints else "Percent engine torque")
            assert channel.values(0, channel.count).tolist() == [5.0 * k % 100.0 for k in range(24)]


def test_values_beyond_a_field_are_told(tmp_path):
    torque = Samples(name="percent torque", values=np.array([50.0, 130.0, 90.0] * 40), unit="%", rate_hz=2.0)
    with _made(tmp_path, torque) as recording:
        remarks = write_by_ending(tmp_path / "log.blf", recording.channels.values(), format="nmea2000")
    # a signed byte, of which three counts are none: up to 124 %
    assert "40 values of percent torque are beyond what PGN_127489 holds." in remarks


def test_a_tdms_file_that_is_opened_and_closed_again(source, tmp_path):
    channels = [one for one in source.channels.values() if one.name != "n_e"]
    write_by_ending(tmp_path / "log.tdms", channels, began=BEGAN.replace(tzinfo=UTC), format="tdms-appended")
    with (tmp_path / "log.tdms").open("rb") as file:
        assert file.read().count(b"TDSm") == 3 * 3
    with nptdms.TdmsFile.open(tmp_path / "log.tdms") as file:
        # what the library says of the last start: the third part begins 20 s later
        assert file["recording"]["M_s"].properties["wf_start_time"] == np.datetime64("2026-06-01T12:00:20.250000")
    with read_recording(tmp_path / "log.tdms") as recording:
        assert recording.began == BEGAN.replace(tzinfo=UTC)
        for channel in channels:
            again = recording.channel(channel.name)
            assert (again.rate_hz, again.start_s, again.clock_jumps) == (channel.rate_hz, channel.start_s, ())
            assert np.array_equal(again.values(0, again.count), channel.values(0, channel.count), equal_nan=True)


def test_the_text_that_labview_would_write(tmp_path):
    fast = Samples(name="M_s", values=np.arange(24.0), unit="V", rate_hz=2.0)
    slow = Samples(name="T", values=np.array([20.0, 21.0, 22.0]), unit="degC", rate_hz=0.25, start_s=1.0)
    with _made(tmp_path, fast, slow) as recording:
        write_by_ending(tmp_path / "log.lvm", recording.channels.values(), began=BEGAN)
    lines = (tmp_path / "log.lvm").read_text().splitlines()
    assert lines[:2] == ["LabVIEW Measurement", "Writer_Version\t2"]
    assert "X_Columns\tMulti" in lines
    assert "Multi_Headings\tYes" in lines
    titles = [number for number, line in enumerate(lines) if line.startswith("X_Value")]
    assert lines[titles[0]] == "X_Value\tM_s\tX_Value\tT\tComment"
    # ten seconds a head: 20 rows of the one and 3 of the other, then 4 rows
    assert lines[titles[0] + 1] == "0.000000\t0.000000\t1.000000\t20.000000"
    assert lines[titles[0] + 4] == "1.500000\t3.000000\t\t"
    assert lines[titles[1] + 1] == "10.000000\t20.000000\t\t"
    assert "Samples\t20\t\t3\t" in lines
    assert "Time\t12:00:10.250000\t\t12:00:13.250000\t" in lines


def test_a_universal_file_as_its_library_reads_it(source, tmp_path):
    write_by_ending(tmp_path / "log.unv", source.channels.values())
    voltage, _, speed, slow = pyuff.UFF(str(tmp_path / "log.unv")).read_sets()
    assert (voltage["id1"], voltage["ordinate_axis_units_lab"], voltage["abscissa_inc"]) == ("M_s", "V", 0.01)
    assert np.array_equal(speed["x"], SENT_S)
    # the format knows no missing value: the sample is not there
    assert slow["data"].size == 29


@pytest.mark.parametrize(
    ("name", "format", "words"),
    [("log.blf", "lvm", r"expected one of the endings \.lvm, found \"\.blf\""),
     ("log.lvm", "LVM", r"expected one of the formats native, csv, .*, found \"LVM\"")],
)  # fmt: skip
def test_an_ending_of_another_format_is_refused(source, tmp_path, name, format, words):
    with pytest.raises(RecordingError, match=words):
        write_by_ending(tmp_path / name, source.channels.values(), format=format)


def test_times_before_second_0_and_strange_names_are_told(tmp_path):
    names = ("shaft torque [port]", "shaft torque (port)", "2nd")
    channels = [
        Samples(name=name, values=np.arange(200.0), unit='N"m\n', rate_hz=100.0, start_s=-0.5) for name in names
    ]
    with _made(tmp_path, *channels) as recording:
        remarks = write_by_ending(tmp_path / "log.blf", recording.channels.values())
    assert "Times begin 1 s later, since a log of a bus has none before second 0." in remarks
    assert "shaft torque (port) is called shaft_torque__port__2." in remarks
    with read_recording(tmp_path / "log.blf", dbc=tmp_path / "log.blf.dbc") as recording:
        assert list(recording.channels) == ["shaft_torque__port_", "shaft_torque__port__2", "_2nd"]
        assert recording.channel("_2nd").start_s == pytest.approx(0.5)
        assert recording.channel("_2nd").values(0, 3).tolist() == [0.0, 1.0, 2.0]


def test_a_dbc_file_that_is_there_is_not_replaced(source, tmp_path):
    (tmp_path / "log.blf.dbc").write_text("mine")
    with pytest.raises(RecordingError, match=r"log\.blf\.dbc"):
        write_by_ending(tmp_path / "log.blf", source.channels.values())
    assert (tmp_path / "log.blf.dbc").read_text() == "mine"
    assert not (tmp_path / "log.blf").exists()


def test_times_beside_a_clock_that_are_not_kept_are_told(source, tmp_path):
    remarks = write_by_ending(tmp_path / "log.tdms", [source.channel("n_e")])
    assert remarks == ("n_e: times of the samples beside their clock are not kept.",)


def test_a_log_without_a_date_has_none(source, tmp_path):
    for name in ("log.asc", "log.blf", "log.log"):
        write_by_ending(tmp_path / name, [source.channel("slow")])
        with read_recording(tmp_path / name, dbc=tmp_path / f"{name}.dbc") as recording:
            assert (recording.began, recording.channel("slow").start_s) == (None, pytest.approx(0.5))
        # the file beside it is read with it; away from there it is asked for
        with read_recording(tmp_path / name) as recording:
            assert set(recording.channels) == {"slow"}
        _moved(tmp_path / f"{name}.dbc")
        with pytest.raises(RecordingError, match="--dbc"):
            read_recording(tmp_path / name)
