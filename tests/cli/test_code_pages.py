"""As on Windows, which is not at hand: code pages, long paths with letters of their own, a report that is open."""

import errno
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from shaftprint.cli import shaftprint

# that of a console, and that of a file, on a Windows of western Europe
CODE_PAGES = ("cp850", "cp1252")
# Windows takes 259 letters unless its owner allows more
LETTERS_OF_A_PATH = 250


@pytest.fixture
def quay(demo, tmp_path):
    """A folder whose files have paths of 250 letters, with spaces and umlauts, and in it what the demo leaves."""
    start = tmp_path / "Schlepper Müller GmbH"
    longest = "second vessel.toml"
    folder = start / f"Ärger am Kai {'x' * (LETTERS_OF_A_PATH - len(str(start)) - len(longest) - 15)}"
    folder.mkdir(parents=True)
    assert len(str(folder / longest)) == LETTERS_OF_A_PATH
    for name in ("recording.nc", "vessel.toml", "campaign.toml", "fingerprint.json"):
        os.link(demo[0] / name, folder / name)
    return folder


def commands(folder):
    """Return commands that print tables or sentences with all letters of the program's own, and take little time."""
    fingerprint, vessel, campaign = folder / "fingerprint.json", folder / "vessel.toml", folder / "campaign.toml"
    return [
        ("new", "vessel", folder / "second vessel.toml"),
        ("structures", "GAUGE-CLOSED"),
        ("inertia", vessel),
        ("inspect", folder / "recording.nc"),
        ("show", fingerprint),
        ("compare", fingerprint, fingerprint, "--name", "Frühjahr", "--name", "Herbst"),
        ("export", "modelica", fingerprint, "-o", folder / "Tug.mo"),
        ("convert", folder / "recording.nc", "-o", folder / "Ä ö.nc"),
        ("identify", folder / "Ü.nc", "--vessel", vessel, "--campaign", campaign, "-o", folder / "out"),
    ]


@pytest.mark.parametrize("code_page", CODE_PAGES)
def test_every_letter_is_of_the_code_page(quay, code_page):
    for command in commands(quay):
        # a letter that the code page lacks is an error here
        result = CliRunner(charset=code_page).invoke(shaftprint, list(map(str, command)), catch_exceptions=False)
        assert result.exit_code == (1 if command[0] == "identify" else 0), result.stderr
    assert f"{quay / 'Ü.nc'}: expected a logger file, found none there." in result.stderr
    assert {path.name for path in quay.iterdir()} >= {"second vessel.toml", "Tug.mo", "Ä ö.nc"}
    assert not (quay / "out").exists()


@pytest.mark.parametrize(("code_page", "rule"), [("cp850", "─"), ("cp1252", "-"), ("utf-8", "─")])
def test_tables_have_rules_that_the_code_page_has(demo, code_page, rule):
    result = CliRunner(charset=code_page).invoke(shaftprint, ["show", str(demo[0])], catch_exceptions=False)
    rules = [line for line in result.stdout.splitlines() if line.strip(" ") and not line.strip(f" {rule}")]
    # parameters, combinations, margins, sensors, physical values
    assert len(rules) >= 5


@pytest.mark.slow
@pytest.mark.parametrize("code_page", CODE_PAGES)
def test_a_name_that_the_code_page_lacks_ends_nothing(demo, tmp_path, code_page):
    vessel = tmp_path / "vessel.toml"
    text = (demo[0] / "vessel.toml").read_text(encoding="utf-8")
    vessel.write_text(text.replace("Damper housing", "減衰器 housing"), encoding="utf-8")
    environment = os.environ | {"PYTHONIOENCODING": code_page, "PYTHONUTF8": "0"}
    command = [sys.executable, "-m", "shaftprint", "inertia", str(vessel)]
    done = subprocess.run(command, env=environment, capture_output=True, check=True)
    assert " ??? housing " in done.stdout.decode(code_page)
    assert done.stderr == b""


@pytest.fixture
def browser(monkeypatch):
    """Let a browser have files of a folder open: Windows refuses to replace them. Return how the folder is named."""
    replace, held = os.replace, []

    def refused(source, target):
        if Path(target).name == "index.html" and Path(target).parent in held:
            raise PermissionError(errno.EACCES, "used by another process", str(source), None, str(target))
        replace(source, target)

    monkeypatch.setattr(os, "replace", refused)
    return held


@pytest.mark.slow
def test_a_report_that_is_open_is_written_anew_once_it_is_closed(run, demo, tmp_path, browser):
    last_year, folder = tmp_path / "last year.json", tmp_path / "Bericht für Müller"
    shutil.copy(demo[0] / "fingerprint.json", last_year)
    command = ("compare", demo[0], last_year, "-o", folder, "--force")
    assert run(*command).exit_code == 0
    before = (folder / "index.html").read_bytes()
    browser.append(folder)
    result = run(*command)
    assert result.exit_code == 1
    (sentence,) = result.stderr.splitlines()
    assert sentence.startswith(f"Error: {folder / 'index.html'}: the new results are complete in ")
    assert "close what has it open" in sentence
    assert (folder / "index.html").read_bytes() == before
    browser.clear()
    assert run(*command).exit_code == 0
    assert sorted(path.name for path in folder.iterdir() if path.name.startswith(".")) == [".shaftprint"]
