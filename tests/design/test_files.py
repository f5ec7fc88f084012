"""The files of a planned test: what a generator puts out is what was planned, and what was written comes back."""

import json
from datetime import UTC, datetime
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.io import loadmat

from shaftprint.campaign import load_campaign, setpoint
from shaftprint.design import PlannedTest, SetPointLine, read_plan, write_plan_files
from shaftprint.design.files._plan_folder import CAMPAIGN
from shaftprint.design.files._plan_json import PLAN, write_plan
from shaftprint.design.files._set_point_files import CSV, GENERATOR, MAT
from shaftprint.design.files._set_point_samples import set_point_samples
from shaftprint.design.inputs._lever import Lever, lever_of_sensor
from shaftprint.design.planned_test._rehearsal import Rehearsal
from shaftprint.design.planned_test._remedies import Remedy
from shaftprint.design.views._abort_card import abort_card
from shaftprint.errors import DesignError

OFFSET_V, SLOPE = -5.0, -251.0


@pytest.fixture(scope="session")
def test(plan):
    """Six minutes at two speeds, to be sailed on the tug."""
    return PlannedTest(
        name="two speeds",
        vessel="Stan Tug 1205, port",
        plan=plan,
        line=SetPointLine(slope_rpm_per_v=SLOPE, offset_v=OFFSET_V),
        created=datetime(2026, 11, 23, tzinfo=UTC),
        noise_source="noise of the Stan Tug 1205 assumed",
    )


@pytest.fixture(scope="session")
def folder(test, tmp_path_factory):
    """Its files."""
    path = tmp_path_factory.mktemp("plan")
    write_plan_files(test, path, rate_hz=100.0)
    return path


def test_the_campaign_file_is_the_campaign(test, folder):
    written = load_campaign(folder / CAMPAIGN)
    time_s = np.arange(0.0, test.campaign.duration_s, 0.05)
    assert setpoint(written, time_s) == pytest.approx(setpoint(test.campaign, time_s), abs=1e-9)
    assert "# The plan was not rehearsed." in (folder / CAMPAIGN).read_text(encoding="utf-8")


