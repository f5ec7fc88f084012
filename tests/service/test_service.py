"""A simulated tug at work: what its logs tell is its truth, and what is wrong with them is found."""

import re
from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest
from click.testing import CliRunner
from tests.tug.busy_crew import BUSY

from shaftprint.campaign import TrialConditions
from shaftprint.cli import shaftprint
from shaftprint.drift import shared_errors
from shaftprint.errors import ServiceError
from shaftprint.fingerprint import read_fingerprint, write_fingerprint
from shaftprint.service import fit_service, scan
from shaftprint.service._deviations import clustered
from shaftprint.service._fit import _beside_limits, sums_of
from shaftprint.service._gather import gather, lever_line
from shaftprint.service._model import FREE, service_model
from shaftprint.service._progress import Progress
from shaftprint.service._score import Score, Simulated, simulated
from shaftprint.service._segment_file import read_segments
from shaftprint.service._vetting import shift_of_lever
from shaftprint.tug import sail_service
from shaftprint.vessel import load_vessel

NOW = datetime(2026, 11, 28, 12, tzinfo=UTC)


@pytest.fixture(scope="module")
def vessel():
    return load_vessel("stan-tug-1205-service")


def scores_of(size, rng, scatter):
    """Return segments that each tell two numbers, their slopes so many times as scattered as stated."""
    information = np.zeros((len(FREE), len(FREE)))
    information[0, 0], information[1, 1] = 4.0, 9.0
    information[range(2, len(FREE)), range(2, len(FREE))] = 1.0
    return [
        Score(
            slope=scatter * np.sqrt(np.diag(information)) * rng.standard_normal(len(FREE)),
            information=information,
            level=1.0,
            count=1000,
            meets_limit=False,
        )
        for _ in range(size)
    ]


def test_intervals_are_as_wide_as_segments_scatter_and_no_narrower_than_the_noise(vessel):
    model, rng = service_model(vessel), np.random.default_rng(3)
    for scatter, expected in ((3.0, 3.0), (0.3, 1.0)):
        each = scores_of(800, rng, scatter)
        sums = sums_of(each, model, model.theta)
        of_noise = np.linalg.inv(sums.information)
        wider = np.sqrt(np.diag(clustered(each, sums.prior, of_noise)[0]) / np.diag(of_noise))
        # K_p and K_i have no prior
        assert wider[:2] == pytest.approx(expected, rel=0.1)


def test_intervals_hold_as_often_as_they_say_however_few_segments_tell_a_number(vessel):
    """Twenty segments of which three tell nearly all: 1.96 deviations of their scatter hold 89 %."""
    model, rng, held, freedom = service_model(vessel), np.random.default_rng(6), [], []
    shares = np.array([8.0, 6.0, 4.0, *[0.2] * 17])
    for _ in range(250):
        each = [
            replace(one, information=share * one.information, slope=np.sqrt(share) * one.slope)
            for one, share in zip(scores_of(20, rng, 1.6), shares, strict=True)
        ]
        sums = sums_of(each, model, model.theta)
        of_noise = np.linalg.inv(sums.information)
        error = of_noise @ sums.slope
        # the scatter is that of the slopes at the greatest likelihood
        fitted = [replace(one, slope=one.slope - one.information @ error) for one in each]
        covariance, dof = clustered(fitted, sums.prior, of_noise)
        held.append(abs(error[0]) < 1.96 * np.sqrt(covariance[0, 0]))
        freedom.append(dof[0])
    assert 0.935 < np.mean(held) < 0.985
    # all else equal, (8 + 6 + 4)^2 / (8^2 + 6^2 + 4^2) are 2.8
    assert 2.5 < np.mean(freedom) < 3.5


def runs_of(*meet):
    return [
        Simulated(record=k, weight=None, residuals=None, slopes=None, beside=None, meets_limit=met)
        for k, met in enumerate(meet)
    ]


def test_segments_at_a_limit_of_the_torque_do_not_count_and_stay_out():
    counts = np.ones(21, dtype=bool)
    left = _beside_limits(runs_of(*[False] * 3, True, *[False] * 17), counts)
    left = _beside_limits(runs_of(*[False] * 3, True, *[False] * (len(left) - 4)), counts)
    assert len(left) == 19
    assert np.flatnonzero(~counts).tolist() == [3, 4]


def test_a_crew_that_always_meets_a_limit_is_told():
    with pytest.raises(ServiceError, match="in which no limit of the torque acts, found 15 beside 4 that meet one"):
        _beside_limits(runs_of(*[False] * 15, *[True] * 4), np.ones(19, dtype=bool))


@pytest.fixture(scope="module")
def worked(vessel, tmp_path_factory):
    """Return the logs of half an hour of a busy crew, and the truth."""
    folder = tmp_path_factory.mktemp("service")
    return sail_service(vessel, folder, hours=0.5, seed=5, habits=BUSY, ending=".nc")


