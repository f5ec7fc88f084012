"""``shaftprint demo --fleet``: its processes."""

import os
import signal
import subprocess
import sys
from contextlib import suppress

import pytest

# Tests that take ten minutes each in place of seconds; nobody waits for them.
PROGRAM = """
import os, time
from pathlib import Path
from shaftprint.cli import _fleet_demo

def tested(*_):
    print(os.getpid(), flush=True)
    time.sleep(600.0)

_fleet_demo.tested = tested
if __name__ == "__main__":
    list(_fleet_demo.all_tested([1, 2], Path(), seed=1, recordings=None, processes=2))
"""


@pytest.mark.slow
def test_the_processes_end_when_the_command_is_killed(tmp_path):
    program = tmp_path / "fleet.py"
    program.write_text(PROGRAM)
    command = subprocess.Popen([sys.executable, str(program)], stdout=subprocess.PIPE, text=True)
    working = [int(command.stdout.readline()) for _ in range(2)]
    assert len({command.pid, *working}) == 3
    command.kill()
    try:
        # all who can write to the pipe have ended before it does
        rest, _ = command.communicate(timeout=60.0)
    except subprocess.TimeoutExpired:
        for one in working:
            with suppress(ProcessLookupError):
                os.kill(one, signal.SIGTERM)
        pytest.fail("expected the processes to end with the command, found them alive after a minute")
    assert rest == ""
