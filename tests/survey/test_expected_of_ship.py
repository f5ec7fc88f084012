"""What a vessel file lets be expected of a ship, beside the truth of the simulated one."""

import pytest

from shaftprint.catalogue import structure
from shaftprint.survey._expected_of_ship import expected_of_ship
from shaftprint.tug import like_stan_tug_1205, normalised_truth
from shaftprint.vessel import load_vessel


def test_slopes_and_time_of_the_ship_are_those_of_the_simulated_tug():
    vessel = load_vessel("stan-tug-1205-underway")
    truth = normalised_truth(like_stan_tug_1205(vessel, offset_v=-6.66), vessel)
    expected = expected_of_ship(structure("FREE-LOG"), vessel)
    # stated to two digits: the pull of the propellers meets the resistance nearly at 4.75 m/s
    for name in ("a", "b", "e", "tau_u"):
        assert expected[name] == pytest.approx(truth[name], rel=0.03), name


def test_without_a_series_or_a_wake_the_slopes_are_not_known():
    vessel = load_vessel("stan-tug-1205-underway")
    propeller = vessel.propeller.model_copy(update={"series": None})
    assert set(expected_of_ship(structure("FREE-LOG"), vessel.model_copy(update={"propeller": propeller}))) == {
        "e",
        "tau_u",
    }
    hull = vessel.hull.model_copy(update={"wake_fraction": None})
    assert set(expected_of_ship(structure("FREE-LOG"), vessel.model_copy(update={"hull": hull}))) == {"e", "tau_u"}
    assert expected_of_ship(structure("GAUGE-CLOSED"), vessel) == {}


def test_a_pitch_has_its_lag_and_the_slope_of_its_series():
    vessel = load_vessel("nifs-research-vessel")
    truth = normalised_truth(like_stan_tug_1205(vessel), vessel)
    expected = expected_of_ship(structure("GAUGE-PITCH"), vessel)
    assert (expected["tau_th"], expected["t_th"]) == (vessel.pitch.lag_s, vessel.pitch.delay_s)
    assert expected["q"] == pytest.approx(truth["q"], rel=0.02)
    assert expected_of_ship(structure("GAUGE-CLOSED"), vessel) == {}


def test_a_combinator_has_its_slope():
    vessel = load_vessel("nifs-research-vessel-combinator")
    # 0.001 of P/D a revolution per minute, at 600 rpm and P/D 0.80
    assert expected_of_ship(structure("GAUGE-COMBINATOR"), vessel)["c_comb"] == pytest.approx(0.75)


def test_at_the_quay_with_a_fixed_pitch_nothing_is_expected():
    assert expected_of_ship(structure("FREE-LOG"), load_vessel("stan-tug-1205")) == {}
