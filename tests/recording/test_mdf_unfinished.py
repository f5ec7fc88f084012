"""MDF files as loggers leave them that were switched off: counts and lengths of the last blocks are not written."""

import faulthandler
import struct
import tempfile
import time

import asammdf
import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording
from shaftprint.recording.readers import _mdf_trial
from shaftprint.recording.readers._mdf_unfinished import bytes_to_read

resource = pytest.importorskip("resource", reason="needs limits of time, which Windows does not have")

TIMES = 0.01 * np.arange(3000)
SPEED = 1200.0 + 100.0 * np.sin(TIMES)
# of the number of records, and of the length of the last block of data
COUNTS_AND_LENGTH = 0x05


def unfinished(path):
    """Write a file with asammdf, and take back what a logger writes last (ASAM MDF 4.1: blocks ID, CG, DT)."""
    with asammdf.MDF(version="4.11") as file:
        file.append([asammdf.Signal(SPEED, TIMES, name="n", unit="rpm")])
        file.save(path, overwrite=True, compression=0)
    content = bytearray(path.read_bytes())
    content[:8] = b"UnFinMF "
    struct.pack_into("<H", content, 60, COUNTS_AND_LENGTH)
    # header of 24 bytes and six links, then the identifier of the records, then their number
    group, data = content.index(b"##CG"), content.index(b"##DT")
    assert struct.unpack_from("<Q", content, group + 24 + 6 * 8 + 8) == (SPEED.size,)
    struct.pack_into("<Q", content, group + 24 + 6 * 8 + 8, 0)
    struct.pack_into("<Q", content, data + 8, 24)
    path.write_bytes(content)
    return path


def test_a_file_that_its_logger_did_not_finish_is_read_whole_and_left_as_it_is(tmp_path):
    path = unfinished(tmp_path / "00000001.mf4")
    before = path.read_bytes()
    with read_recording(path) as recording:
        channel = recording.channel("n")
        assert channel.values(0, channel.count) == pytest.approx(SPEED, abs=0.0)
        assert channel.rate_hz == pytest.approx(100.0)
        assert any("did not finish" in remark for remark in recording.remarks)
    assert path.read_bytes() == before
    assert [one.name for one in tmp_path.iterdir()] == [path.name]


def test_what_the_library_does_not_finish_in_time_is_refused(tmp_path, monkeypatch):
    path = tmp_path / "log.mf4"
    path.write_bytes(b"UnFinMF 4.11".ljust(60, b"\0") + struct.pack("<H", COUNTS_AND_LENGTH) + bytes(400))
    bytes_to_read(path)[0].close()
    program = tmp_path / "endless.py"
    # ends as the system's limit of processor time ends a program
    program.write_text(
        "import os, signal, tempfile\nfile = tempfile.NamedTemporaryFile()\nos.kill(os.getpid(), signal.SIGKILL)\n"
    )
    monkeypatch.setattr(_mdf_trial, "__file__", str(program))
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    monkeypatch.setenv("TMPDIR", str(folder))
    with pytest.raises(RecordingError, match="finish it with the tool of the logger"):
        bytes_to_read(path)
    assert list(folder.iterdir()) == []


def test_the_trial_leaves_the_file_as_it_is(tmp_path, monkeypatch):
    limits = []
    monkeypatch.setattr(resource, "setrlimit", lambda which, limit: limits.append((which, limit[0])))
    monkeypatch.setattr(faulthandler, "dump_traceback_later", lambda *_, **__: None)
    path = unfinished(tmp_path / "log.mf4")
    before = path.read_bytes()
    _mdf_trial.finish(str(path))
    assert path.read_bytes() == before
    ((which, longest_s),) = limits
    assert which == resource.RLIMIT_CPU
    assert 9.0 < longest_s - time.process_time() < 12.0
