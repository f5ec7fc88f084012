"""Trajectories as Dymola, OpenModelica and OMSimulator write them: a table of names over two matrices."""

import numpy as np
import pytest
import scipy.io

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

TIME = 0.01 * np.arange(301)
SPEED = 50.0 + np.sin(TIME)
TORQUE = 1500.0 * np.cos(TIME)


def _letters(words, *, turned):
    width = max(map(len, words))
    matrix = np.array([list(word.ljust(width)) for word in words])
    return np.ascontiguousarray(matrix.T) if turned else matrix


def _save(path, time, columns, *, turned=True, dtype="f8", kind="Atrajectory", places=None):
    """Save columns by name, each with what is said of it, and of all the last as the negative of the one before."""
    names = ["Time", *columns, "minus", "J"]
    said = ["Time in [s]", *(text for text, _ in columns.values()), "Cut torque [N.m]", "Inertia [kg.m2]"]
    count = len(columns)
    table = np.array(
        [[0, *[2] * count, 2, 1], [1, *range(2, count + 2), -(count + 1), 2], [0] * (count + 3), [-1] * (count + 3)]
    )
    if places is not None:
        table[1] = places
    data_1, data_2 = (
        np.array([[0.0, 4.5], [3.0, 4.5]]),
        np.column_stack([time, *(values for _, values in columns.values())]),
    )
    content = {
        "Aclass": _letters([kind, "1.1", "", "binTrans" if turned else "binNormal"], turned=False),
        "name": _letters(names, turned=turned),
        "description": _letters(said, turned=turned),
        "dataInfo": (table if turned else table.T).astype("i4"),
        "data_1": data_1.T if turned else data_1,
        "data_2": (data_2.T if turned else data_2).astype(dtype),
    }
    scipy.io.savemat(path, content, format="4")
    return path


def _columns(rows=slice(None)):
    return {
        "inertia.w": ("Absolute angular velocity [rad/s|rev/min]", SPEED[rows]),
        "torque.tau": ("Driving torque [N.m]", TORQUE[rows]),
    }


@pytest.mark.parametrize("turned", [True, False])
def test_trajectories_are_channels_with_the_unit_of_their_values(tmp_path, turned):
    with read_recording(_save(tmp_path / "result.mat", TIME, _columns(), turned=turned)) as recording:
        assert recording.format == "Modelica trajectories (MATLAB v4)"
        assert {name: one.unit for name, one in recording.channels.items()} == {
            "inertia.w": "rad/s", "torque.tau": "N m", "minus": "N m",
        }  # fmt: skip
        speed = recording.channel("inertia.w")
        assert (speed.rate_hz, speed.start_s, speed.count) == (100.0, 0.0, 301)
        assert speed.long_name == "Absolute angular velocity"
        assert np.array_equal(speed.values(0, 301), SPEED)
        assert np.array_equal(recording.channel("minus").values(5, 9), -TORQUE[5:9])
        assert recording.left_out == {"1 parameters": "they do not change: J"}


def test_of_two_rows_at_an_event_the_later_counts(tmp_path):
    rows = [*range(101), *range(100, 301), 300]
    columns = _columns(rows)
    columns["torque.tau"][1][101] = 7.0
    with read_recording(_save(tmp_path / "result.mat", TIME[rows], columns)) as recording:
        torque = recording.channel("torque.tau")
        assert (torque.rate_hz, torque.count, torque.clock_jumps, torque.is_uneven) == (100.0, 301, (), False)
        assert torque.values(99, 102).tolist() == [TORQUE[99], 7.0, TORQUE[101]]
        assert recording.remarks == ("2 rows before an event have the time of the row behind them, which counts.",)


def test_events_between_the_samples_are_left_out(tmp_path):
    time = np.insert(TIME, 101, [1.0037, 1.0037])
    columns = {name: (text, np.insert(values, 101, [3.0, 4.0])) for name, (text, values) in _columns().items()}
    with read_recording(_save(tmp_path / "result.mat", time, columns, dtype="f4")) as recording:
        speed = recording.channel("inertia.w")
        assert (speed.count, speed.clock_jumps) == (301, ())
        assert np.allclose(speed.values(0, 301), SPEED, rtol=1e-6)
        assert recording.remarks[1] == "1 rows at events between two samples were left out."


@pytest.mark.parametrize(
    ("more", "told"),
    [
        ({"kind": "AlinearSystem"}, "expected the trajectories of a Modelica tool, found 'AlinearSystem'"),
        ({"places": [1, 2, 9, 2, 2]}, "expected places from 1 to 3"),
    ],
)
def test_what_fits_no_trajectory_is_told(tmp_path, more, told):
    with pytest.raises(RecordingError, match=told):
        read_recording(_save(tmp_path / "result.mat", TIME, _columns(), **more))


def test_a_rate_that_is_not_that_of_the_times_is_told(tmp_path):
    path = _save(tmp_path / "result.mat", TIME, _columns())
    with pytest.raises(RecordingError, match="found variable time 100 Hz, the hint sample_rate_hz 50 Hz"):
        read_recording(path, sample_rate_hz=50.0)