@pytest.mark.slow
def test_service_tells_the_truth_without_a_test(worked, vessel, tmp_path):
    files, truth = worked
    found = scan(files, vessel)
    assert not found.refused
    assert found.seconds["clutch out"] > 20.0
    assert len(found.used) > 20
    found.write(tmp_path / "segments.csv")
    water = TrialConditions(draught_m=2.1, water_density_kg_m3=1000.0)
    at = datetime(2026, 11, 27, 8, tzinfo=UTC)
    day = fit_service(tmp_path / "segments.csv", vessel, tested_at=at, conditions=water, now=NOW)
    made = day.fingerprint
    assert (made.conditions.tested_at, made.conditions.draught_m) == (at, 2.1)
    # lighter water: a larger coefficient takes the same torque
    load = made.conditions.shaft_torque.value / vessel.working_point.driving_torque_nm
    assert made.quantity("K_Q").value == pytest.approx(1.025 * load * 0.04943, rel=2e-3)
    # kg m2 of a drawing, to 2 % by the vessel file, do not hang on the scale of the gauge, which is known to 2 % too
    assert made.quantity("I_up").std < 0.025 * made.quantity("I_up").value
    # of two such days the errors of the file are one: nothing of them is left in the difference
    assert {"TVC", "gauge scale", "prior of g", "prior of c_set"} <= set(shared_errors(made, made).common)
    for quantity in day.fingerprint.parameters:
        expected = truth.normalised.get(quantity.name, {"c_set": 1.0, "t_gauge": 0.0}.get(quantity.name))
        assert abs(quantity.value - expected) < 4.0 * quantity.std, quantity.name
    inertia = day.fingerprint.quantity("tau_dn")
    assert inertia.std < 0.02 * inertia.value
    assert day.fingerprint.conditions.campaign == "ordinary service"
    write_fingerprint(day.fingerprint, tmp_path / "fingerprint.json")
    assert read_fingerprint(tmp_path / "fingerprint.json") == day.fingerprint
    # a line for each segment, slope and upper half of the curvature
    lines = day.scores_text().splitlines()
    assert len(lines) == 1 + len(day.segments)
    assert lines[0].count(",") == 2 + 11 + 66


def few_of(worked, vessel, path, *, kept=18):
    """Write the first segments of the logs."""
    files, _ = worked
    found = scan(files[:1], vessel)
    found.write(path)
    lines = path.read_text().splitlines()
    used = [k for k, line in enumerate(lines) if ",yes," in line]
    for k in used[kept:]:
        lines[k] = lines[k].replace(",yes,", ",no,")
    path.write_text("\n".join(lines) + "\n")


@pytest.mark.slow
def test_a_fit_that_was_stopped_goes_on_where_it_was(worked, vessel, tmp_path, monkeypatch):
    few_of(worked, vessel, tmp_path / "segments.csv")
    whole = fit_service(tmp_path / "segments.csv", vessel, now=NOW)
    keep, kept = Progress.keep, []

    def stops(progress, reached):
        keep(progress, reached)
        kept.append(reached)
        raise KeyboardInterrupt

    monkeypatch.setattr(Progress, "keep", stops)
    while not kept or not kept[-1].is_last:
        with pytest.raises(KeyboardInterrupt):
            fit_service(tmp_path / "segments.csv", vessel, progress=tmp_path / "fit.json", now=NOW)
    monkeypatch.setattr(Progress, "keep", keep)
    late = fit_service(tmp_path / "segments.csv", vessel, progress=tmp_path / "fit.json", now=NOW)
    assert [one.steps for one in kept] == list(range(1, whole.fit.steps + 1))
    assert late.fingerprint == whole.fingerprint
    assert late.scores_text() == whole.scores_text()
    assert late.scores_text(at_start=True) == whole.scores_text(at_start=True)


