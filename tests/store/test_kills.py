"""Writers that are killed at any time: what they acknowledged is there, and nothing is damaged."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from shaftprint.store import check, create_store, history, open_store

ROOT = Path(__file__).parents[2]


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="Windows has no fork, and no signal that ends a process at once")
def test_nothing_acknowledged_is_lost_when_writers_are_killed(url):
    """Twenty writers, ten of them killed within 0.3 s of their first record; the benchmark kills a thousand."""
    command = ["-m", "benchmarks.store", "--count", "0", "--kills", "20", "--killed-store", url]
    done = subprocess.run([sys.executable, *command], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    ((acknowledged, lost),) = re.findall(r"20 writers killed: lost of (\d+) acknowledged \| 0 \| (\d+) \|", done.stdout)
    assert "| damaged records | 0 | 0 |" in done.stdout
    assert (int(lost), int(acknowledged) > 10) == (0, True)


@pytest.mark.slow
def test_nothing_acknowledged_is_lost_when_the_server_is_killed(server, put):
    url = server.new_database()
    create_store(url).close()
    for kill in range(3):
        with open_store(url) as store:
            for place in range(10):
                put(store, recording=f"{kill:032x}{place:032x}")
        # the postmaster and its children, as a power cut would
        server.kill()
        server.start()
    with open_store(url) as store:
        assert len(history(store, "Meander").entries) == 30
        assert check(store) == ()
