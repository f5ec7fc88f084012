"""The next commands that a command ends with: they are taken as they are typed, and lead on to the next test."""

import json
import shlex
from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.campaign import Campaign, load_campaign
from shaftprint.cli import _after_test
from shaftprint.cli._after_test import after_test, reach_of
from shaftprint.errors import FingerprintError
from shaftprint.reasons import Reason
from shaftprint.vessel import load_vessel

CARD = (
    *("--power-kw", 1325, "--rated-rpm", 1600, "--cylinders", 12, "--diameter-m", 2.1),
    *("--blades", 4, "--pitch-ratio", 0.95, "--ratio", 5.2),
)
COLUMNS = ("--columns", "time [s],U_setpoint [V],M_s [V],n [rpm]")
INSTRUMENT = '[[sensors.speed]]\nname = "n"\nchannel = "n"\nshaft = "engine"\nunit = "rpm"\n'


def next_lines(result):
    """Return the words of the commands that a command ends with, by what stands before them."""
    assert result.exit_code == 0, result.output
    lines = [line.partition(" shaftprint ") for line in result.output.splitlines()]
    return {label.strip(): shlex.split(words) for label, sign, words in lines if sign and label.rstrip().endswith(":")}


@pytest.fixture
def here(tmp_path, monkeypatch, run):
    """A folder to be in, with a text file that has no titles."""
    monkeypatch.chdir(tmp_path)
    steps = -5.0 + 0.1 * (np.arange(2000) // 400)
    rows = (f"{0.01 * k:.2f};{volts:.3f};{-0.6 * volts:.3f};{-240.0 * volts:.1f}\n" for k, volts in enumerate(steps))
    (tmp_path / "log.csv").write_text("".join(rows))
    return tmp_path


def test_words_of_reading_go_on_to_the_next_command(run, here):
    assert run("inspect", "log.csv").exit_code == 1
    reading = (*COLUMNS, "--delimiter", ";")
    assert next_lines(run("inspect", "log.csv", *reading)) == {"# Next:": ["start", *reading]}
    assert run("new", "vessel", "vessel.toml").exit_code == 0
    text = (here / "vessel.toml").read_text()
    before, after = text.index("[[sensors.speed]]"), text.index("# An instrument that gives")
    (here / "vessel.toml").write_text(text[:before] + INSTRUMENT + text[after:])
    words = next_lines(run("inspect", "log.csv", *reading))["# Next:"]
    assert words[:2] == ["inspect", "log.csv"]
    assert words[-2:] == ["--vessel", "vessel.toml"]
    # which is taken as it is typed, as what makes the campaign is
    lines = next_lines(run(*words))
    following = ["new", "campaign", "campaign.toml", "--from", "log.csv", *reading, "--vessel", "vessel.toml"]
    assert lines == {"Next:": following}
    assert next_lines(run(*following))["Next:"][2:-4] == list(reading)


@pytest.mark.parametrize(
    ("names", "meant"),
    [
        (("ship.toml",), "ship.toml"),
        (("a.toml", "vessel.toml"), "vessel.toml"),
        # which of two is meant nobody knows
        (("a.toml", "b.toml"), None),
    ],
)
def test_the_vessel_file_that_lies_there_is_proposed(run, here, names, meant):
    for name in names:
        run("new", "vessel", name)
    run("new", "campaign", "test.toml")
    words = next_lines(run("inspect", "log.csv", *COLUMNS))["# Next:"]
    assert words == (["start", *COLUMNS] if meant is None else ["inspect", "log.csv", *COLUMNS, "--vessel", meant])


def test_the_first_of_several_next_commands_is_the_next_one_for_a_program(run, here):
    (here / "log.csv").unlink()
    said = run("start", "--yes", *CARD, "--json")
    document = json.loads(said.stdout)["result"]
    assert document["next"].startswith("shaftprint plan ")
    assert "then" not in document
    run("new", "campaign", "test.toml", "--test", "short")
    (here / "log.nc").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(20_000))
    document = json.loads(run("start", "--json").stdout)["result"]
    assert document["next"].startswith("shaftprint inspect ")
    assert [line.split()[1] for line in document["then"]] == ["identify"]


# 0.9 mA of a lever that asks for 1067 rpm more over 16 mA
LIMITS = SimpleNamespace(set_point_rpm=60.01875)
STDS = {"t_d": 0.004, "g": 0.02}


def quantity(name):
    if name not in STDS:
        raise FingerprintError(name)
    return SimpleNamespace(std=STDS[name])


