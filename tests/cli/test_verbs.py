"""What a command does, a program does by a verb: each command names its own, at a door, and both give the same."""

import importlib
import json
from dataclasses import replace

import pytest

import shaftprint as sp
from shaftprint.cli import shaftprint

VERBS = {
    "demo": "tug.sail",
    "new": "signals.proposed_campaign",
    "predict": "forecast.predict_test",
    "sensitivity": "report.sensitivity_chart",
    "inertia": "torsion.expected_inertia",
    "plan": "design.plan_test",
    "continue": "rehearsal.standing_after",
    "sail": "tug.sail",
    "inspect": "signals.inspect_channels",
    "merge": "clocks.merged",
    "join": "clocks.joined",
    "convert": "recording.write_by_ending",
    "identify": "survey.run",
    "identify --with limits": "survey.with_limits",
    "identify --starboard": "survey.run_both",
    "identify --drive": "bench.identify_drive",
    "predict --drive": "bench.predict_files",
    "validate --drive": "bench.validate_drive",
    "limits": "limits.identify_limits",
    "structures": "catalogue.chosen_structures",
    "show": "fingerprint.read_fingerprint",
    "compare": "drift.differ",
    "drift": "drift.watch",
    "sisters": "drift.judge_sisters",
    "validate": "survey.validate_fingerprint",
    "compare-structures": "identify.compare_structures",
    "explain": "identify.identify",
    "simulate": "forecast.simulated_ship",
    "simulate --lever": "forecast.crash_stop",
    "export fmu": "export.write_fmu",
    "export osp": "export.write_osp",
    "export ssp": "export.write_ssv",
    "export modelica": "export.write_modelica",
    "export matlab": "export.write_matlab",
    "export csv": "export.write_csv",
    "export json": "export.write_json",
    "store init": "store.create_store",
    "store add": "store.add",
    "store list": "store.open_store",
    "store history": "store.history",
    "store event": "store.record_event",
    "store export": "store.export_store",
    "store import": "store.import_store",
    "store check": "store.check",
    "store upgrade": "store.open_store",
    "serve": "web.serve",
    "fleet run": "fleet.submit",
    "fleet status": "store.job_counts",
    "fleet retry": "store.retry",
    "fleet report": "store.job",
    "work": "fleet.work",
    "service scan": "service.scan",
    "service fit": "service.fit_service",
    "service watch": "service.watch_folders",
    "start": "card.write_vessel",
    "live channels": "live.read_channel_list",
    "live check": "live.prove",
    "live rehearse": "live.rehearse",
    "live play": "live.play_on_board",
    "live replay": "live.replayed",
}
GROUPS = ("export", "store", "fleet", "service", "live")
SHIP = "pt-may-underway"


def commands():
    for name in shaftprint.helps:
        of_group = shaftprint.get_command(None, name).helps if name in GROUPS else ()
        yield from [f"{name} {one}" for one in of_group] or [name]


def test_every_command_has_a_verb_at_a_door():
    assert {name.partition(" --")[0] for name in VERBS} == set(commands())
    for verb in VERBS.values():
        room, name = verb.split(".")
        assert name in importlib.import_module(f"shaftprint.{room}").__all__, verb


@pytest.fixture(scope="module")
def tug():
    return sp.forecast.ShipBeforeTest(vessel=sp.vessel.load_vessel("stan-tug-1205"))


@pytest.mark.slow
def test_predict_prints_what_predict_test_gives(run, tug):
    predicted = sp.forecast.predict_test(sp.campaign.load_campaign("short"), tug)
    result = run("predict", "--vessel", "stan-tug-1205", "--campaign", "short", "--json", "--no-progress")
    printed = json.loads(result.stdout)["result"]
    named = {one["name"]: one["std"] for one in printed["parameters"]}
    assert named == pytest.approx({one.name: one.std for one in predicted.accuracy.parameters}, nan_ok=True)
    assert len(printed["limits"]) == len(predicted.limits)


@pytest.mark.slow
def test_simulate_writes_what_simulated_ship_gives(run, tug, tmp_path):
    ship = replace(tug, slope_rpm_per_v=-251.0, values={"K_p": 4.0})
    campaign = sp.campaign.load_campaign("short")
    simulation = sp.forecast.simulated_ship(ship, campaign, structure="GAUGE-CLOSED", span=(0.0, 20.0), rate_hz=10.0)
    result = run(
        *("simulate", "--structure", "GAUGE-CLOSED", "--vessel", "stan-tug-1205", "--rpm-per-volt", "-251"),
        *("--set", "K_p=4", "--campaign", "short", "--between", "0", "20", "--rate", "10"),
        *("-o", tmp_path / "out.csv", "--no-progress"),
    )
    assert result.exit_code == 0, result.output
    with sp.recording.read_recording(tmp_path / "out.csv") as written:
        for signal in simulation.signals:
            channel = written.channels[signal.title]
            assert channel.values(0, channel.count) == pytest.approx(signal.values, rel=1e-6)


@pytest.mark.slow
def test_a_crash_stop_answers_in_words_and_numbers(run, tmp_path):
    ship = sp.forecast.ShipBeforeTest(vessel=sp.vessel.load_vessel(SHIP))
    moves = [
        sp.forecast.LeverMove(time_s=at_s, speed_rpm=650.0, gear=gear) for at_s, gear in ((5.0, 0.0), (10.0, -1.0))
    ]
    simulation = sp.forecast.crash_stop(ship, moves, span=(0.0, 12.0), rate_hz=20.0)
    levers = ("--lever", "5:650:neutral", "--lever", "10:650:astern")
    short = ("--between", "0", "12", "--rate", "20")
    given = (
        "--structure",
        "CRASH-STOP",
        *short,
        "--vessel",
        SHIP,
        *levers,
        "-o",
        tmp_path / "stop.csv",
        "--no-progress",
    )
    result = run("simulate", *given, "--json")
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["answer"][-len(simulation.answers) - 1 : -1] == list(simulation.answers)


def test_what_does_not_go_together_is_said_by_the_verb_too():
    unknown, short = sp.forecast.ShipBeforeTest(recording="log.nc"), sp.campaign.load_campaign("short")
    with pytest.raises(sp.errors.RequestError, match="--from needs --vessel"):
        sp.forecast.predict_test(short, unknown)
    with pytest.raises(sp.errors.RequestError, match="expects --vessel, the ship that is stopped"):
        sp.forecast.crash_stop(sp.forecast.ShipBeforeTest(), [])
    with pytest.raises(sp.errors.RequestError, match="expected --vessel, which says what ship and engine allow"):
        sp.forecast.knowledge_of(sp.forecast.ShipBeforeTest())


@pytest.mark.slow
def test_what_a_plan_takes_of_a_ship(tug):
    known = replace(tug, slope_rpm_per_v=-251.0, offset_v=-5.0)
    (limit,) = [sp.design.StatedLimit(name="set-point", value=1.0, unit="V")]
    knowledge = sp.forecast.knowledge_of(known, limits=[limit])
    assert knowledge.limits.set_point_rpm == 251.0
    assert knowledge.noise_is_assumed
    assert "first test of 90 s" in knowledge.remarks[0]
