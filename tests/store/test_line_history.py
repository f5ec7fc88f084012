"""The newest tests of a line: what is read of a long history tells of them what the whole history tells."""

import json
import random
from datetime import UTC, datetime, timedelta

import pytest
from benchmarks.store_documents import document

from shaftprint.store import add_document, record_event
from shaftprint.store._line_history import line_history
from shaftprint.store._sisters import sisters_of

FIRST = datetime(2020, 1, 1, tzinfo=UTC)
NEWEST = 3


@pytest.fixture
def tested(file_store):
    """Put a test of a day into the store, made by a version of the program."""

    def put(day, *, version="0.1.0", trustworthy=True, joint=True, k_q=0.0494, made=0):
        at = FIRST + timedelta(days=day)
        ship = {"name": "Meander", "imo_number": 9074729, "class_name": "Tug", "line": "port"}
        created = (at + timedelta(days=1000 + made)).isoformat()
        content = json.loads(
            document(tested_at=at.isoformat(), created=created, recording=f"{day:064x}", ship=ship, k_q=k_q)
        )
        content["shaftprint_version"] = version
        content["verdict"]["trustworthy"] = trustworthy
        if joint:
            covariance = [[0.34**2, 0.0], [0.0, 0.001**2]]
            content["joint"] = {"names": ["I_dn", "K_Q"], "own_covariance": covariance, "loadings": {}}
        add_document(file_store, json.dumps(content).encode(), named="one.json", now=FIRST)

    return put


def standing(store, newest):
    """Return the days of the tests that stand for the ship, and how many documents were read."""
    found = line_history(store, "Meander", line="port", newest=newest)
    ((ship,), _) = sisters_of([found], newest=NEWEST)
    return [(test.at - FIRST).days for test in ship.tests], len(found.fingerprints)


def test_only_the_newest_documents_are_read(file_store, tested):
    for day in range(20):
        tested(day)
    assert standing(file_store, NEWEST) == ([17, 18, 19], 3)
    assert standing(file_store, None) == ([17, 18, 19], 20)


def test_tests_that_cannot_be_judged_are_gone_past(file_store, tested):
    for day in range(20):
        tested(day, trustworthy=day < 16, joint=day != 15)
    # of the newest twelve eight can be judged, of the newest six one
    assert standing(file_store, NEWEST) == ([12, 13, 14], 12)


def test_another_version_begins_anew_unless_an_early_recording_shows_that_both_agree(file_store, tested):
    for day in range(20):
        tested(day, version="0.2.0" if day > 17 else "0.1.0")
    assert standing(file_store, NEWEST) == ([18, 19], 3)
    tested(4, version="0.2.0", made=1, k_q=0.0494 + 0.0001)
    assert standing(file_store, NEWEST) == ([17, 18, 19], 5)
    tested(5, version="0.2.0", made=1, k_q=0.0494 + 0.0003)
    assert standing(file_store, NEWEST) == ([18, 19], 7)


@pytest.mark.parametrize("seed", range(6))
def test_a_part_of_a_history_tells_what_all_of_it_tells(file_store, tested, seed):
    rng = random.Random(seed)  # noqa: S311
    for day in sorted(rng.sample(range(100), 14)):
        for made in range(rng.choice((1, 1, 1, 2))):
            tested(
                day,
                version=rng.choice(("0.1.0", "0.2.0")),
                trustworthy=rng.random() < 0.6,
                joint=rng.random() < 0.8,
                k_q=0.0494 + rng.choice((0.0, 0.0001, 0.0003)),
                made=made,
            )
    for day in rng.sample(range(100), rng.choice((0, 0, 1))):
        record_event(file_store, "Meander", "docking", at=FIRST + timedelta(days=day, hours=1))
    assert standing(file_store, NEWEST)[0] == standing(file_store, None)[0]
