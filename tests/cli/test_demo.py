"""``shaftprint demo``: the whole way, with truth beside estimate."""

import json
import re
import textwrap
import tomllib
from pathlib import Path

import pytest

from shaftprint.fingerprint import read_fingerprint
from shaftprint.recording import read_recording
from shaftprint.survey import load_trial
from shaftprint.tug import read_truth


def test_files(demo):
    folder, result = demo
    assert result.exit_code == 0
    with read_recording(folder / "recording.nc") as recording:
        found = read_fingerprint(folder / "fingerprint.json")
        assert found.sources[0].sha256 == recording.sha256
    assert read_truth(folder / "recording.truth.json").seed == 1
    assert tomllib.loads((folder / "campaign.toml").read_text())["duration_s"] == 860.0
    trial = load_trial(str(folder / "vessel.toml"), str(folder / "campaign.toml"))
    assert [source.sha256 for source in trial.sources] == [source.sha256 for source in found.sources[1:]]


def test_report_has_its_figures(demo):
    folder, _ = demo
    page = "".join((folder / name).read_text(encoding="utf-8") for name in ("index.html", "thesis.html"))
    written = {path.name for path in (folder / "plots").iterdir()}
    assert {name for name in written if f"plots/{name}" in page} == written
    assert {"fit", "closed_loop", "thesis_mode_5_1", "strips"} <= {Path(name).stem for name in written}
    assert not (folder / "figures").exists()


def test_last_lines_say_what_was_found_and_where(demo):
    folder, result = demo
    tail = result.stdout[result.stdout.index("What was found") :]
    assert "the inertia behind the torque gauge (I_dn): " in tail
    assert "true value 17.00 kg m2." in tail
    assert "true value 0.1221 s." in tail
    assert re.search(r"true value 2\.000+\.", tail)
    assert "The thesis' way finds an inertia time of" in tail
    # what was found in words; names are where they are explained
    assert tail.index("Gain margin: ") < tail.index("Found too, but not to be used")
    kept = json.loads((folder / "fingerprint.json").read_text(encoding="utf-8"))["verdict"]
    few, all_of = len(kept["trusted"]), len(kept["trusted"]) + len(kept["not_trusted"])
    assert f"{few} of {all_of} numbers can be used: `shaftprint show` has them by name" in result.stdout
    assert "Trusted: " not in result.stdout
    assert tail.rstrip().splitlines()[-4:-2] == [
        f"Fingerprint: {Path('demo', 'fingerprint.json')}",
        f"Report:      {Path('demo', 'index.html')}",
    ]
    assert result.stderr == ""


def test_truth_lies_in_the_intervals(demo):
    folder, _ = demo
    found, truth = read_fingerprint(folder / "fingerprint.json"), read_truth(folder / "recording.truth.json")
    for name, true in (
        ("I_dn", truth.physical["inertia_downstream_kg_m2"]),
        ("I_up", truth.physical["inertia_upstream_kg_m2"]),
        ("set-point slope", truth.set_point_slope_rpm_per_v),
        ("k_q", 2.0),
        ("K_p / K_i", truth.normalised["K_p"] / truth.normalised["K_i"]),
    ):
        quantity = found.quantity(name)
        assert abs(quantity.value - true) < 3.0 * quantity.std, name


def test_the_answer_fits_on_a_screen(demo):
    """Verdict, what was found and where it lies, as wide as a pipe; the tables are in the report."""
    _, result = demo
    lines = [row for line in result.stdout.splitlines() for row in (textwrap.wrap(line, 100) or [""])]
    assert len(lines) <= 45
    assert lines[0] == "Verdict: trustworthy, but not governor gains"
    assert "─" not in result.stdout


def test_structures_of_the_thesis_are_in_the_report(demo):
    folder, _ = demo
    page = (folder / "thesis.html").read_text(encoding="utf-8")
    for name in ("OL1", "OL2", "OL3", "OL4", "OL5", "CL1", "CL3", "CL4"):
        assert re.search(rf"\b{name}\b", page), name


@pytest.mark.slow
def test_line_to_do_it_again_works(demo, run, tmp_path, monkeypatch):
    folder, result = demo
    monkeypatch.chdir(folder.parent)
    *_, again, own = result.stdout.rstrip().splitlines()
    assert own.split() == ["Your", "ship:", "shaftprint", "start"]
    words = again.split()
    assert words[:2] == ["Again:", "shaftprint"]
    arguments = [*words[2:-1], tmp_path / "again"]
    assert run(*arguments).exit_code == 0
    again, before = (read_fingerprint(place / "fingerprint.json") for place in (tmp_path / "again", demo[0]))
    assert again.parameters == before.parameters


def test_folder_of_others_is_refused_before_sailing(run, tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    result = run("demo", "--short", "-o", tmp_path)
    assert result.exit_code == 1
    assert [entry.name for entry in tmp_path.iterdir()] == ["mine.txt"]
