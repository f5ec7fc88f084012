"""``shaftprint sisters`` on copies of the fingerprint of the short demo, as if they were of sister ships."""

import json
import os
import subprocess
import sys

import pytest

pytest.importorskip("sqlalchemy", reason="the store is an extra")
ACTION = "governor proportional action"
NAMES = ("Amstel", "Dinkel", "Eem", "Linge", "Merwede")


@pytest.fixture
def yard(demo, run, tmp_path):
    """Write a store with two tests of each ship; the proportional gain of one is a fifth lower."""
    store, paths = ("--store", tmp_path / "yard.db"), []
    for place, name in enumerate(NAMES):
        for year in (2024, 2025):
            content = json.loads((demo[0] / "fingerprint.json").read_text(encoding="utf-8"))
            ship = {"name": name, "class_name": "Stan Tug 1205", "line": "port"}
            content["conditions"] |= {"tested_at": f"{year}-03-0{place + 1}T10:00:00+01:00", "ship": ship}
            for source in content["sources"]:
                if source["role"] == "recording":
                    source["sha256"] = f"{year + 1000 * place:064x}"
            for number in content["physical"]:
                if number["name"] == ACTION and name == "Linge":
                    number["value"] *= 0.8
            paths.append(tmp_path / f"{name}-{year}.json")
            paths[-1].write_text(json.dumps(content), encoding="utf-8")
    assert run("store", "init", *store).exit_code == 0
    assert run("store", "add", *paths, *store).exit_code == 0
    return store


def test_the_odd_ship_is_named_first(run, yard, tmp_path):
    result = run("sisters", "Stan Tug 1205", *yard, "-o", tmp_path / "out")
    assert result.exit_code == 0, result.stderr
    printed = " ".join(result.output.split())
    assert printed.startswith(
        "Is a ship other than its sisters? Yes: 1 of 5 ships. Linge against its sisters: a lower proportional gain of "
        "the governor, by "
    )
    page = (tmp_path / "out" / "index.html").read_text(encoding="utf-8")
    assert "Not all ships are as their sisters are" in page
    document = json.loads(run("sisters", "Stan Tug 1205", *yard, "--json").output)
    finding = document["result"]["finding"]
    assert {ship["name"]: ship["tests"] for ship in finding["ships"]} == dict.fromkeys(NAMES, 2)
    odd = next(ship for ship in finding["ships"] if ship["is_odd"])
    assert odd["change"]["candidates"][0]["size"] == pytest.approx(-0.2, abs=0.01)


def test_what_was_set_on_purpose_leaves_earlier_tests_out(run, yard):
    event = ("governor-changed", "--at", "2024-09-01T08:00+02:00")
    assert run("store", "event", "Linge", *event, *yard).exit_code == 0
    document = json.loads(run("sisters", "Stan Tug 1205", *yard, "--json").output)
    tests = {ship["name"]: ship["tests"] for ship in document["result"]["finding"]["ships"]}
    assert tests == dict.fromkeys(NAMES, 2) | {"Linge": 1}


@pytest.mark.slow
def test_the_page_of_the_server_says_the_same(run, yard):
    question = {"kind": "class", "lines": [[{"name": name}, "port"] for name in NAMES]}
    asked = subprocess.Popen(
        [sys.executable, "-m", "shaftprint.web.calculator", str(2**32), str(2**30)],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        env=os.environ | {"SHAFTPRINT_STORE": str(yard[1])},
    )  # fmt: skip
    # it ends with its input
    with asked:
        asked.stdin.write(json.dumps(question) + "\n")
        asked.stdin.flush()
        answer = json.loads(asked.stdout.readline())
    printed = " ".join(run("sisters", "Stan Tug 1205", *yard).output.split())
    assert answer["word"] == "changed"
    assert " ".join(answer["sentences"]) in printed


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("Stan Tug 1250",), "expected a class of ships in the store, found none. Did you mean Stan Tug 1205?"),
        (("Stan Tug 1205", "--line", "starboard"), "expected one of its lines, port, found 'starboard'."),
    ],
)
def test_what_is_not_there_is_refused_in_a_sentence(run, yard, arguments, message):
    result = run("sisters", *arguments, *yard)
    assert result.exit_code == 1
    assert message in " ".join(result.stderr.split())
