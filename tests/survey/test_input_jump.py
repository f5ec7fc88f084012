"""Samples that the channel of the set point lost are told; those that all channels lost change nothing."""

import pytest
from tests.wrong_recordings import mutations
from tests.wrong_recordings.judged import fingerprint_of, is_right, true_values
from tests.wrong_recordings.trial import ONE_SPEED, SET_POINT, clean


@pytest.mark.parametrize(
    ("begin_s", "lost_s"),
    [(430.0, 0.06), pytest.param(430.0, 0.1, marks=pytest.mark.slow), (645.0, 0.02)],
)
def test_samples_that_the_set_point_lost_are_told(begin_s, lost_s):
    """During the slowest lines 60 ms made a trusted ratio of gains a quarter too large."""
    trial, _ = clean(ONE_SPEED)
    spoilt = fingerprint_of(mutations.cut_out(begin_s, begin_s + lost_s, SET_POINT)(trial))
    assert spoilt.verdict.reasons[0].sentence.startswith("The clock of n_set is in doubt: from S")
    assert f"{1e3 * lost_s:.0f} ms earlier than the campaign file asks" in spoilt.verdict.reasons[0].sentence
    assert spoilt.verdict.trusted == ()


@pytest.mark.parametrize("begin_s", [430.0, pytest.param(645.0, marks=pytest.mark.slow)])
def test_samples_that_all_channels_lost_change_nothing(begin_s):
    trial, _ = clean(ONE_SPEED)
    sound = fingerprint_of(trial)
    shorter = fingerprint_of(mutations.cut_out(begin_s, begin_s + 0.1, *trial.recording.channels)(trial))
    truth = true_values(ONE_SPEED)
    assert shorter.verdict.reasons == ()
    assert set(shorter.verdict.trusted) == set(sound.verdict.trusted)
    assert all(is_right(shorter.quantity(name), truth[name]) for name in ("K_p / K_i", "t_d + t_sp", "gain margin"))
