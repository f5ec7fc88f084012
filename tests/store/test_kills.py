"""Writers that are killed at any time: what they acknowledged is there, and nothing is damaged."""

import os
import random

import pytest
from benchmarks.store import killed

from shaftprint.store import create_store

KILLS = 20


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="Windows has no signal that ends a process at once")
def test_nothing_acknowledged_is_lost_when_writers_are_killed(url):
    create_store(url).close()
    acknowledged, lost, damaged = killed(url, KILLS, random.Random(3))  # noqa: S311
    # one addition of each writer is waited for
    assert acknowledged >= KILLS
    assert (lost, damaged) == (0, 0)


@pytest.mark.slow
def test_nothing_acknowledged_is_lost_when_the_server_is_killed(server, put):
    from shaftprint.store import check, history, open_store

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
