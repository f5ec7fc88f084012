"""What a recording does not say itself is said to ``new`` and ``start`` too, and sensors without a channel are told."""

import numpy as np
import pytest

from shaftprint.campaign import load_campaign, setpoint
from shaftprint.recording import read_recording
from shaftprint.vessel import load_vessel

RATE_HZ = 100.0
CARD = (
    *("--power-kw", 1325, "--rated-rpm", 1600, "--cylinders", 12, "--diameter-m", 2.1),
    *("--blades", 4, "--pitch-ratio", 0.95, "--ratio", 5.2),
)


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A folder to be in, with the log of a test that has no column of times."""
    monkeypatch.chdir(tmp_path)
    campaign = load_campaign("5min")
    time = np.arange(int(campaign.duration_s * RATE_HZ)) / RATE_HZ
    volts = setpoint(campaign, time) + 0.0005 * np.random.default_rng(0).standard_normal(time.size)
    rows = [f"{volt:.5f},{20.0 + row % 5},{1000.0 + row % 11}" for row, volt in enumerate(volts.tolist())]
    (tmp_path / "log.csv").write_text("\n".join(["U_setpoint [V],Drehmoment [kN m],EngineSpeed [rpm]", *rows]))
    return tmp_path


def words(text):
    return " ".join(text.split())


def test_a_campaign_is_made_of_a_file_without_a_clock(run, here):
    files = ("campaign", "test.toml", "--from", "log.csv", "--vessel", "stan-tug-1205")
    refused = run("new", *files)
    assert refused.exit_code == 1
    assert "no column ascends as times do: pass --sample-rate" in words(refused.stderr)
    assert "--columns" not in refused.stderr
    made = run("new", *files, "--sample-rate", 100)
    assert made.exit_code == 0, made.stderr
    assert load_campaign(here / "test.toml").read_off == "log.csv"
    assert made.output.splitlines()[-1].endswith(
        "inspect log.csv --sample-rate 100 --vessel stan-tug-1205 --campaign test.toml"
    )


def test_the_columns_that_are_proposed_are_those_that_may_be_times(run, here):
    text = (here / "log.csv").read_text().splitlines()
    counted = [f"{row},{0.01 * number:.2f}" for number, row in enumerate(text[1:])]
    (here / "log.csv").write_text("\n".join([f"{text[0]},Messpunkt", *counted]))
    refused = run("inspect", "log.csv")
    assert '--columns "Messpunkt=time [s]"' in words(refused.stderr)
    assert run("inspect", "log.csv", "--columns", "Messpunkt=time [s]").exit_code == 0


def test_a_drive_is_made_of_it_too(run, here):
    made = run("new", "drive", "--from", "log.csv", "--sample-rate", 100, "-o", "d.toml")
    assert made.exit_code == 0, made.stderr
    assert made.output.splitlines()[-1].endswith("identify log.csv --sample-rate 100 --drive d.toml -o result")


def test_reading_options_without_a_recording_are_refused(run, here):
    refused = run("new", "campaign", "x.toml", "--decimal", ",")
    assert refused.exit_code == 2
    assert "--decimal says how a recording is read; name it with --from." in words(refused.stderr)


def test_the_rate_of_the_card_reads_the_recording(run, here):
    said = run("start", "--yes", *CARD, "--sample-rate", 100)
    assert said.exit_code == 0, said.stderr
    sensors = load_vessel(here / "vessel.toml").sensors
    assert (sensors.shaft_torque.channel, sensors.set_point.channel) == ("Drehmoment", "U_setpoint")
    assert said.output.splitlines()[-1].endswith(
        "new campaign campaign.toml --from log.csv --sample-rate 100 --vessel vessel.toml"
    )


def test_names_of_no_channel_are_never_written_without_a_word(run, here):
    said = run("start", "--yes", *CARD)
    assert said.exit_code == 1
    assert "no column ascends as times do" in words(said.output + said.stderr)
    # nothing is left for the next one to begin from
    assert not (here / "vessel.toml").exists()
    said = run("start", "--yes", *CARD, "--sample-rate", 100, "--torque", "M_w", "--torque-unit", "N m")
    assert "M_w as shaft torque: log.csv has no such channel, but U_setpoint, Drehmoment, EngineSpeed." in words(
        said.output
    )
    alone = run("new", "vessel", "other.toml", *CARD, "--torque", "Md")
    assert "PTM_e as speed; U_setpoint as set point: no recording was read" in words(alone.output)


def test_a_campaign_that_was_read_off_is_not_told_as_planned(run, here):
    """The times were taken from the recording: that they agree with it says nothing."""
    text = (here / "log.csv").read_text().splitlines()
    rows = [f"{0.01 * number:.2f},{row}" for number, row in enumerate(text[1:])]
    (here / "log.csv").write_text("\n".join([f"time [s],{text[0]}", *rows]))
    assert run("start", "--yes", *CARD).exit_code == 0
    vessel = ("--vessel", "vessel.toml")
    assert run("new", "campaign", "test.toml", "--from", "log.csv", *vessel).exit_code == 0
    campaign = load_campaign(here / "test.toml")
    assert campaign.is_read_off(here / "log.csv")
    assert campaign.is_read_off(here / "log.nc")
    assert not campaign.is_read_off(here / "next.csv")
    assert not load_campaign("5min").is_read_off(here / "log.csv")
    looked = words(run("inspect", "log.csv", *vessel, "--campaign", "test.toml").output)
    assert looked.count("read off this recording") == 2
    planned = words(run("inspect", "log.csv", *vessel, "--campaign", "5min").output)
    assert "read off" not in planned
    assert planned.count(" yes ") == 2


def test_channels_in_another_unit_than_the_vessel_file_has_are_told(run, here):
    assert run("start", "--yes", *CARD, "--sample-rate", 100).exit_code == 0
    files = ("log.csv", "--sample-rate", 100, "--vessel", "vessel.toml")
    assert "Other units" not in run("inspect", *files).output
    text = (here / "vessel.toml").read_text().replace('unit = "kN m"\nscale_nm_per_unit = 1000.0', 'unit = "N m"')
    (here / "vessel.toml").write_text(text)
    assert "Drehmoment: kN m in the recording, N m in the vessel file; converted" in run("inspect", *files).output


def test_what_is_converted_keeps_the_date_of_its_stamps(run, here):
    text = (here / "log.csv").read_text().splitlines()
    rows = [f"30.11.2026 10:15:{number // 100:02d};{row.replace(',', ';')}" for number, row in enumerate(text[1:5001])]
    (here / "log.csv").write_text("\n".join([f"Zeit;{text[0].replace(',', ';')}", *rows]))
    assert run("convert", "log.csv", "--sample-rate", 100, "-o", "log.nc").exit_code == 0
    with read_recording(here / "log.nc") as recording:
        assert recording.began.isoformat() == "2026-11-30T10:15:00"
        assert recording.channel("U_setpoint").rate_hz == 100.0
    refused = run("convert", "log.csv", "--sample-rate", 50, "-o", "other.nc")
    assert "100 Hz for 4800 rows in 48 s, found 50 Hz" in words(refused.stderr)
