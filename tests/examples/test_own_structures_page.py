"""The page on structures of one's own runs as it stands, and what it prints is true."""

import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from shaftprint.cli import shaftprint

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "own-structures.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def defined(tmp_path_factory):
    """Run all Python of the page in order, in a folder of its own; return what it defines."""
    names = {"__name__": "own_structures"}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("page"))
        for block in re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL):
            exec(compile(block, "own-structures.md", "exec"), names)  # noqa: S102
        names["files"] = {path.name for path in Path.cwd().iterdir()}
    return names


@pytest.mark.slow
def test_the_fan_is_found(defined):
    found = defined["profiled"].intervals
    for name, true in (("K", 12.0), ("T", 0.8), ("t_d", 0.05)):
        assert found[name].lower <= true <= found[name].upper, name
    assert defined["assess"](defined["fit"]).trusted == ("K", "T", "t_d")
    assert {"fan.svg", "fan_residuals.svg"} <= defined["files"]


@pytest.mark.slow
def test_the_margin_is_that_of_the_true_fan(defined):
    # K_p = 0.3 and K_i = 0.4 around 12 exp(-0.05 s) / (0.8 s + 1), without the hold
    omega = np.linspace(1.0, 200.0, 1_000_000)
    s = 1j * omega
    gain = (0.3 + 0.4 / s) * 12.0 * np.exp(-0.05 * s) / (0.8 * s + 1.0)
    crossing = np.flatnonzero((gain.imag[:-1] < 0.0) & (gain.imag[1:] >= 0.0))[0]
    margin = defined["margin"]
    assert margin.value == pytest.approx(-1.0 / gain.real[crossing], abs=3.0 * margin.std)


@pytest.mark.slow
def test_the_simulated_loop_ends_where_its_integrator_leads_it(defined):
    answer = defined["answer"].outputs
    assert answer["speed"][-1] == pytest.approx(10.0, abs=1e-3)
    # the proportional part of a step of 10 before anything moves
    at = np.searchsorted(defined["time_s"], 1.0 - 1e-9)
    assert answer["voltage"][at] == pytest.approx(0.3 * 10.0, rel=0.02)


@pytest.mark.slow
def test_reset_time_gives_the_integral_gain(defined):
    reset = defined["reset"]
    assert "K_i" not in reset.names
    assert reset.named(reset.vector({"K_p": 0.3, "T_i": 0.75}))["K_i"] == pytest.approx(0.4)


@pytest.mark.slow
def test_a_second_test_that_is_no_other_one_does_not_fit(defined):
    assert defined["both"].chi_square > 10.0 * defined["both"].degrees_of_freedom


@pytest.mark.slow
def test_the_analyser_s_mass_and_spring_come_back(defined):
    found = defined["identify"](defined["suspension"], defined["measured"], rng=np.random.default_rng(1))
    assert [round(found.value(name), 3) for name in ("m", "c", "k")] == [2.0, 3.0, 800.0]


@pytest.mark.slow
def test_own_blocks_of_the_page_mean_what_they_say(defined):
    s = np.array([0.3j, 4.0j])
    wall, lead_lag = defined["wall"], defined["LeadLag"](defined["lead"], defined["lag"])
    # heat through a wall, first terms of the series of cosh
    np.testing.assert_allclose(wall.transfer(1e-3 * s, 2.0), 1.0 / (1.0 + 1e-3 * s + 1e-6 * s**2 / 6.0), rtol=1e-8)
    np.testing.assert_allclose(lead_lag.transfer(s, 0.1, 0.2), (0.1 * s + 1.0) / (0.2 * s + 1.0))


def test_links_and_commands_of_the_page_exist():
    for link in re.findall(r"\]\(([^)]+)\)", PAGE):
        assert (ROOT / "docs" / link.partition("#")[0]).exists(), link
    fenced = re.findall(r"^```(\w*)\n(.*?)^```", PAGE, flags=re.MULTILINE | re.DOTALL)
    named = {
        name for kind, text in fenced if not kind for name in re.findall(r"^shaftprint ([a-z]+)", text, re.MULTILINE)
    }
    assert named
    assert named <= set(shaftprint.helps)


def test_the_fan_from_a_file_on_the_command_line(tmp_path, monkeypatch):
    blocks = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "fan.py").write_text("\n".join(blocks[:3]), encoding="utf-8")
    result = CliRunner().invoke(shaftprint, ["structures", "fan.py:fan"], catch_exceptions=False)
    assert result.exit_code == 0, result.stderr
    assert result.output.splitlines()[1].startswith("FAN: fan with a late sensor, voltage -> speed")
