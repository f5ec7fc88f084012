"""A latency of the set point below nothing is taken where the data clearly want it."""

from tests.wrong_recordings import mutations
from tests.wrong_recordings.judged import fingerprint_of
from tests.wrong_recordings.trial import ONE_SPEED, SET_POINT, clean


def test_chance_takes_no_latency_below_nothing_and_a_late_set_point_does():
    """80 ms take 10 of the true latency's 52 below nothing where one standard deviation is 22: that is chance."""
    trial = clean(ONE_SPEED)[0]
    by_chance, late = (fingerprint_of(mutations.late(one, SET_POINT)(trial)) for one in (0.08, 0.2))
    assert by_chance.quantity("t_sp").value == 0.0
    assert late.quantity("t_sp").value < -0.08
