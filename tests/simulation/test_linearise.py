"""Steady running and small signals away from the working point, against the thesis' scaling and hand-made numbers."""

import numpy as np
import pytest

from shaftprint.errors import StructureError
from shaftprint.models import limited, structure
from shaftprint.simulation import equilibrium, linearise

TRUTH = {
    "tau_up": 1.016,
    "tau_dn": 0.32,
    "K_p": 5.7,
    "K_i": 4.27,
    "t_d": 0.0703,
    "omega_n": 10.3,
    "zeta": 0.47,
    "t_sp": 0.0518,
    "k_q": 2.0,
    "g": 0.0,
}
OMEGA = np.geomspace(0.03, 30.0, 25)


def test_steady_speed_follows_the_set_point_and_torque_its_square():
    found = equilibrium(limited(), limited().vector(TRUTH), {"n_set": -0.3})
    # 0.7 of the speed takes 0.49 of the torque
    assert found.outputs["n"] == pytest.approx(-0.3, abs=1e-12)
    assert found.outputs["M_s"] == pytest.approx(-0.51, abs=1e-12)


def test_torque_limit_keeps_the_ship_below_its_set_point():
    ship = limited("torque")
    found = equilibrium(ship, ship.vector(TRUTH | {"m_max": 1.44}), {"n_set": 0.5})
    # 1.44 times the torque turns the propeller 1.2 times as fast
    assert found.outputs["n"] == pytest.approx(0.2, abs=1e-9)
    assert found.outputs["M_s"] == pytest.approx(0.44, abs=1e-9)


def test_droop_lowers_the_speed_by_the_rack():
    ship = limited().held_at(droop=0.04)
    found = equilibrium(ship, ship.vector(TRUTH | {"droop": 0.04}), {"n_set": 0.1})
    # e = R X with X = M_b = (1 + n)^2 - 1
    n = found.outputs["n"]
    assert 0.1 - n == pytest.approx(0.04 * ((1.0 + n) ** 2 - 1.0), abs=1e-12)
    assert 0.08 < n < 0.1


@pytest.mark.parametrize("shift", [-0.42843, 0.41578, 0.0])
def test_inertia_times_and_gains_fall_with_the_speed_of_the_working_point(shift):
    # thesis eqs 2.14-2.25 at the quay: tau, K_p and K_i go with 1 / n_0 for one inertia and one governor
    ship = limited()
    about = linearise(ship, ship.vector(TRUTH), {"n_set": shift}).response(1j * OMEGA, normalised=True)
    linear = structure("GAUGE-CLOSED")
    there = {name: TRUTH[name] / (1.0 + shift) for name in ("tau_up", "tau_dn", "K_p", "K_i")}
    expected = linear.response(linear.vector(TRUTH | there), 1j * OMEGA)
    np.testing.assert_allclose(about, expected, rtol=1e-9)


def test_inertia_time_of_the_reference_ship_at_other_speeds():
    # 17 kg m2: 0.560 s at 676.6 rpm and 0.226 s at 1676.6 rpm, 0.320 s at 1183.8 rpm
    ship = limited()
    for speed_rpm, tau_s in ((676.6, 0.560), (1676.6, 0.226)):
        about = linearise(ship, ship.vector(TRUTH), {"n_set": speed_rpm / 1183.8 - 1.0})
        speed, torque = about.response([1j * 1e-3], normalised=True)
        # torque over speed is 2 + tau_dn s
        assert (torque / speed)[0].imag / 1e-3 == pytest.approx(tau_s, abs=1e-3)


def test_a_limited_engine_no_longer_answers_the_set_point():
    ship = limited("torque")
    found = linearise(ship, ship.vector(TRUTH | {"m_max": 1.44}), {"n_set": 0.5}).response([0.1j])
    assert np.abs(found).max() < 1e-9


def test_missing_input_is_named():
    ship = limited()
    with pytest.raises(StructureError, match=r"expected the inputs n_set, found speed"):
        equilibrium(ship, ship.vector(TRUTH), {"speed": 0.1})
