"""``shaftprint compare`` on the fingerprint of the short demo and changed copies of it."""

from dataclasses import replace

import pytest

from shaftprint.fingerprint import read_fingerprint, write_fingerprint


@pytest.fixture
def later(demo, tmp_path):
    """The same line with half as much inertia again behind the gauge."""
    first = read_fingerprint(demo[0] / "fingerprint.json")
    physical = tuple(q.model_copy(update={"value": 1.5 * q.value}) if q.name == "I_dn" else q for q in first.physical)
    place = tmp_path / "later.json"
    write_fingerprint(first.model_copy(update={"physical": physical}), place)
    return place


def test_what_has_changed_is_said_and_reported(run, demo, later, tmp_path):
    result = run("compare", demo[0], later, "-o", tmp_path / "out")
    assert result.exit_code == 0, result.stderr
    assert "later compared with demo" in result.output
    row = next(line for line in result.output.splitlines() if line.strip().startswith("I_dn"))
    assert row.split()[-1] == "differs"
    row = next(line for line in result.output.splitlines() if line.strip().startswith("gain margin"))
    assert row.strip().endswith("no difference seen")
    assert "Has the ship changed? Yes: I_dn by 50.0 %" in result.output
    assert "Not compared, moving with the working point: K_p, K_i, tau_dn, tau_up, k_q." in result.output
    assert (tmp_path / "out" / "index.html").is_file()


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
