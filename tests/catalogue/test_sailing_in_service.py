"""The free-sailing ship that service is compared with: against the linear structure, and against open-water curves."""

import numpy as np
import pytest
from tests.catalogue.sailing_at_large import sailing_at_large
from tests.simulation.test_sailing_at_large import OMEGA, PROPELLER, SHIP

from shaftprint.catalogue import structure
from shaftprint.catalogue._limited import limited
from shaftprint.catalogue._sailing_at_large import SAILING, steady_ship, taken_slope
from shaftprint.simulation import equilibrium, simulate

A, B = (float(slope) for slope in PROPELLER.slopes(np.asarray(0.2)))
OWN = {name: value for name, value in SHIP.items() if name != "sigma"} | {"a": A, "b": B}
WIDE = {"m_max": 6.0, "m_min": -2.0}


@pytest.fixture(scope="module")
def ship():
    return limited("torque", load=SAILING)


def test_small_signals_are_those_of_the_slopes(ship):
    linear = structure("FREE-CLOSED")
    expected = linear.response(linear.vector(OWN | {"sigma": 1.0}), 1j * OMEGA)
    found = ship.response(ship.vector(OWN | WIDE), 1j * OMEGA)
    for output in ("n", "M_s"):
        place = list(ship.outputs).index(output)
        np.testing.assert_allclose(found[place], expected[list(linear.outputs).index(output)], rtol=1e-9)


@pytest.mark.parametrize("n", [-0.4, -0.1, 0.15])
def test_steady_running_is_where_thrust_meets_resistance(ship, n):
    found = equilibrium(ship, ship.vector(OWN | WIDE), {"n_set": n})
    v = found.outputs["v"]
    # d = J^2 K'' / K is -0.45
    thrust = (1.0 + n) ** 2 + A * (1.0 + n) * (v - n) - 0.225 * (v - n) ** 2
    assert thrust == pytest.approx((1.0 + v) ** 4.0, rel=1e-9)
    assert found.outputs["M_s"] == pytest.approx((1.0 + n) ** 2 + B * (1.0 + n) * (v - n) - 0.225 * (v - n) ** 2 - 1.0)
    assert steady_ship(np.array([n]), A, 4.0) == pytest.approx([v], rel=1e-9)


@pytest.mark.parametrize("n", [-0.3, 0.1])
def test_moves_of_a_lever_are_those_of_the_curves_within_a_hundredth(ship, n):
    """Of what shaft and torque move, ten seconds long, on the way and where it has settled."""
    curves = sailing_at_large(PROPELLER, "torque")
    time = np.arange(0.0, 12.0, 0.005)
    demand = n * np.clip(time - 1.0, 0.0, 1.0)
    own = simulate(ship, ship.vector(OWN | WIDE), time, {"n_set": demand}).outputs
    true = simulate(curves, curves.vector(SHIP | WIDE | {"w": 0.2}), time, {"n_set": demand}).outputs
    for mine, theirs in (("n", "n"), ("M_s", "M_s"), ("v", "v_s")):
        assert np.abs(own[mine] - true[theirs]).max() < 0.012 * np.ptp(true[theirs]), mine


def test_a_ship_that_is_faster_at_first_comes_to_rest_with_its_own_rate(ship):
    time = np.arange(0.0, 10.0, 0.005)
    still = {"n_set": np.zeros_like(time)}
    found = simulate(ship, ship.vector(OWN | WIDE), time, still, wanted=("v_0",))
    rate = (OWN["e"] - A) / OWN["tau_u"]
    late = time > 0.1
    expected = np.exp(-rate * (time[late] - OWN["t_sp"]))
    # the governor answers, which moves the ship a little
    np.testing.assert_allclose(found.derivatives["v"][0][late], expected, atol=2e-2)
    # water that comes faster takes load off the propeller
    assert found.derivatives["M_s"][0][200] < 0.1 * B


def test_slope_of_what_the_propeller_takes_is_its_derivative():
    speed, ship, step = np.array([-0.3, 0.0, 0.2]), np.array([-0.1, 0.0, 0.05]), 1e-6

    def torque(n):
        return (1.0 + n) ** 2 + B * (1.0 + n) * (ship - n) - 0.225 * (ship - n) ** 2

    by_hand = (torque(speed + step) - torque(speed - step)) / (2.0 * step)
    np.testing.assert_allclose(taken_slope(speed, ship, B), by_hand, rtol=1e-7)
