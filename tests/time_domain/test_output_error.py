"""The likelihood of a record against its definition, and what fits to it state against what they scatter."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from shaftprint.errors import IdentificationError, StructureError
from shaftprint.identify import (
    Draw,
    Settings,
    Unweighted,
    assess,
    bootstrap,
    compare_fits,
    identify,
    identify_jointly,
    profile,
    refit,
)
from shaftprint.identify.uncertainty._propagation import propagation
from shaftprint.models import FirstOrderLag, Gain, Parameter, Structure
from shaftprint.simulation import Trace
from shaftprint.spectra import FrequencyResponse
from shaftprint.time_domain import TimeSettings, identify_in_time, output_error, record_from_arrays
from shaftprint.time_domain._identify_in_time import with_noise_at
from shaftprint.time_domain._noise_model import NoiseModel
from shaftprint.time_domain._whitening import Whitening

RATE = 10.0
K, T = 1.5, 0.7
GAIN = Parameter("k", "-", 0.1, 5.0, 1.0, "gain")
TIME = Parameter("T", "s", 0.05, 5.0, 1.0, "time")


class Recursion:
    """A stand-in: ``T y' + y = k u`` with straight lines between samples, exactly, and its derivatives by recursion.

    From ``y_{i+1} = a y_i + k ((1 - a) u_i + (1 - (1 - a) T / h) (u_{i+1} - u_i))`` with ``a = exp(-h / T)``.
    """

    def __call__(self, structure, values, record, wanted, *, initial=None, of_states=False):
        named = structure.named(values)
        k, t, h = float(named["k"]), float(named["T"]), 1.0 / record.drive_rate_hz
        if t < 0.06:
            raise StructureError("no steady running")
        u = record.drive["u"]
        a = np.exp(-h / t)
        da = a * h / t**2
        b1 = 1.0 - (1.0 - a) * t / h
        db1 = da * t / h - (1.0 - a) / h
        b0 = (1.0 - a) - b1
        db0 = -da - db1
        first = k * u[0] if initial is None else float(initial[0])

        def run(drive, start):
            return np.concatenate([[start], lfilter([1.0], [1.0, -a], drive, zi=[a * start])[0]])

        y = run(k * (b0 * u[:-1] + b1 * u[1:]), first)
        rests = 0.0 if initial is not None else u[0]
        slopes = {
            "k": run(b0 * u[:-1] + b1 * u[1:], rests),
            "T": run(da * y[:-1] + k * (db0 * u[:-1] + db1 * u[1:]), 0.0),
        }
        rows = np.array([slopes[name] for name in wanted]).reshape(-1, u.size)
        if of_states:
            rows = np.concatenate([rows, a ** np.arange(u.size)[None]])
        return Trace(time_s=record.drive_time_s, outputs={"y": y}, derivatives={"y": rows})

    def rest(self, structure, values, record):
        return np.array([float(structure.named(values)["k"]) * record.drive["u"][0]])


STAND_IN = TimeSettings(simulator=Recursion(), drift_degree=1)
SINGLE = Settings(starts=1)


@pytest.fixture(scope="module")
def lag():
    return Structure(name="LAG", title="A lag", input="u", outputs={"y": Gain(GAIN) * FirstOrderLag(TIME)})


def true_output(u, *, start=None, k=K, t=T):
    """The response on a grid a hundred times finer, by the rule of trapezoids."""
    fine = 100
    time = np.arange(u.size)
    dense = np.interp(np.arange((u.size - 1) * fine + 1) / fine, time, u)
    h = 1.0 / (RATE * fine)
    c = h / (2.0 * t)
    a, b = (1.0 - c) / (1.0 + c), k * c / (1.0 + c)
    first = k * u[0] if start is None else start
    y, _ = lfilter([b, b], [1.0, -a], dense[1:], zi=[a * first + b * dense[0]])
    return np.concatenate([[first], y])[::fine]


def noise(count, rng, *, a=0.8, std=0.02):
    return lfilter([std], [1.0, -a], rng.standard_normal(count + 200))[200:]


def excitation(count, rng):
    return np.repeat(rng.choice([-0.1, 0.1], size=count // 20 + 1), 20)[:count] + 0.02 * np.sin(np.arange(count) / 7.0)


def make_record(seed, *, count=1000, offset=0.0, name="R1", **options):
    rng = np.random.default_rng(seed)
    u = excitation(count, rng)
    y = true_output(u) + noise(count, rng) + offset
    return record_from_arrays(name, {"u": u}, {"y": y}, rate_hz=RATE, **options)


# ---- the likelihood ----


def test_cost_is_that_of_the_whole_covariance_with_offset_and_drift_at_their_best(lag):
    """AR(1) noise has the covariance ``s^2 a^|k| / (1 - a^2)`` within a stretch and none across the gap."""
    a, s = 0.7, 0.05
    used = np.ones(40, dtype=bool)
    used[12:17] = False
    rng = np.random.default_rng(1)
    u = rng.standard_normal(40)
    y = rng.standard_normal(40)
    record = record_from_arrays("R", {"u": u}, {"y": y}, rate_hz=RATE, used=used)
    white = Whitening(noise=NoiseModel(coefficients=np.array([[[a]]]), covariance=np.array([[s**2]])))
    term = output_error(lag, record, settings=STAND_IN).with_noise(white)
    stretch = np.where(np.arange(40) < 12, 0, 1)[used]
    lags = np.abs(np.subtract.outer(np.arange(40)[used], np.arange(40)[used]))
    gamma = np.where(stretch[:, None] == stretch, s**2 * a**lags / (1 - a**2), 0.0)
    drift = np.stack([np.ones(35), np.arange(40.0)[used]], axis=1)
    gap = (y - true_output(u, k=0.9, t=1.3))[used]
    weight = np.linalg.inv(gamma)
    best = np.linalg.solve(drift.T @ weight @ drift, drift.T @ weight @ gap)
    rest = gap - drift @ best
    table = term.table(np.array([[0.9, 1.3]]))
    assert np.sum(table[0, 0] ** 2) == pytest.approx(float(rest @ weight @ rest), rel=1e-5)
    assert term.data_count == 33


@pytest.mark.parametrize("states", [False, True])
def test_derivatives_are_those_of_the_cost(lag, states):
    record = make_record(2, count=300)
    term = output_error(lag, record, settings=replace(STAND_IN, initial_states=states))
    theta = np.array([1.2, 0.9])
    table = term.table(theta[None])[0]
    for i, step in enumerate(1e-5 * np.eye(2)):
        ahead, behind = term.table(np.array([theta + step, theta - step]))
        slope = (np.sum(ahead[0] ** 2) - np.sum(behind[0] ** 2)) / 2e-5 / 2.0
        assert table[0] @ table[1 + i] == pytest.approx(slope, rel=1e-6)


def test_what_is_in_a_gap_does_not_matter(lag):
    used = np.ones(300, dtype=bool)
    used[100:130] = False
    record = make_record(3, count=300, used=used)
    spoilt = record.outputs["y"].copy()
    spoilt[100:130] = 1e3
    other = replace(record, outputs={"y": spoilt})
    theta = np.array([[1.2, 0.9]])
    tables = [output_error(lag, r, settings=STAND_IN).table(theta) for r in (record, other)]
    np.testing.assert_array_equal(*tables)


def test_a_long_gap_begins_offset_and_drift_anew(lag):
    used = np.ones(600, dtype=bool)
    used[200:400] = False
    record = make_record(4, count=600, used=used)
    counts = {s: output_error(lag, record, settings=replace(STAND_IN, anew_after_s=s)).data_count for s in (10.0, 30.0)}
    assert counts == {10.0: 396, 30.0: 398}
    bare = output_error(lag, record, settings=replace(STAND_IN, drift_degree=-1))
    assert bare.data_count == 400


def test_simulation_that_runs_away_costs_much_but_finitely(lag):
    term = output_error(lag, make_record(5, count=300), settings=STAND_IN)
    far = term.table(np.array([[1.0, 0.055], [1.5, 0.7]]))
    assert np.isfinite(far).all()
    assert np.sum(far[0, 0] ** 2) > 1e9 * np.sum(far[1, 0] ** 2)
    assert not far[0, 1:].any()
    states = replace(term, initial_states=True)
    assert np.sum(states.table(np.array([[1.0, 0.055]]))[0, 0] ** 2) > 1e9
    with pytest.raises(IdentificationError, match="runs away"):
        term.model(np.array([1.0, 0.055]))
    with pytest.raises(IdentificationError, match="runs away"):
        term.assessed(np.array([1.0, 0.055]), 0)
    with pytest.raises(IdentificationError, match="runs away"):
        term.redrawn(np.array([1.0, 0.055]), 2, np.random.default_rng(1))


def test_fewer_samples_than_parameters_are_possible_in_a_term(lag):
    record = record_from_arrays("short", {"u": np.arange(2.0)}, {"y": np.arange(2.0)}, rate_hz=RATE)
    term = output_error(lag, record, settings=replace(STAND_IN, drift_degree=-1))
    assert term.table(np.array([[1.0, 1.0]])).shape == (1, 3, 3)


# ---- fits ----


def test_offset_and_gap_leave_the_estimates_where_they_are(lag):
    used = np.ones(3000, dtype=bool)
    used[700:760] = False
    found = identify_in_time(
        [(lag, make_record(6, count=3000, offset=0.7, used=used))],
        rng=np.random.default_rng(1),
        settings=SINGLE,
        time=STAND_IN,
    )
    for estimate, truth in zip(found.parameters, (K, T), strict=True):
        assert abs(estimate.value - truth) < 3.0 * estimate.std
    (part,) = found.parts
    assert part.name == "record R1"
    assert part.noise.order >= 1
    assert part.noise.coefficients[0, 0, 0] == pytest.approx(0.8, abs=0.08)
    assert found.fit_percent["y"] == pytest.approx(found.fit_ceiling["y"], abs=1.0)
    left = part.whitened[:, 0]
    assert left.std() == pytest.approx(1.0, abs=0.05)
    assert abs(np.mean(left[1:] * left[:-1])) < 0.06
    assert found.value("k") == pytest.approx(K, rel=0.1)
    with pytest.raises(IdentificationError, match="to no frequency response"):
        _ = found.response
    verdict = assess(found)
    assert f"LAG explains 1 record of 294 s (FitPercent {found.fit_percent['y']:.1f} %) within" in verdict.reason
    assert "lines" not in verdict.reason


@pytest.mark.long
def test_stated_uncertainty_is_the_scatter_of_two_hundred_tests(lag):
    """200 tests with AR(1) noise: coverage of the 95 % intervals, mean square of the standardised errors, p-values.

    Of 200 intervals 95 % +- 3.1 % cover; the mean square has a standard deviation of 0.1.
    """
    errors, p_values = [], []
    for seed in range(200):
        found = identify_in_time(
            [(lag, make_record(1000 + seed, count=600))],
            rng=np.random.default_rng(seed),
            settings=SINGLE,
            time=STAND_IN,
            start={"k": 1.3, "T": 0.9},
        )
        errors.append([(p.value - truth) / p.std for p, truth in zip(found.parameters, (K, T), strict=True)])
        p_values.append(found.p_value)
    errors = np.array(errors)
    coverage = np.mean(np.abs(errors) < 1.96, axis=0)
    assert np.all((coverage >= 0.88) & (coverage <= 0.99)), coverage
    assert np.all(np.abs(errors.mean(axis=0)) < 0.25)
    assert np.all((np.mean(errors**2, axis=0) > 0.7) & (np.mean(errors**2, axis=0) < 1.4))
    assert 0.005 <= np.mean(np.array(p_values) < 0.05) <= 0.12


def test_white_noise_where_it_is_coloured_states_too_little(lag):
    """AR(1) with ``a = 0.8``: a slow input is ``(1 + a) / (1 - a)`` times less well known in variance than white."""
    record = make_record(7, count=3000)
    std = {}
    for rounds in (0, 3):
        found = identify_in_time(
            [(lag, record)], rng=np.random.default_rng(1), settings=SINGLE, time=replace(STAND_IN, rounds=rounds),
            start={"k": K, "T": T},
        )  # fmt: skip
        std[rounds] = found.parameters[0].std
    # white noise is as strong as the outputs in the first round: only with colour is the noise that of the residuals
    assert std[3] < std[0]


def test_state_in_motion_is_estimated(lag):
    """A record that begins far from rest: unbiased with initial states, far off without."""
    rng = np.random.default_rng(8)
    u = excitation(400, rng)
    y = true_output(u, start=2.0) + 0.1 * noise(400, rng)
    record = record_from_arrays("moving", {"u": u}, {"y": y}, rate_hz=RATE)
    found = {}
    for states in (True, False):
        fit = identify_in_time(
            [(lag, record)], rng=rng, settings=SINGLE, start={"k": 1.3, "T": 0.9},
            time=replace(STAND_IN, initial_states=states),
        )  # fmt: skip
        found[states] = np.abs([fit.value("k") - K, fit.value("T") - T]), np.sqrt(np.diag(fit.covariance))
        if states:
            (part,) = fit.parts
    assert np.all(found[True][0] < 3.5 * found[True][1])
    # model, residuals, noise, FitPercent and ceiling are those of the motion from the state that was found
    truth = true_output(u, start=2.0)
    assert np.abs(part.model["y"] - truth).max() < 0.01
    assert part.fit_percent["y"] == pytest.approx(100.0 * (1.0 - np.std(y - truth) / np.std(y)), abs=0.3)
    assert part.fit_ceiling["y"] == pytest.approx(part.fit_percent["y"], abs=0.3)
    assert np.sqrt(part.noise.covariance[0, 0]) == pytest.approx(0.1 * 0.02, rel=0.15)
    assert np.max(found[False][0]) > 10.0 * np.max(found[True][0])


@pytest.mark.slow
def test_initial_state_is_given_with_its_deviation(lag):
    """Eighty records that begin at 2.0: errors over what is stated, whose mean square scatters by 0.16."""
    errors = []
    for seed in range(80):
        rng = np.random.default_rng(300 + seed)
        u = excitation(300, rng)
        record = record_from_arrays("R", {"u": u}, {"y": true_output(u, start=2.0) + noise(300, rng)}, rate_hz=RATE)
        found = identify_in_time(
            [(lag, record)], rng=rng, settings=SINGLE, start={"k": K, "T": T},
            time=replace(STAND_IN, initial_states=True, drift_degree=-1),
        )  # fmt: skip
        (state,) = found.parts[0].initial_states
        errors.append((state.value - 2.0) / state.std)
    assert state.name == "FirstOrderLag"
    assert 0.6 < np.mean(np.square(errors)) < 1.5
    assert abs(np.mean(errors)) < 0.35


def test_a_record_from_steady_running_has_no_initial_states(lag, mixed):
    assert mixed[1].parts[0].initial_states == ()


def test_flushed_seconds_do_as_well(lag):
    rng = np.random.default_rng(9)
    u = excitation(600, rng)
    used = np.arange(600) >= 80
    y = true_output(u, start=2.0) + 0.1 * noise(600, rng)
    record = record_from_arrays("flushed", {"u": u}, {"y": y}, rate_hz=RATE, used=used)
    found = identify_in_time([(lag, record)], rng=rng, settings=SINGLE, time=STAND_IN, start={"k": 1.3, "T": 0.9})
    for estimate, truth in zip(found.parameters, (K, T), strict=True):
        assert abs(estimate.value - truth) < 3.5 * estimate.std


def test_search_from_many_starts_needs_no_known_one(lag):
    found = identify_in_time(
        [(lag, make_record(10))], rng=np.random.default_rng(1), settings=Settings(starts=5), time=STAND_IN
    )
    assert found.value("T") == pytest.approx(T, rel=0.1)
    assert sum(cluster.starts for cluster in found.clusters) == 5


class RunsAway(Draw):
    """Starts at which the stand-in finds no steady running."""

    def starts(self, lower, upper, count, rng):
        return np.tile([1.0, 0.055], (count, 1))


def test_starts_that_run_away_are_drawn_again(lag):
    term = output_error(lag, make_record(10), settings=STAND_IN)
    np.testing.assert_array_equal(term.evaluable(np.array([[1.0, 0.055], [1.5, 0.7]])), [False, True])
    found = identify_in_time(
        [term], rng=np.random.default_rng(1), settings=Settings(starts=4, draw=RunsAway()), time=STAND_IN
    )
    assert found.value("T") == pytest.approx(T, rel=0.1)
    assert sum(cluster.starts for cluster in found.clusters) == 4


def test_many_starts_at_once_give_what_each_gives_alone(lag):
    term = output_error(lag, make_record(10, count=200), settings=STAND_IN)
    theta = np.random.default_rng(2).uniform(0.2, 2.0, (9, 2))
    together = term.table(theta)
    np.testing.assert_array_equal(together, np.concatenate([term.table(row[None]) for row in theta]))


def test_wrong_structure_is_rejected_though_the_noise_is_taken_from_its_residuals(lag):
    """Data of two lags in a row, fitted with one."""
    rng = np.random.default_rng(11)
    u = excitation(3000, rng)
    twice = true_output(true_output(u, t=0.7), k=1.0, t=0.5)
    added = noise(3000, rng)
    measured = twice + added
    record = record_from_arrays("two lags", {"u": u}, {"y": measured}, rate_hz=RATE)
    found = identify_in_time([(lag, record)], rng=rng, settings=SINGLE, time=STAND_IN, start={"k": 1.3, "T": 0.9})
    assert found.p_value < 1e-6
    assert found.fit_percent["y"] < found.fit_ceiling["y"] - 1.0
    # what two lags would reach
    assert found.fit_ceiling["y"] == pytest.approx(100.0 * (1.0 - added.std() / measured.std()), abs=1.0)
    verdict = assess(found)
    assert not verdict.trustworthy
    assert "two lags" in verdict.reason
    assert verdict.suspects == ()


# ---- terms of different kinds together ----


def response_of(lag, rng):
    frequency = np.array([0.01, 0.03, 0.1, 0.2, 0.4, 0.8])
    exact = lag.response(lag.vector({"k": K, "T": T}), 2j * np.pi * frequency)
    std = 0.01 * np.ones((6, 2))
    parts = std * rng.standard_normal((6, 2))
    return FrequencyResponse(
        frequency_hz=frequency,
        response=(exact[0] + parts[:, 0] + 1j * parts[:, 1])[None, None],
        covariance=np.stack([np.diag(row**2) for row in std]),
        inputs=("u",),
        outputs=("y",),
        lines=tuple(f"S{i}" for i in range(6)),
    )


@pytest.fixture(scope="module")
def mixed(lag):
    rng = np.random.default_rng(12)
    response = response_of(lag, rng)
    pairs = [(lag, make_record(13)), (lag, response), (lag, make_record(14, name="R2"))]
    return pairs, identify_in_time(pairs, rng=rng, settings=Settings(starts=3), time=STAND_IN)


def test_information_of_independent_data_adds_up(lag, mixed):
    _, found = mixed
    theta = found.values
    total = np.zeros((2, 2))
    for term in found.objective.terms:
        rows, _ = term.sensitivity(theta, expected=False)
        total += rows @ rows.T
    np.testing.assert_allclose(found.covariance, np.linalg.inv(total), rtol=1e-8)
    assert [part.name for part in found.parts] == ["record R1", "response of y", "record R2"]
    assert found.data_count == 998 + 12 + 998
    assert found.response.lines == ("S0", "S1", "S2", "S3", "S4", "S5")
    assert found.fit_percent["y"] == found.parts[0].fit_percent["y"]
    for estimate, truth in zip(found.parameters, (K, T), strict=True):
        assert abs(estimate.value - truth) < 3.0 * estimate.std


def test_all_machinery_of_a_fit_takes_mixed_terms(lag, mixed):
    _, found = mixed
    assert 1e-3 < found.p_value <= 1.0
    assert [test.name for test in found.line_tests] == ["R1", "S0", "S1", "S2", "S3", "S4", "S5", "R2"]
    verdict = assess(found, profile=profile(found))
    assert verdict.trustworthy
    assert set(verdict.trusted) == {"k", "T"}
    assert "explains 6 good spectral lines and 2 records of 200 s (FitPercent " in verdict.reason
    intervals = profile(found).intervals
    for estimate in found.parameters:
        interval = intervals[estimate.name]
        assert interval.upper - interval.lower == pytest.approx(3.92 * estimate.std, rel=0.05)
    spread = bootstrap(found, count=60, rng=np.random.default_rng(3))
    for estimate in found.parameters:
        assert spread.estimates[estimate.name].std == pytest.approx(estimate.std, rel=0.3)
    np.testing.assert_array_equal(found.structure_values(2), found.values)


def test_uncertainty_is_told_by_term(mixed):
    _, found = mixed
    spread = propagation(found)
    assert set(spread.noise) == {"noise of record R1", "noise of y", "noise of record R2"}
    np.testing.assert_allclose(sum(spread.noise.values()), found.covariance, rtol=1e-8)


def test_what_is_made_for_responses_alone_says_so(lag, mixed):
    _, found = mixed
    with pytest.raises(IdentificationError, match="record R1 is no frequency response"):
        refit(found, np.zeros((1, 1, 6)))
    part = found.parts[0]
    renamed = replace(found, parts=(replace(part, structure=replace(part.structure, name="OTHER")),))
    with pytest.raises(IdentificationError, match="only fits to frequency responses are compared"):
        compare_fits([found, renamed], rng=np.random.default_rng(1))
    with pytest.raises(IdentificationError, match="record R1 is weighted by its noise"):
        identify_jointly(
            list(found.objective.terms[:1]), rng=np.random.default_rng(1), settings=Settings(weighting=Unweighted())
        )


def test_start_is_a_fit_to_the_responses_by_default(lag, mixed):
    pairs, found = mixed
    again = identify_in_time(
        pairs,
        rng=np.random.default_rng(5),
        settings=SINGLE,
        time=STAND_IN,
        start=identify(lag, pairs[1][1], rng=np.random.default_rng(6)),
    )
    np.testing.assert_allclose(again.values, found.values, rtol=1e-3)


# ---- refusals ----


def test_wrong_requests_are_refused(lag):
    record = make_record(15, count=100)
    rng = np.random.default_rng(1)
    with pytest.raises(IdentificationError, match="at least one structure with a record"):
        identify_in_time([(lag, response_of(lag, rng))], rng=rng)
    with pytest.raises(IdentificationError, match="record R1 from u to y: choose a structure"):
        output_error(replace(lag, outputs={"z": lag.outputs["y"]}), record)
    with pytest.raises(IdentificationError, match="drift degree of at least -1"):
        TimeSettings(drift_degree=-2)
    with pytest.raises(IdentificationError, match="runs away"):
        with_noise_at(output_error(lag, record, settings=STAND_IN), np.array([1.0, 0.055]))


def test_states_follow_those_near_by_in_one_simulation(lag, monkeypatch):
    """A descent begins with two simulations: at rest, and from the states that this gives; each step takes one."""
    whole = make_record(12, count=400)
    moving = {name: values[57:] for name, values in (*whole.inputs.items(), *whole.outputs.items())}
    cut = record_from_arrays("cut", {"u": moving["u"]}, {"y": moving["y"]}, rate_hz=RATE)
    term = output_error(lag, cut, settings=replace(STAND_IN, initial_states=True))
    runs = []
    monkeypatch.setattr(Recursion, "__call__", counted(Recursion.__call__, runs))
    table = term.following(2)
    places = [np.array([1.2, 0.9]) + step * np.array([1.0, -1.0]) for step in (0.0, 2e-3, 4e-3, 6e-3)]
    followed = [table(place[None], np.array([1]))[0] for place in places]
    assert len(runs) <= 2 + 3
    alone = term.table(np.array(places))
    for one, other in zip(followed, alone, strict=True):
        assert one[0] @ one[0] == pytest.approx(other[0] @ other[0], rel=1e-7)
        np.testing.assert_allclose(one[1:] @ one[0], other[1:] @ other[0], rtol=1e-3)


def counted(verb, runs):
    def call(*arguments, **options):
        runs.append(options)
        return verb(*arguments, **options)

    return call