def test_a_generator_that_holds_its_samples_puts_out_lines_without_delay(test, folder):
    """Held samples are a staircase; its lines have the phase of the plan and lose sinc(f / rate) of their amplitude."""
    table = np.loadtxt(folder / CSV, delimiter=",", skiprows=1)
    assert (folder / CSV).read_text(encoding="utf-8").splitlines()[0] == "time_s,V,rpm"
    volts = np.loadtxt(folder / GENERATOR)
    assert volts == pytest.approx(table[:, 1])
    leg, excitation = test.plan.legs[0], test.campaign.multisines[0]
    fine_s = excitation.settled_s + np.arange(0.0, leg.window_s, 1e-3)
    held = volts[np.floor(fine_s * 100.0 + 1e-9).astype(int)] - excitation.level_v
    for place in (0, len(leg.harmonics) // 2, len(leg.harmonics) - 1):
        omega = 2.0 * np.pi * leg.harmonics[place] / leg.period_s
        turned = np.exp(-1j * omega * (fine_s + 0.5e-3 - excitation.start_s))
        amplitude = 2.0 * np.mean(held * turned)
        planned = leg.amplitudes[place] * leg.level_rpm / SLOPE * np.sinc(leg.frequency_hz[place] / 100.0)
        assert abs(amplitude - planned) < 2e-3 * np.abs(leg.amplitudes).max() * leg.level_rpm / abs(SLOPE)


def test_volts_and_rpm_are_the_same_set_point(test, folder):
    table = np.loadtxt(folder / CSV, delimiter=",", skiprows=1)
    assert table[:, 2] == pytest.approx(1183.8 - 251.0 * (table[:, 1] + 5.0), abs=1e-3)
    limits = test.plan.limits
    for leg, excitation in zip(test.plan.legs, test.campaign.multisines, strict=True):
        inside = (table[:, 0] > excitation.start_s) & (table[:, 0] < excitation.stop_s)
        assert np.abs(table[inside, 2] - leg.level_rpm).max() <= limits.set_point_rpm + 1e-3


def test_matlab_reads_the_same(folder):
    table, content = np.loadtxt(folder / CSV, delimiter=",", skiprows=1), loadmat(str(folder / MAT))
    assert content["set_point_v"][:, 0] == pytest.approx(table[:, 1], abs=1e-6)
    assert content["set_point_rpm"][:, 0] == pytest.approx(table[:, 2], abs=1e-3)
    assert content["sample_rate_hz"].item() == 100.0


@pytest.mark.parametrize("rate_hz", [10.0, 0.0, -1.0, float("nan"), float("inf"), 1e9])
def test_a_rate_that_cannot_render_the_lines_is_refused(test, rate_hz):
    with pytest.raises(DesignError, match="expected at least"):
        set_point_samples(test, rate_hz=rate_hz)


def test_a_plan_comes_back_from_its_file(test, folder):
    again = read_plan(folder)
    assert (again.name, again.vessel, again.line, again.created) == (test.name, test.vessel, test.line, test.created)
    assert again.rehearsal is None
    assert again.plan.limits == test.plan.limits
    assert again.plan.timetable == test.plan.timetable
    assert dict(again.plan.peaks[0].uses) == dict(test.plan.peaks[0].uses)
    for one, other in zip(again.plan.legs, test.plan.legs, strict=True):
        assert one.harmonics == other.harmonics
        assert np.array_equal(one.amplitudes, other.amplitudes)
    stds = [[e.std for e in plan.predicted.parameters] for plan in (again.plan, test.plan)]
    assert stds[0] == pytest.approx(stds[1], rel=1e-12)


def test_rehearsal_and_remedies_come_back(test, tmp_path):
    rehearsal = Rehearsal(
        names=("K_p",),
        errors=np.array([[0.1], [-0.2]]),
        stated=np.array([[0.15], [0.15]]),
        planned=np.array([0.15]),
        limited=np.array([0.0, 0.01]),
        failures=("no line",),
    )
    remedy = Remedy(name="a second leg", worst=float("inf"), ratios={"K_p": float("inf")})
    known = {"rehearsal": rehearsal, "remedies": (remedy,)}
    changed = PlannedTest(**{name: getattr(test, name) for name in test.__slots__} | known)
    write_plan(changed, tmp_path / PLAN)
    again = read_plan(tmp_path / PLAN)
    assert again.rehearsal.sentences == rehearsal.sentences
    assert again.remedies == (remedy,)


def wrong(folder, tmp_path, change):
    """What reading a plan says in which something was changed."""
    content = json.loads((folder / PLAN).read_text(encoding="utf-8"))
    change(content)
    (tmp_path / PLAN).write_text(json.dumps(content), encoding="utf-8")
    with pytest.raises(DesignError) as caught:
        read_plan(tmp_path)
    return str(caught.value)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda c: c.update(schema_version=2), "expected a plan of schema 1, found schema 2"),
        (lambda c: c.update(legs=[]), "legs"),
        (lambda c: c.update(evil=1), "evil"),
        (lambda c: c["legs"][0].update(harmonics=[3, 1]), "amplitudes"),
        (lambda c: c["legs"][0].update(period_s=-1.0), "legs.0.period_s: Input should be greater than 0"),
        (lambda c: c["legs"][0].update(period_s="1e40"), "legs.0.period_s"),
        (lambda c: c["legs"][0].update(amplitudes=[[0.1, 0.2]]), "two rows: real and imaginary parts"),
        (lambda c: c["legs"][0]["noise"].update(density=[[1.0], [1.0, 2.0]]), "density: expected lists of numbers"),
        (lambda c: c["ship"]["covariance"][0].__setitem__(0, None), "ship.covariance: expected at most 100000 finite"),
        (lambda c: c["ship"]["covariance"][0].__setitem__(0, 10**400), "ship.covariance: expected lists of numbers"),
        (lambda c: c["limits"].update(evil=1), "limits.evil"),
        (lambda c: c["legs"][0].update(period_s=float("nan")), "period_s"),
        (lambda c: c["legs"][0]["noise"].update(frequency_hz=[]), "noise levels"),
        (lambda c: c["limits"].update(lowest_speed_rpm=1e9), "speeds from lower to higher"),
        (lambda c: c["ship"].update(structure="/etc/passwd"), "none of the shipped ones"),
        (lambda c: c["ship"]["values"].update(K_p=1e31), "K_p"),
        (lambda c: c["ship"].update(covariance=[[1.0]]), "covariance"),
        (lambda c: c.update(slope_rpm_per_v=0.0), "slope other than 0"),
        (lambda c: c.update(created="yesterday"), "created"),
    ],
)
def test_a_file_that_is_no_plan_is_refused_in_a_sentence(folder, tmp_path, change, words):
    message = wrong(folder, tmp_path, change)
    assert PLAN in message
    assert words in message


