"""The log of a control unit, frame by frame, from a CAN logger's MDF 4 file to the governor's gain."""

import json
from importlib.resources import files

import numpy as np
import pytest
from asammdf import Signal
from click.testing import CliRunner
from tests.can_frames import DBC, EEC1, eec1, raw_log

from shaftprint.campaign import load_campaign
from shaftprint.cli import shaftprint
from shaftprint.recording import read_recording
from shaftprint.tug import Tug, sail
from shaftprint.vessel import load_vessel

SHIPPED = files("shaftprint.vessel") / "shipped" / "stan_tug_1205_ecu.toml"


def call(*arguments):
    result = CliRunner().invoke(shaftprint, [str(one) for one in arguments], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.output


@pytest.mark.slow
def test_raw_log_of_a_bus_gives_the_gain_of_the_governor(tmp_path):
    """EEC1 every 20 ms, 15 % of jitter, 1 % lost, 1 % a bit: everything by the command line, as a user has it."""
    text = SHIPPED.read_text(encoding="utf-8")
    sailed, vessel, log, dbc = (tmp_path / name for name in ("sailed.toml", "vessel.toml", "log.mf4", "engine.dbc"))
    sailed.write_text(text.replace("cycle_s = 0.05", "cycle_s = 0.02"), encoding="utf-8")
    vessel.write_text(
        sailed.read_text(encoding="utf-8").replace('"X_percent"', '"ActualEnginePercentTorque"'), encoding="utf-8"
    )
    tug = Tug(message_jitter=0.15, messages_lost=0.01)
    truth = sail(load_vessel(sailed), load_campaign("short"), tmp_path / "sailed.nc", tug=tug, seed=7).normalised
    dbc.write_text(DBC, encoding="utf-8")
    with read_recording(tmp_path / "sailed.nc") as recording:
        channels = dict(recording.channels)
        bus = channels.pop("X_percent")
        times, percent = bus.stamps_s(0, bus.count), bus.values(0, bus.count)
        analog = [
            Signal(
                one.read(0, one.count), one.time_s(0, one.count), name=name, unit=one.unit,
                conversion={"a": one.scale, "b": one.offset},
            )
            for name, one in channels.items()
        ]  # fmt: skip
        raw_log(log, [(times, EEC1, eec1(percent, np.full(times.size, 0xFFFF / 8.0)))], analog)
    assert "raw messages of a bus; give the DBC file" in call("inspect", log)
    call("convert", log, "--dbc", dbc, "-o", tmp_path / "log.nc", "--no-progress")
    asked = [tmp_path / "log.nc", "--vessel", vessel, "--campaign", "short", "--no-progress"]
    inspected = call("inspect", *asked)
    assert "ActualEnginePercentTorque: a message every 20 ms +/- 4.2 ms, 1.1 % lost, steps of 1 %" in inspected
    assert "Problems\n  * None." in inspected
    call("identify", *asked, "--structure", "GAUGE-ECU", "-o", tmp_path / "result")
    content = json.loads((tmp_path / "result" / "fingerprint.json").read_text(encoding="utf-8"))
    gain = next(one for one in content["parameters"] if one["name"] == "K_p")
    assert gain["value"] == pytest.approx(truth["K_p"], rel=0.02)
