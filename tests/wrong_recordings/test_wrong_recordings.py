"""Wrong recordings are refused or not trusted, with the cause; wrong and trusted: none."""

import pytest
from tests.wrong_recordings.cases import CASES, FAST, Case
from tests.wrong_recordings.judged import answer, fingerprint_of, is_right, true_values
from tests.wrong_recordings.trial import clean

SLOW = tuple(case for case in CASES if not case.fast)


def expect_right_answer(case: Case) -> None:
    found = answer(case)
    assert found.passes, f"{found.outcome}: {', '.join(found.wrong)}; {found.words}"


def test_there_are_enough_cases():
    assert len(CASES) >= 80
    assert len({case.name for case in CASES}) == len(CASES)
    assert len(FAST) == 11


def test_the_recording_that_was_not_spoilt_is_trusted_and_right():
    """Refusing everything is no answer: the good recording keeps its numbers, and no reason speaks against it."""
    trial, _ = clean()
    fingerprint = fingerprint_of(trial)
    assert fingerprint.verdict.trustworthy
    assert fingerprint.verdict.reasons == ()
    assert {"I_dn", "K_Q", "k_q", "t_d + t_sp", "gain margin", "n_0"} <= set(fingerprint.verdict.trusted)
    truth = true_values()
    assert all(is_right(fingerprint.quantity(name), truth[name]) for name in ("I_dn", "K_Q", "t_d + t_sp"))


@pytest.mark.parametrize("case", FAST, ids=lambda case: case.name)
def test_wrong_recording(case):
    expect_right_answer(case)


@pytest.mark.wrong_recordings
@pytest.mark.parametrize("case", SLOW, ids=lambda case: case.name)
def test_every_wrong_recording(case):
    expect_right_answer(case)
