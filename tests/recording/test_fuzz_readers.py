"""Mutated files of every format end in channels or in one sentence: no other error, no hang, no memory out of bounds.

``SHAFTPRINT_FUZZ=2000`` sets how many inputs each format gets; without it a few.
"""

import gzip
import os
import resource
import signal
import sys
import tempfile
import time

import asammdf
import h5netcdf
import nptdms
import numpy as np
import pytest
import scipy.io

from shaftprint.errors import RecordingError
from shaftprint.recording import RecordingWriter, read_recording, write_mat_v73
from shaftprint.recording.readers import READERS

INPUTS = int(os.environ.get("SHAFTPRINT_FUZZ", "25"))
LONGEST_S = 5.0
MOST_MEMORY_MB = 1000.0
CLOCK = np.arange(400) / 100.0
COUNTS = np.arange(-200, 200, dtype=np.int16)


def _native(path):
    with RecordingWriter(path) as writer:
        writer.declare("M_s", unit="N m", rate_hz=100.0, scale=0.5)
        writer.append("M_s", COUNTS)


def _mdf(path):
    with asammdf.MDF(version="4.10") as file:
        torque = asammdf.Signal(COUNTS, CLOCK, name="M_s", unit="V", conversion={"a": 0.5, "b": -3.0})
        file.append([torque, asammdf.Signal(np.sin(CLOCK), CLOCK, name="U", unit="V")])
        file.append([asammdf.Signal(CLOCK[:50], CLOCK[:50] * 7.0, name="X", invalidation_bits=CLOCK[:50] > 0.2)])
        file.save(path, overwrite=True, compression=1)


def _mdf3(path):
    with asammdf.MDF(version="3.30") as file:
        file.append([asammdf.Signal(COUNTS, CLOCK, name="M_s", unit="V", conversion={"a": 0.5, "b": -3.0})])
        file.save(path, overwrite=True)


def _tdms(path):
    said = {"wf_increment": 0.01, "wf_start_offset": 0.25, "unit_string": "V"}
    with nptdms.TdmsWriter(str(path)) as writer:
        for part in (slice(0, 150), slice(150, 400)):
            channels = [
                nptdms.ChannelObject("a", "M_s", COUNTS[part], said),
                nptdms.ChannelObject("a", "U", CLOCK[part]),
            ]
            writer.write_segment(channels)


def _mat(version):
    def write(path):
        slow = {} if version == "4" else {"slow": {"fs": 10.0, "X": CLOCK[:40]}}
        scipy.io.savemat(
            path, {"t": CLOCK, "M_s": np.sin(CLOCK), **slow}, format=version, do_compression=version == "5"
        )

    return write


def _mat73(path):
    _native(path.with_suffix(".nc"))
    with read_recording(path.with_suffix(".nc")) as recording:
        write_mat_v73(path, recording.channels.values())


def _netcdf4(path):
    with h5netcdf.File(path, "w") as file:
        file.dimensions = {"time": 400}
        file.create_variable("time", ("time",), "f8", data=CLOCK).attrs["units"] = "seconds since 2026-03-04"
        file.create_variable("M_s", ("time",), "i2", data=COUNTS, compression="gzip").attrs["scale_factor"] = 0.5


def _netcdf3(path):
    with scipy.io.netcdf_file(path, "w") as file:
        file.createDimension("time", 400)
        file.createVariable("time", "d", ("time",))[:] = CLOCK
        file.createVariable("M_s", "h", ("time",))[:] = COUNTS


def _text(path):
    rows = (f"{4 + k // 86400:02}.03.2026 05:06:{k % 60:02},5;{k},25;-3,5e-2" for k in range(60))
    path.write_text("Logger 7\n\nDate;M_s;U\n;N m;V\n" + "\n".join(rows) + "\n")


def _packed(path):
    _text(path)
    path.write_bytes(gzip.compress(path.read_bytes()))


def _noise(path):
    path.write_bytes(np.random.default_rng(5).bytes(4000))


