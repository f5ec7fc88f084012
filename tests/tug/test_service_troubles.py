"""What a simulated ship does wrong is what its name says."""

import numpy as np
import pytest

from shaftprint.choices import SERVICE_TROUBLES
from shaftprint.errors import SettingsError
from shaftprint.service import scan
from shaftprint.tug import Tug, sail_service
from shaftprint.tug.service._habits import Habits, lever_course
from shaftprint.tug.service._troubles import TROUBLES, Channels, Load, trimmed
from shaftprint.vessel import load_vessel

NAMES = Channels(lever="lever", speed="speed", torque="torque")
LINE = (-83.5, -251.0)


def course():
    rng = np.random.default_rng(1)
    made = lever_course(Habits(), Tug(), load_vessel("stan-tug-1205-service"), hours=300.0 / 3600.0, rng=rng)
    corners = {"corner_s": (0.0, 99.0, 100.0, 199.0, 200.0), "corner_v": (-5.0, -5.0, -5.4, -5.4, -4.8)}
    return made.model_copy(update=corners)


def load(size=0.04):
    time = np.arange(300.0)
    return Load(time_s=time, load=1.0 + size * np.sin(2.0 * np.pi * time / 150.0))


def speed(course, time):
    return LINE[0] + LINE[1] * course.voltage(time)


@pytest.mark.parametrize(("name", "gain"), [("trims", 1.0), ("trims-a-little", 0.3)])
def test_somebody_who_trims_holds_the_torque(name, gain):
    before, time = course(), np.arange(20.0, 300.0)
    share = speed(trimmed(before, TROUBLES[name].lever, load(), line=LINE), time) / speed(before, time) - 1.0
    # behind a lag of five seconds
    seen = 0.04 / np.hypot(1.0, 5.0 * 2.0 * np.pi / 150.0)
    assert np.abs(share).max() == pytest.approx(0.5 * gain * seen, rel=0.03)


def test_somebody_who_trims_at_moves_leaves_the_lever_alone_between_them():
    moved = trimmed(course(), TROUBLES["trims-at-moves"].lever, load(), line=LINE)
    for first, last in ((1.0, 98.0), (101.0, 198.0), (201.0, 299.0)):
        assert np.ptp(moved.voltage(np.linspace(first, last, 50))) < 1e-9
    assert abs(moved.voltage(np.array([150.0]))[0] + 5.4) > 0.01


def test_a_load_controller_acts_at_high_torque_only():
    high = course().model_copy(update={"corner_v": (-5.0, -5.0, -6.5, -6.5, -4.8)})
    moved = trimmed(high, TROUBLES["load-controller"].lever, load(), line=LINE)
    time = np.arange(300.0)
    taken = speed(moved, time) / speed(high, time) - 1.0
    assert np.all(taken[110:190] < -0.05)
    assert np.all(taken[:90] == pytest.approx(0.0, abs=1e-9))


def test_logs_are_changed_as_named():
    rng = np.random.default_rng(1)
    values = {"lever": np.repeat([1200.0, 600.0, 1200.0, 600.0, 1200.0], 500), "speed": rng.uniform(1190, 1210, 2500)}
    values["torque"] = np.full(2500, 3.0)
    late = TROUBLES["lever-late"].logged(values, 100.0, NAMES)["lever"]
    early = TROUBLES["lever-early"].logged(values, 100.0, NAMES)["lever"]
    assert (np.flatnonzero(np.diff(late))[0], np.flatnonzero(np.diff(early))[0]) == (519, 479)
    astern = TROUBLES["astern"].logged(values, 100.0, NAMES)["torque"]
    assert [astern[at] for at in (100, 1200, 2200)] == [3.0, pytest.approx(-2.1), 3.0]
    # the last message of the torque may come a sample before or after that of the lever
    for count in (2499, 2501):
        beside = TROUBLES["astern"].logged({**values, "torque": np.full(count, 3.0)}, 100.0, NAMES)["torque"]
        assert (beside.size, beside[-1]) == (count, 3.0)
    banded = TROUBLES["deadband"].logged(values, 100.0, NAMES)["speed"]
    steps = np.abs(np.diff(banded))
    assert steps[steps > 0.0].min() > 0.005 * 1190.0
    assert tuple(TROUBLES) == SERVICE_TROUBLES


def test_there_is_no_other_trouble(tmp_path):
    with pytest.raises(SettingsError, match=r"expected a trouble of lever-late, .* found storms"):
        sail_service(load_vessel("stan-tug-1205-service"), tmp_path / "x", hours=0.1, seed=1, trouble="storms")


@pytest.mark.long
def test_a_ship_that_is_trimmed_is_refused(tmp_path):
    vessel = load_vessel("stan-tug-1205-service")
    files, _ = sail_service(vessel, tmp_path / "logs", hours=0.5, seed=3, trouble="trims")
    assert "trims it against the load" in scan(files, vessel).refused


def test_a_course_begins_and_ends_within_its_hours():
    vessel = load_vessel("stan-tug-1205-service")
    course = lever_course(Habits(), Tug(), vessel, hours=2.0, rng=np.random.default_rng(1))
    rpm = -250.97 * (np.array(course.corner_v) - 0.04947603) - 83.467
    assert rpm.min() >= 599.9
    assert rpm.max() <= 1650.1
    assert course.corner_s[-1] < 7200.0
    assert 60 < len(course.corner_s) / 2 < 240
    assert all(later > earlier for earlier, later in zip(course.corner_s, course.corner_s[1:], strict=False))
