"""``shaftprint sail`` writes a raw recording and its truth."""

from importlib.resources import files

import numpy as np
import pytest
import tomlkit

from shaftprint.recording import read_recording
from shaftprint.settings import write_template
from shaftprint.tug import read_truth


def test_recording_and_truth_are_written(run, tmp_path, brief_campaign):
    path = tmp_path / "test.nc"
    result = run("sail", "stan-tug-1205", brief_campaign, "-o", path, "--seed", 7)
    assert result.exit_code == 0
    assert f"{path}: the raw recording of 30 s." in result.output
    with read_recording(path) as recording:
        assert set(recording.channels) == {"U_setpoint", "PTM_e", "PTM_1", "PTM_4", "M_s"}
        assert {channel.count for channel in recording.channels.values()} == {60_000}
    truth = read_truth(tmp_path / "test.truth.json")
    assert (truth.seed, truth.duration_s, truth.campaign) == (7, 30.0, "Half a minute")


def test_same_seed_same_file(run, tmp_path, brief_campaign):
    for name in ("a.nc", "b.nc"):
        run("sail", "stan-tug-1205", brief_campaign, "-o", tmp_path / name, "--seed", 3)
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()


def test_existing_recording_is_kept_unless_forced(run, tmp_path, brief_campaign):
    path = tmp_path / "test.nc"
    path.write_text("mine")
    result = run("sail", "stan-tug-1205", brief_campaign, "-o", path)
    assert result.exit_code == 1
    assert "exists already; choose another name or replace it with --force" in result.stderr
    assert path.read_text() == "mine"
    assert run("sail", "stan-tug-1205", brief_campaign, "-o", path, "--force").exit_code == 0
    assert path.read_bytes()[:4] == b"\x89HDF"


@pytest.mark.parametrize("place", [".", "", ".."])
def test_folder_in_the_place_of_the_recording(run, tmp_path, brief_campaign, monkeypatch, place):
    monkeypatch.chdir(tmp_path)
    result = run("sail", "stan-tug-1205", brief_campaign, "-o", place)
    assert result.exit_code == 1
    assert "expected a file for the recording, found a folder; add a file name" in result.stderr


@pytest.mark.parametrize("name", ["vessel.toml", "stan-tug-1206"])
def test_vessel_that_is_not_there(run, tmp_path, brief_campaign, name):
    result = run("sail", name, brief_campaign, "-o", tmp_path / "test.nc")
    assert result.exit_code == 1
    assert name in result.stderr
    assert not (tmp_path / "test.nc").exists()


def test_all_errors_of_a_vessel_file_at_once(run, tmp_path, brief_campaign):
    path = tmp_path / "vessel.toml"
    write_template("vessel", path)
    text = path.read_text()
    text = text.replace("cylinders = 6", "cylinders = -6").replace("pitch_ratio", "pitch_ration")
    path.write_text(text)
    result = run("sail", path, brief_campaign, "-o", tmp_path / "test.nc")
    assert result.exit_code == 1
    assert "engine.cylinders" in result.stderr
    assert "propeller.pitch_ration" in result.stderr
    assert "is pitch_ratio meant?" in result.stderr


def test_seed_below_zero_is_a_usage_error(run, tmp_path, brief_campaign):
    assert run("sail", "stan-tug-1205", brief_campaign, "-o", tmp_path / "test.nc", "--seed", -1).exit_code == 2


@pytest.mark.slow
def test_a_test_on_a_bus_as_its_logger_writes_it(run, tmp_path, brief_campaign):
    content = tomlkit.parse((files("shaftprint.vessel") / "shipped" / "stan_tug_1205.toml").read_text())
    content["sensors"]["speed"] = [{"name": "n_e", "channel": "EngineSpeed", "unit": "rpm", "shaft": "engine"}]
    vessel, log = tmp_path / "on_a_bus.toml", tmp_path / "test.blf"
    vessel.write_text(tomlkit.dumps(content))
    result = run("sail", vessel, brief_campaign, "-o", log, "--messages", "speed=50", "--messages", "torque=100",
                 "--jitter", 15, "--lost", 2)  # fmt: skip
    assert result.exit_code == 0
    assert "test.blf.dbc beside it says what the frames hold" in result.stderr
    with read_recording(log, dbc=tmp_path / "test.blf.dbc") as recording:
        speed = recording.channel("EngineSpeed")
        assert (speed.unit, speed.rate_hz) == ("rpm", pytest.approx(50.0, rel=1e-3))
        assert speed.count == pytest.approx(0.98 * 50.0 * 30.0, abs=20)
        # 15 % of 20 ms about the cycle, of which a step has two
        steps = np.diff(speed.stamps_s(0, speed.count))
        assert steps[steps < 0.03].std() == pytest.approx(0.003 * 2**0.5, rel=0.1)
        torque = recording.channel("M_s")
        assert torque.rate_hz == pytest.approx(100.0, rel=1e-3)
        assert torque.count == pytest.approx(0.98 * 100.0 * 30.0, abs=30)


@pytest.mark.parametrize("text", ["speed", "speed=0", "rack=10", "speed=inf"])
def test_messages_need_a_rate(run, tmp_path, brief_campaign, text):
    result = run("sail", "stan-tug-1205", brief_campaign, "-o", tmp_path / "x.nc", "--messages", text)
    assert result.exit_code == 2
    assert f'expected torque, speed, set-point with a rate, such as speed=50, found "{text}"' in result.stderr
