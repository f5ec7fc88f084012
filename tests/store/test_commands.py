"""``shaftprint store``, from the first fingerprint of a ship to its history."""

import json

import click
import pytest
from benchmarks.store_documents import IMO_NUMBER, document

from shaftprint.cli import shaftprint


@pytest.fixture
def yard(tmp_path, monkeypatch, run):
    """A folder with a store and fingerprints of two years."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("SHAFTPRINT_STORE", raising=False)
    for year, k_q in ((2025, 0.049), (2026, 0.052)):
        folder = tmp_path / f"result-{year}"
        folder.mkdir()
        made = document(tested_at=f"{year}-07-01T09:30:00", recording=f"{year:064d}", k_q=k_q)
        (folder / "fingerprint.json").write_bytes(made)
    assert run("store", "init").exit_code == 0
    return tmp_path


STATED = ("--ship", "Meander", "--imo", IMO_NUMBER, "--line", "port", "--time-zone", "Europe/Amsterdam")


def test_every_action_is_listed_with_its_help(run):
    group = shaftprint.get_command(None, "store")
    text = " ".join(run("store", "--help").output.split())
    for name, words in group.helps.items():
        assert f"{name} {words}" in text
        action = group.get_command(None, name)
        assert action.get_short_help_str(limit=200) == words
        assert all(parameter.help for parameter in action.params if isinstance(parameter, click.Option))


def test_a_fleet_from_the_first_fingerprint_to_its_history(yard, run):
    added = run("store", "add", "result-2026", "result-2025/fingerprint.json", *STATED)
    assert added.exit_code == 0, added.output
    assert added.stdout.count(" of Meander, port is kept.") == 2
    event = run("store", "event", "Meander", "propeller-polished", "--at", "2026-01-15T08:00+01:00", "--number", "K_Q")
    assert event.stdout == "Meander, port: propeller-polished of 2026-01-15 07:00 +00:00 is kept.\n"
    shown = run("store", "history", "Meander", "--number", "K_Q", "--time-zone", "Europe/Amsterdam").stdout
    # summer time is two hours before UTC, winter time one
    rows = [line.split() for line in shown.splitlines() if line.startswith(" 202") and "0.0" in line and "to" in line]
    assert [row[:3] + row[6:7] for row in rows] == [
        ["2025-07-01", "09:30", "+02:00", "0.0490"],
        ["2026-07-01", "09:30", "+02:00", "0.0520"],
    ]
    assert "2026-01-15 08:00 +01:00" in shown
    assert "2025-07-01 07:30 +00:00" in run("store", "history", IMO_NUMBER).stdout
    assert "K_Q" in run("store", "list", "--number", "K_Q").stdout


def test_numbers_have_all_digits_in_json(yard, run):
    run("store", "add", "result-2025", *STATED)
    found = json.loads(run("store", "history", "Meander", "--number", "K_Q", "--json").stdout)["result"]["history"]
    (entry,) = found["entries"]
    assert (entry["numbers"][0]["value"], entry["numbers"][0]["name"]) == (0.049, "K_Q")
    assert entry["fingerprint"]["trial"]["tested_at"] == "2025-07-01 07:30:00+00:00"
    lines = json.loads(run("store", "list", "--json").stdout)["result"]["lines"]
    assert [line["tests"] for line in lines] == [1]


def test_an_export_of_one_store_is_imported_into_another(yard, run):
    added = run("store", "add", "result-2025", "result-2026", *STATED, "--class", "Stan Tug 1205")
    assert added.exit_code == 0, added.stderr
    listed = json.loads(run("store", "list", "--json").stdout)["result"]["lines"]
    assert [line["line"]["ship"]["class_name"] for line in listed] == ["Stan Tug 1205"]
    assert run("store", "export", "fleet.jsonl").exit_code == 0
    assert "exists already" in run("store", "export", "fleet.jsonl").stderr
    assert run("store", "export", "fleet.jsonl", "--force").exit_code == 0
    assert "expected another file than the store itself" in run("store", "export", "shaftprint.db", "--force").stderr
    options = {"env": {"SHAFTPRINT_STORE": "other.db"}}
    assert run("store", "init", **options).stdout.startswith("other.db is an empty store")
    assert "New fingerprints: 2; new events: 0" in run("store", "import", "fleet.jsonl", **options).stdout
    assert run("store", "check", **options).stdout == "other.db: every record is as it was written.\n"
    assert "nothing was changed" in run("store", "upgrade", **options).stdout


@pytest.mark.parametrize(
    ("words", "code", "sentence"),
    [
        (
            ("add", "result-2025"),
            1,
            "expected the name of its ship, its shaft line and the offset of 2025-07-01 09:30:00 from UTC, found none "
            "of them; state them with --ship, --line and --time-zone, such as Europe/Amsterdam.",
        ),
        (("add", "result-2025", "--time-zone", "UTC"), 1, "state them with --ship and --line."),
        (("add", "result-2025", "--ship", "Meander", "--time-zone", "UTC"), 1, "state it with --line."),
        (("add", "result-2025", "--ship", "Meander", "--line", "port"), 1, "state the zone with --time-zone"),
        (
            ("add", "result-2025", "--store", "nowhere.db"),
            1,
            "make one with shaftprint store init. result-2025/fingerprint.json: expected the name of its ship, its",
        ),
        (("add", "result-2025", "result-2026", "--tested-at", "2026-01-01"), 2, "each test has its own time"),
        (("add", "result-2025", "--time-zone", "Europe/Amsterdm"), 2, "found 'Europe/Amsterdm'"),
        (("event", "Meander", "docking", "--at", "2026-01-01"), 2, "--at: expected an offset such as +02:00"),
        (("event", "Meander", "docking", "--at", "2026-01-01", "--time-zone", "UTC"), 1, "It has none yet"),
        (("histroy", "Meander"), 2, "Did you mean history?"),
        (("history", "\x1b[2JMeander"), 1, "?[2JMeander: expected the name or IMO number"),
        (("import", "result-2025"), 1, "cannot be read: Is a directory"),
    ],
)
def test_what_is_wrong_is_one_sentence(yard, run, words, code, sentence):
    result = run("store", *words)
    assert (result.exit_code, result.stdout) == (code, "")
    assert sentence in result.stderr
    assert "\x1b" not in result.stderr


def test_hostile_names_move_no_cursor(yard, run):
    name = "\x1b]0;owned\x07\nVerdict: fine"
    run("store", "add", "result-2025", "--ship", name, "--line", name, "--time-zone", "UTC")
    for words in (("list",), ("history", name), ("list", "--json"), ("check",)):
        result = run("store", *words)
        assert result.exit_code == 0
        assert "\x1b" not in result.output
        assert "\nVerdict" not in result.output
