"""``shaftprint fleet`` and ``shaftprint work``, as their page has them."""

import json
import re
import shlex
import shutil
from pathlib import Path

import click
import pytest

from shaftprint.cli import shaftprint
from shaftprint.fingerprint import read_fingerprint

PAGE = (Path(__file__).parents[2] / "docs" / "fleet-runs.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"^\| `((?:store|fleet|work)[^`]*)` \|", PAGE, flags=re.MULTILINE)


def test_the_program_of_the_page_finds_an_empty_ledger(capsys):
    (program,) = re.findall(r"^```python\n(.*?)^```", PAGE, flags=re.MULTILINE | re.DOTALL)
    exec(compile(program, "docs/fleet-runs.md", "exec"), {})  # noqa: S102
    assert "done=0" in capsys.readouterr().out


def test_every_action_is_listed_with_its_help(run):
    group = shaftprint.get_command(None, "fleet")
    text = " ".join(run("fleet", "--help").output.split())
    for name, words in group.helps.items():
        assert f"{name} {words}" in text
        action = group.get_command(None, name)
        assert action.get_short_help_str(limit=200) == words
        assert all(parameter.help for parameter in action.params if isinstance(parameter, click.Option))


@pytest.fixture
def yard(demo, tmp_path, monkeypatch):
    """A folder with a recording in a list and a folder of recordings, one of which is damaged."""
    folder, _ = demo
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("SHAFTPRINT_STORE", raising=False)
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "1")
    for name in ("recording.nc", "vessel.toml", "campaign.toml"):
        shutil.copy(folder / name, tmp_path / name)
    (tmp_path / "recordings").mkdir()
    (tmp_path / "recordings" / "cut.nc").write_bytes((tmp_path / "recording.nc").read_bytes()[:100_000])
    row = "recording.nc,Meander,port,2026-03-31T09:30+02:00,1.8"
    (tmp_path / "list.csv").write_text(f"recording,ship,line,tested-at,draught-m\n{row}\n", encoding="utf-8")
    return tmp_path


@pytest.mark.slow
def test_commands_do_what_their_page_says(yard, run):
    said = {}
    for line in COMMANDS:
        result = run(*shlex.split(line))
        assert result.exit_code == 0, result.output
        said[line.split(" -")[0]] = result.output
    assert "Jobs done here: 1; refused: 0." in said["fleet run list.csv"]
    assert "Recordings: 1; to be identified: 1." in said["fleet run recordings"]
    assert "Jobs done here: 0; refused: 1." in said["work"]
    assert "waiting: 0, running: 0, done: 1, refused: 1." in said["fleet status"]
    assert "cut.nc" in said["fleet status"]
    assert "Jobs that wait again: 1" in said["fleet retry"]
    assert (yard / "report-1" / "index.html").exists()
    # the same computer gives the same numbers
    assert "not equal bit by bit" not in said["fleet report 1"]
    conditions = read_fingerprint(yard / "report-1" / "fingerprint.json").conditions
    assert (conditions.draught_m, conditions.tested_at.isoformat()) == (1.8, "2026-03-31T09:30:00+02:00")


@pytest.mark.slow
def test_a_run_without_work_asks_only(yard, run):
    run("store", "init")
    options = ("--vessel", "vessel.toml", "--campaign", "campaign.toml", "--processes", 0, "--json")
    first = json.loads(run("fleet", "run", "list.csv", *options).stdout)["result"]
    again = json.loads(run("fleet", "run", "list.csv", *options).stdout)["result"]
    assert first["asked"] == again["asked"] == {"recordings": 1, "jobs": 1, "to_do": 1}
    assert [one["state"] for one in again["jobs"]] == ["waiting"]
    status = json.loads(run("fleet", "status", "--json").stdout)["result"]
    assert status["counts"] == {"waiting": 1, "running": 0, "done": 0, "refused": 0}


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("fleet", "run", "nowhere"), "nowhere: expected a list in CSV, but it cannot be read: No such file"),
        (("fleet", "run", "list.csv"), "expected a vessel, found none; add it, or state --vessel"),
        (("fleet", "status"), "expected a store, found nothing there; make one with shaftprint store init"),
        (("fleet", "report", "1", "-o", "report"), "expected a store, found nothing there"),
    ],
)
def test_what_cannot_be_done_is_said_in_a_sentence(tmp_path, monkeypatch, run, words, said):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("SHAFTPRINT_STORE", raising=False)
    (tmp_path / "list.csv").write_text("recording\na.nc\n", encoding="utf-8")
    result = run(*words)
    assert result.exit_code in {1, 2}
    assert said in " ".join(result.output.split())
