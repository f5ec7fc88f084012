"""Free-sailing structures against the equations themselves, solved frequency by frequency."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.models import check_structure
from shaftprint.models._margins import poles

OMEGA_RAD_S = np.geomspace(1e-3, 30.0, 40)
# A Stan Tug at 9.9 kn: slopes of Ka4-70 at J 0.494, inertia times of gauge and ship.
TUG = {
    "a": -0.9018,
    "b": -0.4084,
    "e": 4.0,
    "tau_u": 6.78,
    "tau_dn": 0.222,
    "tau_up": 0.70,
    "g": -0.3,
    "K_p": 5.7,
    "K_i": 4.27,
    "t_d": 0.0703,
    "omega_n": 10.3,
    "zeta": 0.47,
    "t_sp": 0.0518,
    "p": 2.36,
    "q": 2.65,
    "tau_th": 1.3,
}


def response(name, **change):
    model = structure(name)
    values = model.vector({k: v for k, v in (TUG | change).items() if k in model.names})
    return dict(zip(model.channels, model.response(values, 1j * OMEGA_RAD_S), strict=True))


def ship(n_set, theta_set, *, shafts=((1.0, 1.0),), **change):
    """Solve the equations of shafts, governors and one ship at each frequency; nothing is eliminated by hand.

    ``shafts`` holds the share of the thrust of each shaft and the factor on its set point. Returns ``n`` and ``M_s`` of
    the first shaft and ``v``, each (frequencies,).
    """
    x = TUG | change
    found = []
    for s in 1j * OMEGA_RAD_S:
        count = len(shafts)
        # unknowns: of each shaft n, M_s, M_b, Q, T; then v
        left, right = np.zeros((5 * count + 1, 5 * count + 1), dtype=complex), np.zeros(5 * count + 1, dtype=complex)
        v = 5 * count
        theta = theta_set / (x["tau_th"] * s + 1.0)
        lag = x["omega_n"] ** 2 / (s**2 + 2 * x["zeta"] * x["omega_n"] * s + x["omega_n"] ** 2)
        governor = (x["K_p"] + x["K_i"] / s) * np.exp(-s * x["t_d"]) * lag
        for k, (share, follows) in enumerate(shafts):
            n, m_s, m_b, torque, thrust = range(5 * k, 5 * k + 5)
            # tau_up s n = M_b - M_s;  tau_dn s n = M_s - Q
            left[n, [n, m_b, m_s]] = x["tau_up"] * s, -1.0, 1.0
            left[m_s, [n, m_s, torque]] = x["tau_dn"] * s, -1.0, 1.0
            # M_b = g n + C (n_set - n)
            left[m_b, [m_b, n]] = 1.0, governor - x["g"]
            right[m_b] = governor * np.exp(-s * x["t_sp"]) * n_set * follows
            # Q = (2 - b) n + b v + q theta;  T = (2 - a) n + a v + p theta
            left[torque, [torque, n, v]] = 1.0, x["b"] - 2.0, -x["b"]
            right[torque] = x["q"] * theta
            left[thrust, [thrust, n, v]] = 1.0, x["a"] - 2.0, -x["a"]
            right[thrust] = x["p"] * theta
            left[v, thrust] = -share
        left[v, v] = x["tau_u"] * s + x["e"]
        solved = np.linalg.solve(left, right)
        found.append([solved[0], solved[1], solved[v]])
    return np.array(found).T


def test_closed_loop_is_that_of_the_equations():
    n, m_s, v = ship(1.0, 0.0)
    found = response("FREE-LOG")
    assert found["n", "n_set"] == pytest.approx(n, rel=1e-10)
    assert found["M_s", "n_set"] == pytest.approx(m_s, rel=1e-10)
    assert found["v_s", "n_set"] == pytest.approx(v, rel=1e-10)
    closed = response("FREE-CLOSED")
    assert all(np.array_equal(closed[channel], found[channel]) for channel in closed)


def test_core_is_speed_over_torque():
    n, m_s, v = ship(1.0, 0.0)
    assert response("FREE-CORE")["n", "M_s"] == pytest.approx(n / m_s, rel=1e-10)
    assert response("FREE-SHIP")["n", "M_s"] == pytest.approx(n / m_s, rel=1e-10)
    assert response("FREE-SHIP")["v_s", "M_s"] == pytest.approx(v / m_s, rel=1e-10)


def test_pitch_against_the_governor():
    n, m_s, v = ship(0.0, 1.0)
    found = response("FREE-PITCH")
    assert found["n", "theta_set"] == pytest.approx(n, rel=1e-9)
    assert found["M_s", "theta_set"] == pytest.approx(m_s, rel=1e-9)
    assert found["v_s", "theta_set"] == pytest.approx(v, rel=1e-9)
    n, m_s, v = ship(1.0, 0.0)
    assert found["n", "n_set"] == pytest.approx(n, rel=1e-10)
    assert found["v_s", "n_set"] == pytest.approx(v, rel=1e-10)


def test_governor_takes_the_speed_back_after_a_step_of_pitch():
    """Slowly the integrator holds the speed, the torque rises by ``q + b p / (e - a)``, the ship by ``p / (e - a)``."""
    found = response("FREE-PITCH")
    settled = TUG["p"] / (TUG["e"] - TUG["a"])
    assert abs(found["n", "theta_set"][0]) < 1e-3
    assert found["v_s", "theta_set"][0] == pytest.approx(settled, rel=5e-3)
    assert found["M_s", "theta_set"][0] == pytest.approx(TUG["q"] + TUG["b"] * settled, rel=5e-3)


def test_two_shafts_that_move_together_are_one():
    """Both drive one speed state; ``tau_u`` is that of the whole ship."""
    both = ship(1.0, 0.0, shafts=((0.5, 1.0), (0.5, 1.0)))
    found = response("FREE-LOG")
    for channel, value in zip((("n", "n_set"), ("M_s", "n_set"), ("v_s", "n_set")), both, strict=True):
        assert found[channel] == pytest.approx(value, rel=1e-9)


def test_one_of_two_shafts_has_half_the_hold_on_the_ship():
    """The other's governor holds its speed; here a hundred times stronger, so that it nearly does."""
    n, m_s, v = ship(1.0, 0.0, shafts=((0.5, 1.0), (0.5, 0.0)), K_i=427.0, K_p=40.0, t_d=0.0, omega_n=1e4, zeta=0.7)
    found = response("FREE-LOG", sigma=0.5, K_i=427.0, K_p=40.0, t_d=0.0, omega_n=1e4, zeta=0.7)
    core = response("FREE-CORE", sigma=0.5)["n", "M_s"]
    assert core == pytest.approx(n / m_s, rel=1e-3)
    assert found["v_s", "n_set"] / found["n", "n_set"] == pytest.approx(v / n, rel=0.01)
    assert np.abs(core / response("FREE-CORE")["n", "M_s"] - 1.0).max() > 0.05


