"""A vessel file that contradicts itself is told so by every command that makes something of it, in the same words."""

import json

import pytest

from shaftprint.settings import write_template

TITLE = "The vessel file contradicts itself"
SENTENCE = (
    "ship.toml, gearbox.ratio: expected 4, as the engine's 1800 rpm turn the propeller at 450 rpm, found 3.82; "
    "correct the ratio, engine.rated_speed_rpm or gearbox.propeller_rated_rpm."
)


@pytest.fixture
def aboard(tmp_path, monkeypatch, brief_campaign):
    """A folder with a brief campaign and the template, whose propeller is said to turn at another speed."""
    monkeypatch.chdir(tmp_path)
    write_template("vessel", "ship.toml")
    text = (tmp_path / "ship.toml").read_text()
    (tmp_path / "ship.toml").write_text(text.replace("# propeller_rated_rpm = 471.2 ", "propeller_rated_rpm = 450.0 "))
    return tmp_path


def contradictions(result):
    """Return the sentences under the title, of the answer in JSON."""
    assert result.exit_code == 0, result.output
    answer = json.loads(result.stdout)["answer"]
    return answer[answer.index(TITLE) + 1]


@pytest.mark.slow
def test_sail_predict_and_inspect_say_the_same(run, aboard):
    sailed = run("sail", "ship.toml", "brief.toml", "-o", "log.nc", "--json")
    predicted = run("predict", "--vessel", "ship.toml", "--campaign", "5min", "--json")
    inspected = run("inspect", "log.nc", "--vessel", "ship.toml", "--json")
    assert [contradictions(result) for result in (sailed, predicted, inspected)] == 3 * [SENTENCE]


def test_identify_says_so_before_the_recording_is_read(run, aboard):
    result = run("identify", "none.nc", "--vessel", "ship.toml", "--campaign", "brief.toml", "-o", "result")
    assert result.exit_code == 1
    assert f"{TITLE} * {SENTENCE}" in " ".join(result.output.split())


def test_plan_says_so_before_the_leg_that_is_refused_for_it(run, aboard):
    overloaded = (aboard / "ship.toml").read_text().replace("shaft_torque_nm = 1725", "shaft_torque_nm = 5500")
    (aboard / "ship.toml").write_text(overloaded)
    line = ("--rpm-per-volt", "-251", "--offset", "-5", "--limit", "set-point=1.0V")
    result = run("plan", "--vessel", "ship.toml", *line, "--within", "5min", "-o", aboard / "plan")
    assert result.exit_code == 1
    assert TITLE in result.output
    assert "working_point.shaft_torque_nm" in result.output


def test_quiet_does_not_hide_a_contradiction(run, aboard):
    result = run("predict", "--vessel", "ship.toml", "--campaign", "5min", "--quiet")
    assert result.exit_code == 0
    assert TITLE in result.output


def test_a_file_that_agrees_is_not_spoken_of(run, aboard):
    result = run("predict", "--vessel", "stan-tug-1205", "--campaign", "5min")
    assert "vessel file contradicts" not in result.output
    assert "on the vessel file" not in result.output
