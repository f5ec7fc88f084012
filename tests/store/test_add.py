"""What is put in is there once; a later fingerprint of a recording takes the place of the earlier, which stays."""

from datetime import UTC, datetime, timedelta, timezone
from zoneinfo import ZoneInfo

import pytest
from benchmarks.store_documents import IMO_NUMBER, document

from shaftprint.errors import FingerprintError, StoreError
from shaftprint.fingerprint import read_fingerprint, write_fingerprint
from shaftprint.store import add, history, newest
from shaftprint.store import document as kept_document
from shaftprint.store._nouns import Ship
from shaftprint.store._stated import Stated

NOW = datetime(2026, 11, 24, 12, 0, tzinfo=UTC)
NOBODY = {"name": "Meander", "line": "port"}


def test_a_document_comes_back_byte_by_byte(store, tmp_path):
    # spaces and a field order that this program would not write
    content = document(ship=NOBODY).replace(b'"findings": []', b'"findings":    [ "\xc3\xa9" ]')
    (tmp_path / "one.json").write_bytes(content)
    added = add(store, tmp_path / "one.json", now=NOW)
    assert added.outcome == "added"
    assert kept_document(store, added.sha256) == content


def test_a_fingerprint_that_the_program_wrote_is_kept(store, tmp_path):
    (tmp_path / "by_hand.json").write_bytes(document(ship=NOBODY))
    write_fingerprint(read_fingerprint(tmp_path / "by_hand.json"), tmp_path / "one.json")
    add(store, tmp_path / "one.json", now=NOW)
    (entry,) = history(store, "Meander").entries
    (number,) = (one for one in entry.numbers if one.name == "K_Q")
    # 1.96 standard deviations of 0.001 on each side
    assert (number.value, number.std, number.trusted) == (0.0494, 0.001, True)
    assert (number.low, number.high) == pytest.approx((0.0494 - 0.00196, 0.0494 + 0.00196), abs=1e-7)
    assert [one.trusted for one in entry.numbers if one.name == "I_up"] == [False]
    # 12 parameters, 4 combinations, 6 physical values, 3 margins, 7 calibrations
    assert len(entry.numbers) == 32


def test_the_same_document_is_kept_once(store, put):
    assert [put(store).outcome, put(store).outcome] == ["added", "known"]
    assert len(history(store, "Meander", superseded=True).entries) == 1


def test_a_recording_that_was_identified_again_is_one_test(store, put):
    first = put(store, created="2026-03-14T09:30:00Z", k_q=0.049)
    second = put(store, created="2026-09-01T00:00:00Z", k_q=0.051)
    assert (second.outcome, second.other) == ("supersedes", first.sha256)
    (entry,) = history(store, "Meander", number="K_Q").entries
    assert entry.numbers[0].value == 0.051
    assert [line.tests for line in newest(store)] == [1]
    everything = history(store, "Meander", number="K_Q", superseded=True).entries
    assert [(one.numbers[0].value, one.fingerprint.superseded) for one in everything] == [(0.049, True), (0.051, False)]
    assert everything[1].fingerprint.supersedes == first.sha256
    assert kept_document(store, first.sha256) == document(ship=document_ship(), k_q=0.049)


def document_ship():
    return {"name": "Meander", "imo_number": IMO_NUMBER, "class_name": "Stan Tug 1205", "line": "port"}


K_Q = (0.050, 0.051, 0.052)


@pytest.mark.parametrize("order", [(0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0)])
def test_the_one_made_last_is_shown_whichever_was_put_in_first(file_store, put, order):
    made = [f"2026-0{month}-01T00:00:00Z" for month in (4, 5, 6)]
    hashes = {place: put(file_store, created=made[place], k_q=K_Q[place]).sha256 for place in order}
    (entry,) = history(file_store, "Meander", number="K_Q").entries
    assert entry.numbers[0].value == 0.052
    chain = [one.fingerprint for one in history(file_store, "Meander", superseded=True).entries]
    assert [one.sha256 for one in chain] == [hashes[0], hashes[1], hashes[2]]
    assert [one.supersedes for one in chain] == [None, hashes[0], hashes[1]]


def test_a_late_identification_of_an_early_version_says_that_it_is_superseded(store, put):
    later = put(store, created="2026-09-01T00:00:00Z")
    earlier = put(store, created="2026-03-14T09:30:00Z")
    assert (earlier.outcome, earlier.other) == ("superseded", later.sha256)


