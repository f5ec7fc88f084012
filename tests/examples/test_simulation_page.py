"""The page on simulation runs as it stands, and what it prints is true."""

import re
from pathlib import Path

import numpy as np
import pytest

from shaftprint.cli import shaftprint

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "simulation.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def defined():
    """Run all Python of the page in order; return what it defines."""
    names = {"__name__": "simulation"}
    for block in re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL):
        exec(compile(block, "simulation.md", "exec"), names)  # noqa: S102
    return names


@pytest.mark.slow
def test_the_ship_does_not_turn_slower_than_it_is_asked(defined):
    # the engine cannot brake the line: the speed comes down to what is asked for, and no further
    speed = defined["trace"].outputs["n"]
    assert speed.min() == pytest.approx(-0.4285, abs=2e-3)
    assert defined["trace"].derivatives["n"].shape == (2, speed.size)


@pytest.mark.slow
def test_a_centred_jump_is_as_exact_as_the_page_says(defined):
    exact, fast = defined["exact"], defined["fast"]
    assert np.abs(fast.outputs["n"][::2] - exact.outputs["n"]).max() < 1e-4
    assert np.abs(fast.outputs["M_s"][::2] - exact.outputs["M_s"]).max() < 4e-4
    early = defined["simulate"](defined["loop"], defined["cl4"], defined["grid_s"], defined["jump"], hold=True)
    assert np.abs(early.outputs["n"] - exact.outputs["n"]).max() == pytest.approx(0.004, abs=0.001)
    assert np.abs(early.outputs["M_s"] - exact.outputs["M_s"]).max() == pytest.approx(0.013, abs=0.001)


@pytest.mark.slow
def test_the_scaling_of_the_thesis_comes_out(defined):
    np.testing.assert_allclose(defined["about"], defined["scaled"], rtol=1e-9)


@pytest.mark.slow
def test_the_motor_runs_up_at_its_limit(defined):
    outputs, time = defined["moved"].outputs, defined["run_s"]
    assert outputs["voltage"].max() == 24.0
    assert outputs["speed"][-1] == pytest.approx(200.0, abs=0.01)
    # 288 (1 - exp(-t / T)) while the amplifier gives all it has; the set point takes one sample to rise
    part = (time > 1.05) & (time < 1.3)
    low, high = (288.0 * (1.0 - np.exp(-(time[part] - at) / 0.4)) for at in (1.0, 0.998))
    assert np.all((outputs["speed"][part] > low) & (outputs["speed"][part] < high))
    rested = defined["equilibrium"](defined["motor"], defined["motor"].vector({}), {"set_point": 400.0})
    assert rested.outputs["speed"] == pytest.approx(12.0 * 24.0)


@pytest.mark.slow
def test_small_signals_of_the_motor_are_those_of_its_block_diagram(defined):
    s = 1j * np.array([0.3, 2.0, 20.0])
    forward = (0.5 + 1.0 / s) * 12.0 / (0.4 * s + 1.0)
    motor = defined["motor"]
    found = motor.response(motor.vector({}), s)
    np.testing.assert_allclose(found[0], forward / (1.0 + forward * np.exp(-0.03 * s)), rtol=1e-9)


@pytest.mark.slow
def test_the_digital_unit_counts_in_its_period_and_stops_in_its_deadband(defined):
    outputs, time = defined["settled"].outputs, defined["run_s"]
    jumps = time[1:][np.diff(outputs["voltage"]) != 0.0]
    steps = np.diff(jumps) / 0.05
    np.testing.assert_allclose(steps, np.rint(steps), atol=1e-6)
    # anywhere within the deadband of 2 rad/s it is content
    assert abs(outputs["speed"][-1] - 100.0) < 2.1
    assert abs(outputs["speed"][-1] - 100.0) > 0.1


def test_links_commands_and_options_of_the_page_exist():
    for link in re.findall(r"\]\(([^)]+)\)", PAGE):
        assert (ROOT / "docs" / link).exists(), link
    fenced = re.findall(r"^```(\w*)\n(.*?)^```", PAGE, flags=re.MULTILINE | re.DOTALL)
    shown = "".join(text for kind, text in fenced if not kind)
    named = set(re.findall(r"^shaftprint ([a-z]+)", shown, flags=re.MULTILINE))
    assert named == {"simulate"} <= set(shaftprint.helps)
    command = shaftprint.get_command(None, "simulate")
    known = {option for parameter in command.params for option in parameter.opts}
    assert set(re.findall(r"(?<= )--?[a-z-]+", shown)) <= known
