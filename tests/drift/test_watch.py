"""Steps and ramps in histories of a known line: found, dated, sized, and taken for nothing after what was done."""

import tracemalloc
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from tests.drift.test_differ import PRIORS
from tests.known_fits import TRUTH, fitted, taken

from shaftprint.drift import differ, history_of, watch
from shaftprint.drift._causes import CAUSES
from shaftprint.drift._course_search import CourseSearch
from shaftprint.drift._dated import Event
from shaftprint.drift._series import _with_draught, series_of
from shaftprint.drift._words import limit_sentence, time_to_limit, watch_sentences
from shaftprint.errors import FingerprintError
from shaftprint.identify import Settings
from shaftprint.reasons import Reason

FIRST = datetime(2024, 1, 1, tzinfo=UTC)
QUARTER = timedelta(days=91.3125)


def made(place, base, **factors):
    """Return a test of a quarter: a fingerprint with some numbers multiplied, of a recording of its own."""
    physical = tuple(replace(one, value=one.value * factors.get(one.name, 1.0)) for one in base.physical)
    parameters = tuple(replace(one, value=one.value * factors.get(one.name, 1.0)) for one in base.parameters)
    sources = tuple(
        one.model_copy(update={"sha256": f"{place:064x}"}) if one.role == "recording" else one for one in base.sources
    )
    conditions = base.conditions.model_copy(update={"tested_at": FIRST + place * QUARTER})
    return base.model_copy(
        update={"physical": physical, "parameters": parameters, "sources": sources, "conditions": conditions}
    )


def looked_at(fingerprints, events=()):
    history = history_of({f"t{place}": one for place, one in enumerate(fingerprints)}, events)
    return history, watch(history, rng=np.random.default_rng(1), draws=300)


@pytest.fixture(scope="module")
def base():
    return taken(fitted("GAUGE-CLOSED", TRUTH, share=0.002, settings=Settings(starts=20, priors=PRIORS)))


P_ACTION, I_ACTION = "governor proportional action", "governor integral action"


def test_an_unchanged_ship_has_no_drift(base):
    history, finding = looked_at([made(place, base) for place in range(5)])
    assert finding.drifts == ()
    assert watch_sentences(finding, history) == ("No change beyond chance in 5 tests from 2024-01-01 to 2024-12-31.",)


@pytest.mark.parametrize(("beyond", "pieces"), [(0, 8), (12, 8), (25, 4), (250, 1)])
def test_draws_end_where_the_rest_could_make_nothing_unlikely(base, monkeypatch, beyond, pieces):
    """Of 2000 in pieces of 250 the 100th beyond decides: (1 + 100) / 2001 is more than one in twenty."""
    history = history_of({f"t{place}": made(place, base) for place in range(5)})
    search = CourseSearch.of(series_of(history, made=5, load_repeatability=0.02), 5)
    drawn = []
    evidence = np.where(np.arange(250) < beyond, np.inf, -1.0)
    monkeypatch.setattr(CourseSearch, "_largest_of", lambda self, looks, noise: drawn.append(noise.shape) or evidence)
    p_value = search.nearest(np.zeros((search.values.size, 2000))).p_value
    assert len(drawn) == pieces
    assert p_value == pytest.approx((1.0 + pieces * beyond) / (1.0 + pieces * 250.0))
    assert (p_value <= 0.05) == (beyond < 13)


def test_a_search_takes_little_more_room_than_its_courses(base):
    """Of a hundred tests the courses take 13 MB, and six times as much was taken to find them."""
    history = history_of({f"t{place}": made(place, base) for place in range(40)})
    series = series_of(history, made=40, load_repeatability=0.02)
    tracemalloc.start()
    search = CourseSearch.of(series, 40)
    found = tracemalloc.get_traced_memory()[1]
    tracemalloc.reset_peak()
    search.likeliest()
    looked_through = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert search.columns.shape == (40 * len(series.names), 2 * 40 * len(series.causes))
    assert found < 4.0 * search.columns.nbytes
    assert looked_through < 5.0 * search.columns.nbytes


