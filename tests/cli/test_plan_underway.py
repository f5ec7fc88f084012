"""A dither in transit from the command line: planned, sailed and identified; and what a plan cannot move."""

import json
from statistics import median

import pytest

from shaftprint.design import read_plan
from shaftprint.survey import run as identify

VESSEL = "stan-tug-1205-underway"
SHIP = ("--vessel", VESSEL, "--limit", "set-point=0.13V", "--no-progress")
LINE = ("--rpm-per-volt", "-251", "--offset", "-6.66")
# Of no line: what bends the slow lines of one speed, and numbers that priors alone know.
LEFT = ("c_set", "g", "tau_up", "k_q")


@pytest.fixture(scope="module")
def planned(invoke, tmp_path_factory):
    """Half an hour at 2 % of the speed."""
    folder = tmp_path_factory.mktemp("underway") / "plan"
    done = invoke("plan", *SHIP, *LINE, "--within", "30min", "--rehearse", "2", "-o", folder)
    assert done.exit_code == 0, done.stderr
    return folder, done


@pytest.mark.long
def test_half_an_hour_of_dither_is_planned_for_the_ship_and_its_log(planned):
    folder, done = planned
    assert "Rehearsed with 2 simulated tests" in done.stdout
    assert "noise of the Stan Tug 1205 underway assumed" in done.stdout
    test = read_plan(folder)
    assert test.plan.ship.structure.name == "FREE-LOG"
    (leg,) = test.plan.legs
    assert leg.level_rpm == pytest.approx(1600.0)
    # 0.13 V of 251 rpm: 2 % of the speed
    assert leg.peak_rpm <= 0.13 * 251.0
    assert leg.peak_rpm > 0.95 * 0.13 * 251.0
    assert set(test.plan.priors) == {"g", "tau_up", "t_gauge", "t_log", "k_q"}
    # lines are chosen and phased together: more is known than by the sines of the shipped half hour
    known = {name: test.plan.predicted.estimate(name) for name in ("b", "(e - a) / tau_u", "(2 - a) / tau_u")}
    for one, share in zip(known.values(), (0.06, 0.03, 0.025), strict=True):
        assert one.std < share * abs(one.value)
    # what the file promises is the middle of the possible ships
    content = json.loads((folder / "plan.json").read_text(encoding="utf-8"))
    promised = known["b"].std * test.plan.band.middle["b"]
    assert content["predicted"]["b"]["std"] == pytest.approx(promised, rel=1e-6)


@pytest.mark.long
def test_sailed_and_identified_it_gives_what_was_planned(planned, invoke, tmp_path):
    """Stated deviations over those that are predicted at the truth, the median of five recordings, which hold it."""
    folder, _ = planned
    campaign = folder / "campaign.toml"
    stated, z = {}, {}
    for seed in range(1, 6):
        path = tmp_path / f"{seed}.nc"
        assert invoke("sail", VESSEL, campaign, "-o", path, "--seed", seed).exit_code == 0
        found = identify(path, VESSEL, campaign, judge=False).identification
        truth = json.loads(path.with_suffix(".truth.json").read_text(encoding="utf-8"))["normalised"]
        truth |= {
            "(e - a) / tau_u": (truth["e"] - truth["a"]) / truth["tau_u"],
            "(2 - a) / tau_u": (2.0 - truth["a"]) / truth["tau_u"],
            "b (2 - a) / tau_u": truth["b"] * (2.0 - truth["a"]) / truth["tau_u"],
            "K_p / K_i": truth["K_p"] / truth["K_i"],
            "t_d + t_sp": truth["t_d"] + truth["t_sp"],
        }
        for one in (*found.parameters, *found.combinations):
            stated.setdefault(one.name, []).append(one.std)
            if one.name in truth and one.name not in LEFT:
                z.setdefault(one.name, []).append((one.value - truth[one.name]) / one.std)
        path.unlink()
    # planned for the values that are assumed; what lines tell of zeta and K_p goes with where these truly are
    values = [f"--value={name}={truth[name]}" for name in found.structure.names if name in truth and name not in LEFT]
    done = invoke("predict", "--vessel", VESSEL, "--campaign", campaign, *values, "--no-progress", "--json")
    assert done.exit_code == 0, done.stderr
    predicted = json.loads(done.stdout)["result"]
    known = {one["name"]: one["std"] for one in (*predicted["parameters"], *predicted["combinations"])}
    numbers = [name for name in known if name not in LEFT and name in stated and known[name] is not None]
    assert len(numbers) >= 12
    for name in numbers:
        # that of a quotient hangs on how its two numbers go together besides
        assert (0.65 if name == "K_p / K_i" else 0.75) < median(stated[name]) / known[name] < 1.35, name
    assert max(abs(median(values)) for values in z.values()) < 2.5


def test_other_speeds_are_refused_underway(invoke, tmp_path):
    done = invoke("plan", *SHIP, *LINE, "--within", "30min", "--speeds", "1.0,0.8", "-o", tmp_path / "plan")
    assert done.exit_code == 2
    assert "--speeds: expected none, so that all legs are at the 1600 rpm of the vessel file, found 1, 0.8" in (
        done.stderr
    )
    assert not (tmp_path / "plan").exists()


@pytest.mark.long
@pytest.mark.slow
def test_a_pitch_that_is_not_planned_is_said_to_stand(invoke, tmp_path):
    options = ("--speeds", "1.0", "--limit", "set-point=0.3V", "--rpm-per-volt", "-127", "--offset", "-5")
    folder = tmp_path / "plan"
    done = invoke("plan", "--vessel", "nifs-research-vessel", "--within", "4min", *options, "-o", folder)
    assert done.exit_code == 0, done.stderr
    assert "The pitch stands at P/D 0.8 while the speed is moved: the plan is for GAUGE-CLOSED" in done.stdout
    assert "what the pitch does to the torque is not found" in (folder / "index.html").read_text(encoding="utf-8")
    (remark,) = read_plan(folder).remarks
    assert remark in read_plan(folder).sentences


def test_a_structure_with_two_inputs_cannot_be_planned(invoke, tmp_path):
    options = ("--structure", "GAUGE-PITCH", "--limit", "set-point=0.3V", "--rpm-per-volt", "-127", "--offset", "-5")
    folder = tmp_path / "plan"
    done = invoke("plan", "--vessel", "nifs-research-vessel", "--within", "4min", *options, "-o", folder)
    assert done.exit_code == 1
    assert "structure GAUGE-PITCH: expected n and M_s from one input" in done.stderr
