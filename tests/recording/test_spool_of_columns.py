"""What is unpacked lies in a file without a name, and has an end."""

import gzip
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording


def table(rows):
    """Return the text of a table whose rows differ."""
    return "time [s],c0\n" + "\n".join(f"{0.01 * row:.2f},{row % 97}" for row in range(rows)) + "\n"


def test_columns_come_back_from_whatever_row_is_asked_for(tmp_path):
    path = tmp_path / "long.csv"
    rows = 300_000
    path.write_text(table(rows))
    with read_recording(path) as recording:
        channel = recording.channels["c0"]
        for start, stop in ((0, 5), (rows - 3, rows), (99_990, 240_010), (7, 7)):
            np.testing.assert_array_equal(channel.source(start, stop), np.arange(start, stop) % 97)
    with pytest.raises(RecordingError, match="has been closed already"):
        channel.source(0, 1)


@pytest.mark.skipif(os.name != "posix", reason="the system takes a file without a name back")
def test_a_reader_that_is_killed_leaves_nothing(tmp_path):
    path, scratch = tmp_path / "long.csv", tmp_path / "scratch"
    path.write_text(table(50_000))
    scratch.mkdir()
    program = (
        "import os, signal, sys\n"
        "from shaftprint.recording import read_recording\n"
        "read_recording(sys.argv[1])\n"
        "os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, str(path)], env=os.environ | {"TMPDIR": str(scratch)}, check=False
    )
    assert done.returncode == -9
    assert list(scratch.iterdir()) == []


@pytest.mark.slow
def test_what_is_far_longer_unpacked_than_packed_is_refused(tmp_path):
    path = tmp_path / "zeros.csv.gz"
    with gzip.open(path, "wt") as file:
        file.write("time [s],U [V]\n")
        for _ in range(12):
            file.write("0,0\n" * 100_000)
    # 1.2 million rows of two values, 19 MB, from 10 kB
    assert path.stat().st_size < 40_000
    before = set(Path(tempfile.gettempdir()).glob("shaftprint-*"))
    with pytest.raises(RecordingError, match="expected at most 400 times its length when it is unpacked"):
        read_recording(path)
    assert set(Path(tempfile.gettempdir()).glob("shaftprint-*")) <= before
