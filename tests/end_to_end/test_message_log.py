"""The log of a control unit, message by message, from an MDF 4 file to the governor's gain."""

import json
from importlib.resources import files

import pytest
from click.testing import CliRunner

from shaftprint.campaign import load_campaign
from shaftprint.cli import shaftprint
from shaftprint.tug import Tug, sail_as
from shaftprint.vessel import load_vessel

SHIPPED = files("shaftprint.vessel") / "shipped" / "stan_tug_1205_ecu.toml"


@pytest.mark.slow
def test_raw_log_of_a_bus_gives_the_gain_of_the_governor(tmp_path):
    """20 ms, 15 % of jitter, 1 % lost, 1 % a bit: everything by the command line, as a user has it."""
    text = SHIPPED.read_text(encoding="utf-8")
    assert text.count("cycle_s = 0.05") == 1
    vessel = tmp_path / "vessel.toml"
    vessel.write_text(text.replace("cycle_s = 0.05", "cycle_s = 0.02"), encoding="utf-8")
    log = tmp_path / "log.mf4"
    tug = Tug(message_jitter=0.15, messages_lost=0.01)
    truth = sail_as(load_vessel(vessel), load_campaign("short"), log, tug=tug, seed=7).normalised
    asked = [str(log), "--vessel", str(vessel), "--campaign", "short", "--no-progress"]
    inspected = CliRunner().invoke(shaftprint, ["inspect", *asked], catch_exceptions=False)
    assert "X_percent: a message every 20 ms +/- 4.2 ms" in inspected.output
    assert "Problems\n  * None." in inspected.output
    folder = tmp_path / "result"
    done = CliRunner().invoke(
        shaftprint,
        ["identify", *asked, "--structure", "GAUGE-ECU", "-o", str(folder), "--json"],
        catch_exceptions=False,
    )
    assert done.exit_code == 0
    content = json.loads((folder / "fingerprint.json").read_text(encoding="utf-8"))
    gain = next(one for one in content["parameters"] if one["name"] == "K_p")
    assert gain["value"] == pytest.approx(truth["K_p"], rel=0.02)