def test_a_step_is_found_with_its_size_and_the_test_at_which_it_began(base):
    tests = [made(place, base, **({P_ACTION: 0.95} if place >= 3 else {})) for place in range(6)]
    history, finding = looked_at(tests)
    (drift,) = finding.drifts
    best = drift.best
    assert (best.cause.name, best.shape, best.since) == ("proportional gain of the governor", "step", 3)
    assert best.size == pytest.approx(-0.05, abs=1e-6)
    assert drift.p_value < 1e-3
    sentence = watch_sentences(finding, history)[0]
    assert sentence.startswith("Yes: a lower proportional gain of the governor, by 5.0")
    assert "between 2024-07-01 and 2024-09-30" in sentence


def test_what_was_noted_is_confirmed_with_its_size(base):
    """A governor that somebody set 5 % lower and noted is no alarm, and no "no change" either."""
    tests = [made(place, base, **({P_ACTION: 0.95} if place >= 3 else {})) for place in range(6)]
    noted = Event(kind="governor-changed", at=FIRST + 2.5 * QUARTER)
    history, finding = looked_at(tests, [noted])
    assert finding.drifts == ()
    ((event, changes),) = [(one.event, one.changes) for one in finding.noted]
    assert event == noted
    assert [one.cause.name for one in changes] == ["proportional gain of the governor"]
    assert changes[0].size == pytest.approx(-0.05, abs=1e-6)
    # the same deviation as of a step whose time nobody knew, beside the levels of both times
    _, alone = looked_at(tests)
    assert changes[0].std == pytest.approx(alone.drifts[0].best.std, rel=1e-6)
    first, second = watch_sentences(finding, history)
    assert first == "No change but what was noted in 6 tests from 2024-01-01 to 2025-04-01."
    day = f"{noted.at:%Y-%m-%d}"
    assert second.startswith(
        f"Since the change of the governor on {day}, as noted: a lower proportional gain of the governor, by 5.0"
    )


def test_what_was_noted_and_did_nothing_is_said(base):
    history, finding = looked_at(
        [made(place, base) for place in range(5)], [Event(kind="injectors-changed", at=FIRST + 1.5 * QUARTER)]
    )
    assert [one.changes for one in finding.noted] == [()]
    assert "nothing is other than before by more than chance" in watch_sentences(finding, history)[1]


def test_a_docking_takes_fouling_off_and_what_is_left_is_said(base):
    """Fouling of 4 % a year, of which the dock takes all that was there after two and a half years."""
    dock = 10
    fouled = [0.04 * place / 4.0 - (0.1 if place >= dock else 0.0) for place in range(16)]
    tests = [made(place, base, K_Q=float(np.exp(size))) for place, size in enumerate(fouled)]
    history, finding = looked_at(tests, [Event(kind="docking", at=FIRST + (dock - 0.5) * QUARTER)])
    (drift,) = finding.drifts
    assert (drift.best.cause.name, drift.best.shape, drift.best.is_expected) == ("propeller", "ramp", True)
    (noted,) = finding.noted
    assert noted.changes[0].cause.name == "propeller"
    assert noted.changes[0].size == pytest.approx(np.expm1(-0.1), abs=1e-4)
    # 15 quarters at 1 % less the 10 %
    assert finding.by_now["propeller"].size == pytest.approx(np.expm1(0.05), abs=1e-4)
    first, second, last = watch_sentences(finding, history)
    assert first.startswith("No change but expected wear: more propeller torque at the same speed")
    assert ", 5.1" in first
    assert f" by {history.tests[-1].at:%Y-%m-%d}" in first
    assert second.startswith("Since the docking on ")
    assert last == "What to do: cleaning the propeller takes it off."


def test_a_real_change_stands_before_wear_that_is_expected(base):
    tests = [
        made(place, base, **{"K_Q": float(np.exp(0.02 * place)), P_ACTION: 0.97 if place >= 6 else 1.0})
        for place in range(12)
    ]
    history, finding = looked_at(tests)
    assert [drift.best.is_expected for drift in finding.by_urgency] == [False, True]
    sentences = watch_sentences(finding, history)
    assert sentences[0].startswith("Yes: a lower proportional gain of the governor")
    assert sentences[1].startswith("As expected, beside it more propeller torque")
    assert sentences[-1] == "What to do: read the gains in the control unit; cleaning the propeller takes it off."


