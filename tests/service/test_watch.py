"""Days that were made up: what has changed is named, and what has not gives no alarm."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.errors import ServiceError
from shaftprint.service._day_folder import Day, read_day, scores_text, theta_text
from shaftprint.service._model import FREE, service_model
from shaftprint.service._watch import watch_days
from shaftprint.vessel import load_vessel

SEGMENTS = 60


@pytest.fixture(scope="module")
def model():
    return service_model(load_vessel("stan-tug-1205-service"))


def information(model):
    """Return what a segment tells: each number to 8 %, gains and delays with a valley between them."""
    size = 0.08 * np.maximum(np.abs(model.theta), 0.05)
    size[FREE.index("c_set")] = 0.004
    valley = np.array([name in ("K_p", "zeta", "t_d", "t_sp") for name in FREE]) / 2.0
    shape = np.eye(len(FREE)) - 0.98 * np.outer(valley, valley)
    return shape / np.outer(size, size)


def days(model, rng, *, count, error, change=None, since=0):
    """Return days of a ship whose fingerprint is wrong by an error, with a change from some day on."""
    told = information(model)
    root = np.linalg.cholesky(told)
    made = []
    for day in range(count):
        moved = -error + (change if change is not None and day >= since else 0.0)
        noise = rng.standard_normal((SEGMENTS, len(FREE))) @ root.T
        # the lever's scale is another every day
        moved = moved + 0.003 * rng.standard_normal() * (np.array(FREE) == "c_set")
        made.append(
            Day(
                name=f"day {day}",
                slopes=noise + told @ moved,
                information=np.repeat(told[None], SEGMENTS, axis=0),
                theta=model.theta,
                fingerprint=None,
            )
        )
    return made


def fingerprint_error(model, rng):
    """Return the covariance of a fingerprint of one day, and an error of that size."""
    covariance = np.linalg.inv(SEGMENTS * information(model))
    return covariance, np.linalg.cholesky(covariance) @ rng.standard_normal(len(FREE))


def test_a_fingerprint_at_another_load_keeps_its_deviations_in_newton_metres(model):
    vessel = load_vessel("stan-tug-1205-service")
    load = 0.8
    std = 0.1 * np.ones(len(FREE))
    at_load = SimpleNamespace(
        structure="GAUGE-CLOSED", held={}, covariance=np.diag(std**2),
        parameters=[SimpleNamespace(name=name, value=0.0 if name == "g" else 2.0) for name in FREE],
        conditions=SimpleNamespace(
            vessel="a tug",
            shaft_torque=SimpleNamespace(value=load * vessel.working_point.driving_torque_nm),
            engine_speed=SimpleNamespace(value=vessel.working_point.engine_speed_rpm),
        ),
    )  # fmt: skip
    at_point = service_model(vessel, at_load)
    deviations = dict(zip(FREE, np.sqrt(np.diag(at_point.covariance)), strict=True))
    # the same newton metres are less of the larger torque; g has no value whose ratio would tell it
    for name in ("K_p", "K_i", "tau_dn", "tau_up", "g"):
        assert deviations[name] == pytest.approx(0.1 * load)
    for name in ("omega_n", "zeta", "t_d", "t_sp", "t_gauge", "c_set"):
        assert deviations[name] == pytest.approx(0.1)
    assert at_point.values["K_p"] == pytest.approx(2.0 * load)


@pytest.mark.parametrize("scale_std", [1e-9, 0.005])
def test_the_deviation_of_a_change_is_that_of_the_scatter_of_segments(model, scale_std):
    rng = np.random.default_rng(5)
    covariance, error = fingerprint_error(model, rng)
    # one segment tells more of this number, another of that, and of the scale of the lever with it
    way = np.sqrt(np.diag(information(model))) * rng.standard_normal((SEGMENTS, len(FREE)))
    made = [
        replace(day, slopes=3.0 * day.slopes, information=day.information + way[:, :, None] * way[:, None, :])
        for day in days(model, rng, count=3, error=0.0 * error)
    ]
    scale = FREE.index("c_set")
    rest = [k for k in range(len(FREE)) if k != scale]
    found = watch_days(made, replace(model, prior_std={**model.prior_std, "c_set": scale_std}), covariance)
    one = next(one for one in found.causes if one.cause.name == "inertia behind the gauge")
    # by hand: g = H e + H v s + noise, e of that covariance, s since the last days
    v = (model.theta * (np.array(FREE) == "tau_dn"))[rest]
    prior = np.linalg.inv(covariance[np.ix_(rest, rest)])
    normal = np.zeros((len(rest) + 1, len(rest) + 1))
    right = np.zeros(len(rest) + 1)
    design = []
    for number, day in enumerate(made):
        # the scale of the lever, which is another every day, is taken out by what the day tells of it
        total = day.information.sum(axis=0)
        share = total[:, scale] / (total[scale, scale] + scale_std**-2)
        without = (np.eye(len(FREE)) - np.outer(share, np.eye(len(FREE))[scale]))[rest]
        own, h = day.slopes @ without.T, without @ day.information[:, :, rest]
        after = float(number >= len(made) - one.days)
        block = np.column_stack([np.eye(len(rest)), after * v])
        normal += block.T @ h.sum(axis=0) @ block
        right += block.T @ own.sum(axis=0)
        design.append((own, h, block))
    normal[:-1, :-1] += prior
    inverse = np.linalg.inv(normal)
    solution = inverse @ right
    assert one.size == pytest.approx(solution[-1], rel=1e-6)
    row = inverse[-1]
    variance = row[:-1] @ prior @ row[:-1]
    for own, h, block in design:
        left = own - (h @ block @ solution)
        variance += np.sum((left @ block @ row) ** 2)
        # what a day differs by however long it is
        variance += (0.003 * row @ block.T @ h.sum(axis=0) @ v) ** 2
    assert one.std == pytest.approx(np.sqrt(variance), rel=1e-6)


@pytest.mark.parametrize(
    ("names", "share", "cause"),
    [
        (("K_p",), -0.08, "a lower proportional gain of the governor"),
        (("K_p", "K_i"), -0.08, "less torque for the same rack: injection or turbocharger"),
        (("tau_dn",), 0.08, "more inertia behind the torque gauge"),
    ],
)
def test_what_has_changed_is_named_with_the_day_on_which_it_did(model, names, share, cause):
    rng = np.random.default_rng(2)
    covariance, error = fingerprint_error(model, rng)
    change = share * model.theta * np.array([name in names for name in FREE])
    found = watch_days(days(model, rng, count=8, error=error, change=change, since=4), model, covariance)
    assert found.is_alarm
    assert found.headline.startswith(f"The line has changed since day 4: {cause}, by ")
    assert found.causes[0].size == pytest.approx(share, abs=4.0 * found.causes[0].std)
    # the headline says the size of the table
    assert f"by {abs(100.0 * found.causes[0].size):.2g} +/- " in found.headline
    assert found.first in ("day 4", "day 5", "day 6")


def test_an_unchanged_line_gives_no_alarm_though_its_fingerprint_is_wrong(model):
    alarms = 0
    for seed in range(6):
        rng = np.random.default_rng((seed, 3))
        covariance, error = fingerprint_error(model, rng)
        found = watch_days(days(model, rng, count=8, error=error), model, covariance)
        alarms += found.first is not None
    # one a year: six ships of 8 days give an eighth of an alarm
    assert alarms <= 1
    assert 3.0 < found.limit < 4.5


def test_days_against_another_fingerprint_are_refused(model):
    rng = np.random.default_rng(4)
    covariance, error = fingerprint_error(model, rng)
    day = replace(days(model, rng, count=1, error=error)[0], theta=1.01 * model.theta)
    with pytest.raises(ServiceError, match="one that began from other values"):
        watch_days([day], model, covariance)
    with pytest.raises(ServiceError, match="at least one day"):
        watch_days([], model, covariance)


def test_a_folder_that_is_no_day_is_told(tmp_path, model):
    with pytest.raises(ServiceError, match=r"found no values-against\.json and scores-against\.csv"):
        read_day(tmp_path)
    (tmp_path / "values-against.json").write_text(theta_text(model.theta, model.free))
    for text in ("", "log,move_s\n", scores_text([], [], FREE), scores_text([], [], FREE).replace("g_K_p", "x")):
        (tmp_path / "scores-against.csv").write_text(text)
        with pytest.raises(ServiceError, match="found something else; fit the day again"):
            read_day(tmp_path)
