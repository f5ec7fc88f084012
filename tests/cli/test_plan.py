"""``shaftprint plan``: the answer, the files, and what is said of options that cannot be meant."""

import json

import numpy as np
import pytest
from tests.planned import with_little_effort

from shaftprint.campaign import load_campaign
from shaftprint.design import read_plan
from shaftprint.fingerprint import read_fingerprint

LINE = ("--rpm-per-volt", "-251", "--offset", "-5")
SHIP = ("--vessel", "stan-tug-1205", "--limit", "set-point=1.0V", "--no-progress")
# Known to a per cent, so that the search is short and limits are those of one ship.
EXACT = tuple(
    word
    for name, value in (("K_p", 5.7), ("K_i", 4.27), ("t_d", 0.07), ("omega_n", 10.3), ("zeta", 0.47), ("tau_dn", 0.32))
    for word in ("--prior", f"{name}={value}+-{0.01 * value}")
)


@pytest.fixture(scope="module")
def planned(tmp_path_factory):
    """Four minutes at two speeds, with a wish that is met and one that cannot be."""
    from click.testing import CliRunner

    from shaftprint.cli import shaftprint

    folder = tmp_path_factory.mktemp("planned") / "plan"
    words = [
        "plan", *SHIP, *LINE, "--limit", "motoring=300Nm", "--within", "4min", "--speeds", "1.15,0.78",
        "--structure", "GAUGE-CLOSED", "--free", "tau_up", "--free", "g",
        "--wish", "tau_dn=1%", "--wish", "t_d + t_sp=0.0005", "--name", 'a "test" <b>', "-o", str(folder),
    ]  # fmt: skip
    with pytest.MonkeyPatch.context() as patch:
        with_little_effort(patch)
        return folder, CliRunner().invoke(shaftprint, words, catch_exceptions=False)


@pytest.mark.slow
def test_what_cannot_be_reached_ends_with_3_and_says_what_would_help(planned):
    folder, result = planned
    assert result.exit_code == 3
    first, *_ = result.stdout.splitlines()
    assert first.endswith(" min at 1361 rpm and 923 rpm do not meet the wish for t_d + t_sp.")
    assert 3.8 < float(first.split()[0]) <= 4.0
    text = " ".join(result.stdout.split())
    assert "t_d + t_sp: the best that can be reached is" in text
    assert "With the latency of the set point known to 5 ms" in text
    assert "The plan was not rehearsed." in text
    assert "Card for the bridge" in text
    assert {path.name for path in folder.iterdir() if not path.name.startswith(".")} == {
        "campaign.toml", "index.html", "plan.json", "plots", "set_point.csv", "set_point.mat",
        "set_point_generator.txt",
    }  # fmt: skip


@pytest.mark.slow
def test_page_and_json_say_that_it_was_not_rehearsed_and_hostile_names_stay_text(planned):
    folder, _ = planned
    page = (folder / "index.html").read_text(encoding="utf-8")
    assert "not rehearsed" in page
    assert "a &#34;test&#34; &lt;b&gt;" in page
    assert "<b>" not in page
    content = json.loads((folder / "plan.json").read_text(encoding="utf-8"))
    assert (content["schema_version"], content["rehearsed"]) == (1, False)
    assert content["name"] == 'a "test" <b>'


@pytest.mark.slow
def test_the_plan_keeps_what_was_stated(planned):
    folder, _ = planned
    test = read_plan(folder)
    assert [leg.level_rpm for leg in test.plan.legs] == pytest.approx([1.15 * 1183.8, 0.78 * 1183.8])
    assert dict(test.plan.wish.relative) == {"tau_dn": 0.01}
    assert dict(test.plan.wish.absolute) == {"t_d + t_sp": 0.0005}
    # at two speeds the fit knows how far the line of the set point may bend
    assert set(test.plan.priors) == {"t_gauge", "b_set"}
    assert test.plan.predicted.estimate("tau_dn").std < 0.01 * test.plan.predicted.estimate("tau_dn").value
    volts = np.loadtxt(folder / "set_point.csv", delimiter=",", skiprows=1)[:, 1]
    for leg, level in zip(test.campaign.multisines, test.plan.legs, strict=True):
        assert leg.level_v == pytest.approx(-5.0 + (level.level_rpm - 1183.8) / -251.0)
    assert volts.min() >= test.campaign.multisines[0].level_v - 1.0
    assert volts.max() <= test.campaign.multisines[1].level_v + 1.0


@pytest.mark.slow
def test_other_commands_take_the_campaign(planned, run):
    folder, _ = planned
    assert len(load_campaign(folder / "campaign.toml").multisines) == 2
    result = run(
        "predict", "--campaign", folder / "campaign.toml", "--vessel", "stan-tug-1205", "--rpm-per-volt", "-251"
    )
    assert result.exit_code == 0
    assert "tau_dn" in result.output


