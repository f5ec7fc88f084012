"""``shaftprint compare`` on the fingerprint of the short demo and changed copies of it."""

import json
import re
from dataclasses import replace

import pytest

from shaftprint.fingerprint import read_fingerprint, write_fingerprint


@pytest.fixture
def later(demo, tmp_path):
    """The same line with half as much inertia again behind the gauge."""
    first = read_fingerprint(demo[0] / "fingerprint.json")
    physical = tuple(replace(q, value=1.5 * q.value) if q.name == "I_dn" else q for q in first.physical)
    place = tmp_path / "later.json"
    write_fingerprint(first.model_copy(update={"physical": physical}), place)
    return place


def test_what_has_changed_is_said_and_reported(run, demo, later, tmp_path):
    result = run("compare", demo[0], later, "-o", tmp_path / "out")
    assert result.exit_code == 0, result.stderr
    assert "later compared with demo" in result.output
    row = next(line for line in result.output.splitlines() if line.strip().startswith("I_dn"))
    assert " differs " in row
    row = next(line for line in result.output.splitlines() if line.strip().startswith("gain margin"))
    assert " no difference seen " in row
    assert "Has the ship changed? Yes: more inertia behind the torque gauge, by 50.0" in result.output
    assert "later: what has changed" in result.output
    moving = result.output.partition("normalised numbers, which move with the working point")[2].splitlines()
    left_out = [line.split()[0] for line in moving if "cannot be compared" in line]
    assert left_out == ["K_p", "K_i", "tau_dn", "tau_up", "k_q"]
    assert "Not compared, moving with the working point: K_p (see governor proportional action), " in result.output
    assert (tmp_path / "out" / "index.html").is_file()


def test_whether_the_ship_has_changed_is_said_first(run, demo, later):
    first, *_ = run("compare", demo[0], later).output.splitlines()
    assert first.startswith("Has the ship changed? Yes: more inertia behind the torque gauge, by 50.0")
    result = run("compare", demo[0], later, demo[0], "--name", "2024", "--name", "2025", "--name", "2026")
    one, two = (line for line in result.output.splitlines() if line.startswith("Has the ship changed"))
    assert one.startswith("Has the ship changed, 2025? Yes: more inertia behind the torque gauge, by 50.0")
    assert two.startswith("Has the ship changed, 2026? No: ")


def test_of_two_ships_it_is_not_said_that_one_has_changed(run, demo, later):
    other = read_fingerprint(later)
    conditions = other.conditions.model_copy(update={"vessel": "Ferry of four"})
    write_fingerprint(other.model_copy(update={"conditions": conditions}), later)
    first, *_ = run("compare", demo[0], later).output.splitlines()
    assert first.startswith("Of Stan Tug 1205, port and Ferry of four: is later other than demo? Yes: more inertia")


def test_each_number_may_be_judged_by_itself(run, demo, later):
    result = run("compare", demo[0], later, "--each-number")
    assert result.output.startswith("Has the ship changed? Yes: I_dn by 50.0 %")
    assert "what has changed" not in result.output


def test_a_fingerprint_of_an_earlier_version_is_judged_number_by_number(run, demo, later):
    content = json.loads(later.read_text(encoding="utf-8"))
    del content["joint"]
    later.write_text(json.dumps(content), encoding="utf-8")
    document = json.loads(run("compare", demo[0], later, "--json").output)
    assert "has no joint covariance" in document["result"]["causes"]["later"]["because"]
    printed = " ".join(run("compare", demo[0], later).output.split())
    assert "Yes: I_dn by 50.0 %" in printed
    assert "Judged number by number: a fingerprint of an earlier version has no joint covariance" in printed


def test_what_the_vessel_files_state_alike_is_said(run, demo, later):
    """The copy was made with the same file, to which the scale of the gauge and the inertia table are common."""
    output = run("compare", demo[0], later).output
    assert "Both vessel files state the same." in output
    (common,) = [line for line in output.splitlines() if line.startswith("Stated alike for both tests")]
    assert "TVC" in common
    assert "gauge scale" in common


