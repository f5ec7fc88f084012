"""Mutated files of every format end in channels or in one sentence: no other error, no hang, no memory out of bounds.

``SHAFTPRINT_FUZZ=2000`` sets how many inputs each format gets; without it a few. The inputs are read by a program of
its own, so that a library that hangs or crashes ends one program and fails one test.
"""

import json
import os
import queue
import runpy
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording.readers._all import READERS

pytest.importorskip("resource", reason="needs limits of memory, which Windows does not have")

INPUTS = int(os.environ.get("SHAFTPRINT_FUZZ", "6"))
# A busy machine with a slow disk may let a program wait for longer; a hang is one all the same.
LONGEST_S = 5.0 if INPUTS >= 2000 else 30.0
MOST_MEMORY_MB = 1000.0
START_S = 120.0
PROGRAM = Path(__file__).with_name("read_mutated_files.py")
MUTATED_FILES = runpy.run_path(str(PROGRAM))
FORMATS = MUTATED_FILES["FORMATS"]


class Reading:
    """A program that reads mutated files, watched line by line."""

    def __init__(self, name, first, stop, folder):
        words = [sys.executable, str(PROGRAM), name, str(first), str(stop), str(folder)]
        self._errors = (folder / "stderr").open("w+")
        self.process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=self._errors, text=True)
        self._lines = queue.SimpleQueue()
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._listener.start()

    def _listen(self):
        for line in self.process.stdout:
            self._lines.put(json.loads(line))
        self._lines.put(None)

    def next(self, longest_s):
        """Return what was said of the next input, or how it ended without a word."""
        try:
            said = self._lines.get(timeout=longest_s)
        except queue.Empty:
            return {"fault": f"takes more than {longest_s:g} s"}
        if said is not None:
            return said
        return {"fault": f"the program ended with code {self.process.wait()}: {self.errors()[-2000:]}"}

    def errors(self):
        """Return what was written to the standard error."""
        self._errors.seek(0)
        return self._errors.read()

    def end(self):
        """End the program, whatever it does."""
        self.process.kill()
        self.process.wait()
        self._listener.join()
        self.process.stdout.close()
        self._errors.close()


def _read_mutated(name, inputs, folder):
    """Return what was said of each input; after a hang or a crash the next program goes on behind it."""
    found = []
    while len(found) < inputs:
        reading = Reading(name, len(found), inputs, folder)
        try:
            start = reading.next(START_S)
            assert "fault" not in start, start["fault"]
            while len(found) < inputs:
                said = reading.next(LONGEST_S)
                found.append({"number": len(found), **said})
                if "fault" in said:
                    break
            else:
                reading.process.wait(START_S)
                assert reading.errors() == ""
        finally:
            reading.end()
    return found


def is_message(reason):
    """Whether a reason is one line, or one with the first five mistakes indented below it and a count of the others."""
    _, *mistakes = reason.splitlines()
    return len(mistakes) <= 6 and all(line.startswith("  ") for line in mistakes)


@pytest.mark.slow
@pytest.mark.parametrize("name", FORMATS)
def test_mutated_files_end_in_channels_or_in_one_message(tmp_path, name):
    # Dewesoft's library runs in a process of its own, which takes half a second
    inputs = max(INPUTS // 50, 1) if name == "log.dxd" else INPUTS
    found = _read_mutated(name, inputs, tmp_path)
    faults = [f"input {said['number']}: {said['fault']}" for said in found if "fault" in said]
    assert not faults, "\n".join(faults)
    reasons = [said["reason"] for said in found if said["reason"] is not None]
    assert reasons
    assert [reason for reason in reasons if not is_message(reason)] == []
    slowest = max(found, key=lambda said: said["took_s"])
    peak_mb = max(said["peak_mb"] for said in found)
    sys.stdout.write(
        f"{name}: {inputs} inputs, {len(reasons)} refused, slowest {slowest['took_s']:.2f} s "
        f"(input {slowest['number']}), peak {peak_mb:.0f} MB\n"
    )
    assert slowest["took_s"] < LONGEST_S, slowest
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
        path.write_bytes(MUTATED_FILES["mutated"](content, rng))
        try:
            MUTATED_FILES["read_all"](path)
        except RecordingError:
            continue
    assert list(scratch.iterdir()) == []