def test_a_ramp_is_found_with_its_slope_and_beginning(base):
    """Three per cent a year from the third test on, in logarithms."""
    tests = [made(place, base, I_dn=float(np.exp(0.03 * max(place - 2, 0) / 4.0))) for place in range(12)]
    history, finding = looked_at(tests)
    best = finding.drifts[0].best
    assert (best.cause.name, best.shape, best.since) == ("inertia behind the gauge", "ramp", 2)
    # 91.3125 days are a quarter of 365.25
    assert best.size == pytest.approx(np.expm1(0.03), rel=1e-6)
    assert "by 3.0" in watch_sentences(finding, history)[0]
    assert "a year since 2024-07-01" in watch_sentences(finding, history)[0]


def doubted(test, kind="gauge steadiness"):
    """Return a test whose verdict doubts all that depends on its torque gauge, and is trustworthy in the rest."""
    reason = Reason(kind=kind, sentence="doubt")
    return test.model_copy(update={"verdict": replace(test.verdict, reasons=(reason,))})


def test_a_test_that_its_verdict_doubts_says_nothing_and_takes_nothing_from_the_others(base):
    """The gauge of the second test was off: what the five others show of the gain is found as without it."""
    tests = [made(place, base, **({P_ACTION: 0.95} if place >= 3 else {})) for place in range(6)]
    # what it shows is of no ship
    tests[1] = doubted(made(1, base, **{P_ACTION: 1.3, I_ACTION: 0.7}))
    _, finding = looked_at(tests)
    (drift,) = finding.drifts
    assert (drift.best.cause.name, drift.best.shape, drift.best.since) == (
        "proportional gain of the governor",
        "step",
        3,
    )
    without = looked_at([*tests[:1], *tests[2:]])[1].drifts[0].best
    assert drift.best.size == pytest.approx(without.size, abs=2e-4)
    assert drift.best.std == pytest.approx(without.std, rel=0.02)
    assert P_ACTION in finding.names
    assert finding.left_out == {
        "t1": "all of its numbers: it depends on a torque gauge and a load that stay the same during the test"
    }


def test_numbers_that_half_of_the_tests_doubt_are_not_judged(base):
    tests = [made(place, base) for place in range(6)]
    _, finding = looked_at([doubted(test) if place % 2 else test for place, test in enumerate(tests)])
    assert P_ACTION not in finding.names
    assert P_ACTION in finding.left_out
    assert not any(name.startswith("t") and name[1:].isdigit() for name in finding.left_out)


def test_wear_is_seen_before_anything_else_as_slow(base):
    """What injection loses in a year is seen where a gain of as much is within chance: no engine wears upwards."""

    def worn(per_year):
        shares = [float(np.exp(per_year * place / 4.0)) for place in range(8)]
        return looked_at(
            [made(place, base, **{P_ACTION: share, I_ACTION: share}) for place, share in enumerate(shares)]
        )

    def course(finding):
        drift = finding.drifts[0] if finding.drifts else finding.nearest
        return drift.best

    clear = course(worn(-0.01)[1])
    slow = 0.01 * 3.5 / abs(clear.score)
    history, finding = worn(-slow)
    # beside a score of 4, which anything else asks for
    assert course(finding).score == pytest.approx(-3.5, abs=0.2)
    assert (course(finding).cause.name, course(finding).shape) == ("injection or turbocharger", "ramp")
    assert watch_sentences(finding, history)[0].startswith("Yes: less torque for the same rack")
    assert worn(slow)[1].drifts == ()