def following(campaign, *, reading=(), trustworthy=True, asked="short", kind="set-point shape", is_undecided=False):
    reasons = () if trustworthy else (Reason(kind=kind, sentence=""),)
    verdict = SimpleNamespace(trustworthy=trustworthy, reasons=reasons)
    fingerprint = SimpleNamespace(verdict=verdict, quantity=quantity)
    return after_test(
        ("log.csv", "ship.toml", str(campaign)),
        ("result", fingerprint),
        load_vessel("stan-tug-1205"),
        load_campaign(asked),
        reading=reading,
        is_undecided=is_undecided,
    )


def test_a_test_is_validated_and_then_the_next_one_is_planned(here):
    first, then = following("test.toml")
    assert first == (
        *("validate", "log.csv", "--vessel", "ship.toml", "--campaign", "test.toml"),
        *("--fingerprint", "result"),
    )
    assert then[:5] == ("plan", "--vessel", "ship.toml", "--after", "result")
    # inspect led here, and says the same again
    assert following("test.toml", trustworthy=False, reading=COLUMNS) == []
    ((*plan,),) = following("test.toml", trustworthy=False, kind="too few data")
    assert plan[:3] == ["plan", "--vessel", "ship.toml"]
    # validate has no option for what the file does not say
    convert, validate, plan = following("test.toml", reading=COLUMNS)
    assert [str(word) for word in convert] == ["convert", "log.csv", *COLUMNS, "-o", "log.nc"]
    assert [str(word) for word in validate[:2]] == ["validate", "log.nc"]
    assert plan == then


@pytest.mark.parametrize(
    ("targets", "goes_on"),
    [({"t_d": 0.003}, True), ({"t_d": 0.005, "g": 0.03}, False), ({}, False), ({"another": 1.0}, True)],
)
def test_a_plan_goes_on_while_a_wish_of_it_is_not_met(here, monkeypatch, targets, goes_on):
    (here / "plan").mkdir()
    (here / "plan" / "plan.json").write_text("{}")
    planned = SimpleNamespace(plan=SimpleNamespace(targets=targets, stairs_rpm=(), limits=LIMITS))
    monkeypatch.setattr(_after_test, "_plan_json", SimpleNamespace(PLAN="plan.json", read_plan=lambda folder: planned))
    campaign = here / "plan" / "campaign.toml"
    last = [str(word) for word in following(campaign)[-1]]
    if goes_on:
        assert last == ["continue", "log.csv", "--plan", str(here / "plan"), "--vessel", "ship.toml"]
    else:
        assert last[0] == "plan"
        # what was allowed then, not what is usual
        assert last[last.index("--limit") + 1] == "set-point=60rpm"


def test_a_planned_campaign_alone_says_how_far_it_goes(here):
    """A leg of one line of 0.2 V about its level, at 250 rpm a volt: 50 rpm."""
    leg = {
        "name": "M1", "level_v": -5.0, "start_s": 10.0, "settled_s": 20.0, "stop_s": 60.0, "period_s": 10.0,
        "harmonics": [3], "amplitudes_v": [0.2], "phases_rad": [0.0],
    }  # fmt: skip
    content = {"name": "t", "duration_s": 70.0, "offset_v": -5.0, "ramp_v_per_s": 1.0, "multisines": [leg]}
    asked = Campaign.model_validate({**content, "slope_rpm_per_v": -250.0, "offset_rpm": 1200.0})
    assert reach_of("none.toml", asked) in ("50rpm", "49.9rpm", "50.1rpm")
    assert reach_of("none.toml", Campaign.model_validate(content)) == ""


@pytest.mark.parametrize(("sentences", "is_validated"), [(["The steps may prove nothing."], False), ([], True)])
def test_steps_that_the_plan_says_prove_nothing_are_not_offered(here, monkeypatch, sentences, is_validated):
    (here / "plan.json").write_text("{}")
    planned = SimpleNamespace(plan=SimpleNamespace(targets={}, limits=LIMITS))
    monkeypatch.setattr(_after_test, "_plan_json", SimpleNamespace(PLAN="plan.json", read_plan=lambda folder: planned))
    monkeypatch.setattr(_after_test, "_hidden", SimpleNamespace(stairs_sentences=lambda plan: sentences))
    commands = [words[0] for words in following(here / "campaign.toml")]
    assert commands == (["validate"] if is_validated else []) + ["plan"]


def test_steps_that_were_tried_and_say_nothing_are_not_tried_again(here):
    assert [words[0] for words in following("test.toml", is_undecided=True)] == ["plan"]


def test_a_plan_that_cannot_be_read_is_no_reason_to_refuse(here):
    (here / "plan.json").write_text("{}")
    assert following(here / "campaign.toml")[-1][0] == "plan"
