"""What the pages show: their Python runs, their commands exist with the options that they are given, links lead on."""

import importlib
import re
import shlex
from datetime import UTC, datetime
from pathlib import Path

import click
import numpy as np
import pytest
from click.testing import CliRunner

import shaftprint as sp
from shaftprint.cli import shaftprint
from shaftprint.cli._command_group import COMMANDS
from shaftprint.cli._inputs import settings_text

ROOT = Path(__file__).parents[2]
PAGES = {
    path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8")
    for path in (ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md")))
}
FENCE = re.compile(r"^```([^\n]*)\n(.*?)^```", flags=re.MULTILINE | re.DOTALL)
# Run by `.ci/run` or by hand: they install, or take minutes.
NOT_RUN = ("make ", "python ", "py ", "pip ", "cd ", ".venv")


def blocks(page):
    """Return kind and text of every fenced block of a page."""
    return [(kind.strip(), text) for kind, text in FENCE.findall(PAGES[page])]


def python_of(page):
    """Return the Python of a page, in order, without the lines that set up a notebook's cell."""
    found = [text for kind, text in blocks(page) if kind in ("python", "{code-cell} ipython3")]
    # options of a cell, and magic that only a notebook knows
    return [re.sub(r"^[:%]\w.*\n", "", text, flags=re.MULTILINE) for text in found]


def commands_of(page):
    """Return the arguments of every shaftprint command of a page; what stands behind a # is left out."""
    shells = [text for kind, text in blocks(page) if kind in ("", "sh", "bash", "console", "text")]
    lines = "\n".join(shells).replace("\\\n", " ").splitlines()
    found = (re.match(r"\s*(?:\$ )?(?:[\w.]*[\\/])*shaftprint ([a-z-].*)", line) for line in lines)
    return [shlex.split(line[1], comments=True) for line in found if line]


OTHER_TESTS = [path for path in (ROOT / "tests").rglob("test_*.py") if path.parent != Path(__file__).parent]
OTHER_TEXT = "\n".join(path.read_text(encoding="utf-8") for path in OTHER_TESTS)
# A page that another test opens has its own checks there, of what its Python finds.
OPENED = {page for page in PAGES if f'"{Path(page).name}"' in OTHER_TEXT}
WITH_PYTHON = [page for page in PAGES if python_of(page)]
WITH_COMMANDS = [page for page in PAGES if commands_of(page)]


# sails the whole campaign
FULL_SIZE = {"docs/thesis-figures.md"}


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(page, marks=pytest.mark.full_size) if page in FULL_SIZE else page
        for page in WITH_PYTHON
        if page not in OPENED
    ],
)
def test_python_of_a_page_runs(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    names = {"__name__": "page"}
    for text in python_of(page):
        # a page that shows an example runs it only when it is built: tests/examples runs it for the tests
        if "SHAFTPRINT_EXAMPLES" in text or "ran[" in text:
            continue
        exec(compile(text, page, "exec"), names)  # noqa: S102
    capsys.readouterr()


def test_pages_with_tests_of_their_own_are_run_there():
    for page in WITH_PYTHON:
        if page in OPENED:
            name = re.escape(Path(page).name)
            tests = [path for path in OTHER_TESTS if re.search(name, path.read_text(encoding="utf-8"))]
            assert any(re.search(r"exec\(|runpy", path.read_text(encoding="utf-8")) for path in tests), page


@pytest.mark.parametrize("page", WITH_COMMANDS)
def test_commands_of_a_page_exist_and_take_their_options(page):
    for arguments in commands_of(page):
        name, *rest = arguments
        if name.startswith("-"):
            continue
        assert name in COMMANDS, arguments
        command = importlib.import_module(f"shaftprint.cli._{name.replace('-', '_')}").command
        try:
            command.make_context(name, list(rest))
        except click.exceptions.Exit:
            pass
        except click.ClickException as error:
            pytest.fail(f"{page}: shaftprint {' '.join(arguments)}: {error.format_message()}")


@pytest.mark.parametrize("page", PAGES)
def test_nothing_but_known_programs_is_asked_of_a_shell(page):
    for kind, text in blocks(page):
        if kind in ("sh", "bash", "console"):
            for line in text.replace("\\\n", " ").splitlines():
                words = re.sub(r"^\$ ", "", line.strip())
                assert not words or words.startswith(("shaftprint ", "#", *NOT_RUN)), f"{page}: {line}"


@pytest.mark.parametrize("page", PAGES)
def test_links_of_a_page_lead_to_something(page):
    folder = (ROOT / page).parent
    text = FENCE.sub("", PAGES[page])
    for link in re.findall(r"\]\(([^)\s]+)\)", text):
        target = link.partition("#")[0]
        if target and not link.startswith(("http", "mailto")) and "reference/generated" not in link:
            assert (folder / target).exists(), link


# Of these a page's own line is run as it stands, on a ship and a recording that are there. The tests of the command
# line run the others, which take longer, in their own way.
QUICK = {"new", "predict", "inspect", "show", "structures", "sensitivity", "simulate", "export"}
SLOW = ("export fmu", "inspect FILE")


def quick_commands(page):
    """Return the commands of a page that are run here, with the recording that is there for the user's."""
    found = [[re.sub(r"^log\.csv$", "recording.nc", word) for word in words] for words in commands_of(page)]
    chosen = [words for words in found if words[0] in QUICK and not " ".join(words).startswith(SLOW)]
    # the recording that is there was made with the short campaign
    return [["short" if word == "thesis" and words[0] == "inspect" else word for word in words] for words in chosen]


@pytest.fixture(scope="module")
def harbour(tmp_path_factory):
    """A folder with what a user of the pages has: settings, a recording of 14 minutes, a fingerprint, a structure."""
    folder = tmp_path_factory.mktemp("harbour")
    vessel, campaign = sp.vessel.load_vessel("stan-tug-1205"), sp.campaign.load_campaign("short")
    for name, kind, shipped in (
        ("mine.toml", "vessel", "stan-tug-1205"),
        ("test.toml", "campaign", "short"),
        ("campaign.toml", "campaign", "short"),
        ("last_year.toml", "campaign", "short"),
    ):
        (folder / name).write_bytes(settings_text(kind, shipped))
    sp.tug.sail(vessel, campaign, folder / "recording.nc", seed=1)
    for name in ("last_year.nc", "tug.nc"):
        (folder / name).symlink_to(folder / "recording.nc")
    with sp.recording.read_recording(folder / "recording.nc") as recording:
        signals = sp.signals.prepare_signals(recording, vessel, campaign)
    measured = sp.spectra.estimate_spectra(signals, campaign)
    line = sp.models.structure("GAUGE-CLOSED")
    known = sp.identify.Settings(priors=sp.identify.priors_from_vessel(line, vessel, signals.working_point))
    fit = sp.identify.identify(line, measured.response, rng=np.random.default_rng(1), settings=known)
    fingerprint = sp.fingerprint.take_fingerprint(
        fit,
        signals=signals,
        signal_to_noise=measured.signal_to_noise,
        vessel=vessel,
        campaign=campaign,
        settings_files=(),
        now=datetime.now(UTC),
    )
    for name in ("result", "demo"):
        (folder / name).mkdir()
        sp.fingerprint.write_fingerprint(fingerprint, folder / name / "fingerprint.json")
    (folder / "my_ship.py").write_text(
        "import dataclasses\nfrom shaftprint.models import structure\n"
        "my_loop = dataclasses.replace(structure('GAUGE-CLOSED'), name='MY-LOOP')\n"
    )
    rows = "".join(f"{0.1 * i:.1f},{0.0 if i < 10 else 0.02}\n" for i in range(50))
    (folder / "set_point.csv").write_text(f"time [s],n_set [-]\n{rows}")
    return folder


@pytest.mark.parametrize("page", [page for page in WITH_COMMANDS if quick_commands(page)])
def test_quick_commands_of_a_page_end_well(page, harbour, tmp_path, monkeypatch):
    for path in harbour.iterdir():
        (tmp_path / path.name).symlink_to(path)
    monkeypatch.chdir(tmp_path)
    for words in quick_commands(page):
        if words[0] == "new":
            Path(words[-1]).unlink()
        result = CliRunner().invoke(shaftprint, words, catch_exceptions=False)
        assert result.exit_code == 0, f"shaftprint {' '.join(words)}: {result.output}{result.stderr}"
        if words[0] == "new":
            # what the user fills in
            Path(words[-1]).write_bytes((harbour / words[-1]).read_bytes())