def test_the_time_to_a_limit_carries_the_slope_on(base):
    """Three per cent a year in logarithms since 2024-07-01 are six per cent after ln 1.06 / 0.03 = 1.942 years."""
    tests = [made(place, base, I_dn=float(np.exp(0.03 * max(place - 2, 0) / 4.0))) for place in range(12)]
    history, finding = looked_at(tests)
    best = finding.drifts[0].best
    when = time_to_limit(best, 0.06, history)
    begin = history.tests[2].at
    year = timedelta(days=365.25)
    assert (when.at - begin) / year == pytest.approx(np.log(1.06) / 0.03, rel=1e-6)
    std = best.std / (1.0 + best.size)
    assert (when.earliest - begin) / year == pytest.approx(np.log(1.06) / (0.03 + 1.96 * std), rel=1e-3)
    assert (when.latest - begin) / year == pytest.approx(np.log(1.06) / (0.03 - 1.96 * std), rel=1e-3)
    assert time_to_limit(replace(best, std=0.1), 0.06, history).latest is None
    sentence = limit_sentence(finding, best.cause, 0.06, history)
    # 709.4 days after the afternoon of 2024-07-01
    assert sentence.startswith("inertia behind the gauge, 6 %: reached on 2026-06-11 if it goes on as it did (95 % ")
    other = next(cause for cause in CAUSES if cause.name == "propeller")
    assert "no ramp of it is seen" in limit_sentence(finding, other, 0.1, history)
    with pytest.raises(FingerprintError, match="expected a limit above zero and below 100 %, found 0"):
        time_to_limit(best, 0.0, history)
    with pytest.raises(FingerprintError, match="expected a ramp, found a step"):
        time_to_limit(replace(best, shape="step"), 0.06, history)


def test_what_was_done_to_the_governor_is_no_drift_of_it(base):
    tests = [made(place, base, **({P_ACTION: 0.9, I_ACTION: 0.8} if place >= 3 else {})) for place in range(6)]
    event = Event(kind="governor-changed", at=FIRST + 2.5 * QUARTER)
    assert looked_at(tests)[1].drifts
    assert looked_at(tests, [event])[1].drifts == ()
    # a propeller that was polished at that time does not explain the gains
    assert looked_at(tests, [Event(kind="propeller-polished", at=event.at)])[1].drifts


def test_fouling_goes_on_after_a_docking(base):
    """K_Q grows by 4 % a year, falls back in the dock and grows again: one slope, a level of each epoch."""
    growth = [0.01 * place for place in range(6)] + [0.01 * place for place in range(6)]
    tests = [made(place, base, K_Q=float(np.exp(share))) for place, share in enumerate(growth)]
    _, finding = looked_at(tests, [Event(kind="docking", at=FIRST + 5.5 * QUARTER)])
    best = finding.drifts[0].best
    assert (best.cause.name, best.shape) == ("propeller", "ramp")
    assert best.size == pytest.approx(np.expm1(0.04), rel=1e-6)
    assert len(finding.drifts) == 1


@pytest.mark.parametrize(("before_m", "since_m", "changed"), [(None, None, True), (3.0, 3.0, True), (3.0, 3.3, False)])
def test_torque_that_goes_with_the_draught_is_no_change_of_the_propeller(base, before_m, since_m, changed):
    """K_Q is 5 % higher from the fifth test on; a draught of 10 % more takes 6.6 % by the Admiralty coefficient."""
    tests = [
        _at_draught(made(place, base, K_Q=1.05 if place >= 4 else 1.0), since_m if place >= 4 else before_m)
        for place in range(8)
    ]
    _, finding = looked_at(tests)
    assert [one.best.cause.name for one in finding.drifts] == ["propeller"] * changed


def test_an_unstated_draught_is_the_mean_of_the_tests_that_were_made_whatever_the_horizon(base):
    tests = [_at_draught(base, draught_m) for draught_m in (2.0, None, 3.0)]
    # of 2 and 3 m each is half of log(1.5) beside the mean, and two thirds of that is the torque's
    for horizon in (3, 20):
        extended = [*tests, *tests[-1:] * (horizon - 3)]
        assert _with_draught(extended, 3)[:3] == pytest.approx(np.array([-1.0, 0.0, 1.0]) * np.log(1.5) / 3.0)


def _at_draught(test, draught_m):
    return test.model_copy(update={"conditions": test.conditions.model_copy(update={"draught_m": draught_m})})


def test_two_tests_say_what_a_comparison_says(base):
    """The size is that of the pair; the probability is of a ship that is looked at for years."""
    tests = [made(0, base), made(1, base, omega_n=0.97)]
    pair = differ(*tests).changes[0].best
    best = looked_at(tests)[1].drifts[0].best
    assert best.cause == pair.cause
    assert best.size == pytest.approx(pair.size, rel=1e-6)
    assert best.std == pytest.approx(pair.std, rel=0.01)