def test_time_and_ship_of_the_tests_stand_beside_each_other(run, demo, later):
    content = json.loads(later.read_text(encoding="utf-8"))
    content["conditions"] |= {
        "tested_at": "2026-03-13T14:05:00+01:00",
        "ship": {"name": "Meander", "imo_number": 9074729, "line": "port"},
        "draught_m": 1.8,
    }
    later.write_text(json.dumps(content), encoding="utf-8")
    printed = run("compare", demo[0], later).output.partition("Stated of the tests")[2]
    rows = [re.split(r"\s{2,}", line.strip()) for line in printed.splitlines()]
    cells = {row[0]: row[1:] for row in rows}
    assert cells["tested"][1] == "2026-03-13 14:05 +01:00"
    assert cells["ship"][1] == "Meander, port, IMO 9074729"
    assert cells["draught"][1] == "1.80 m"
    document = json.loads(run("compare", demo[0], later, "--json").output)
    assert document["result"]["conditions"]["later"]["ship"]["imo_number"] == 9074729
    shown = run("show", later).output
    assert "ship Meander, port, IMO 9074729; tested 2026-03-13 14:05 +01:00" in shown


def test_folders_of_one_name_are_told_apart_by_their_path(run, demo, later, tmp_path):
    for year in ("2025", "2026"):
        (tmp_path / year / "result").mkdir(parents=True)
    first, other = (tmp_path / year / "result" / "fingerprint.json" for year in ("2025", "2026"))
    first.write_bytes((demo[0] / "fingerprint.json").read_bytes())
    other.write_bytes(later.read_bytes())
    result = run("compare", first.parent, other.parent)
    assert result.exit_code == 0, result.stderr
    assert "2026/result compared with 2025/result" in result.output
    result = run("compare", first, other, later)
    assert "2026/result compared with 2025/result" in result.output
    assert "later compared with 2025/result" in result.output


def test_more_load_from_day_to_day_hides_more(run, demo, tmp_path):
    """A torque coefficient 8 % up is more than chance; not where loads of one ship scatter by 10 %."""
    first = read_fingerprint(demo[0] / "fingerprint.json")
    physical = tuple(replace(q, value=1.08 * q.value) if q.name == "K_Q" else q for q in first.physical)
    write_fingerprint(first.model_copy(update={"physical": physical}), tmp_path / "fouled.json")
    found = run("compare", demo[0], tmp_path / "fouled.json").output
    assert "changed? Yes: more propeller torque at the same speed: fouled, damaged, or more draught, by 8.0 " in found
    result = run("compare", demo[0], tmp_path / "fouled.json", "--load-repeatability", "10")
    assert "Has the ship changed? No: " in result.output


def test_a_test_that_is_not_trustworthy_tells_nothing(run, demo, later):
    found = read_fingerprint(later)
    doubtful = found.model_copy(update={"verdict": replace(found.verdict, trustworthy=False)})
    write_fingerprint(doubtful, later)
    result = run("compare", demo[0], later)
    assert result.exit_code == 0, result.stderr
    assert "Has the ship changed? It cannot be told: not trustworthy: later." in result.output


def test_names_are_asked_for_where_they_are_needed(run, demo, later, tmp_path):
    result = run("compare", demo[0], demo[0])
    assert result.exit_code == 2
    assert "tell them apart with --name" in result.stderr
    result = run("compare", demo[0], later, "--name", "only one")
    assert "expected a --name for each of 2 fingerprints, found 1" in result.stderr
    result = run("compare", demo[0])
    assert "expected two or more fingerprints, found 1" in result.stderr


def test_a_file_that_is_no_fingerprint_leaves_no_report(run, demo, tmp_path):
    (tmp_path / "no.json").write_text("{}", encoding="utf-8")
    result = run("compare", demo[0], tmp_path / "no.json", "-o", tmp_path / "out")
    assert result.exit_code == 1
    assert "without a schema_version" in result.stderr
    assert not (tmp_path / "out").exists()
