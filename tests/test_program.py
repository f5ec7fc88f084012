"""What the program for computers without Python does with its words; ``make program`` builds it."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

START = Path(__file__).resolve().parent.parent / "requirements" / "program" / "start.py"


@pytest.fixture
def start():
    """Return the program's first module."""
    specification = importlib.util.spec_from_file_location("program_start", START)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


@pytest.fixture
def begun(monkeypatch):
    """Return the words with which the command line was begun."""
    words = []
    monkeypatch.setattr("shaftprint.cli.main", lambda: words.append(sys.argv[1:]))
    return words


def ended(*words):
    return subprocess.run(
        [sys.executable, START, *words], capture_output=True, text=True, encoding="utf-8", check=False
    )


def test_it_runs_a_module_as_python_does():
    done = ended("-P", "-m", "platform", "terse")
    assert done.returncode == 0, done.stderr
    assert (
        done.stdout.strip()
        == subprocess.run(
            [sys.executable, "-m", "platform", "terse"], capture_output=True, text=True, encoding="utf-8", check=True
        ).stdout.strip()
    )


def test_words_are_those_of_the_command_line():
    done = ended("--version")
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("shaftprint ")


def test_a_double_click_opens_the_pages_of_a_store_among_the_documents(start, begun, monkeypatch, tmp_path):
    (tmp_path / "Documents").mkdir()
    monkeypatch.setattr(Path, "home", lambda: tmp_path)
    monkeypatch.setattr(sys, "argv", ["shaftprint"])
    start.main()
    folder = tmp_path / "Documents" / "shaftprint"
    assert folder.is_dir()
    store, state = str(folder / "shaftprint.db"), str(folder / "server")
    assert begun == [["serve", "--open", "--store", store, "--state", state]]


def test_a_file_that_lies_elsewhere_is_not_run(start, begun, monkeypatch, tmp_path):
    (tmp_path / "log.py").write_text("raise SystemExit('was run')")
    monkeypatch.setattr(sys, "argv", ["shaftprint", str(tmp_path / "log.py")])
    start.main()
    assert begun == [[str(tmp_path / "log.py")]]