FORMATS = {
    "native.nc": _native, "log.mf4": _mdf, "log.mdf": _mdf3, "log.tdms": _tdms, "v4.mat": _mat("4"),
    "v5.mat": _mat("5"), "v73.mat": _mat73, "other.nc": _netcdf4, "classic.nc": _netcdf3, "log.csv": _text,
    "log.csv.gz": _packed, "log.dxd": _noise,
}  # fmt: skip


def _mutated(content, rng):
    """Return a damaged copy: bits, numbers, pieces, ends; the beginning, where formats say most, more often."""
    found = bytearray(content)
    for _ in range(int(rng.integers(1, 6))):
        length = len(found)
        place = int(length * rng.random() ** (3 if rng.random() < 0.5 else 1)) if length else 0
        size = int(2 ** rng.uniform(0, 8))
        match int(rng.integers(6)):
            case 0:
                found[place : place + 1] = bytes([int(rng.integers(256))])
            case 1:
                found[place : place + 4] = rng.choice([b"\xff\xff\xff\xff", b"\xff\xff\xff\x7f", bytes(4), b"\0\0\0\1"])
            case 2:
                found[place : place + 8] = rng.integers(0, 2**62, dtype=np.int64).tobytes()
            case 3:
                del found[place : place + size]
            case 4:
                found[place:place] = found[place : place + size]
            case _:
                del found[place if rng.random() < 0.3 else length :]
    return bytes(found)


def _read_all(path):
    with read_recording(path) as recording:
        for channel in recording.channels.values():
            for start in range(0, channel.count, 100_000):
                channel.values(start, min(start + 100_000, channel.count))


def _overdue(number, frame):
    raise BaseException(f"reading takes more than {6 * LONGEST_S:g} s")


@pytest.mark.skipif(not hasattr(signal, "SIGALRM"), reason="needs alarms to end a reader that hangs")
@pytest.mark.parametrize("name", FORMATS)
def test_mutated_files_end_in_channels_or_in_one_sentence(tmp_path, name):
    path = tmp_path / name
    FORMATS[name](path)
    content = path.read_bytes()
    if name != "log.dxd":
        _read_all(path)
    rng = np.random.default_rng(11)
    signal.signal(signal.SIGALRM, _overdue)
    refused, lines, slowest = 0, 1, 0.0
    # Dewesoft's library runs in a process of its own, which takes half a second
    inputs = max(INPUTS // 50, 1) if name == "log.dxd" else INPUTS
    for number in range(inputs):
        mutated = _mutated(content, rng)
        path.write_bytes(mutated)
        signal.alarm(int(6 * LONGEST_S))
        begin = time.perf_counter()
        try:
            _read_all(path)
        except RecordingError as error:
            refused += 1
            lines = len(str(error).splitlines())
        finally:
            signal.alarm(0)
        assert lines == 1, number
        slowest = max(slowest, time.perf_counter() - begin)
        assert slowest < LONGEST_S, f"input {number} took {slowest:.1f} s"
    assert refused > 0
    peak_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (1024.0 if sys.platform != "darwin" else 1048576.0)
    sys.stdout.write(f"{name}: {inputs} inputs, {refused} refused, slowest {slowest:.2f} s, peak {peak_mb:.0f} MB\n")
    if INPUTS >= 2000:
        # alone in its process; in the whole suite other tests fill the memory
        assert peak_mb < MOST_MEMORY_MB


def test_every_reader_is_fuzzed(tmp_path):
    formats = set()
    for name, write in FORMATS.items():
        path = tmp_path / name
        write(path)
        formats |= {reader.NAME for reader in READERS if reader.is_mine(path)}
    assert formats == {reader.NAME for reader in READERS}


def test_nothing_is_left_behind(tmp_path, monkeypatch):
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(scratch))
    path = tmp_path / "v5.mat"
    FORMATS["v5.mat"](path)
    content = path.read_bytes()
    rng = np.random.default_rng(3)
    for _ in range(30):
        path.write_bytes(_mutated(content, rng))
        try:
            _read_all(path)
        except RecordingError:
            continue
    assert list(scratch.iterdir()) == []
