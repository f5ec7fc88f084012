"""Workers: what they make is what identify makes, and what dies or is ended costs no result."""

import os
import re
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from shaftprint import __version__
from shaftprint.errors import SettingsError
from shaftprint.fingerprint._json_file import fingerprint_document
from shaftprint.fleet import submit, work
from shaftprint.fleet._arguments import job_arguments
from shaftprint.store import JobRequest, claim, document, enqueue, job, job_counts, jobs
from shaftprint.survey import run as survey_run

KNOWN = {"ship": "Meander", "line": "port", "tested_at": "2026-03-31T09:30+02:00"}
CREATED = re.compile(rb'"created": "[^"]*"')


@pytest.fixture
def asked(store, tmp_path):
    """Ask for a file that is no recording, so that nothing is computed."""
    (tmp_path / "a.nc").write_bytes(b"no recording")
    arguments = job_arguments(tmp_path / "a.nc", "stan-tug-1205", "short", named="test", **KNOWN)
    (asked,) = submit(store, [arguments], now=datetime.now(UTC))
    return asked


@pytest.mark.long
@pytest.mark.slow
def test_jobs_give_what_identify_gives(demo, store, tmp_path, monkeypatch):
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "1")
    folder, _ = demo
    files = (folder / "recording.nc", folder / "vessel.toml", folder / "campaign.toml")
    (tmp_path / "broken.nc").write_bytes(files[0].read_bytes()[:100_000])
    wanted = [job_arguments(*files, named="test", **KNOWN, seed=seed) for seed in (1, 2)]
    wanted.append(job_arguments(tmp_path / "broken.nc", *files[1:], named="test", **KNOWN))
    asked = submit(store, wanted, now=datetime.now(UTC))
    worked = work(store, processes=2)
    assert (worked.done, worked.refused, worked.died) == (2, 1, 0)
    done = job(store, asked[0].id)
    fingerprint = survey_run(
        *files, conditions=wanted[0].conditions, rng=np.random.default_rng(1), judge=False
    ).fingerprint
    # equal byte by byte, but for the time at which each was made
    assert CREATED.sub(b"", document(store, done.result)) == CREATED.sub(b"", fingerprint_document(fingerprint))
    assert "broken.nc" in job(store, asked[2].id).sentence
    # nothing is left, and nothing is done again
    assert [one.state for one in submit(store, wanted, now=datetime.now(UTC))] == ["done", "done", "refused"]
    assert work(store).done == 0


def processes_of_this_one():
    found = Path(f"/proc/{os.getpid()}/task").glob("*/children")
    return [int(one) for file in found for one in file.read_text().split()]


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="the system does not say what a process has started")
def test_a_recording_on_which_processes_die_is_refused_after_three(store, asked):
    before = set(processes_of_this_one())

    def kill(event):
        if event.what == "begun":
            threading.Thread(target=kill_the_next, daemon=True).start()

    def kill_the_next():
        end = time.monotonic() + 60.0
        while not (new := set(processes_of_this_one()) - before) and time.monotonic() < end:
            time.sleep(0.01)
        for process in new:
            with suppress(ProcessLookupError):
                os.kill(process, signal.SIGKILL)

    worked = work(store, report=kill)
    assert (worked.done, worked.refused, worked.died) == (0, 0, 3)
    assert job(store, asked.id).sentence.startswith("the worker died three times on this recording")


def test_a_recording_that_takes_too_long_is_ended(store, asked):
    # the process itself needs longer to begin
    assert work(store, limit_s=0.05).refused == 1
    assert job(store, asked.id).sentence.startswith("it took more than 0.000833333 minutes and was ended")


def test_a_worker_that_is_ended_gives_its_job_back(store, asked):
    stop = threading.Event()
    work(store, stop=stop, report=lambda event: stop.set())
    given_back = job(store, asked.id)
    assert (given_back.state, given_back.tries, given_back.lease_until) == ("waiting", 0, None)


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="Windows has no such signals")
def test_an_interrupted_command_leaves_the_ledger_right(store, url, asked):
    command = [sys.executable, "-m", "shaftprint", "work", "--store", url, "--processes", "1", "--wait"]
    # the file is refused at once; what comes after it waits for the worker to look again
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        end = time.monotonic() + 120.0
        while job(store, asked.id).state != "refused" and time.monotonic() < end:
            time.sleep(0.2)
        process.send_signal(signal.SIGTERM)
        _, said = process.communicate()
    assert (process.returncode, said) == (130, "Interrupted; nothing is left half-written.\n")
    assert job_counts(store).refused == 1


@pytest.mark.slow
def test_what_stands_in_the_ledger_is_not_trusted(store):
    """Arguments of another program, and a structure that would be run."""
    enqueue(
        store,
        [
            JobRequest(key="1", args={"recording": 5}, version=__version__),
            JobRequest(
                key="2",
                args={"recording": "a.nc", "vessel": "stan-tug-1205", "campaign": "short", "structure": "mine.py:line"},
                version=__version__,
            ),
        ],
    )
    assert work(store).refused == 2
    sentences = [one.sentence for one in jobs(store)]
    assert sentences[0].startswith("job: ")
    assert sentences[1].startswith("there is no structure 'mine.py:line'")
    assert claim(store, owner="a", version=__version__) is None


@pytest.mark.slow
def test_a_poisoned_job_does_not_hold_those_behind_it(store, tmp_path):
    (tmp_path / "a.nc").write_bytes(b"no recording")
    good = {"recording": str(tmp_path / "a.nc"), "vessel": "stan-tug-1205", "campaign": "short"}
    poisoned = [{"nonsense": 1}, good | {"conditions": {"tested_at": "0001-01-01T00:00:00+14:00"}}, good | {"seed": 1}]
    keys = [f"{place:064x}" for place in range(4)]
    enqueue(
        store,
        [
            JobRequest(key=key, args=args, version=__version__)
            for key, args in zip(keys, [*poisoned, good], strict=True)
        ],
    )

    def forbidden(one):
        if one.id == 3:
            raise OverflowError("date value out of range")
        return "not any more" if one.id == 4 else None

    worked = work(store, forbidden=forbidden)
    assert (worked.refused, worked.died) == (4, 0)
    sentences = [one.sentence for one in jobs(store)]
    assert "expected what shaftprint fleet run puts in" in sentences[0]
    assert "expected a time from 1950-01-01" in sentences[1]
    assert "the program failed: OverflowError" in sentences[2]
    assert sentences[3] == "not any more"


@pytest.mark.parametrize("text", ["0001-01-01T00:00+14:00", "9999-12-31T23:59-14:00", "2999-01-01T00:00+00:00"])
def test_a_time_that_cannot_be_is_refused_before_anything_is_asked_for(store, tmp_path, text):
    (tmp_path / "a.nc").write_bytes(b"no recording")
    with pytest.raises(SettingsError, match="expected a time from 1950-01-01"):
        job_arguments(tmp_path / "a.nc", "stan-tug-1205", "short", named="test", tested_at=text)
