"""A first test whose set point came late is no hindrance to the next plan."""

from tests.wrong_recordings import mutations
from tests.wrong_recordings.judged import fingerprint_of
from tests.wrong_recordings.trial import ONE_SPEED, SET_POINT, clean

from shaftprint.catalogue import structure
from shaftprint.design.inputs._known_ship import ship_of_fingerprint


def test_a_test_is_planned_after_one_whose_set_point_came_late():
    late = fingerprint_of(mutations.late(0.2, SET_POINT)(clean(ONE_SPEED)[0]))
    assert ship_of_fingerprint(late, structure(late.structure)).by_name["t_sp"] == 0.0
