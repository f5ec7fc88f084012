"""HDF5 as other programs lay it out: columns, rows, tables of records; what is not read is named."""

import h5py
import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

TIME = 0.01 * np.arange(200)
U, Y = np.sign(np.sin(TIME)), np.cos(TIME)


def _values(recording, name):
    channel = recording.channel(name)
    assert (channel.rate_hz, channel.count) == (100.0, 200)
    return channel.values(0, 200)


@pytest.mark.parametrize("shape", [(200, 1), (1, 200), (1, 200, 1), (200,)])
def test_a_vector_of_any_shape(tmp_path, shape):
    with h5py.File(tmp_path / "log.h5", "w") as file:
        for name, values in (("time", TIME), ("u", U), ("y", Y)):
            file[name] = values.reshape(shape)
    with read_recording(tmp_path / "log.h5") as recording:
        assert np.array_equal(_values(recording, "u"), U)
        assert np.array_equal(_values(recording, "y")[50:60], Y[50:60])
        assert set(recording.channels) == {"u", "y"}


@pytest.mark.parametrize(("axis", "word"), [(0, "row"), (1, "column")])
def test_signals_side_by_side(tmp_path, axis, word):
    with h5py.File(tmp_path / "log.h5", "w") as file:
        file["data"], file.attrs["fs"] = np.stack([U, Y], axis=axis), 100.0
    with read_recording(tmp_path / "log.h5") as recording:
        assert np.array_equal(_values(recording, f"data {word} 1"), U)
        assert np.array_equal(_values(recording, f"data {word} 2"), Y)


def test_a_table_of_records(tmp_path):
    table = np.zeros(200, dtype=[("time", "f8"), ("u", "i2"), ("ok", "?"), ("note", "S4"), ("three", "f8", (3,))])
    table["time"], table["u"], table["ok"] = TIME, U, Y > 0.0
    with h5py.File(tmp_path / "log.h5", "w") as file:
        file["log"] = table
    with read_recording(tmp_path / "log.h5") as recording:
        assert np.array_equal(_values(recording, "u"), U)
        assert np.array_equal(_values(recording, "ok"), Y > 0.0)
        assert recording.left_out == {
            "log/note": "expected real numbers, found text.",
            "log/three": "expected real numbers, found several numbers a row.",
        }


def test_what_is_not_read_is_named(tmp_path):
    with h5py.File(tmp_path / "log.h5", "w") as file:
        file["time"], file["y"] = TIME, Y
        file["cube"], file["name"], file["complex"] = np.zeros((3, 4, 5)), [b"a", b"b"], np.zeros(5, complex)
        file["square"] = np.zeros((100, 100))
    with read_recording(tmp_path / "log.h5") as recording:
        assert set(recording.channels) == {"y"}
        assert set(recording.left_out) == {"cube", "name", "complex", "square"}
        assert "found an array of 3 x 4 x 5" in recording.left_out["cube"]
        assert recording.left_out["name"] == "expected real numbers, found text."
    with h5py.File(tmp_path / "log.h5", "w") as file:
        file["cube"] = np.zeros((3, 4, 5))
    with pytest.raises(RecordingError, match="cube: expected a vector or at most 64 of them side by side"):
        read_recording(tmp_path / "log.h5")
