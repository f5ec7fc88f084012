"""``shaftprint simulate --structure CRASH-STOP``: when and where a ship stands, and who may be stopped like this."""

import json
import re
from importlib.resources import files

import numpy as np
import pytest
from tests.cli.test_simulate import columns

from shaftprint.simulation import simulate, stopped_ship
from shaftprint.tug import read_truth
from shaftprint.vessel import load_vessel

SHIP = "pt-may-underway"
STOP = ("simulate", "--structure", "crash-stop", "--vessel", SHIP, "--no-progress", "-o", "stop.csv")
MOVES = ("--lever", "5:650:neutral", "--lever", "10:650:astern", "--lever", "14:1400:astern")
SHIPPED = files("shaftprint.vessel") / "shipped" / "pt_may_underway.toml"


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A working folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.slow
def test_the_ship_stands_when_and_where_its_columns_say(run, here):
    result = run(*STOP, *MOVES, "--between", "0", "60")
    assert result.exit_code == 0, result.output
    first = " ".join(result.output.splitlines()[:2])
    seconds, of_seconds, metres, of_metres = map(float, re.findall(r"\d+\.?\d*", first)[:4])
    found = columns(here / "stop.csv")
    time, way = found["time [s]"], found["ship speed [m/s]"]
    # a sum of the speeds that were written, by hand
    distance = np.concatenate([[0.0], np.cumsum(0.5 * (way[1:] + way[:-1]) * np.diff(time))])
    at = np.argmax(way <= 0.0)
    assert seconds == pytest.approx(time[at] - 5.0, abs=0.1)
    assert metres == pytest.approx(distance[at] - distance[np.searchsorted(time, 5.0)], abs=0.3)
    np.testing.assert_allclose(found["distance [m]"], distance, atol=0.05)
    assert set(np.unique(found["gear [-]"])) == {-1.0, 0.0, 1.0}
    # the clutches are open here: no torque reaches the gauge
    open_ = (time > 6.5) & (time < 9.9)
    np.testing.assert_allclose(found["shaft torque [N m]"][open_], 0.0, atol=1e-6)
    assert "it may stall" in " ".join(result.output.split())
    assert of_seconds > 0.5
    assert of_metres > 1.0


@pytest.mark.slow
def test_deviations_are_those_of_other_wakes_and_resistances(run, here):
    run(*STOP, *MOVES, "--between", "0", "40")
    found = columns(here / "stop.csv")
    ship = stopped_ship(load_vessel(SHIP))
    fine = np.arange(0.0, 40.0, 0.0025)
    speed = np.where(fine < 5.0, 1600.0, np.where(fine < 14.0, 650.0, 1400.0)) / 1600.0 - 1.0
    gear = np.where(fine < 5.0, 0.0, np.where(fine < 10.0, -1.0, -2.0))
    values = {name: stated.value for name, stated in ship.stated.items()}

    def way(**moved):
        vector = ship.structure.vector(values | moved)
        return simulate(ship.structure, vector, fine, {"n_set": speed, "gear": gear}).outputs["v_s"]

    # central differences over a tenth of a deviation, summed over what the file knows with one
    variance = np.zeros_like(fine)
    for name, stated in ship.stated.items():
        step = 0.1 * stated.std
        if step:
            up, down = (way(**{name: stated.value + sign * step}) for sign in (1.0, -1.0))
            variance += ((up - down) / 0.2) ** 2
    written = np.interp(found["time [s]"], fine, 5.0 * np.sqrt(variance))
    np.testing.assert_allclose(found["ship speed std [m/s]"], written, rtol=0.03, atol=2e-3)


@pytest.mark.slow
def test_a_ship_that_still_sails_is_said_to(run, here):
    result = run(*STOP, "--lever", "2:650:neutral", "--between", "0", "20")
    assert result.exit_code == 0, result.output
    text = " ".join(result.output.split())
    assert re.search(r"The ship still makes 3\.\d\d m/s at 20 s, and is not driven astern\.", text)
    result = run(*STOP, *MOVES, "--between", "0", "16", "--force")
    assert "at 16 s; a later end of --between shows when it stands." in " ".join(result.output.split())


