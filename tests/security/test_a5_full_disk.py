"""Issue item A5: a full disk ends in a sentence, not in a crash of HDF5's library when the program ends."""

import shutil
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from shaftprint.recording import RecordingWriter, read_recording

HERE = Path(__file__).parent
resource = pytest.importorskip("resource", reason="Windows has no limit of file sizes")


def called(*arguments, **options):
    """Run a program to its end, HDF5's own included."""
    call = [sys.executable, *map(str, arguments)]
    return subprocess.run(call, capture_output=True, text=True, timeout=600, check=False, **options)


# from the first byte of the header to the last block of the second channel, which is written when the file is closed
@pytest.mark.slow
@pytest.mark.parametrize("limit", [0, 1, 96, 1000, 5_000, 520_000, 1_000_000, 2_000_000, 3_700_000, 3_725_000])
@pytest.mark.parametrize("ending", [".nc", ".mat"])
def test_every_block_may_be_the_last(tmp_path, ending, limit):
    path = tmp_path / f"test{ending}"
    done = called(HERE / "write_until_full.py", path, limit)
    assert done.returncode == 1, (done.returncode, done.stderr)
    assert f"{path}: the " in done.stderr
    assert "cannot be written: " in done.stderr
    assert "File too large" in done.stderr
    assert done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def limited():
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 20, resource.RLIM_INFINITY))


@pytest.mark.slow
@pytest.mark.parametrize("ending", [".nc", ".csv"])
def test_sail_ends_with_its_sentence(tmp_path, ending):
    path = tmp_path / f"test{ending}"
    sail = ("-m", "shaftprint", "sail", "stan-tug-1205", "short", "-o", path, "--no-progress")
    done = called(*sail, preexec_fn=limited)
    assert done.returncode == 1, (done.returncode, done.stderr)
    # other formats are made of a native recording in the same folder
    assert done.stderr.startswith(f"Error: {tmp_path}")
    assert "cannot be written: File too large; check the path, the permissions and the free space." in done.stderr
    assert done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_a_disk_of_1_mb(tmp_path):
    """On a disk that is really full, where this user may mount one."""
    disk = tmp_path / "disk"
    disk.mkdir()
    path = disk / "test.nc"
    script = f"mount -t tmpfs -o size=1m none {disk}"
    if shutil.which("unshare") is None:
        pytest.skip("needs unshare")
    mount = ["unshare", "-rm", "sh", "-c"]
    if subprocess.run([*mount, script], capture_output=True, check=False).returncode:
        pytest.skip("this user may mount no disk")
    inner = f"{script} && {sys.executable} {HERE / 'write_until_full.py'} {path}; echo $?; ls -A {disk}"
    done = subprocess.run([*mount, inner], capture_output=True, text=True, timeout=300, check=False)
    assert done.stdout == "1\n", done.stderr
    assert done.stderr == (
        f"{path}: the recording cannot be written: No space left on device; check the path, the permissions and the "
        "free space.\n"
    )


def test_an_interrupt_waits_for_the_library(tmp_path, monkeypatch):
    """It comes out between two calls, not inside of one, where HDF5 could not close its file any more."""
    path = tmp_path / "test.nc"
    counts = np.arange(300_000, dtype=np.int16)
    reached = []

    def interrupted_compression(self, counts, time_s):
        signal.raise_signal(signal.SIGINT)
        reached.append("write went on")

    def write():
        with RecordingWriter(path) as writer:
            writer.declare("M_s", unit="V", rate_hz=2000.0)
            writer.append("M_s", counts)
            reached.append("not reached")

    monkeypatch.setattr("shaftprint.recording._channel_writer.ChannelWriter.append", interrupted_compression)
    # a shell in the background has its children ignore the interrupt
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            write()
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)
    assert reached == ["write went on"]
    assert list(tmp_path.iterdir()) == []


def test_what_is_written_comes_back(tmp_path):
    done = called(HERE / "write_until_full.py", tmp_path / "test.nc")
    assert done.returncode == 0, done.stderr
    expected = np.random.default_rng(1).integers(-30_000, 30_000, 1_000_000)
    with read_recording(tmp_path / "test.nc") as opened:
        for name in ("M_s", "n_e"):
            np.testing.assert_array_equal(opened.channel(name).read(0, 1_000_000), expected)
