"""A ship that is stopped by its clutches, against the same ship in newtons and metres integrated by SciPy."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from shaftprint.catalogue._crash_stop import FourQuadrantPropeller, crash_stop
from shaftprint.errors import StructureError
from shaftprint.propeller import four_quadrants
from shaftprint.simulation import equilibrium, simulate

CURVE = four_quadrants(blades=4, area_ratio=0.70)
PITCH, DIAMETER, WATER = 0.9, 1.494, 1025.0
SHAFT, SHIP, WAKE = 1400.0 / 60.0 / 6.16, 4.6, 0.15
PROPELLER = FourQuadrantPropeller(
    curve=CURVE, pitch_ratio=PITCH, diameter_m=DIAMETER, shaft_speed_rev_s=SHAFT, ship_speed_m_s=SHIP
)
GOVERNOR = {"K_p": 4.0, "K_i": 2.5, "t_d": 0.0, "omega_n": 15.0, "zeta": 0.7, "g": 0.0}
LIMITS = {"m_max": 2.5, "m_min": -0.3, "T_aw": 0.5}
LINE = {"tau_dn": 0.4, "tau_up": 1.6, "w": WAKE, "e": 2.6, "tau_u": 14.0, "m_c": 3.0, "t_c": 1.0}


def lever(time):
    """Return the set point and which clutch is asked for: idle, then neither, astern, and more speed astern."""
    demand = np.where(time < 2.0, 0.0, np.where(time < 12.0, -0.55, -0.2))
    gear = np.where(time < 3.0, 0.0, np.where(time < 8.0, -1.0, -2.0))
    return demand, gear


def sailed(values, until_s, step_s=0.005):
    time = np.arange(0.0, until_s, step_s)
    demand, gear = lever(time)
    ship = crash_stop(PROPELLER)
    return time, simulate(ship, ship.vector(values), time, {"n_set": demand, "gear": gear}).outputs


def in_newtons(values, until_s, time):
    """Return engine [rev/s], shaft [rev/s], ship [m/s] and way [m] at times."""
    p = values | {"i_r": values.get("i_r", 1.0), "r_t": values.get("r_t", 1.0)}

    def forces(n, v):
        both = CURVE.forces(n, v * (1.0 - WAKE), pitch_ratio=PITCH, diameter_m=DIAMETER, water_density_kg_m3=WATER)
        return float(both.thrust_n), float(both.torque_nm)

    thrust_n, torque_nm = forces(SHAFT, SHIP)
    # engine at the speed of the shaft, inertias from their times
    upstream, downstream = (p[k] * torque_nm / (2.0 * math.pi * SHAFT) for k in ("tau_up", "tau_dn"))
    mass = p["tau_u"] * thrust_n / SHIP
    hold, soft = p["m_c"] * torque_nm, 2e-3 * SHAFT

    def rates(t, y):
        engine, shaft, ship, _, integral, rack, rack_rate = y
        demand, _ = lever(np.array(t))
        # one clutch opens from 3 s on, the other closes from 8 s on
        closed = 1.0 - min(max((t - 3.0) / p["t_c"], 0.0), 1.0) - min(max((t - 8.0) / p["t_c"], 0.0), 1.0)
        error = float(demand) + 1.0 - engine / SHAFT
        lowest = p["m_min"] * (1.0 + 0.5 * (engine / SHAFT - 1.0)) - 1.0
        wanted = p["K_p"] * error + integral
        given = min(max(wanted, lowest), p["m_max"] - 1.0)
        brake = torque_nm * (1.0 + min(max(rack, lowest), p["m_max"] - 1.0))
        ahead = max(closed, 0.0) * hold * math.tanh((engine - shaft) / soft)
        slip = engine / p["i_r"] + shaft
        astern = max(-closed, 0.0) * hold * p["i_r"] * math.tanh(slip / soft)
        thrust, torque = forces(shaft, ship)
        resistance = thrust_n * (ship / SHIP) * abs(ship / SHIP) ** (p["e"] - 1.0)
        return [
            (brake - ahead - astern / p["i_r"]) / (2.0 * math.pi * upstream),
            (ahead - astern - torque) / (2.0 * math.pi * downstream),
            (thrust * (p["r_t"] if thrust < 0.0 else 1.0) - resistance) / mass,
            ship,
            p["K_i"] * error + (given - wanted) / p["T_aw"],
            rack_rate,
            p["omega_n"] ** 2 * (given - rack) - 2.0 * p["zeta"] * p["omega_n"] * rack_rate,
        ]

    state = np.array([SHAFT * (1.0 + soft / SHAFT * math.atanh(1.0 / p["m_c"])), SHAFT, SHIP, 0.0, 0.0, 0.0, 0.0])
    pieces = []
    # no step reaches over a jump
    for begin, end in pairwise((0.0, 2.0, 3.0, 8.0, 12.0, until_s)):
        inside = time[(time >= begin) & (time < end)]
        solved = solve_ivp(
            rates, (begin, end), state, "LSODA", t_eval=np.append(inside, end), rtol=1e-8, atol=1e-8, max_step=0.02
        )
        pieces.append(solved.y[:4, :-1])
        state = solved.y[:, -1]
    return np.concatenate(pieces, axis=1)


@pytest.mark.parametrize("more", [{}, {"i_r": 1.2, "r_t": 0.8}], ids=["equal trains", "other train astern"])
def test_it_stops_as_the_same_ship_in_newtons_and_metres(more):
    values = GOVERNOR | LIMITS | LINE | more
    # short steps and a stiff clutch, so that what is compared are the equations
    time, found = sailed(values | {"k_c": 20000.0, "c_c": 40.0}, 60.0, step_s=0.0005)
    some = slice(0, None, 1000)
    engine, shaft, ship, way = in_newtons(values, 60.0, time[some])
    # the clutch of the reference has no spring, which takes 8 ms where both speeds meet
    np.testing.assert_allclose(1.0 + found["v_s"][some], ship / SHIP, atol=2e-3)
    np.testing.assert_allclose(1.0 + found["n_s"][some], shaft / SHAFT, atol=0.01)
    np.testing.assert_allclose(1.0 + found["n"][some], engine / SHAFT, atol=0.01)
    np.testing.assert_allclose(SHIP * (time + found["x_s"])[some], way, atol=0.25)
    # it is a crash stop: the shaft turns astern and the ship stands before the end
    assert found["n_s"][-1] < -1.5
    assert found["v_s"][-1] < -1.0


def test_a_closed_clutch_carries_the_torque_and_an_open_one_nothing():
    values = GOVERNOR | LIMITS | LINE
    ship = crash_stop(PROPELLER)
    steady = equilibrium(ship, ship.vector(values), {"n_set": 0.0, "gear": 0.0}).outputs
    for name in ("n", "n_s", "M_s", "v_s"):
        assert steady[name] == pytest.approx(0.0, abs=1e-9)
    time, found = sailed(values, 8.0)
    open_ = (time > 4.5) & (time < 8.0)
    np.testing.assert_allclose(found["M_s"][open_], -1.0, atol=1e-9)
    # the engine idles, the water turns the propeller ahead
    assert found["n"][time > 7.9][0] == pytest.approx(-0.55, abs=0.01)
    assert -0.9 < found["n_s"][time > 7.9][0] < -0.1


def test_a_clutch_that_holds_too_little_slips_ahead():
    values = GOVERNOR | LIMITS | LINE | {"m_c": 0.8}
    time = np.arange(0.0, 40.0, 0.005)
    ship = crash_stop(PROPELLER)
    weak = ship.vector(values)
    held = ship.vector(values | {"m_c": 3.0})
    # from a speed at which 0.8 of the torque is enough to one at which it is not
    inputs = {"n_set": np.where(time < 1.0, -0.3, 0.0), "gear": np.zeros_like(time)}
    slipping, holding = (simulate(ship, p, time, inputs).outputs for p in (weak, held))
    assert holding["n_s"][-1] == pytest.approx(0.0, abs=2e-3)
    # the torque is what the plates hold; engine and shaft part
    assert slipping["M_s"][-1] == pytest.approx(-0.2, abs=1e-6)
    assert slipping["n"][-1] - slipping["n_s"][-1] > 0.05


def test_a_propeller_that_does_not_pull_is_refused():
    with pytest.raises(StructureError, match="expected a propeller that pulls at its working point, found none"):
        crash_stop(
            FourQuadrantPropeller(
                curve=CURVE, pitch_ratio=PITCH, diameter_m=DIAMETER, shaft_speed_rev_s=SHAFT, ship_speed_m_s=9.0
            )
        )
