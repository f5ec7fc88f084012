"""Readers from other packages, and a Dewesoft library that stands in for the one that needs Dewesoft's files."""

import os
import sys
from pathlib import Path

import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import Samples, read_recording, recording_from_arrays
from shaftprint.recording.readers import _outside

# Names and signatures as in dwdatareader 1.3.0; DWIGetScaledSamples fills two arrays whose ctypes views it is given.
STAND_IN = """
import ctypes
from datetime import UTC, datetime
import numpy as np

class DWError(RuntimeError):
    pass

class DWBinaryChannel:
    pass

class DWComplexChannel:
    pass

class Info:
    start_measure_time = datetime(2026, 3, 4, 4, 46, 7, tzinfo=UTC)
    start_store_time = datetime(2026, 3, 4, 5, 6, 7, tzinfo=UTC)

class Channel:
    description = "what it is"
    def __init__(self, index, name, unit, kind, rate, times, values, size=1):
        self.index, self.unique_key, self.unit, self.channel_type = index, name, unit, kind
        self.sample_rate, self.times, self.values, self.array_size = rate, times, values, size
        self.number_of_samples = len(times)

class Closed(Channel):
    @property
    def description(self):
        raise DWError("no such channel")

K = np.arange(600_000)
CHANNELS = [
    Channel(0, "M_s", "Nm", 0, 2000.0, 1200.25 + K / 2000.0, K * 0.5),
    Channel(1, "X", "%", 1, 0.0, K[:300] / 20.0, -1.0 * K[:300]),
    Channel(2, "bus", "", 1, 0.0, np.cumsum(1 + K[:300] % 7), K[:300]),
    Channel(3, "triggered", "V", 0, 2000.0, K[:300] / 2000.0 + 5.0 * (K[:300] > 100), K[:300]),
    Channel(4, "spectrum", "V", 0, 10.0, K[:300] / 10.0, K[:300], size=8),
    Channel(5, "single", "V", 2, 0.0, K[:1], K[:1]),
    Channel(6, "CAN/EngineSpeed", "rpm", 1, 0.0, K[:300] / 50.0, K[:300]),
    Closed(7, "CAN/Demand", "%", 1, 0.0, K[:300] / 50.0, K[:300]),
]
REFUSED = 6

class DWFile(dict):
    reader_handle = None
    info = Info()
    def __init__(self, source):
        if open(source, "rb").read(4) != b"DEWE":
            raise DWError("no Dewesoft file")
        super().__init__({channel.unique_key: channel for channel in CHANNELS})
    def __enter__(self):
        return self
    def __exit__(self, *what):
        pass

class Library:
    def DWIGetScaledSamples(self, handle, index, start, count, data, time):
        if index == REFUSED:
            return 10
        part = slice(start.value, start.value + count.value)
        for view, values in ((data, CHANNELS[index].values), (time, CHANNELS[index].times)):
            found = np.ascontiguousarray(values[part], dtype=float)
            ctypes.memmove(view.data, found.ctypes.data, found.nbytes)
        return 0

DLL = Library()
"""


def _read_acme(path: Path, **hints: object):
    if path.suffix != ".acme":
        return None
    torque = np.fromfile(path, dtype="<f4")
    return recording_from_arrays(
        path, [Samples(name="M_s", values=torque, unit="N m", rate_hz=1000.0)], format="ACME logger"
    )


@pytest.fixture
def outside(monkeypatch):
    """Make functions known as if another package offered them."""

    def make_known(*functions):
        monkeypatch.setattr(_outside, "_functions", lambda: [(f"number {k}", f) for k, f in enumerate(functions)])

    return make_known


def test_a_plain_function_is_a_reader(tmp_path, outside):
    outside(_read_acme)
    path = tmp_path / "log.acme"
    np.array([1.5, -2.0], dtype="<f4").tofile(path)
    with read_recording(path) as recording:
        assert recording.format == "ACME logger"
        assert recording.channel("M_s").values(0, 2).tolist() == [1.5, -2.0]


def test_an_outside_reader_leaves_other_files_alone(native, outside):
    outside(_read_acme)
    with read_recording(native) as recording:
        assert recording.format == "shaftprint recording (NetCDF-4)"


def test_an_outside_reader_that_fails_is_named(native, outside):
    def broken(path, **hints):
        raise ZeroDivisionError("never mind")

    outside(broken)
    with pytest.raises(RecordingError, match=r"the reader number 0 of another package failed \(ZeroDivisionError"):
        read_recording(native)


def test_arrays_that_are_no_channels_are_refused(native):
    twice = [Samples(name="a", values=[1.0, 2.0], unit="V", rate_hz=1.0)] * 2
    with pytest.raises(RecordingError, match="channel a: expected a unique name"):
        recording_from_arrays(native, twice, format="x")


@pytest.fixture
def dewesoft(tmp_path, monkeypatch):
    """A folder in which the stand-in is found first, also by other processes."""
    (tmp_path / "dwdatareader.py").write_text(STAND_IN)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=os.pathsep)
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "dwdatareader", raising=False)
    return tmp_path


def test_dewesoft_channels_with_clocks_and_without(dewesoft):
    path = dewesoft / "log.dxd"
    path.write_bytes(b"DEWE")
    with read_recording(path) as recording:
        torque, percent = recording.channel("M_s"), recording.channel("X")
        assert (torque.unit, torque.rate_hz, torque.start_s, torque.count) == ("N m", 2000.0, 1200.25, 600_000)
        assert torque.values(262_143, 262_146).tolist() == [131_071.5, 131_072.0, 131_072.5]
        assert (percent.rate_hz, percent.values(298, 300).tolist()) == (20.0, [-298.0, -299.0])
        assert set(recording.left_out) == {"triggered", "spectrum", "single", "CAN/EngineSpeed", "CAN/Demand"}
        for name in ("CAN/EngineSpeed", "CAN/Demand"):
            assert "Dewesoft's library refuses the channel" in recording.left_out[name]
        assert recording.channel("bus").is_uneven
        assert "triggered" in recording.left_out["triggered"]
        # the first sample was taken 20 minutes later, when storing began
        assert recording.began.isoformat() == "2026-03-04T04:46:07+00:00"
    with pytest.raises(RecordingError, match="closed already"):
        torque.read(0, 1)


def test_a_file_that_dewesofts_library_refuses(dewesoft):
    path = dewesoft / "log.d7d"
    path.write_bytes(b"something else")
    with pytest.raises(
        RecordingError, match=r"Dewesoft's library refuses \(.*no Dewesoft file\); open it in Dewesoft X"
    ):
        read_recording(path)


def test_a_library_that_ends_the_process_ends_in_a_sentence(dewesoft):
    (dewesoft / "dwdatareader.py").write_text("import os\nos.abort()\n")
    path = dewesoft / "log.d7d"
    path.write_bytes(b"DEWE")
    with pytest.raises(RecordingError, match="Dewesoft's library refuses"):
        read_recording(path)


@pytest.mark.parametrize(("ending", "package"), [(".mf4", "asammdf"), (".tdms", "nptdms")])
def test_a_library_that_is_absent_is_named(tmp_path, monkeypatch, ending, package):
    path = tmp_path / f"log{ending}"
    path.write_bytes(b"MDF     4.10    " if ending == ".mf4" else b"TDSm" + bytes(24))
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(
        RecordingError, match=rf'{package}, which is not installed; pip install "shaftprint\[readers\]"'
    ):
        read_recording(path)
