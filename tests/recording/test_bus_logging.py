"""Raw frames of a CAN bus: taken apart by a DBC file, each signal at the times of its own message."""

import numpy as np
import pytest
from asammdf import Signal
from tests.can_frames import DBC, EEC1, EEC2, eec1, eec2, raw_log

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording, write_recording


def sent(count, period_s, first_s, seed):
    rng = np.random.default_rng(seed)
    times = first_s + period_s * np.arange(count) + 0.2 * period_s * rng.uniform(-1.0, 1.0, count)
    return times[rng.random(count) > 0.01]


FAST, SLOW = sent(3000, 0.02, 0.0137, 1), sent(1200, 0.05, 0.031, 2)
TORQUE, RPM = np.rint(40.0 + 9.0 * np.sin(FAST)), 0.125 * np.rint(8.0 * (1200.0 + 100.0 * np.sin(FAST)))
PEDAL, LOAD = 0.4 * np.rint(125.0 + 50.0 * np.sin(SLOW)), np.rint(50.0 + 9.0 * np.sin(SLOW))


@pytest.fixture
def dbc(tmp_path):
    (tmp_path / "engine.dbc").write_text(DBC, encoding="utf-8")
    return tmp_path / "engine.dbc"


@pytest.fixture
def log(tmp_path):
    frames = [(FAST, EEC1, eec1(TORQUE, RPM)), (SLOW, EEC2, eec2(PEDAL, LOAD))]
    analog_s = np.arange(6000) / 100.0
    return raw_log(tmp_path / "log.mf4", frames, [Signal(np.sin(analog_s), analog_s, name="M_s", unit="V")])


def test_frames_become_channels_at_the_times_of_their_messages(log, dbc):
    with read_recording(log, dbc=dbc) as recording:
        assert not recording.left_out
        expected = {
            "DriversDemandPercentTorque": (FAST, TORQUE, "%", "SPN 512"),
            "ActualEnginePercentTorque": (FAST, TORQUE, "%", "SPN 513"),
            "EngineSpeed": (FAST, RPM, "rpm", "SPN 190: actual speed of the crankshaft"),
            "AcceleratorPedalPosition1": (SLOW, PEDAL, "%", "SPN 91"),
            "EnginePercentLoadAtCurrentSpeed": (SLOW, LOAD, "%", "SPN 92"),
        }
        assert set(recording.channels) == {"M_s", *expected}
        assert not recording.channel("M_s").is_uneven
        for name, (times, values, unit, long_name) in expected.items():
            channel = recording.channel(name)
            assert channel.is_uneven
            assert (channel.unit, channel.long_name) == (unit, long_name)
            assert channel.stamps_s(0, channel.count) == pytest.approx(times, abs=1e-9)
            assert channel.values(0, channel.count) == pytest.approx(values, abs=1e-9)
    with pytest.raises(RecordingError, match="closed already"):
        channel.read(0, 1)


def test_what_was_taken_apart_can_be_kept(log, dbc, tmp_path):
    with read_recording(log, dbc=str(dbc)) as recording:
        write_recording(tmp_path / "log.nc", recording.channels.values())
    with read_recording(tmp_path / "log.nc") as again:
        speed = again.channel("EngineSpeed")
        assert np.array_equal(speed.values(0, speed.count), RPM)
        assert speed.long_name.startswith("SPN 190")


def test_indicators_are_no_values(tmp_path, dbc):
    """0xFF and 0xFE in a byte, 0xFFFF and 0xFE00 in two: not available, error (SAE J1939-71)."""
    content = eec1(TORQUE, RPM)
    content[10, 1], content[11, 1] = 0xFF, 0xFE
    content[12, 3:5], content[13, 3:5] = 0xFF, [0x00, 0xFE]
    with read_recording(raw_log(tmp_path / "log.mf4", [(FAST, EEC1, content)]), dbc=dbc) as recording:
        torque, speed = (recording.channel(name) for name in ("DriversDemandPercentTorque", "EngineSpeed"))
        assert np.flatnonzero(np.isnan(torque.values(0, torque.count))).tolist() == [10, 11]
        assert np.flatnonzero(np.isnan(speed.values(0, speed.count))).tolist() == [12, 13]


def test_two_engines_on_one_bus_are_told_apart(tmp_path, dbc):
    frames = [(FAST, EEC1, eec1(TORQUE, RPM)), (FAST + 0.001, EEC1 + 1, eec1(TORQUE - 20.0, RPM))]
    with read_recording(raw_log(tmp_path / "log.mf4", frames), dbc=dbc) as recording:
        ports = [recording.channel(f"EEC1 of {sender}.ActualEnginePercentTorque") for sender in ("0x0", "0x1")]
        assert [one.values(5, 6)[0] for one in ports] == [TORQUE[5], TORQUE[5] - 20.0]


def test_without_a_dbc_file_raw_frames_of_no_standard_are_left_out_and_said(tmp_path):
    analog_s = np.arange(6000) / 100.0
    frames = [(FAST, 0x0CFF0400, eec1(TORQUE, RPM))]
    log = raw_log(tmp_path / "log.mf4", frames, [Signal(np.sin(analog_s), analog_s, name="M_s", unit="V")])
    with read_recording(log) as recording:
        assert set(recording.channels) == {"M_s"}
        assert recording.left_out["group 1"] == (
            "raw messages of a bus; give the DBC file that says what they hold, dbc= (--dbc of shaftprint convert)."
        )
        unknown = "CAN1 identifier 0CFF0400 (group 65284, sender 0x0)"
        assert recording.left_out[unknown].startswith(f"{FAST.size} frames")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (None, r"other\.dbc: expected a DBC file, found none there"),
        ("hello\n", r"other\.dbc: expected a DBC file with messages and signals, found none in it"),
        (DBC.replace("2364540158", "2364605694").replace("2364539902", "2364605438"), r"found none of them in the log"),
    ],
)
def test_a_dbc_file_that_does_not_fit_is_told(log, tmp_path, text, message):
    if text is not None:
        (tmp_path / "other.dbc").write_text(text, encoding="utf-8")
    with pytest.raises(RecordingError, match=message):
        read_recording(log, dbc=tmp_path / "other.dbc")


def test_a_log_without_raw_frames_needs_no_dbc_file(tmp_path, log, dbc):
    with read_recording(log) as recording:
        write_recording(tmp_path / "log.nc", recording.channels.values())
    with pytest.raises(RecordingError, match="expected no hints for this format, found the hint dbc"):
        read_recording(tmp_path / "log.nc", dbc=dbc)


def test_a_line_that_cannot_be_read_is_left_out_and_the_library_prints_nothing(log, dbc, capsys):
    text = dbc.read_text(encoding="utf-8")
    broken = text.replace("BO_ ", ' SG_ Two Words : 24|16@1+ (1,0) [0|1] "" ECU\nBO_ ', 2).split("\n", 1)
    dbc.write_text("\n".join(broken), encoding="utf-8")
    with read_recording(log, dbc=dbc) as recording:
        assert "Two Words cannot be read." in recording.left_out.values()
    assert capsys.readouterr() == ("", "")
