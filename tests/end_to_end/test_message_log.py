"""The log of a control unit, frame by frame, from a CAN logger's MDF 4 file to the governor's gain."""

import json
from importlib.resources import files

import numpy as np
import pytest
from asammdf import Signal
from click.testing import CliRunner
from tests.can_frames import DBC, EEC1, EEC2, eec1, eec2, raw_log

from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.cli import shaftprint
from shaftprint.identify import Settings
from shaftprint.recording import read_recording
from shaftprint.survey import fit, leg_tests, load_trial, measure
from shaftprint.tug import Tug, sail
from shaftprint.vessel import Vessel, load_vessel

SHIPPED = files("shaftprint.vessel") / "shipped" / "stan_tug_1205_ecu.toml"


def call(*arguments):
    result = CliRunner().invoke(shaftprint, [str(one) for one in arguments], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.output


@pytest.mark.long
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
    # the DBC file beside it says what its frames hold
    assert "ActualEnginePercentTorque" in call("inspect", log)
    call("convert", log, "--dbc", dbc, "-o", tmp_path / "log.nc", "--no-progress")
    asked = [tmp_path / "log.nc", "--vessel", vessel, "--campaign", "short", "--no-progress"]
    inspected = call("inspect", *asked)
    assert "ActualEnginePercentTorque: a message every 20 ms +/- 4.2 ms, 1.1 % lost, steps of 1 %" in inspected
    assert "Problems\n  * None." in inspected
    call("identify", *asked, "--structure", "GAUGE-ECU", "-o", tmp_path / "result")
    content = json.loads((tmp_path / "result" / "fingerprint.json").read_text(encoding="utf-8"))
    gain = next(one for one in content["parameters"] if one["name"] == "K_p")
    assert gain["value"] == pytest.approx(truth["K_p"], rel=0.02)


@pytest.mark.long
@pytest.mark.slow
def test_the_pedal_of_a_raw_log_asks_in_place_of_a_voltage(tmp_path):
    """EEC1 with the torque and EEC2 with the pedal, 0.4 % a bit, beside gauge and pick-ups; no set point is wired."""
    line = 'unit = "%"\nv_per_unit = -0.047814\nv_at_zero = -2.7233\nmessage_latency_s = 0.01\n'
    text = SHIPPED.read_text(encoding="utf-8").replace("cycle_s = 0.05", "cycle_s = 0.02")
    text = text.replace('channel = "X_percent"', 'channel = "ActualEnginePercentTorque"')
    old = 'channel = "U_setpoint"\nunit = "V"\n'
    assert text.count(old) == 1
    text = text.replace(old, f'channel = "AcceleratorPedalPosition1"\n{line}')
    vessel, log, dbc = (tmp_path / name for name in ("vessel.toml", "log.mf4", "engine.dbc"))
    vessel.write_text(text, encoding="utf-8")
    dbc.write_text(DBC, encoding="utf-8")
    tug = Tug(message_jitter=0.15, messages_lost=0.01, set_point_cycle_s=0.02)
    truth = sail(load_vessel(vessel), load_campaign("short"), tmp_path / "sailed.nc", tug=tug, seed=8).normalised
    with read_recording(tmp_path / "sailed.nc") as recording:
        channels = dict(recording.channels)
        pedal, torque = (channels.pop(name) for name in ("AcceleratorPedalPosition1", "ActualEnginePercentTorque"))
        sent = [(one.stamps_s(0, one.count), one.values(0, one.count)) for one in (torque, pedal)]
        analog = [
            Signal(
                one.read(0, one.count), one.time_s(0, one.count), name=name, unit=one.unit,
                conversion={"a": one.scale, "b": one.offset},
            )
            for name, one in channels.items()
        ]  # fmt: skip
        frames = [
            (sent[0][0], EEC1, eec1(sent[0][1], np.full(sent[0][0].size, 0xFFFF / 8.0))),
            (sent[1][0], EEC2, eec2(sent[1][1], np.full(sent[1][0].size, 255.0))),
        ]
        raw_log(log, frames, analog)
    call("convert", log, "--dbc", dbc, "-o", tmp_path / "log.nc", "--no-progress")
    proposed = call("inspect", tmp_path / "log.nc")
    assert '[sensors.set_point]\nchannel = "AcceleratorPedalPosition1"' in proposed
    asked = [tmp_path / "log.nc", "--vessel", vessel, "--campaign", "short", "--no-progress"]
    inspected = call("inspect", *asked)
    assert "AcceleratorPedalPosition1: a message every 20 ms +/- 4.2 ms" in inspected
    assert "Problems\n  * None." in inspected
    call("identify", *asked, "--structure", "GAUGE-ECU", "-o", tmp_path / "result")
    content = json.loads((tmp_path / "result" / "fingerprint.json").read_text(encoding="utf-8"))
    found = {one["name"]: one for one in content["parameters"]}
    for name in ("K_p", "K_i", "t_d", "t_sp"):
        assert found[name]["value"] == pytest.approx(truth[name], abs=4.0 * found[name]["std"])
    assert found["K_p"]["value"] == pytest.approx(truth["K_p"], rel=0.02)


@pytest.mark.slow
def test_the_rack_of_two_legs_tells_governor_and_delay(tmp_path):
    """Ten minutes at two speeds, nothing known beforehand: one model of both, the rack of each over its own mean."""
    content = load_vessel("stan-tug-1205-ecu").model_dump()
    content["sensors"]["rack"] |= {"cycle_s": 0.02}
    trial = load_trial(Vessel.model_validate(content), load_campaign("two-speeds"))
    tug = Tug(message_jitter=0.15, messages_lost=0.01)
    true = sail(trial.vessel, trial.campaign, tmp_path / "legs.nc", tug=tug, seed=3)
    measurement = measure(tmp_path / "legs.nc", trial)
    assert [leg.spectra.response.outputs for leg in measurement.legs] == [("n", "M_s", "X")] * 2
    ecu = structure("GAUGE-ECU")
    (found,) = fit([ecu], measurement, settings={ecu.name: Settings()}, rng=np.random.default_rng(1))
    assert all(one.test.p_value > 0.01 for one in leg_tests(found, measurement.working_points))
    point, truth = measurement.signals.working_point, dict(true.normalised)
    speed, torque = (
        point.engine_speed_rev_s * 60.0 / true.engine_speed_rpm,
        point.shaft_torque_nm / true.shaft_torque_nm,
    )
    rack = measurement.signals.channels["X"].reference / truth["X_0"]
    changes = {"K_p": speed / rack, "K_i": speed / rack, "v": rack / torque}
    changes |= dict.fromkeys(("tau_dn", "tau_up", "g"), speed / torque)
    distance = {
        one.name: (one.value - truth[one.name] * changes.get(one.name, 1.0)) / one.std
        for one in found.parameters
        if one.name in truth
    }
    assert len(distance) == 12
    assert max(map(abs, distance.values())) < 3.0
    share = {one.name: one.std / one.value for one in found.parameters}
    assert (share["K_p"] < 5e-4, share["t_d"] < 0.01, share["omega_n"] < 4e-3) == (True, True, True)
