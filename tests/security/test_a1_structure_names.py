"""Item A1: a name out of a data file is never a path to code.

``structure`` of a fingerprint may hold any text. Whatever command reads it, no file is run that the user has not named
on the command line; the error says which option is wanted.
"""

import json
from pathlib import Path

import pytest

COMMANDS = {
    "export csv": ("export", "csv", "{0}", "-o", "out.csv"),
    "export fmu": ("export", "fmu", "{0}", "-o", "out.fmu", "--source-only"),
    "export json": ("export", "json", "{0}", "-o", "out.json"),
    "export matlab": ("export", "matlab", "{0}", "-o", "out.mat"),
    "export modelica": ("export", "modelica", "{0}", "-o", "out.mo"),
    "export osp": ("export", "osp", "{0}", "-o", "out.fmu"),
    "export ssp": ("export", "ssp", "{0}", "-o", "out.ssv"),
    "simulate": ("simulate", "--fingerprint", "{0}", "--campaign", "short", "-o", "out.csv"),
    "validate": (
        "validate", "{1}", "--vessel", "stan-tug-1205", "--campaign", "short", "--fingerprint", "{0}", "--no-progress",
    ),
    "compare": ("compare", "{0}", "{1}", "--name", "a", "--name", "b", "-o", "out"),
    "show": ("show", "{0}"),
}  # fmt: skip
# what these print of a fingerprint needs no structure
NEED_NONE = {"compare", "show"}


@pytest.fixture
def helper(tmp_path, monkeypatch):
    """A file of code in the working folder, and the file that it leaves when it is run."""
    monkeypatch.chdir(tmp_path)
    left = tmp_path / "ran"
    (tmp_path / "helper.py").write_text(f"open({str(left)!r}, 'w').close()\nx = 1\n", encoding="utf-8")
    return left


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("place", ["helper.py:x", "{folder}/helper.py:x", "HELPER.PY:x"])
def test_no_command_runs_a_file_that_a_fingerprint_names(command, place, run, forged, helper, demo, tmp_path):
    name = place.format(folder=tmp_path)
    path = forged(lambda content: content.update(structure=name))
    other = demo[0] / ("fingerprint.json" if command == "compare" else "recording.nc")
    result = run(*(part.format(path, other) for part in COMMANDS[command]))
    assert not helper.exists()
    if command in NEED_NONE:
        assert result.exit_code == 0, result.stderr
        return
    assert result.exit_code == 1
    assert "--structure" in result.stderr
    assert not list(tmp_path.glob("out*"))


def test_a_fingerprint_of_an_own_structure_says_which_option_is_wanted(run, forged, helper):
    def own(content):
        content["structure"] = "MY-LOOP"
        content["sources"].append({"role": "structure", "name": "helper.py", "sha256": "ab" * 32})

    result = run("export", "json", forged(own))
    assert result.exit_code == 1
    assert "MY-LOOP" in result.stderr
    assert "read helper.py, then give it with --structure helper.py:NAME" in result.stderr
    assert not helper.exists()


@pytest.mark.slow
@pytest.mark.parametrize("command", ["export csv", "export modelica", "simulate"])
def test_the_option_still_takes_a_file(command, run, forged, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = (
        "from dataclasses import replace\n"
        "from shaftprint.catalogue import structure\n"
        "loop = replace(structure('GAUGE-CLOSED'), name='MY-LOOP')\n"
    )
    Path("ship.py").write_text(text, encoding="utf-8")
    path = forged(lambda content: content.update(structure="MY-LOOP"))
    result = run(*(part.format(path) for part in COMMANDS[command]), "--structure", "ship.py:loop")
    assert result.exit_code == 0, result.stderr


def test_shipped_names_of_a_fingerprint_need_no_option(run, forged, tmp_path):
    path = forged(lambda content: content.update(structure="gauge-closed"))
    result = run("export", "json", path, "-o", tmp_path / "out.json")
    assert result.exit_code == 0, result.stderr
    assert json.loads((tmp_path / "out.json").read_text())["structure"]["name"] == "GAUGE-CLOSED"


def test_the_python_call_runs_no_file_either(forged, helper):
    from shaftprint.errors import FingerprintError
    from shaftprint.export import exported_model
    from shaftprint.fingerprint import read_fingerprint

    found = read_fingerprint(forged(lambda content: content.update(structure="helper.py:x")))
    with pytest.raises(FingerprintError, match="structure"):
        exported_model(found)
    assert not helper.exists()