def test_a_recording_counts_once(base):
    again = made(1, base)
    history = history_of(
        {
            "a": made(0, base),
            "b": made(1, base),
            "c": again.model_copy(update={"created": datetime(2030, 1, 1, tzinfo=UTC)}),
        }
    )
    assert [test.name for test in history.tests] == ["a", "c"]
    assert history.left_out == {"b": "it is of the same recording as c"}


def test_tests_that_cannot_be_judged_are_left_out(base):
    doubtful = made(1, base)
    doubtful = doubtful.model_copy(update={"verdict": replace(doubtful.verdict, trustworthy=False)})
    earlier = made(2, base).model_copy(update={"joint": None})
    history, finding = looked_at([made(0, base), doubtful, earlier])
    assert set(history.left_out) == {"t1", "t2"}
    assert watch_sentences(finding, history) == (
        "It cannot be told: expected 2 tests that can be judged or more, found 1.",
    )


def test_a_test_without_its_time_is_refused(base):
    with pytest.raises(FingerprintError, match="t1: expected when the test was made, with time zone, found nothing"):
        history_of(
            {
                "t0": made(0, base),
                "t1": base.model_copy(update={"conditions": base.conditions.model_copy(update={"tested_at": None})}),
            }
        )


@pytest.mark.parametrize(("kind", "at"), [("paint", FIRST), ("docking", datetime(2024, 1, 1))])  # noqa: DTZ001
def test_events_that_cannot_be_are_refused(kind, at):
    with pytest.raises(FingerprintError, match="event"):
        Event(kind=kind, at=at)


@pytest.mark.slow
def test_false_alarms_are_as_rare_as_stated(base):
    """Forty ships of ten tests, drawn with the covariance that the tests state: 5 % is two of them, six are 1 in 70."""
    rng = np.random.default_rng(3)
    values = np.array([base.quantity(name).value for name in base.joint.names])
    alarms = 0
    for ship in range(40):
        drawn = rng.multivariate_normal(np.zeros(values.size), np.array(base.joint.own_covariance), size=10)
        tests = [
            made(place, base, **dict(zip(base.joint.names, 1.0 + errors / values, strict=True)))
            for place, errors in enumerate(drawn)
        ]
        history = history_of({f"t{place}": one for place, one in enumerate(tests)})
        found = watch(history, rng=np.random.default_rng(ship), draws=300, load_repeatability=0.0, horizon=10)
        alarms += bool(found.drifts)
    assert alarms <= 5


# ---- another version of the program ----


def by(version, fingerprint):
    return fingerprint.model_copy(update={"shaftprint_version": version})


def test_another_version_of_the_program_is_no_change_of_the_ship(base):
    """Gains a twentieth lower from the test on that another version identified: it may be the program."""
    tests = [by("0.1.0", made(place, base)) for place in range(3)]
    tests += [by("0.2.0", made(place, base, **{P_ACTION: 0.95})) for place in range(3, 6)]
    history, finding = looked_at(tests)
    (epoch,) = history.events
    assert (epoch.kind, epoch.at, epoch.note) == (
        "program-changed",
        FIRST + 3 * QUARTER,
        "shaftprint 0.1.0 before, 0.2.0 from then on",
    )
    assert finding.drifts == ()
    # stated by hand, it is not repeated
    stated = Event(kind="program-changed", at=FIRST + 2.5 * QUARTER)
    assert looked_at(tests, [stated])[0].events == (stated,)


@pytest.mark.parametrize(("moved", "sees"), [(0.1, True), (0.3, False)])
def test_a_recording_that_both_versions_identified_shows_whether_they_find_the_same(base, moved, sees):
    """Up to a fifth of a standard deviation both are one program, and the change is the ship's."""
    gain = base.quantity(P_ACTION)
    factor = 1.0 + moved * gain.std / gain.value
    tests = [by("0.1.0", made(place, base)) for place in range(3)]
    tests += [by("0.2.0", made(place, base, **{P_ACTION: 0.95})) for place in range(3, 6)]
    again = by("0.2.0", made(1, base, **{P_ACTION: factor}))
    history, finding = looked_at([*tests, again.model_copy(update={"created": base.created + timedelta(days=1)})])
    assert len(history.tests) == 6
    # one test in the middle is of the other version too: there and back again, where they differ
    assert bool(finding.drifts) is sees
    assert ([one.kind for one in history.events] == []) is sees