@pytest.mark.slow
def test_rows_do_not_change_the_answer(run, here):
    def said(*options):
        result = run(*STOP, *MOVES, "--between", "0.3", "40", "--force", *options)
        return [float(number) for number in re.findall(r"\d+\.?\d*", " ".join(result.output.splitlines()[:3]))[:6]]

    few, many = said("--rate", "20"), said("--rate", "200")
    assert few[:5] == pytest.approx(many[:5], rel=0.02)
    # the deviation of the lowest speed changes fast where it is reached
    assert few[5] == pytest.approx(many[5], rel=0.2)


@pytest.mark.slow
def test_a_vessel_file_that_contradicts_itself_is_said_to(run, here):
    text = SHIPPED.read_text(encoding="utf-8")
    (here / "ship.toml").write_text(text.replace("resistance_n = 24020.0", "resistance_n = 240200.0"), encoding="utf-8")
    result = run("simulate", "--structure", "CRASH-STOP", "--vessel", "ship.toml", *MOVES, "-o", "stop.csv", "-q")
    assert "The vessel file contradicts itself" in result.output


@pytest.mark.slow
def test_an_engine_that_is_turned_backwards_is_said_to(run, here):
    result = run(
        *STOP, "--lever", "5:650:neutral", "--lever", "5.5:650:astern", "--set", "tau_up=0.05", "--set", "w=-0.1"
    )
    assert "The engine is stopped and turned backwards" in " ".join(result.output.split())


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--lever", "5:650:back"), "expected a time in s, an engine speed in rpm and one of ahead, neutral, astern"),
        (("--lever", "5:650"), "such as 5:650:neutral, found 5:650"),
        (("--lever", "nan:650:astern"), "such as 5:650:neutral, found nan:650:astern"),
        ((), "expects --lever, one or more, each at a later time"),
        (("--lever", "5:650:neutral", "--lever", "5:650:astern"), "each at a later time than the one before"),
        ((*MOVES, "--between", "0", "12"), "and ends after the last, at 14 s; found 0 to 12 s."),
        ((*MOVES, "--between", "5", "60"), "begins before the first move of the lever, at 5 s, where the ship sails"),
        (("--lever", "0:650:neutral"), "begins before the first move of the lever, at 0 s"),
        (("--lever", "1e9:650:neutral"), "expected at most 3600 s, found 0 to 1e+09 s"),
        ((*MOVES, "--between", "0", "1e12"), "expected at most 3600 s, found 0 to 1e+12 s"),
        (("--lever", "5:5000:astern"), "expected engine speeds from 650 to 1800 rpm, found 5000 rpm at 5 s"),
        (("--lever", "5:400:neutral"), "expected engine speeds from 650 to 1800 rpm, found 400 rpm at 5 s"),
        ((*MOVES, "--rate", "1"), "expected at least 20 rows a second of CRASH-STOP, found 1"),
        ((*MOVES, "--linear"), "without --campaign, --input, --rpm-per-volt, --linear or --hold"),
        ((*MOVES, "--set", "w=0.9"), "w from --set: expected wake fraction from -0.2 to 0.6, found 0.9"),
        ((*MOVES, "--set", "m_c=0"), "m_c from --set: expected torque at which a clutch slips"),
        ((*MOVES, "--set", "i_r=0"), "i_r from --set: expected ratio of the train astern"),
        ((*MOVES, "--campaign", "thesis"), "is moved by --lever alone"),
        ((*MOVES, "--set", "w_c=1"), "--set w_c: expected a parameter of CRASH-STOP, one of"),
    ],
)
def test_wrong_arguments(run, here, arguments, message):
    result = run(*STOP, *arguments)
    assert result.exit_code != 0
    assert message in " ".join(result.output.split())
    assert not (here / "stop.csv").exists()


@pytest.mark.parametrize(
    ("vessel", "message"),
    [
        ("stan-tug-1205-underway", "a crash stop expects gearbox.astern_ratio, gearbox.clutch_torque_nm."),
        ("e-ferry-ellen", "an [engine] (a motor reverses without clutches)"),
        ("nifs-research-vessel", "a fixed pitch (blades that turn stop a ship without clutches)"),
        ("pt-may", "working_point.ship_speed_m_s (the speed from which it stops), hull.wake_fraction"),
    ],
)
def test_ships_that_are_not_stopped_by_clutches(run, here, vessel, message):
    result = run("simulate", "--structure", "CRASH-STOP", "--vessel", vessel, *MOVES, "-o", "stop.csv")
    assert result.exit_code != 0
    assert message in " ".join(result.output.split())


