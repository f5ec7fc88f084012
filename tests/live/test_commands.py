"""What ``shaftprint live`` prints and leaves."""

import json
import tomllib
from importlib.resources import files as files_of

import numpy as np
import pytest
import tomlkit
from tests.live.rehearsed import CAMPAIGN, VESSEL, played

import shaftprint as sp
from shaftprint.live._replay import replayed


@pytest.fixture
def files(tmp_path):
    """A campaign with its lever, and a vessel file that allows a program to play it."""
    campaign = tmp_path / "legs.toml"
    stated = CAMPAIGN.model_copy(update={"slope_rpm_per_v": -250.97, "offset_rpm": 1183.8})
    content = json.loads(stated.model_dump_json(exclude_defaults=True))
    campaign.write_text(tomlkit.dumps(content), encoding="utf-8")
    return str(campaign)


@pytest.mark.slow
def test_check_refuses_what_leaves_the_envelope_with_every_reason(run, files, tmp_path):
    result = run("live", "check", "--vessel", "stan-tug-1205", "--campaign", files)
    assert result.exit_code == 1
    assert "[envelope]" in result.output
    text = files_of("shaftprint.vessel").joinpath("shipped/stan_tug_1205.toml").read_text(encoding="utf-8")
    vessel = tmp_path / "vessel.toml"
    vessel.write_text(text + "\n[envelope]\nhighest_shaft_torque_nm = 4000.0\nlongest_s = 600.0\n", encoding="utf-8")
    assert run("live", "check", "--vessel", str(vessel), "--campaign", files).exit_code == 0
    narrow = "\n[envelope]\nhighest_shaft_torque_nm = 1800.0\nhighest_slew_v_per_s = 1.0\nlongest_s = 30.0\n"
    vessel.write_text(text + narrow, encoding="utf-8")
    result = run("live", "check", "--vessel", str(vessel), "--campaign", files)
    assert result.exit_code == 3
    for words in ("shaft torque: expected within 0 to 1800", "at most 1 V/s", "at most 30 s"):
        assert words in " ".join(result.output.split())


@pytest.mark.slow
def test_a_rehearsal_leaves_a_recording_that_says_the_same_again(run, files, tmp_path):
    recording = tmp_path / "test.nc"
    result = run("live", "rehearse", "stan-tug-1205", files, "-o", str(recording), "-v")
    assert result.exit_code == 0, result.output
    assert "played" in result.output
    assert recording.exists()
    assert not list(tmp_path.glob("*.journal"))
    played_as = tmp_path / "test.campaign.toml"
    assert tomllib.loads(played_as.read_text(encoding="utf-8"))["name"] == "two legs"
    assert '"kind": "revert"' in (tmp_path / "test.events.jsonl").read_text(encoding="utf-8")
    again = run("live", "replay", str(recording), "--vessel", "stan-tug-1205", "--campaign", str(played_as), "-v")
    assert again.exit_code == 0
    lines = [line for line in result.output.splitlines() if line.startswith("M")]
    # two legs in a sentence each, and their three test frequencies each
    assert [" Hz " in line for line in lines] == [False, False, *[True] * 6]
    # between them a replay says as each period ends
    shown = [line for line in again.output.splitlines() if line.startswith("M")]
    assert shown == lines
    assert result.output.splitlines()[-1].split()[:3] == ["Next:", "shaftprint", "identify"]


def test_a_rehearsal_with_a_fault_ends_with_three_and_its_reason(run, files, tmp_path):
    result = run("live", "rehearse", "stan-tug-1205", files, "-o", str(tmp_path / "t.nc"), "--fault", "late-revert")
    assert result.exit_code == 3
    assert "give the set point back to the lever" in " ".join(result.output.split())
    wrong = run("live", "rehearse", "stan-tug-1205", files, "-o", str(tmp_path / "u.nc"), "--fault", "rust@5")
    assert wrong.exit_code == 2
    assert "expected frozen, silent" in wrong.output
    both = run(
        "live", "rehearse", "stan-tug-1205", files, "-o", str(tmp_path / "v.nc"), "--pace", "1", "--over", "mqtt"
    )
    assert (both.exit_code, "expected one of --pace and --over" in " ".join(both.output.split())) == (2, True)


@pytest.mark.slow
def test_what_was_shown_live_is_what_the_recording_gives(tmp_path):
    outcome, test, _ = played(tmp_path)
    left = test.record.finish(outcome.campaign)
    campaign = sp.campaign.load_campaign(left.campaign)
    with sp.recording.read_recording(left.recording) as recording:
        # in blocks of another length than those that came
        last = {name: lines for _, name, lines in replayed(recording, VESSEL, campaign, block_s=0.37)}
    offline = [one for lines in last.values() for one in lines]
    assert [one.line for one in offline] == [one.line for one in outcome.judgements]
    for live, later in zip(outcome.judgements, offline, strict=True):
        assert np.allclose(later.response, live.response, rtol=1e-12, atol=0.0)
        assert np.allclose(later.std, live.std, rtol=1e-9, atol=0.0)


@pytest.mark.slow
def test_the_fit_of_the_journal_is_that_of_the_recording(tmp_path):
    outcome, test, _ = played(tmp_path)
    trial = sp.survey.Trial(vessel=VESSEL, campaign=outcome.campaign)

    def known(path):
        """What is fitted to the legs of a journal while a test runs, or to what has become of it."""
        chosen = sp.catalogue.structure("GAUGE-CLOSED")
        with sp.recording.read_recording(path) as recording:
            measurement = sp.survey.measure(recording, trial)
        (fit,) = sp.survey.fit(
            [chosen], measurement, settings={chosen.name: sp.identify.Settings()}, rng=np.random.default_rng(1)
        )
        return [leg.spectra.response for leg in measurement.legs], fit

    shown, of_journal = known(test.record.journal_path)
    later, of_file = known(test.record.finish(outcome.campaign).recording)
    for live, offline in zip(shown, later, strict=True):
        assert np.allclose(offline.response, live.response, rtol=1e-12, atol=0.0)
        assert np.allclose(offline.covariance, live.covariance, rtol=1e-12, atol=0.0)
    assert np.allclose(of_file.values, of_journal.values, rtol=1e-12, atol=0.0)
    assert np.allclose(of_file.covariance, of_journal.covariance, rtol=1e-12, atol=0.0)