@pytest.mark.parametrize("content", ["", "[]", "{", "null", "[" * 100_000, "\x00"])
def test_a_file_that_is_no_json_is_refused(tmp_path, content):
    (tmp_path / PLAN).write_text(content, encoding="utf-8")
    with pytest.raises(DesignError, match="expected a plan"):
        read_plan(tmp_path)


def test_a_folder_without_a_plan_says_how_to_come_by_one(tmp_path):
    with pytest.raises(DesignError, match="shaftprint plan"):
        read_plan(tmp_path)


@pytest.fixture(scope="module")
def of_current(test):
    """The same test with a lever of 4 to 20 mA for 2 to -8 V: one mA is -0.625 V, and 0 mA are 4.5 V."""
    lever = Lever(unit="mA", v_per_unit=-0.625, v_at_zero=4.5)
    line = SetPointLine(slope_rpm_per_v=SLOPE, offset_v=OFFSET_V, lever=lever)
    return PlannedTest(**{name: getattr(test, name) for name in test.__slots__} | {"line": line})


def test_the_files_speak_the_lever_s_own_unit_beside_volts(of_current, tmp_path):
    write_plan_files(of_current, tmp_path, rate_hz=100.0)
    assert (tmp_path / CSV).read_text(encoding="utf-8").splitlines()[0] == "time_s,V,rpm,mA"
    table, content = np.loadtxt(tmp_path / CSV, delimiter=",", skiprows=1), loadmat(str(tmp_path / MAT))
    # the first leg is at 1.15 of 1183.8 rpm: 177.57 rpm over 251 rpm/V below -5 V, and (4.5 + 5.707) / 0.625 mA
    assert table[0, 1:] == pytest.approx([-5.7075, 1361.37, 16.332], abs=1e-3)
    assert content["lever"][:, 0] == pytest.approx(table[:, 3], abs=1e-6)
    assert content["lever_unit"].item() == "mA"
    assert read_plan(tmp_path).line == of_current.line
    assert abort_card(of_current).lever == of_current.line.lever


def test_the_lever_is_that_of_the_vessel_file_and_none_where_it_is_in_volts():
    current = SimpleNamespace(unit="mA", slope_v=0.5, v_at_zero=1.0)
    assert lever_of_sensor(current) == Lever(unit="mA", v_per_unit=0.5, v_at_zero=1.0)
    # behind a divider the logger sees other volts, and the ship the campaign's
    assert lever_of_sensor(SimpleNamespace(unit="V", slope_v=2.0, v_at_zero=None)) is None


def test_a_lever_without_a_scale_is_refused():
    with pytest.raises(DesignError, match="expected a finite scale other than 0 V for one mA"):
        Lever(unit="mA", v_per_unit=0.0)