@pytest.mark.parametrize(
    ("series", "message"),
    [
        ('series = "Ka4-70 in nozzle 19A"', "expected an open propeller, found Ka4-70 in nozzle 19A"),
        ('series = "Wageningen B4-40"', "expected a propeller Wageningen B4-70, the only one whose coefficients are"),
        ("", "expected propeller.series in the vessel file, found none"),
    ],
)
def test_a_propeller_without_curves_is_refused(run, here, series, message):
    text = SHIPPED.read_text(encoding="utf-8")
    (here / "ship.toml").write_text(text.replace('series = "Wageningen B4-70"', series), encoding="utf-8")
    result = run("simulate", "--structure", "CRASH-STOP", "--vessel", "ship.toml", *MOVES, "-o", "stop.csv")
    assert message in " ".join(result.output.split())


def test_nothing_else_is_done_with_it(run, here):
    result = run("structures", "crash-stop")
    assert "which is simulated alone: shaftprint simulate --structure CRASH-STOP" in " ".join(result.output.split())


def test_a_lever_moves_nothing_else(run, here):
    result = run("simulate", "--structure", "GAUGE-CLOSED", "--vessel", "stan-tug-1205", *MOVES, "-o", "y.csv")
    assert "--lever is for --structure CRASH-STOP" in " ".join(result.output.split())


def test_a_fingerprint_of_the_quay_is_refused(run, demo, here):
    result = run(*STOP, *MOVES, "--fingerprint", str(demo[0]))
    assert result.exit_code != 0
    assert "expected a fingerprint of the ship underway, found one of GAUGE-CLOSED" in " ".join(result.output.split())


@pytest.mark.long
@pytest.mark.slow
def test_a_test_underway_tells_governor_and_engine(run, here):
    """Half an hour of dither of a ship with open propellers: its truth is inside the intervals, and stops the ship."""
    assert run("sail", SHIP, "dither", "-o", "u.nc", "--seed", "3", "--no-progress").exit_code == 0
    common = ("--vessel", SHIP, "--campaign", "dither", "--no-report", "--no-progress")
    assert run("identify", "u.nc", *common, "-o", "u").exit_code == 0
    found = json.loads((here / "u" / "fingerprint.json").read_text(encoding="utf-8"))
    truth = read_truth(here / "u.truth.json").normalised
    numbers = {one["name"]: one for one in found["parameters"]}
    for name in ("b", "K_p", "K_i", "omega_n", "tau_dn", "tau_up"):
        assert abs(numbers[name]["value"] - truth[name]) < 3.0 * numbers[name]["std"], name
    assert truth["b"] < -1.5
    result = run(*STOP, *MOVES, "--between", "0", "60", "--fingerprint", "u", "--json")
    assert result.exit_code == 0, result.output
    (table, *_) = json.loads(result.stdout)["tables"]
    origin = {row[0]: row[3] for row in table["rows"]}
    assert {name: origin[name] for name in ("K_p", "tau_dn", "w", "tau_u")} == {
        "K_p": "fingerprint",
        "tau_dn": "fingerprint",
        "w": "vessel file",
        "tau_u": "vessel file",
    }
    with_governor = columns(here / "stop.csv")["engine speed std [rpm]"]
    run(*STOP, *MOVES, "--between", "0", "60", "--force")
    # the covariance of the governor is in the speed of the engine on its way to the new set point
    at = np.searchsorted(columns(here / "stop.csv")["time [s]"], 15.5)
    assert with_governor[at] > 2.0 * columns(here / "stop.csv")["engine speed std [rpm]"][at]
    text = SHIPPED.read_text(encoding="utf-8").replace("shaft_torque_nm = 3422.0", "shaft_torque_nm = 4000.0")
    (here / "other.toml").write_text(text, encoding="utf-8")
    other = ("simulate", "--structure", "CRASH-STOP", "--vessel", "other.toml", "--fingerprint", "u", "-o", "x.csv")
    result = run(*other, *MOVES)
    assert "expected a fingerprint from about 4000 N m, the working point of PT May" in " ".join(result.output.split())