@pytest.mark.long
def test_days_are_fitted_and_watched_from_the_command_line(worked, vessel, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    few_of(worked, vessel, tmp_path / "a.csv", kept=20)
    few_of(worked, vessel, tmp_path / "b.csv", kept=30)

    def run(*words):
        return CliRunner().invoke(shaftprint, ["service", *words, "--vessel", "stan-tug-1205-service", "--no-progress"])

    first = run("fit", "a.csv", "-o", "first")
    assert first.exit_code == 0, first.output
    told = " ".join(first.output.split())
    assert re.search(r"\d+ of \d+ numbers can be used: `shaftprint show` has them by name", told)
    assert (
        first.output.rstrip()
        .splitlines()[-1]
        .endswith("shaftprint service fit OTHER --vessel stan-tug-1205-service --fingerprint first -o other-day")
    )
    again = run("fit", "b.csv", "--fingerprint", "first", "-o", "second")
    assert again.exit_code == 0, again.output
    assert (
        again.output.rstrip()
        .splitlines()[-1]
        .endswith("shaftprint service watch second --vessel stan-tug-1205-service --against first")
    )
    kept = {"fingerprint.json", "scores.csv", "values.json", "scores-against.csv", "values-against.json"}
    assert kept <= {one.name for one in (tmp_path / "second").iterdir()}
    assert not list(tmp_path.glob(".second*"))
    words = ["service", "watch", "second", "--vessel", "stan-tug-1205-service", "--against", "first"]
    watched = CliRunner().invoke(shaftprint, words)
    assert watched.exit_code == 0, watched.output
    assert "No change is seen in 1 day of service" in watched.output
    assert "gives no alarm" in " ".join(watched.output.split())


@pytest.mark.slow
def test_a_scan_says_the_next_command(worked, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    words = ["service", "scan", str(worked[0][0]), "--vessel", "stan-tug-1205-service", "--no-progress"]
    seen = CliRunner().invoke(shaftprint, words)
    assert seen.output.rstrip().splitlines()[-1].endswith(f"{words[2]} --vessel stan-tug-1205-service -o segments.csv")
    kept = CliRunner().invoke(shaftprint, [*words, "-o", "monday.csv"])
    assert (
        kept.output.rstrip()
        .splitlines()[-1]
        .endswith("shaftprint service fit monday.csv --vessel stan-tug-1205-service -o day")
    )


@pytest.mark.parametrize(("name", "found"), [("tug_scan", "none"), ("tug.npz", "'.npz'")])
def test_a_table_without_its_ending_is_refused_before_a_log_is_read(tmp_path, name, found):
    words = ["service", "scan", str(tmp_path / "log.nc"), "--vessel", "stan-tug-1205-service", "--no-progress"]
    refused = CliRunner().invoke(shaftprint, [*words, "-o", str(tmp_path / name)])
    assert refused.exit_code == 1
    told = " ".join(refused.output.split())
    assert f"expected a file with the ending .csv, found {found}; take " in told
    assert told.endswith(f"{name.partition('.')[0]}.csv.")
    assert not list(tmp_path.iterdir())


def test_a_folder_for_the_page_that_cannot_be_is_refused_before_a_log_is_read(tmp_path):
    (tmp_path / "log.nc").write_bytes(b"no log at all")
    (tmp_path / "page").write_text("a file", encoding="utf-8")
    words = ["service", "scan", str(tmp_path / "log.nc"), "--vessel", "stan-tug-1205-service", "--no-progress"]
    refused = CliRunner().invoke(shaftprint, [*words, "--page", str(tmp_path / "page")])
    assert refused.exit_code == 1
    assert "expected a folder for the results, found a file" in refused.output
    assert "log.nc" not in refused.output


@pytest.mark.long
def test_the_same_day_twice_is_known_better_and_is_the_same(worked, vessel, tmp_path):
    for name in ("a", "b"):
        few_of(worked, vessel, tmp_path / f"{name}.csv")
    one = fit_service(tmp_path / "a.csv", vessel, now=NOW).fit
    both = fit_service([tmp_path / "a.csv", tmp_path / "b.csv"], vessel, now=NOW).fit
    assert np.all(np.abs(both.theta - one.theta) < 0.5 * one.std)
    assert both.std[FREE.index("tau_dn")] == pytest.approx(one.std[FREE.index("tau_dn")] / np.sqrt(2.0), rel=0.1)


@pytest.mark.slow
def test_segments_are_taken_out_by_hand(worked, vessel, tmp_path):
    files, _ = worked
    scan(files, vessel).write(tmp_path / "segments.csv")
    text = (tmp_path / "segments.csv").read_text()
    (tmp_path / "segments.csv").write_text(text.replace(",yes,", ",no,", 1))
    segments, _, _ = read_segments(tmp_path / "segments.csv")
    assert [one.reason for one in segments].count("taken out by hand") == 1
    (tmp_path / "segments.csv").write_text(text.replace(",yes,", ",maybe,", 1))
    with pytest.raises(ServiceError, match='expected "yes" or "no" in the column used, found "maybe"'):
        read_segments(tmp_path / "segments.csv")


@pytest.mark.slow
@pytest.mark.parametrize("late_s", [0.0, 0.1])
def test_clock_of_the_lever_is_held_against_a_fingerprint(worked, vessel, late_s):
    files, truth = worked
    gathered = gather(files, vessel)
    model = service_model(vessel)
    model = replace(model, values={**model.values, **{k: v for k, v in truth.normalised.items() if k in FREE}})
    line = lever_line(gathered.still)
    late = [
        replace(one, lever_v=np.roll(one.lever_v, round(late_s * one.rate_hz)))
        for one in gathered.segments
        if not one.reason
    ]
    found = shift_of_lever(simulated(model.records(late, line), model, model.theta), model)
    assert found.value == pytest.approx(1e3 * late_s, abs=12.0)
    assert bool(found.refused) == (late_s > 0.02)
