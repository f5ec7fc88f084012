"""Five tests of a drive: kept as those of a ship are, with their history, and watched for drift."""

import json

import numpy as np
import pytest
from benchmarks.store_documents import document
from click.testing import CliRunner
from tests.drive_documents import TRUTH, drive_document

from shaftprint.cli import shaftprint
from shaftprint.store import create_store, newest, open_store

HEAVIER = 1.03 * TRUTH["J"]


@pytest.fixture
def program(tmp_path, monkeypatch):
    """Run the program in a folder with an empty store."""
    monkeypatch.chdir(tmp_path)
    create_store("shaftprint.db").close()

    def run(*arguments, code=0):
        result = CliRunner().invoke(shaftprint, [str(one) for one in arguments], catch_exceptions=False)
        assert result.exit_code == code, result.output
        return " ".join((result.output if code == 0 else result.stderr).split())

    return run


def files(folder, *, heavier_from=6, seed=1, **further):
    rng = np.random.default_rng(seed)
    paths = []
    for month in range(1, 6):
        path = folder / f"test{month}.json"
        truth = {"J": HEAVIER} if month >= heavier_from else {}
        path.write_bytes(drive_document(month, rng, **truth, **further))
        paths.append(path)
    return paths


def test_five_tests_of_a_drive_are_kept_and_its_heavier_rotor_is_seen(tmp_path, program):
    paths = files(tmp_path, heavier_from=4)
    assert "of bench motor, drive is kept" in program("store", "add", *paths)
    with open_store("shaftprint.db") as store:
        (line,) = newest(store)
    assert (line.line.ship.name, line.line.position, line.tests) == ("bench motor", "drive", 5)
    shown = program("store", "history", "bench motor", "--number", "J")
    assert shown.count("physical value") == 5
    found = json.loads(program("drift", "bench motor", "--json"))["result"]["finding"]
    best = found["drifts"][0]["courses"][0]
    assert best["cause"]["name"] == "J"
    # the fourth test is the first of the heavier rotor: 3 % of its inertia, each test to 0.2 %
    assert best["since"] == 3
    assert best["size"] == pytest.approx(0.03, abs=0.004)
    assert "Has the drive changed? Yes: a higher J" in program("drift", *paths)


def test_a_drive_that_stayed_as_it_is_does_not_drift(tmp_path, program):
    paths = files(tmp_path, seed=3)
    assert "Has the drive changed? No change beyond chance in 5 tests" in program("drift", *paths)
    words = program("compare", paths[0], paths[4])
    assert "Has the drive changed? No: 3 numbers of the drive, judged together, agree within chance." in words


def test_what_was_not_stated_is_asked_for(tmp_path, program):
    (path, *_) = files(tmp_path, stated=False)
    asked = program("store", "add", path, code=1)
    assert "expected the time of the test, found none; state it with --tested-at" in asked
    assert "is kept" in program("store", "add", path, "--tested-at", "2026-01-10T09:00Z")


def test_a_drive_with_a_name_that_is_too_long_is_called_by_its_user(tmp_path, program):
    (path, *_) = files(tmp_path, drive="m" * 101)
    assert "the name of its ship and its shaft line, found none of them; state them" in program(
        "store", "add", path, code=1
    )
    assert "of motor, bench is kept" in program("store", "add", path, "--ship", "motor", "--line", "bench")


def test_a_ship_and_a_drive_are_not_compared(tmp_path, program):
    (path, *_) = files(tmp_path)
    (tmp_path / "ship.json").write_bytes(document())
    assert "expected fingerprints of ships, or of drives, found both" in program(
        "compare", path, tmp_path / "ship.json", code=2
    )