@pytest.mark.long
@pytest.mark.slow
def test_json_is_whole_where_the_wish_cannot_be_met(run, tmp_path):
    result = run(
        "plan", *SHIP, *LINE, *EXACT, "--within", "150s", "--speeds", "1", "--wish", "t_d=0.1%", "--json",
        "-o", tmp_path / "plan",
    )  # fmt: skip
    assert result.exit_code == 3
    document = json.loads(result.stdout)
    assert document["command"] == "plan"
    assert document["result"]["met"] is False
    assert document["result"]["rehearsed"] is False
    assert document["answer"][0].endswith("do not meet the wish for t_d.")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--within", "12"), "expected a length of time such as 12min, 90s or 1h, found '12'"),
        (("--within", "-3min"), "expected a length of time"),
        (("--within", "nanmin"), "expected a length of time"),
        (("--wish", "t_d"), "expected a number of the line and how well it is to be known"),
        (("--wish", "t_d=0%"), "expected a number of the line"),
        (("--wish", "t_d=10ms"), "expected a number of the line"),
        (("--limit", "sett-point=1V"), "Did you mean set-point?"),
        (("--limit", "rate=600rpm"), "expected a positive number in rpm/s such as rate=600rpm/s"),
        (("--limit", "set-point=100"), "expected a unit behind 100, V or rpm or mA or % or counts, such as"),
        (("--limit", "torque=-5Nm"), "expected a positive number in Nm or N m or kNm"),
        (("--limit", "full-scale=5kN"), "expected a positive number in Nm or N m or kNm such as full-scale=10kNm"),
        (("--limit", "ripple=60Nm"), "expected a positive number in % or no unit such as ripple=60%"),
        (("--speeds", "0.78;1.15"), "expected speeds over that of the working point, such as 0.78,1.15"),
        (("--speeds", "0.78,0"), "expected speeds"),
    ],
)
def test_an_option_that_cannot_be_meant_says_what_was_expected(run, tmp_path, words, message):
    result = run("plan", *SHIP, *LINE, *words, "-o", tmp_path / "plan")
    assert result.exit_code == 2
    assert message in " ".join(result.stderr.split())
    assert not (tmp_path / "plan").exists()


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        ((*SHIP, *LINE), 2, "expected --within, such as --within 12min"),
        ((*SHIP, *LINE, "--shortest"), 2, "--shortest needs a --wish"),
        ((*SHIP, "--within", "5min"), 2, "such as --rpm-per-volt -251 --offset -5"),
        (("--vessel", "stan-tug-1205", *LINE, "--within", "5min"), 2, "such as --limit set-point=1.0V"),
        ((*SHIP, *LINE, "--within", "5min", "--wish", "t_d=1%", "--wish", "t_d=2%"), 2, "expected each number once"),
        ((*SHIP, *LINE, "--within", "5min", "--wish", "td=1%"), 1, "Did you mean t_d?"),
        ((*SHIP, *LINE, "--within", "20s"), 1, "give more time or fewer speeds"),
        ((*SHIP, *LINE, "--within", "5min", "--speeds", "0.3"), 1, "choose another"),
        ((*SHIP, *LINE, "--within", "5min", "--structure", "OL5"), 1, "a plan needs the closed loop"),
        # at 1.15 of the speed the shaft carries 2281 N m; one sample in 10,000 has 1.3 * 60 % of it on top
        (
            (
                *SHIP,
                *LINE,
                "--within",
                "5min",
                "--limit",
                "full-scale=3.9kNm",
                "--limit",
                "ripple=60%",
                "--speeds",
                "1.15,0.78",
            ),
            1,
            "full_scale_nm of [sensors.shaft_torque]: expected more than 4061 N m for a leg at 1361.37 rpm, whose "
            "shaft torque is 2281 N m with orders and noise of 78 % on it, found a gauge that shows up to 3900 N m",
        ),
        ((*SHIP, *LINE, "--within", "5min", "--after", "nothing.json"), 1, "expected a fingerprint in JSON"),
        ((*SHIP, *LINE, "--within", "5min", "--noise-from", "nothing.nc"), 2, "--noise-from needs --noise-campaign"),
    ],
)
def test_what_is_missing_or_impossible_is_one_sentence_and_leaves_no_folder(run, tmp_path, words, code, message):
    result = run("plan", *words, "-o", tmp_path / "plan")
    assert result.exit_code == code
    assert message in " ".join(result.stderr.split())
    assert not (tmp_path / "plan").exists()


@pytest.mark.slow
def test_after_a_first_test_its_numbers_noise_and_line_are_taken(run, demo, tmp_path):
    scout = demo[0]
    words = ("--vessel", scout / "vessel.toml", "--after", scout / "fingerprint.json", "--limit", "set-point=0.4V")
    result = run("plan", *words, "--within", "3min", "--speeds", "1.1", "-o", tmp_path / "plan", "--no-progress")
    assert result.exit_code == 0
    test, first = read_plan(tmp_path / "plan"), read_fingerprint(scout / "fingerprint.json")
    # the simulated set point: -250.97 rpm/V; at 1183.8 rpm -5 V, to which the potentiometer adds -0.0495 V
    assert test.line.slope_rpm_per_v == pytest.approx(-250.97, rel=0.01)
    assert test.line.offset_v == pytest.approx(-5.0495, abs=0.005)
    # numbers are normalised where the first test was, speeds are shares of the vessel file's working point
    assert test.plan.limits.engine_speed_rpm == first.conditions.engine_speed.value
    assert [leg.level_rpm for leg in test.plan.legs] == pytest.approx([1.1 * 1183.8])
    place = test.plan.ship.structure.names.index("tau_dn")
    assert test.plan.ship.by_name["tau_dn"] == first.quantity("tau_dn").value
    assert test.plan.ship.covariance[place, place] == pytest.approx(first.quantity("tau_dn").std ** 2)
    # below the slowest line of the first test the noise is that which is usual
    recorded, planned = first.noise[0].frequency_hz, test.plan.noise[0].frequency_hz
    assert set(recorded) <= set(planned)
    assert planned[0] < recorded[0]
    # one sample in a hundred of the tug's orders and noise is above 0.49 of the load
    assert first.torque_ripple == pytest.approx(0.49, abs=0.05)
    assert test.plan.limits.gauge.ripple == first.torque_ripple
    assert "noise of the first test" in " ".join(result.stdout.split())
