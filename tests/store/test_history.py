"""What a store tells: tests in the order of time, the newest of each line, and what was done in between."""

from datetime import UTC, datetime

import pytest
from benchmarks.store_documents import IMO_NUMBER

from shaftprint.errors import StoreError
from shaftprint.store import document, history, newest, record_event

DOCKED = datetime(2026, 5, 1, 8, 0, tzinfo=UTC)


@pytest.fixture
def years(store, put):
    """Three tests of a port line, put in out of order, and one of the starboard line."""
    for year, k_q in ((2026, 0.053), (2024, 0.049), (2025, 0.051)):
        put(store, recording=f"{year:064d}", tested_at=f"{year}-06-01T12:00:00+02:00", k_q=k_q)
    starboard = {"name": "Meander", "imo_number": IMO_NUMBER, "line": "starboard"}
    put(store, recording="ff" * 32, tested_at="2025-06-02T12:00:00Z", k_q=0.048, ship=starboard)
    return store


def test_a_history_is_in_the_order_of_time(years):
    entries = history(years, "Meander", number="K_Q", lines=("port",)).entries
    assert [entry.numbers[0].value for entry in entries] == [0.049, 0.051, 0.053]
    assert [entry.fingerprint.trial.tested_at.year for entry in entries] == [2024, 2025, 2026]
    # 12:00 in a zone two hours before UTC
    assert entries[0].fingerprint.trial.tested_at == datetime(2024, 6, 1, 10, tzinfo=UTC)
    both = history(years, "Meander", number="K_Q").entries
    assert [entry.numbers[0].value for entry in both] == [0.049, 0.051, 0.048, 0.053]


def test_the_newest_of_each_line(years):
    lines = newest(years, number="K_Q")
    assert {line.line.position: (line.tests, line.number.value) for line in lines} == {
        "port": (3, 0.053),
        "starboard": (1, 0.048),
    }
    assert [line.number for line in newest(years, number="no such number")] == [None, None]


def test_the_newest_is_the_newest_fingerprint_of_its_recording(years, put):
    again = {"recording": f"{2026:064d}", "tested_at": "2026-06-01T12:00:00+02:00", "created": "2027-01-01T00:00:00Z"}
    put(years, k_q=0.060, **again)
    lines = newest(years, number="K_Q")
    assert {line.line.position: (line.tests, line.number.value) for line in lines}["port"] == (3, 0.060)


def test_what_is_not_there_is_named(years):
    with pytest.raises(StoreError, match=r"^Meandr: expected the name or IMO number of a ship in the store.*Meander\?"):
        history(years, "Meandr")
    with pytest.raises(StoreError, match="expected one of its lines, port, starboard, found 'centre'"):
        history(years, "Meander", lines=("centre",))
    with pytest.raises(StoreError, match="found 'K_q' in none of its tests"):
        history(years, "Meander", number="K_q")
    with pytest.raises(StoreError, match="expected it in the store, found none"):
        document(years, "0" * 64)
    with pytest.raises(StoreError, match="expected the SHA-256"):
        document(years, "' OR 1=1")


def test_an_event_is_kept_once_and_shown_with_the_tests(years):
    ((event, is_new),) = record_event(
        years, "Meander", "propeller-polished", at=DOCKED, lines=["port"], numbers=["K_Q"], note="by divers"
    )
    assert is_new
    ((_, is_new),) = record_event(
        years, str(IMO_NUMBER), "propeller-polished", at=DOCKED, lines=["port"], numbers=["K_Q"], note="by divers"
    )
    assert not is_new
    with pytest.raises(StoreError, match="found one with another note or other numbers, which stays as it is"):
        record_event(years, "Meander", "propeller-polished", at=DOCKED, lines=["port"])
    assert history(years, "Meander").events == (event,)
    assert history(years, "Meander", lines=("starboard",)).events == ()
    assert (event.at, event.numbers, event.note) == (DOCKED, ("K_Q",), "by divers")


def test_an_event_says_which_of_several_lines(years):
    with pytest.raises(StoreError, match="expected which of its lines, port, starboard, found none; state --line"):
        record_event(years, "Meander", "docking", at=DOCKED)
    events = record_event(years, "Meander", "docking", at=DOCKED, lines=["port", "starboard"])
    assert [event.line.position for event, _ in events] == ["port", "starboard"]


@pytest.mark.parametrize(
    ("kind", "more", "words"),
    [
        ("dockng", {}, "expected docking, .*Did you mean docking"),
        ("other", {}, "expected a note"),
        ("docking", {"note": "a\0"}, "expected a note of letters"),
        ("docking", {"at": datetime(2026, 5, 1)}, "expected a time with its offset"),  # noqa: DTZ001
        ("docking", {"numbers": ["x" * 300]}, "expected a name of a number of 1 to 200 letters"),
    ],
)
def test_an_event_that_cannot_be_kept_is_refused(years, kind, more, words):
    with pytest.raises(StoreError, match=words):
        record_event(years, "Meander", kind, lines=["port"], **{"at": DOCKED} | more)
