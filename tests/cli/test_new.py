"""``shaftprint new`` writes files that can be loaded as they stand."""

import pytest

from shaftprint.campaign import load_campaign, load_trial_conditions
from shaftprint.vessel import load_vessel


def test_conditions_of_a_test_can_be_filled_in(run, tmp_path):
    result = run("new", "conditions", tmp_path / "today.toml")
    assert result.exit_code == 0
    assert result.output.endswith("today.toml: the conditions of a test to fill in.\n")
    assert load_trial_conditions(tmp_path / "today.toml").wind_m_s == 3.0


@pytest.mark.parametrize(("kind", "load"), [("vessel", load_vessel), ("campaign", load_campaign)])
def test_template_can_be_loaded(run, tmp_path, kind, load):
    path = tmp_path / f"mine {kind}.toml"
    result = run("new", kind, path)
    assert result.exit_code == 0
    assert result.output.splitlines()[0] == f"{path}: a {kind} to fill in."
    assert load(path).name


@pytest.mark.parametrize(
    ("name", "minutes", "speeds"), [("12min", 12.35, 2), ("5min", 5.3, 2), ("short", 14.3, 0), ("thesis", 190.8, 0)]
)
def test_tests_to_begin_with(run, tmp_path, name, minutes, speeds):
    path = tmp_path / "test.toml"
    result = run("new", "campaign", path, "--test", name)
    assert result.exit_code == 0
    assert result.output.startswith(f"{path}: ")
    campaign = load_campaign(path)
    assert campaign == load_campaign(name)
    assert campaign.duration_s / 60.0 == pytest.approx(minutes, abs=0.05)
    assert len({leg.level_v for leg in campaign.legs}) == speeds


def test_a_vessel_begins_with_no_test(run, tmp_path):
    result = run("new", "vessel", tmp_path / "mine.toml", "--test", "5min")
    assert result.exit_code == 2
    assert "write `shaftprint new campaign`" in result.stderr
    assert not (tmp_path / "mine.toml").exists()


def test_existing_file_is_kept(run, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text("mine")
    result = run("new", "vessel", path)
    assert result.exit_code == 1
    assert "exists already" in result.stderr
    assert path.read_text() == "mine"


def test_missing_folder(run, tmp_path):
    result = run("new", "vessel", tmp_path / "no" / "mine.toml")
    assert result.exit_code == 1
    assert "cannot be written" in result.stderr


def test_unknown_kind_is_a_usage_error(run, tmp_path):
    result = run("new", "propeller", tmp_path / "mine.toml")
    assert result.exit_code == 2
    assert "'propeller' is not one of 'vessel', 'campaign'" in result.stderr
