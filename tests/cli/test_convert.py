"""``shaftprint convert`` brings recordings into the native container and out of it."""

import asammdf
import nptdms
import numpy as np
import pymatreader
import pytest

from shaftprint.recording import read_recording

CLOCK = np.arange(1000) / 100.0
COUNTS = np.arange(-500, 500, dtype=np.int16)


@pytest.fixture
def logged(tmp_path):
    """An MDF file of counts and values on one clock, and a slower channel."""
    path = tmp_path / "logged.mf4"
    with asammdf.MDF(version="4.10") as file:
        torque = asammdf.Signal(COUNTS, CLOCK, name="M_s", unit="Nm", conversion={"a": 0.5, "b": -3.0})
        file.append([torque, asammdf.Signal(np.sin(CLOCK), CLOCK, name="U", unit="")])
        file.append([asammdf.Signal(CLOCK[:10] * 7.0, CLOCK[:10] * 100.0, name="X", unit="%")])
        file.save(path)
    return path


def test_counts_scales_clocks_and_units_go_into_the_native_container(run, tmp_path, logged):
    before = logged.read_bytes()
    path = tmp_path / "test.nc"
    result = run("convert", logged, "-o", path, "--unit", "U=V")
    assert result.exit_code == 0
    assert f"{path}: 3 channels of {logged}." in result.output
    assert logged.read_bytes() == before
    with read_recording(path) as recording:
        assert recording.format == "shaftprint recording (NetCDF-4)"
        torque, voltage, slow = (recording.channel(name) for name in ("M_s", "U", "X"))
        assert (torque.unit, torque.scale, torque.offset, torque.rate_hz) == ("N m", 0.5, -3.0, 100.0)
        assert torque.read(0, 1000).dtype == np.int16
        assert np.array_equal(torque.read(0, 1000), COUNTS)
        assert voltage.unit == "V"
        assert np.array_equal(voltage.values(0, 1000), np.sin(CLOCK))
        assert (slow.unit, slow.rate_hz, slow.count) == ("%", 1.0, 10)


def test_ending_chooses_the_format_and_channels_can_be_chosen(run, tmp_path, logged):
    mat, tdms = tmp_path / "test.mat", tmp_path / "test.tdms"
    assert run("convert", logged, "-o", mat, "--channel", "M_s").exit_code == 0
    # pymatreader and npTDMS are the judges
    found = pymatreader.read_mat(mat)
    assert np.array_equal(np.ravel(found["M_s"]), COUNTS * 0.5 - 3.0)
    assert "U" not in found
    assert run("convert", logged, "-o", tdms, "--channel", "M_s", "--channel", "U").exit_code == 0
    channels = {channel.name: channel for group in nptdms.TdmsFile(tdms).groups() for channel in group.channels()}
    assert set(channels) == {"M_s", "U"}
    assert np.array_equal(channels["M_s"][:], COUNTS * 0.5 - 3.0)
    assert channels["M_s"].properties["wf_increment"] == 0.01


def test_several_recordings_into_a_folder(run, tmp_path, logged):
    other = tmp_path / "other.mf4"
    other.write_bytes(logged.read_bytes())
    folder = tmp_path / "native"
    folder.mkdir()
    assert run("convert", logged, other, "-o", folder).exit_code == 0
    assert sorted(path.name for path in folder.iterdir()) == ["logged.mf4.nc", "other.mf4.nc"]
    result = run("convert", logged, other, "-o", tmp_path / "absent")
    assert result.exit_code == 2
    assert "expected an existing folder for 2 recordings" in result.stderr


def test_channels_that_cannot_be_used_are_told(run, tmp_path):
    path, target = tmp_path / "text.mf4", tmp_path / "text.nc"
    with asammdf.MDF(version="4.10") as file:
        file.append(
            [
                asammdf.Signal(COUNTS, CLOCK, name="M_s"),
                asammdf.Signal(np.full(1000, b"on"), CLOCK, name="W", encoding="utf-8"),
            ]
        )
        file.save(path)
    result = run("convert", path, "-o", target)
    assert result.exit_code == 0
    assert f"{path}: left out W: " in result.stderr
    with read_recording(target) as recording:
        assert list(recording.channels) == ["M_s"]


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (["--unit", "M_s=V"], 'expected no other unit than the file\'s "N m", found "V"'),
        (["--channel", "M_x"], 'expected a channel "M_x", found M_s, U, X'),
        (["--unit", "M_s"], 'expected CHANNEL=UNIT such as M_s="N m", found "M_s"'),
    ],
)
def test_refusals_leave_nothing_behind(run, tmp_path, logged, more, message):
    target = tmp_path / "test.nc"
    result = run("convert", logged, "-o", target, *more)
    assert result.exit_code in (1, 2)
    assert message in result.stderr
    assert not target.exists()


def test_an_existing_file_is_kept_unless_forced(run, tmp_path, logged):
    target = tmp_path / "test.nc"
    target.write_text("mine")
    result = run("convert", logged, "-o", target)
    assert result.exit_code == 1
    assert "exists already" in result.stderr
    assert target.read_text() == "mine"
    assert run("convert", logged, "-o", target, "--force").exit_code == 0


def test_a_log_of_a_bus_says_what_it_loses_and_is_read_with_the_dbc_file_beside_it(run, tmp_path):
    source, log = tmp_path / "test.csv", tmp_path / "test.blf"
    source.write_text("time [s],M_s [V]\n" + "".join(f"{0.01 * row:.2f},{row % 7}\n" for row in range(200)))
    result = run("convert", source, "-o", log)
    # 6 V over 64254 steps of 2^-13 V at least
    assert f"{log}: M_s is rounded to steps of 0.00012207 V, counts of 16 bits." in result.stderr
    assert "test.blf.dbc beside it says what the frames hold" in result.stderr
    again = tmp_path / "again.nc"
    assert run("convert", log, "--dbc", tmp_path / "test.blf.dbc", "-o", again).exit_code == 0
    with read_recording(again) as recording:
        assert recording.channel("M_s").values(0, 8).tolist() == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 0.0]
    result = run("convert", source, "-o", log, "--format", "lvm")
    assert result.exit_code == 1
    assert 'expected one of the endings .lvm, found ".blf"' in result.stderr


def test_all_channels_go_to_one_rate(run, tmp_path, logged):
    path = tmp_path / "even.csv"
    result = run("convert", logged, "-o", path, "--channel", "M_s", "--channel", "U", "--rate", 40.0, "--unit", "U=V")
    assert result.exit_code == 0, result.output
    with read_recording(path) as recording:
        torque, voltage = recording.channel("M_s"), recording.channel("U")
        assert (torque.rate_hz, torque.count) == (40.0, voltage.count)
        time = torque.time_s(0, torque.count)
        inside = (time > 1.0) & (time < 9.0)
        # the torque is a line, 0.5 of -500 to 499 less 3, the voltage a sine
        assert torque.values(0, torque.count)[inside] == pytest.approx((50.0 * time - 253.0)[inside], abs=1e-2)
        assert voltage.values(0, voltage.count)[inside] == pytest.approx(np.sin(time[inside]), abs=1e-3)
    refused = run("convert", logged, "-o", tmp_path / "x.nc", "--rate", 0)
    assert refused.exit_code == 1
    assert "--rate: expected a positive rate in Hz, found 0." in refused.output