@pytest.mark.parametrize(("a", "b"), [(-0.9, -0.41), (-1.26, -0.58), (-2.7, -1.13), (0.0, 0.0)])
def test_slowly_the_gain_is_one_half_where_resistance_is_quadratic(a, b):
    model = structure("FREE-CORE")
    values = model.vector({"a": a, "b": b, "e": 2.0, "tau_u": 6.8, "tau_dn": 0.3})
    assert model.response(values, [0.0])[0, 0] == pytest.approx(0.5, rel=1e-14)


def test_between_the_corners_the_ship_stands_still():
    """A heavy ship and a light shaft: the gain is ``1 / (2 - b)``; 0.415 for the tug at full speed, 0.5 at the quay."""
    model = structure("FREE-CORE")
    values = model.vector({"a": -0.9018, "b": -0.4084, "e": 4.0, "tau_u": 200.0, "tau_dn": 1e-4})
    assert abs(model.response(values, [2j])[0, 0]) == pytest.approx(0.415, abs=5e-4)


@pytest.mark.parametrize(
    ("a", "b", "e", "tau_u", "tau_n", "expected"),
    [
        # 9.9 kn at 1800 rpm
        (-0.9018, -0.4084, 4.0, 6.78, 0.9217, (-0.63, -2.71)),
        # 7 kn at 1183.8 rpm with w .15, t .12 and e 2.5
        (-1.262, -0.583, 2.5, 12.33, 1.496, (-0.24, -1.80)),
    ],
)
def test_poles_of_shaft_and_ship(a, b, e, tau_u, tau_n, expected):
    model = structure("FREE-CORE").free_between(tau_dn=(0.0, 5.0))
    found = poles(model, model.vector({"a": a, "b": b, "e": e, "tau_u": tau_u, "tau_dn": tau_n}))
    assert found.imag == pytest.approx([0.0, 0.0])
    assert sorted(found.real, reverse=True) == pytest.approx(expected, abs=5e-3)


def test_at_the_quay_it_is_the_gauge_aware_line():
    quay, gauge = structure("FREE-CLOSED"), structure("GAUGE-CLOSED")
    known = {k: v for k, v in TUG.items() if k in gauge.names}
    found = quay.response(quay.vector(known | {"a": 0.0, "b": 0.0, "e": 2.0, "tau_u": 50.0}), 1j * OMEGA_RAD_S)
    assert found == pytest.approx(gauge.response(gauge.vector(known | {"k_q": 2.0}), 1j * OMEGA_RAD_S), rel=1e-12)


@pytest.mark.parametrize("name", ["FREE-CORE", "FREE-SHIP", "FREE-CLOSED", "FREE-LOG", "FREE-PITCH"])
def test_derivatives_are_those_of_the_response(name):
    model = structure(name)
    values = model.vector({k: v for k, v in (TUG | {"sigma": 0.8}).items() if k in model.names})
    _, slopes = model.gradient(values, 1j * OMEGA_RAD_S, model.names)
    for place, parameter in enumerate(model.names):
        step = 1e-5 * max(abs(values[place]), 1e-2)
        moved = [values + sign * step * np.eye(values.size)[place] for sign in (1, -1)]
        ahead, behind = (model.response(value, 1j * OMEGA_RAD_S) for value in moved)
        scale = np.abs(slopes[place]).max()
        assert slopes[place] == pytest.approx((ahead - behind) / (2.0 * step), rel=1e-6, abs=1e-6 * scale), parameter


def test_blocks_agree_with_themselves():
    check_structure(structure("FREE-CORE").free_between(sigma=(0.3, 1.0)))
