"""``shaftprint new campaign --from``: the file is that of the recording."""

import numpy as np
import pytest

from shaftprint.campaign import load_campaign, setpoint

RATE_HZ = 100.0


@pytest.fixture
def recording(tmp_path):
    campaign = load_campaign("5min")
    time = np.arange(int(campaign.duration_s * RATE_HZ)) / RATE_HZ
    volts = setpoint(campaign, time) + 0.0005 * np.random.default_rng(0).standard_normal(time.size)
    path = tmp_path / "log.csv"
    rows = [f"{second:.2f},{volt:.5f}" for second, volt in zip(time.tolist(), volts.tolist(), strict=True)]
    path.write_text("\n".join(["time [s],U_setpoint [V]", *rows]))
    return path


def test_the_set_point_of_the_file_is_that_of_the_recording(run, tmp_path, recording):
    path = tmp_path / "test.toml"
    result = run("new", "campaign", "--from", recording, "--vessel", "stan-tug-1205", "-o", path)
    assert result.exit_code == 0, result.stderr
    assert result.output.splitlines()[0] == f"{path}: multisines: M1, M2."
    time = np.arange(0.0, 317.0, 0.1)
    assert setpoint(load_campaign(path), time) == pytest.approx(setpoint(load_campaign("5min"), time), abs=0.01)
    assert path.read_text().startswith("# What the set point of log.csv shows.")
    again = run("new", "campaign", "--from", recording, "--vessel", "stan-tug-1205", "-o", path)
    assert again.exit_code == 1
    assert "exists" in again.stderr


def test_a_set_point_in_messages_shows_its_tests_too(run, tmp_path):
    random, campaign = np.random.default_rng(1), load_campaign("5min")
    time = np.arange(0.0, campaign.duration_s, 0.02)
    time = time + random.uniform(-0.008, 0.008, time.size)
    time = np.round(time[random.random(time.size) > 0.01], 4) + 1.0
    volts = 0.02 * np.round(setpoint(campaign, time) / 0.02)
    rows = [f"{second:.4f},{volt:.2f}" for second, volt in zip(time.tolist(), volts.tolist(), strict=True)]
    log, path = tmp_path / "bus.csv", tmp_path / "test.toml"
    log.write_text("\n".join(["time [s],U_setpoint [V]", *rows]))
    result = run("new", "campaign", "--from", log, "--vessel", "stan-tug-1205", "-o", path)
    assert result.exit_code == 0, result.stderr
    assert result.output.splitlines()[0] == f"{path}: multisines: M1, M2."
    apart = setpoint(load_campaign(path), time) - setpoint(campaign, time)
    assert np.sqrt(np.mean(apart**2)) < 0.02


def test_what_cannot_be_asked_together(run, tmp_path, recording):
    path = tmp_path / "test.toml"
    for words, reason in (
        (("campaign", path, "--from", recording), "--from needs --vessel"),
        (("vessel", path, "--from", recording, "--vessel", "stan-tug-1205"), "write `shaftprint new campaign`"),
        (("campaign",), "expected the file to write once"),
        (("campaign", path, "-o", path), "expected the file to write once"),
    ):
        result = run("new", *words)
        assert result.exit_code == 2
        assert reason in result.stderr
        assert not path.exists()