def test_conditions_are_those_of_the_newest_fingerprint(store, put):
    put(store, created="2026-03-14T09:30:00Z", draught_m=1.0)
    put(store, created="2026-03-15T09:30:00Z", draught_m=2.5, place="Quay 12")
    (entry,) = history(store, "Meander").entries
    assert (entry.fingerprint.trial.draught_m, entry.fingerprint.trial.place) == (2.5, "Quay 12")


def test_two_lines_that_one_recording_holds_are_two_tests(store, put):
    put(store)
    put(store, ship={"name": "Meander", "imo_number": IMO_NUMBER, "line": "starboard"})
    assert {line.line.position: line.tests for line in newest(store)} == {"port": 1, "starboard": 1}


def test_without_a_recording_each_document_is_a_test(store, put):
    put(store, recording=None)
    put(store, recording=None, k_q=0.05)
    assert [line.tests for line in newest(store)] == [2]


# ---- when ----


def test_a_time_that_nobody_states_is_not_guessed(file_store, put):
    with pytest.raises(
        StoreError, match=r"^one.json: expected the time of the test, found none; state it with --tested"
    ):
        put(file_store, tested_at=None)
    with pytest.raises(StoreError, match=r"found 2026-03-13 14:05:00; state the zone with --time-zone"):
        put(file_store, tested_at="2026-03-13T14:05:00")
    assert newest(file_store) == ()


def test_a_time_is_that_of_its_zone(store, put):
    amsterdam = ZoneInfo("Europe/Amsterdam")
    # summer time, two hours before UTC; the document states an offset and needs no zone
    put(store, tested_at="2026-07-01T14:05:00", recording="01" * 32, zone=amsterdam)
    put(store, tested_at=None, recording="02" * 32, stated=Stated(tested_at=datetime(2026, 1, 1, 9)), zone=amsterdam)  # noqa: DTZ001
    put(store, tested_at="2026-03-13T14:05:00-05:00", recording="03" * 32, zone=amsterdam)
    times = [entry.fingerprint.trial.tested_at for entry in history(store, "Meander").entries]
    assert times == [
        datetime(2026, 1, 1, 8, tzinfo=UTC),
        datetime(2026, 3, 13, 19, 5, tzinfo=UTC),
        datetime(2026, 7, 1, 12, 5, tzinfo=UTC),
    ]


def test_a_time_that_clocks_show_twice_is_asked_for(file_store, put):
    with pytest.raises(StoreError, match=r"2026-10-25 02:30:00 twice; state it with --tested-at"):
        put(file_store, tested_at="2026-10-25T02:30:00", zone=ZoneInfo("Europe/Amsterdam"))


def test_a_time_stated_against_the_document_is_refused(file_store, put):
    stated = Stated(tested_at=datetime(2026, 3, 13, 14, 5, tzinfo=UTC))
    with pytest.raises(
        StoreError, match=r"made 2026-03-13 13:05 \+00:00, and --tested-at says 2026-03-13 14:05 \+00:00"
    ):
        put(file_store, stated=stated)
    same = Stated(tested_at=datetime(2026, 3, 13, 9, 5, tzinfo=timezone(timedelta(hours=-4))))
    assert put(file_store, stated=same).outcome == "added"


# ---- which ship ----


def test_a_ship_that_nobody_states_is_not_guessed(file_store, put):
    with pytest.raises(StoreError, match=r"^one.json: expected the name of its ship and its shaft line, found none of"):
        put(file_store, ship=None)
    with pytest.raises(StoreError, match=r"expected its shaft line, found none; state it with --line"):
        put(file_store, ship=None, stated=Stated(ship="Meander"))
    added = put(file_store, ship=None, stated=Stated(ship="Meander", line="port", imo_number=IMO_NUMBER))
    assert added.line.ship == Ship(name="Meander", imo_number=IMO_NUMBER)


