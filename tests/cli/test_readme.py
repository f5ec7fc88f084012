"""Everything that is shown works as printed: the README's Python, its commands and figures, and the examples."""

import re
import runpy
from pathlib import Path

import pytest

from shaftprint.catalogue import structure
from shaftprint.cli import shaftprint

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")


@pytest.fixture
def beside_demo(demo, tmp_path, monkeypatch):
    """A working folder in which the demo has been run."""
    (tmp_path / "demo").symlink_to(demo[0], target_is_directory=True)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _printed(text):
    """Return value and 95 % interval of each number that was printed, by name."""
    rows = re.findall(r"^(.{30}) *(\S+)   95 % interval (\S+) to (\S+)", text, flags=re.MULTILINE)
    return {name.strip(): tuple(map(float, numbers)) for name, *numbers in rows}


@pytest.mark.slow
def test_python_of_the_readme(beside_demo, capsys):
    blocks = re.findall(r"```python\n(.*?)```", README, flags=re.DOTALL)
    assert len(blocks) == 1
    lines = [line for line in blocks[0].splitlines() if line.strip() and not line.startswith(("import", "from"))]
    assert len(lines) <= 10
    script = beside_demo / "readme.py"
    script.write_text(blocks[0])
    runpy.run_path(str(script))
    numbers = _printed(capsys.readouterr().out)
    # truth of the simulated tug: 0.0703 s + 0.0518 s, 5.7 / 4.27, quadratic propeller
    for name, true in (("t_d + t_sp", 0.1221), ("K_p / K_i", 1.3349), ("k_q", 2.0)):
        value, low, high = numbers[name]
        # three standard deviations, where 95 % are two
        assert value - 1.5 * (value - low) < true < value + 1.5 * (high - value)


@pytest.mark.slow
def test_example_of_every_step(beside_demo, capsys):
    runpy.run_path(str(ROOT / "examples" / "identify_recording.py"))
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("working point: 118")
    assert sum(" 95 %: " in line for line in lines) == len(structure("GAUGE-CLOSED").free) + len(
        structure("GAUGE-CLOSED").combinations
    )


def test_example_of_ones_own_structure(beside_demo, capsys):
    runpy.run_path(str(ROOT / "examples" / "own_structure.py"), run_name="__main__")
    printed = capsys.readouterr().out
    compliance, std = map(float, re.search(r"ELASTIC-CORE: .* c = (-?[\d.]+) \+/- ([\d.]+)", printed).groups())
    # the shaft of the simulated tug is stiff
    assert compliance == pytest.approx(0.0, abs=3.0 * std)
    assert "GAUGE-CORE wins" in printed


@pytest.mark.slow
def test_example_of_ones_own_structure_on_the_command_line(run, beside_demo):
    own = f"{ROOT / 'examples' / 'own_structure.py'}:elastic_core"
    given = ("--vessel", "demo/vessel.toml", "--campaign", "demo/campaign.toml", "--no-progress")
    result = run("identify", "demo/recording.nc", *given, "--structure", own, "-v", "-o", "elastic")
    assert result.exit_code == 0, result.stderr
    assert "ELASTIC-CORE explains" in result.output
    assert "Identified parameters" in result.output
    assert "compliance of the shaft" in result.output


def test_commands_in_the_readme_exist():
    named = set(re.findall(r"^(?:\S*[\\/])?shaftprint ([a-z]+)", README, flags=re.MULTILINE))
    assert named
    assert named <= set(shaftprint.helps)


@pytest.mark.parametrize("page", ["README.md", "CONTRIBUTING.md"])
def test_files_that_a_page_names_exist(page):
    text = (ROOT / page).read_text(encoding="utf-8")
    links = [link for link in re.findall(r"\]\(([^)]+)\)", text) if not link.startswith("http")]
    links += re.findall(r"`((?:docs|examples|requirements|src|models|\.ci)/[\w./-]*)`", text)
    for link in links:
        assert (ROOT / link).exists() or (ROOT / "src" / "shaftprint" / link).exists(), link


def test_decisions_are_numbered_without_gap():
    names = sorted(path.name for path in (ROOT / "docs" / "decisions").glob("*.md"))
    assert [int(name[:4]) for name in names] == list(range(1, len(names) + 1))


def test_make_targets_that_pages_name_exist():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for page in ("README.md", "CONTRIBUTING.md", ".ci/run"):
        text = (ROOT / page).read_text(encoding="utf-8")
        for target in re.findall(r"`?\bmake ([a-z-]+)`?$|`make ([a-z-]+)`|^make ([a-z-]+)", text, flags=re.MULTILINE):
            assert f"\n{''.join(target)}:" in makefile


@pytest.mark.parametrize("path", sorted((ROOT / "requirements").glob("*.txt")), ids=lambda path: path.name)
def test_locked_requirements_have_hashes_and_name_no_index(path):
    text = path.read_text(encoding="utf-8")
    pins = re.findall(r"^[a-z][^ ]*==\S+", text, flags=re.MULTILINE)
    assert len(pins) > 20
    assert len(re.findall(r"--hash=sha256:[0-9a-f]{64}", text)) >= len(pins)
    for word in ("http", "index-url", "find-links", "@", "file:"):
        assert word not in text
