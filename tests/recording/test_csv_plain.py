"""Text without titles, without times, or with columns apart by white space: what scientific programs write."""

import numpy as np
import pytest
from click.testing import CliRunner

from shaftprint.cli import shaftprint
from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

TORQUE = [1.25, 1.5, -0.002]
LABVIEW = """LabVIEW Measurement
Separator\tTab
X_Columns\tOne
***End_of_Header***

Channels\t1
Samples\t3
Y_Unit_Label\tVolts
Delta_X\t0.1
***End_of_Header***
X_Value\tM_s\tComment
0.5\t1.25
0.6\t1.5
0.7\t-0.002
"""


def _written(folder, text, name="log.txt"):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def _torque(path, **hints):
    with read_recording(path, **hints) as recording:
        channel = recording.channel("M_s")
        return channel, channel.values(0, channel.count).tolist()


@pytest.mark.parametrize(
    ("text", "unit"),
    [
        ("time M_s\n0.5 1.25\n0.6 1.5\n0.7 -0.002\n", ""),
        ("  time [s]   M_s [N m]\n   0.5   1.25\n   0.6   1.5\n   0.7  -0.002\n", "N m"),
        ("# time [s]  M_s (N m)\n0,5 1,25\n0,6 \t1,5\n0,7 -0,002  \n", "N m"),
        ("% made by a program\n% t M_s\n% s Nm\n0.5 1.25\n0.6 1.5\n0.7 -0.002\n", "N m"),
        (LABVIEW, "V"),
    ],
)
def test_columns_apart_by_white_space_or_with_a_preamble(tmp_path, text, unit):
    channel, values = _torque(_written(tmp_path, text))
    assert values == TORQUE
    assert (channel.rate_hz, channel.start_s) == (pytest.approx(10.0), 0.5)
    assert channel.unit == unit


@pytest.mark.parametrize("name", ["log.txt", "log.dat"])
def test_numbers_without_titles_are_named_by_the_user(tmp_path, name):
    path = tmp_path / name
    np.savetxt(path, np.column_stack([[0.5, 0.6, 0.7], [7.0, 8.0, 9.0], TORQUE]))
    channel, values = _torque(path, columns="time, u, M_s [Nm]")
    assert values == TORQUE
    assert (channel.unit, channel.rate_hz, channel.start_s) == ("N m", pytest.approx(10.0), 0.5)
    with pytest.raises(
        RecordingError, match=r"line 1: expected titles .* above 3 columns of numbers, found none; pass"
    ):
        read_recording(path)
    with pytest.raises(
        RecordingError, match="expected a row of 2 columns, as the hint columns says, found 3; name each of them"
    ):
        read_recording(path, columns="time,M_s")


def test_names_that_the_user_gives_take_the_place_of_titles(tmp_path):
    path = _written(tmp_path, "Zeitachse;;;\nx;Kanal 1;Kanal 1\n500;0;1,25\n600;0;1,5\n700;0;-0,002\n")
    channel, values = _torque(path, columns="time [ms],u,M_s [kNm]")
    assert values == TORQUE
    assert (channel.unit, channel.rate_hz, channel.start_s) == ("kN m", pytest.approx(10.0), 0.5)


@pytest.mark.parametrize(
    ("text", "hints"),
    [
        ("  1.25  3\n  1.5  4\n -0.002  5\n", {"columns": "M_s,u"}),
        ("M_s,u\n1.25,3\n1.5,4\n-0.002,5\n", {}),
    ],
)
def test_a_rate_that_the_user_gives_takes_the_place_of_times(tmp_path, text, hints):
    path = _written(tmp_path, text)
    channel, values = _torque(path, sample_rate_hz=250.0, **hints)
    assert values == TORQUE
    assert (channel.rate_hz, channel.start_s, channel.count) == (250.0, 0.0, 3)
    with pytest.raises(RecordingError, match=r'expected a column "time \[s\]".*or pass sample_rate_hz='):
        read_recording(path, **hints)


def test_a_single_column_at_a_rate(tmp_path):
    path = _written(tmp_path, "1.25\n1.5\n-0.002\n")
    channel, values = _torque(path, columns="M_s [V]", sample_rate_hz=2000.0)
    assert (channel.rate_hz, values) == (2000.0, TORQUE)


def test_a_rate_beside_times_must_be_theirs(tmp_path):
    path = _written(tmp_path, "time,M_s\n0.5,1.25\n0.6,1.5\n0.7,-0.002\n")
    assert _torque(path, sample_rate_hz=10.0)[1] == TORQUE
    with pytest.raises(
        RecordingError, match=r"one sample rate, found column time 10 Hz, the hint sample_rate_hz 2000 Hz"
    ):
        read_recording(path, sample_rate_hz=2000.0)


def test_the_commands_take_names_of_columns(tmp_path):
    path = _written(tmp_path, "".join(f"{0.01 * k:.2f} {k % 7}\n" for k in range(200)), name="log.dat")
    target = tmp_path / "log.nc"
    said = CliRunner().invoke(shaftprint, ["inspect", str(path), "--no-progress"])
    assert said.exit_code == 1
    assert "columns" in said.stderr
    options = ["--columns", "time,M_s", "--unit", "M_s=N m"]
    done = CliRunner().invoke(shaftprint, ["convert", str(path), "-o", str(target), *options])
    assert done.exit_code == 0, done.stderr
    with read_recording(target) as recording:
        channel = recording.channel("M_s")
        assert (channel.unit, channel.rate_hz, channel.count) == ("N m", 100.0, 200)
        assert channel.values(0, 9).tolist() == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 0.0, 1.0]


def test_white_space_numbers_over_many_lines_are_a_table_whatever_the_ending(tmp_path):
    path = tmp_path / "robot.dat"
    numbers = np.random.default_rng(2).normal(size=(500, 2))
    np.savetxt(path, numbers, fmt="%16.7e")
    with read_recording(path, columns="u,y", sample_rate_hz=500.0) as recording:
        assert recording.channel("y").values(0, 500) == pytest.approx(numbers[:, 1], rel=1e-6)
