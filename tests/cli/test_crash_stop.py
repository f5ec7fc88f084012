"""``shaftprint simulate --structure CRASH-STOP``: when and where a ship stands, and who may be stopped like this."""

import re
from importlib.resources import files

import numpy as np
import pytest
from tests.cli.test_simulate import columns

from shaftprint.simulation import simulate, stopped_ship
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


def test_a_ship_that_still_sails_is_said_to(run, here):
    result = run(*STOP, "--lever", "2:650:neutral", "--between", "0", "20")
    assert result.exit_code == 0, result.output
    assert re.search(r"The ship still makes 3\.\d\d m/s at 20 s", " ".join(result.output.split()))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--lever", "5:650:back"), "expected a time in s, an engine speed in rpm and one of ahead, neutral, astern"),
        (("--lever", "5:650"), "such as 5:650:neutral, found 5:650"),
        (("--lever", "nan:650:astern"), "such as 5:650:neutral, found nan:650:astern"),
        ((), "expects --lever, one or more, each at a later time"),
        (("--lever", "5:650:neutral", "--lever", "5:650:astern"), "each at a later time than the one before"),
        ((*MOVES, "--between", "0", "12"), "expected a stretch that holds all moves of the lever, 5 to 14 s"),
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
        ("stan-tug-1205-underway", "a crash stop expects gearbox.astern_ratio; gearbox.clutch_torque_nm."),
        ("e-ferry-ellen", "an [engine]; a motor reverses without clutches"),
        ("nifs-research-vessel", "a fixed pitch; blades that turn stop a ship without clutches"),
        ("pt-may", "working_point.ship_speed_m_s, the speed from which it stops; hull.wake_fraction"),
    ],
)
def test_ships_that_are_not_stopped_by_clutches(run, here, vessel, message):
    result = run("simulate", "--structure", "CRASH-STOP", "--vessel", vessel, *MOVES, "-o", "stop.csv")
    assert result.exit_code != 0
    assert message in " ".join(result.output.split())


def test_a_propeller_in_a_nozzle_is_refused(run, here):
    text = SHIPPED.read_text(encoding="utf-8")
    (here / "ship.toml").write_text(text.replace('"Wageningen B4-70"', '"Ka4-70 in nozzle 19A"'), encoding="utf-8")
    result = run("simulate", "--structure", "CRASH-STOP", "--vessel", "ship.toml", *MOVES, "-o", "stop.csv")
    assert "expected an open propeller, found Ka4-70 in nozzle 19A" in " ".join(result.output.split())


def test_nothing_else_is_done_with_it(run, here):
    result = run("structures", "crash-stop")
    assert "which is simulated alone: shaftprint simulate --structure CRASH-STOP" in " ".join(result.output.split())


def test_a_lever_moves_nothing_else(run, here):
    result = run("simulate", "--structure", "GAUGE-CLOSED", "--vessel", "stan-tug-1205", *MOVES, "-o", "y.csv")
    assert "--lever is for --structure CRASH-STOP" in " ".join(result.output.split())


def test_a_fingerprint_of_another_working_point_is_refused(run, demo, here):
    result = run(*STOP, *MOVES, "--fingerprint", str(demo[0]))
    assert result.exit_code != 0
    assert "expected a fingerprint from about 1600 rpm, the working point of PT May" in " ".join(result.output.split())