@pytest.mark.parametrize(
    ("stated", "words"),
    [
        (Stated(ship="Other"), "it states 'Meander' as the name of its ship, and --ship says 'Other'"),
        (Stated(line="starboard"), "it states 'port' as its shaft line, and --line says 'starboard'"),
        (Stated(imo_number=9319466), "it is of the ship with IMO 9074729, and --imo says 9319466"),
        (Stated(imo_number=9074728), "--imo: expected seven digits of which the last checks the others, found 9074728"),
    ],
)
def test_a_ship_stated_against_the_document_is_refused(file_store, put, stated, words):
    with pytest.raises(StoreError, match=words):
        put(file_store, stated=stated)


def test_a_ship_keeps_its_number_under_a_new_name(store, put):
    put(store, recording="01" * 32)
    renamed = {"name": "Rhine", "imo_number": IMO_NUMBER, "line": "port"}
    put(store, recording="02" * 32, ship=renamed, tested_at="2026-10-01T00:00:00Z")
    # an old test that comes late does not give it the old name back
    put(store, recording="03" * 32, tested_at="2020-01-01T00:00:00Z")
    (line,) = newest(store)
    assert (line.line.ship.name, line.tests) == ("Rhine", 3)
    assert len(history(store, str(IMO_NUMBER)).entries) == 3


def test_a_ship_gets_its_number_when_it_is_first_stated(store, put):
    put(store, recording="01" * 32, ship=NOBODY)
    put(store, recording="02" * 32)
    put(store, recording="03" * 32, ship=NOBODY)
    (line,) = newest(store)
    assert (line.line.ship.imo_number, line.tests) == (IMO_NUMBER, 3)


def test_of_two_ships_of_one_name_the_number_says_which(store, put):
    put(store, recording="01" * 32)
    put(store, recording="02" * 32, ship={"name": "Meander", "imo_number": 9319466, "line": "port"})
    with pytest.raises(StoreError, match=r"expected one ship of the name 'Meander', found IMO 9074729, IMO 9319466"):
        put(store, recording="03" * 32, ship=NOBODY)
    with pytest.raises(StoreError, match=r"name the ship by its IMO number"):
        history(store, "Meander")
    assert len(history(store, "9319466").entries) == 1


# ---- what is no fingerprint, or cannot be kept ----


def test_what_is_no_fingerprint_is_not_kept(file_store, tmp_path):
    for content in (b"", b"{}", b"[" * 100_000, b'{"kind": "drive"}', b"\xff\xfe"):
        (tmp_path / "x.json").write_bytes(content)
        with pytest.raises(FingerprintError, match=r"x\.json"):
            add(file_store, tmp_path / "x.json", now=NOW)
    with pytest.raises(StoreError, match="found nothing there; name the file"):
        add(file_store, tmp_path / "none.json", now=NOW)
    with pytest.raises(StoreError, match="cannot be read: Is a directory"):
        add(file_store, tmp_path, now=NOW)


def test_a_document_that_is_too_long_is_refused(file_store, tmp_path):
    (tmp_path / "x.json").write_bytes(document(ship=NOBODY) + b" " * 2**24)
    with pytest.raises(StoreError, match=r"expected a fingerprint of at most 16 MiB, found 16\.0"):
        add(file_store, tmp_path / "x.json", now=NOW)


@pytest.mark.parametrize(
    "name", ["Robert'); DROP TABLE ship;--", "\x1b[2J\x1b]0;owned\x07", "%s ? :name {0}", "Ærø 船", "a" * 100]
)
def test_hostile_names_are_names(store, put, name):
    put(store, ship={"name": name, "line": name}, place=name)
    (entry,) = history(store, name, lines=(name,)).entries
    assert (entry.fingerprint.line.ship.name, entry.fingerprint.trial.place) == (name, name)


def test_a_nul_is_refused_before_a_database_does(store, put):
    with pytest.raises(StoreError, match=r"one.json: expected a name of a ship of letters, found 'a\\x00b'"):
        put(store, ship={"name": "a\0b", "line": "port"})
    with pytest.raises(StoreError, match=r"expected a place of letters"):
        put(store, place="\0")
    with pytest.raises(StoreError, match="found none"):
        history(store, "a\0b")


def test_a_name_longer_than_an_index_takes_is_refused(store, put):
    with pytest.raises(StoreError, match=r"expected a place of 1 to 4000 letters, found 5000 letters"):
        put(store, place="x" * 5000)
    with pytest.raises(StoreError, match=r"expected a shaft line of 1 to 200 letters, found 3000"):
        put(store, ship=None, stated=Stated(ship="Meander", line="x" * 3000))
