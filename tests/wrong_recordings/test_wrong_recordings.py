"""Wrong recordings are refused or not trusted, with the cause; wrong and trusted: none."""

import pytest
from tests.wrong_recordings import mutations
from tests.wrong_recordings.case import Case
from tests.wrong_recordings.cases import CASES
from tests.wrong_recordings.judged import answer, fingerprint_of, is_right, true_values
from tests.wrong_recordings.legs import CASES_OF_LEGS
from tests.wrong_recordings.trial import ONE_SPEED, SET_POINT, TWO_SPEEDS, clean

FAST = tuple(case for case in CASES if case.fast)
# neighbours in the list are of one kind: of those that are not dear, one in four stands for them before a release
OFTEN = frozenset(case.name for case in CASES[::4])


def marked(case: Case) -> object:
    """Return a case that is not of every test run: two speeds, other ships, three of four others are for a release."""
    often = case.test == ONE_SPEED and not case.ship and case.name in OFTEN
    long = [] if often else [pytest.mark.long]
    return pytest.param(case, id=f"{case.test.file} {case.name}", marks=[pytest.mark.wrong_recordings, *long])


def expect_right_answer(case: Case) -> None:
    found = answer(case)
    assert found.passes, f"{found.outcome}: {', '.join(found.wrong)}; {found.words}"


def test_there_are_enough_cases():
    assert len(CASES) >= 150
    assert len(CASES_OF_LEGS) >= 150
    for cases in (CASES, CASES_OF_LEGS):
        assert len({case.name for case in cases}) == len(cases)
    assert len(FAST) == 11


def expect_trusted_and_right(test):
    """Refusing everything is no answer: a good recording keeps its numbers, and no reason speaks against it."""
    fingerprint, truth = fingerprint_of(clean(test)[0]), true_values(test)
    assert fingerprint.verdict.trustworthy
    assert fingerprint.verdict.reasons == ()
    assert {"I_dn", "K_Q", "k_q", "t_d + t_sp", "gain margin", "n_0"} <= set(fingerprint.verdict.trusted)
    assert all(is_right(fingerprint.quantity(name), truth[name]) for name in ("I_dn", "K_Q", "t_d + t_sp"))


def test_the_recording_that_was_not_spoilt_is_trusted_and_right():
    expect_trusted_and_right(ONE_SPEED)


@pytest.mark.parametrize("late_s", [0.15, pytest.param(0.3, marks=pytest.mark.wrong_recordings)])
def test_a_set_point_that_is_logged_late_costs_what_rests_on_its_clock_alone(late_s):
    """All else is what it is without: where the latency stopped at nothing, nothing was left to be trusted."""
    trial = clean(ONE_SPEED)[0]
    clock = ("t_sp", "t_d + t_sp")
    sound, late = fingerprint_of(trial), fingerprint_of(mutations.late(late_s, SET_POINT)(trial))
    for one in (*late.parameters, *late.combinations, *late.margins):
        before = sound.quantity(one.name)
        moved = late_s if one.name in clock else 0.0
        # its slow lines tell the slope of the set point, its noise is another at each moment
        assert one.value == pytest.approx(before.value - moved, abs=(1.0 if one.name == "c_set" else 0.05) * before.std)
    assert set(sound.verdict.trusted) - set(late.verdict.trusted) == {"t_d + t_sp"}
    assert "t_sp" not in late.verdict.trusted


@pytest.mark.parametrize("late_s", [0.06, 0.08])
def test_a_set_point_that_is_late_within_chance_leaves_the_truth_in_the_intervals(late_s):
    """The latency stands at nothing, or near it, and what rests on it reaches to where one below nothing had it."""
    late = fingerprint_of(mutations.late(late_s, SET_POINT)(clean(ONE_SPEED)[0]))
    truth = true_values(ONE_SPEED)
    assert late.quantity("t_sp").value >= 0.0
    moved = {"t_sp", "t_d + t_sp"}
    assert [one for one in late.verdict.trusted if one in truth.keys() - moved] != []
    for name in ("t_d", "omega_n", "zeta", "K_p / K_i", "gain margin", "phase margin", "delay margin"):
        assert is_right(late.quantity(name), truth[name]), name


@pytest.mark.wrong_recordings
def test_the_two_speeds_that_were_not_spoilt_are_trusted_and_right():
    expect_trusted_and_right(TWO_SPEEDS)


@pytest.mark.parametrize("case", FAST, ids=lambda case: case.name)
def test_wrong_recording(case):
    expect_right_answer(case)


@pytest.mark.parametrize("case", [marked(case) for case in (*CASES, *CASES_OF_LEGS) if case not in FAST])
def test_every_wrong_recording(case):
    expect_right_answer(case)
