"""What a vessel file states of a ship that is stopped by its clutches."""

import pytest

from shaftprint.errors import SettingsError
from shaftprint.simulation import stopped_ship
from shaftprint.vessel import load_vessel

# PT May underway: 3422 N m at the shaft, 6.16 to 1 with 0.97, clutches of 3600 N m, 2500 N m at most at 1600 rpm
BRAKE_NM = 3422.0 / (6.16 * 0.97)


def test_stated_values_are_those_of_the_vessel_file_over_its_working_point():
    ship = stopped_ship(load_vessel("pt-may-underway"))
    stated = {name: one.value for name, one in ship.stated.items()}
    assert ship.structure.name == "CRASH-STOP"
    assert ship.speed_m_s == 5.0
    assert stated["m_c"] == pytest.approx(3600.0 / BRAKE_NM)
    assert stated["m_max"] == pytest.approx(2500.0 / BRAKE_NM)
    assert stated["i_r"] == 1.0
    # m v / R of 110 t with 6 % of added mass at 5 m/s against 24,020 N
    assert stated["tau_u"] == pytest.approx(1.06 * 110e3 * 5.0 / 24020.0)
    assert (stated["w"], ship.stated["w"].std) == (0.15, 0.05)
    # I 2 pi n_s / M_s of 70.9 kg m2
    assert stated["tau_dn"] == pytest.approx(70.9 * 2.0 * 3.141592653589793 * 1600.0 / 60.0 / 6.16 / 3422.0)
    assert {"K_p", "t_d", "tau_dn"} <= ship.of_the_line
    assert not {"w", "tau_u", "m_c"} & ship.of_the_line


def test_a_ship_at_the_quay_lists_all_that_is_missing():
    with pytest.raises(SettingsError, match=r"crash stop expects working_point\.ship_speed_m_s .*astern_ratio"):
        stopped_ship(load_vessel("stan-tug-1205"))
