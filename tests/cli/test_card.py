"""``shaftprint new vessel`` with what stands on a ship's card, and what the other commands make of the file."""

import json

import pytest

from shaftprint.fingerprint import read_fingerprint
from shaftprint.tug import read_truth
from shaftprint.vessel import load_vessel

ENGINE = ("--power-kw", 221, "--rated-rpm", 1800, "--cylinders", 6)
PROPELLER = ("--diameter-m", 1.05, "--blades", 3, "--pitch-ratio", 1.11, "--nozzle")
SENSORS = ("--engine-pulses", "PTM_e=1", "--shaft-pulses", "PTM_4=4", "--torque", "M_s", "--set-point", "U_setpoint")
CARD = (*ENGINE, *PROPELLER, "--ratio", 3.82)


def test_a_card_makes_a_file(run, tmp_path):
    result = run("new", "vessel", *CARD, *SENSORS, "--name", "Tug", tmp_path / "mine.toml")
    assert result.exit_code == 0
    assert "contradicts" not in result.output
    vessel = load_vessel(tmp_path / "mine.toml")
    assert vessel.name == "Tug"
    assert [sensor.channel for sensor in vessel.sensors.speed] == ["PTM_e", "PTM_4"]


def test_all_that_is_missing_is_said_at_once(run, tmp_path):
    result = run("new", "vessel", *ENGINE, tmp_path / "mine.toml")
    assert result.exit_code == 2
    for option in ("--diameter-m", "--blades", "--pitch-ratio", "--ratio or --propeller-rpm"):
        assert option in result.stderr
    assert "--cylinders" not in result.stderr
    assert not (tmp_path / "mine.toml").exists()


def test_a_card_that_contradicts_itself_is_told_so(run, tmp_path):
    result = run("new", "vessel", *CARD, "--propeller-rpm", 450, tmp_path / "mine.toml", "--json")
    assert result.exit_code == 0
    answer = json.loads(result.stdout)["answer"]
    assert "The vessel file contradicts itself" in answer
    assert any("gearbox.ratio: expected 4, " in sentence for sentence in answer)


def test_pulses_that_the_logger_cannot_show_are_told_with_the_most_that_it_can(run, tmp_path):
    """Four samples from tooth to tooth: 500 teeth a second at 2000 Hz, 16 a turn at the 30 turns of 1800 rpm."""
    refused = run("new", "vessel", *CARD, "--engine-pulses", "fly=120", tmp_path / "mine.toml")
    assert refused.exit_code == 2
    assert (
        "fly: expected a logger of 15000 Hz or more, as 120 pulses a turn need at the rated 1800 rpm" in refused.stderr
    )
    result = run("new", "vessel", *CARD, "--engine-pulses", "fly=24", tmp_path / "mine.toml")
    answer = " ".join(result.output.split())
    assert "sensors.speed[1].pulses_per_revolution: expected at most 16, as a logger of 2000 Hz shows at" in answer
    assert "1800 rpm of the engine, found 24; log at 2900 Hz or more" in answer
    # of the propeller shaft, 3.82 times as slow, 63
    for pulses, is_told in (("63", False), ("64", True), ("60-2", False), ("31+1", False), ("32+1", True)):
        path = tmp_path / f"{pulses}.toml"
        result = run("new", "vessel", *CARD, "--shaft-pulses", f"shaft={pulses}", path)
        assert ("as a logger of 2000 Hz shows" in " ".join(result.output.split())) == is_told, pulses
    # what is shown at the 1200 rpm of the test is no contradiction; the plan, which lacks the lever, tells it too
    planned = run("plan", "--vessel", path, "--within", "12min", "-o", tmp_path / "plan")
    assert "Findings on the vessel file" in planned.output
    assert "expected at most 31, as a logger of 2000 Hz shows" in " ".join(planned.output.split())


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--engine-pulses", "PTM_e"), "expected CHANNEL=PULSES such as PTM_e=1"),
        (("--diameter-m", "1e70"), "is not in the range"),
        (("--torque-unit", "V"), "--torque-unit V needs --torque-scale"),
        (("--power-kw", "-1"), "-1.0 is not in the range"),
    ],
)
def test_wrong_options(run, tmp_path, words, message):
    result = run("new", "vessel", *CARD, *words, tmp_path / "mine.toml")
    assert result.exit_code == 2
    assert message in result.stderr


def test_a_card_makes_no_campaign(run, tmp_path):
    result = run("new", "campaign", *CARD, tmp_path / "mine.toml")
    assert result.exit_code == 2
    assert "write `shaftprint new vessel`" in result.stderr


@pytest.fixture(scope="module")
def sailed(tmp_path_factory, invoke):
    """A folder with the file of the Stan Tug's card and a test of five minutes that was sailed with it."""
    folder = tmp_path_factory.mktemp("card")
    test = ("--test-rpm", 1183.8, "--torque-nm", 1725)
    assert invoke("new", "vessel", *CARD, *SENSORS, *test, folder / "mine.toml").exit_code == 0
    result = invoke("sail", folder / "mine.toml", "5min", "-o", folder / "log.nc", "--seed", 3)
    assert result.exit_code == 0
    return folder


@pytest.mark.slow
def test_the_file_predicts(run, sailed):
    result = run("predict", "--vessel", sailed / "mine.toml", "--campaign", "5min")
    assert result.exit_code == 0
    assert "Expected with the assumed values" in result.output


@pytest.mark.slow
def test_the_file_inspects(run, sailed):
    result = run("inspect", sailed / "log.nc", "--vessel", sailed / "mine.toml", "--campaign", "5min")
    assert result.exit_code == 0
    assert result.output.startswith("Good enough: ")


@pytest.mark.long
@pytest.mark.slow
def test_the_file_identifies_what_was_sailed(run, sailed):
    """The simulated ship has the inertias of the file: 13.7955 kg m2 behind the gauge, 3.73202 * 3.82^2 before it."""
    out = sailed / "out"
    result = run("identify", sailed / "log.nc", "--vessel", sailed / "mine.toml", "--campaign", "5min", "-o", out)
    assert result.exit_code == 0
    truth = read_truth(sailed / "log.truth.json")
    assert truth.set_point_slope_rpm_per_v == -250.97
    found = read_fingerprint(out / "fingerprint.json")
    for name, expected in (("I_dn", 13.7955), ("I_up", 54.459), ("K_Q", 0.04943)):
        quantity = found.quantity(name)
        assert abs(quantity.value - expected) < 4.0 * quantity.std, name
        # what the card did not know, the test does
        assert quantity.std < 0.1 * expected, name
