"""Every shipped structure against the equations of the thesis, written out in 50-digit arithmetic.

The forms below come from the equations, not from the blocks: no composition, no shared sub-expressions, no derivative
by hand. Derivatives are mpmath's, at 50 digits.
"""

import mpmath
import numpy as np
import pytest
from mpmath import mp

from shaftprint.catalogue import STRUCTURES, structure

DIGITS = 50
OMEGA = np.array([0.01, 0.0276, 0.691, 4.91, 10.29, 31.0, 94.31, 200.0])


def governor(s, p):
    """``M_s / e`` of eqs 4.3, 4.20, 4.22 (with ``2 zeta omega_n s``); a missing element is 1."""
    lag = 1
    if "omega_n" in p:
        lag = p["omega_n"] ** 2 / (s**2 + 2 * p["zeta"] * p["omega_n"] * s + p["omega_n"] ** 2)
    return p.get("v", 1) * (p["K_p"] + p["K_i"] / s) * mp.exp(-p.get("t_d", 0) * s) * lag


def core(s, p):
    """``n / M_s`` of eq. 4.2."""
    return 1 / (p["tau_n"] * s + p["k_q"])


def closed(s, p, engine=governor):
    """``n / n_set`` and ``M_s / n_set`` of eqs 4.25 and 4.26."""
    loop = core(s, p) * engine(s, p)
    return loop / (loop + 1), engine(s, p) / (loop + 1)


def governor_pade(s, p):
    """The same with the delay of eq. 4.24, whose terms are ``(s t_d)^k``."""
    x = s * p["t_d"]
    above = 30240 - 15120 * x + 3360 * x**2 - 420 * x**3 + 30 * x**4 - x**5
    below = 30240 + 15120 * x + 3360 * x**2 + 420 * x**3 + 30 * x**4 + x**5
    return governor(s, {name: value for name, value in p.items() if name != "t_d"}) * above / below


def pid(s, p):
    """PID governor with a filtered derivative, eqs 4.18 and 4.19."""
    return p["K_p"] + p["K_i"] / s + p["K_d"] * s / (p["T_f"] * s + 1)


def five_parameters(s, p):
    """Eqs 2.26-2.28, the last with the ``s`` that is missing in print; 2 stands where the propeller's slope is."""
    tau, g, k = p["tau_n"], p["g"], p["k_q"]
    v_p, v_i = p["v"] * p["K_p"], p["v"] * p["K_i"]
    below = s**2 + (v_p - g + k) / tau * s + v_i / tau
    speed = (v_p / tau * s + v_i / tau) / below
    error = (s + (k - g) / tau) / below
    torque = (v_p * s**2 + (v_i * tau + k * v_p) / tau * s + k * v_i / tau) / below
    return speed, error, torque


def sinc(x):
    return mp.one if x == 0 else mp.sin(x) / x


def pick_up(s, p):
    """Mean over a window, hold, delay; on the frequency axis both windows are ``sin(w T / 2) / (w T / 2)``."""
    omega = s / mp.j
    windows = sinc(omega * p["T_average"] / 2) * sinc(omega * p["T_hold"] / 2)
    return windows * mp.exp(-s * p["t_pickup"])


def load_slope(s, p):
    """Torque of propeller and water over speed: quasi-steady slope, water to be accelerated, slipstream that lags.

    The slipstream: ``Q = (k_q + kappa) n - kappa u`` with ``tau_i s u = n - u``.
    """
    slope = p["k_q"] + p.get("tau_w", 0) * s
    if "kappa" in p:
        slope += p["kappa"] - p["kappa"] / (p["tau_i"] * s + 1)
    return slope


def telemetry(s, p):
    return mp.exp(-s * p["t_gauge"]) / (p["T_filter"] * s + 1)


def gauge(s, p):
    """``n / n_set`` (true speed) and ``M_s / n_set`` of the two free bodies cut at the gauge.

    Upstream ``M_b - M_s = tau_up s n`` with ``M_b = g n + v C e^(-s t_d) F e``; downstream
    ``M_s - k_q n = tau_dn s n``; the error is ``e = c_set e^(-s t_sp) n_set - n``. Three equations in ``M_b``,
    ``M_s`` and ``n``, solved as a linear system. The torque is seen ``t_gauge`` late.
    """
    engine = governor(s, p)
    demand = p["c_set"] * mp.exp(-s * p["t_sp"])
    matrix = mp.matrix(
        [
            [1, -1, -p["tau_up"] * s],
            [0, 1, -load_slope(s, p) - p["tau_dn"] * s],
            [1, 0, -p["g"] + engine],
        ]
    )
    _, torque, speed = mp.lu_solve(matrix, mp.matrix([0, 0, engine * demand]))
    return speed, torque * telemetry(s, p)


def gauge_open(s, p):
    """``M_s / e`` from the measured speed: ``e = n_set - pick-up(n)``."""
    speed, torque = gauge(s, p)
    return (torque / (1 - pick_up(s, p) * speed),)


def gauge_closed(s, p):
    speed, torque = gauge(s, p)
    return pick_up(s, p) * speed, torque


def gauge_ecu(s, p):
    """The rack is what the governor makes of its own error, seen ``t_rack`` late."""
    speed, torque = gauge(s, p)
    error = p["c_set"] * mp.exp(-s * p["t_sp"]) - speed
    rack = (p["K_p"] + p["K_i"] / s) * error * mp.exp(-s * p["t_rack"])
    return pick_up(s, p) * speed, torque, rack


def gauge_elastic(s, p, on_engine=False):
    """Three bodies, the pick-up at shaft or engine, ``M_s`` at the gauge; the governor feels the engine's ``n_1``.

    ``M_b - T = (tau_up - tau_m) s n_1``, ``T - M_s = tau_m s n``, ``M_s - k_q n = tau_dn s n``,
    ``s T = (k_c + d_c s) (n_1 - n)`` and ``M_b = g n_1 + v C e^(-s t_d) F (c_set e^(-s t_sp) n_set - n_1)``, solved as
    a linear system in ``M_b``, ``T``, ``M_s``, ``n_1`` and ``n``.
    """
    engine = governor(s, p)
    demand = p["c_set"] * mp.exp(-s * p["t_sp"])
    spring = p["k_c"] + p["d_c"] * s
    matrix = mp.matrix(
        [
            [1, -1, 0, -(p["tau_up"] - p["tau_m"]) * s, 0],
            [0, 1, -1, 0, -p["tau_m"] * s],
            [0, 0, 1, 0, -p["k_q"] - p["tau_dn"] * s],
            [0, s, 0, -spring, spring],
            [1, 0, 0, engine - p["g"], 0],
        ]
    )
    _, _, torque, ahead, behind = mp.lu_solve(matrix, mp.matrix([0, 0, 0, 0, engine * demand]))
    return pick_up(s, p) * (ahead if on_engine else behind), torque * telemetry(s, p)


def gauge_hybrid(s, p):
    """The same two free bodies with a torque from outside upstream; the engine gives what is left of the whole.

    ``M_b = (1 - c_m s_m) (g n + v C e^(-s t_d) F (c_set e^(-s t_sp) n_set - n))`` and
    ``M_b + c_m M_m - M_s = tau_up s n``, solved for either input alone.
    """
    given = 1 - p["c_m"] * p["s_m"]
    engine = given * governor(s, p)
    demand = p["c_set"] * mp.exp(-s * p["t_sp"])
    matrix = mp.matrix(
        [[1, -1, -p["tau_up"] * s], [0, 1, -p["k_q"] - p["tau_dn"] * s], [1, 0, engine - given * p["g"]]]
    )
    _, torque, speed = mp.lu_solve(matrix, mp.matrix([0, 0, engine * demand]))
    _, moved, turned = mp.lu_solve(matrix, mp.matrix([-p["c_m"], 0, 0]))
    seen, shown = pick_up(s, p), telemetry(s, p)
    return seen * speed, seen * turned, shown * torque, shown * moved


def gauge_motor(s, p):
    """The same two free bodies; the torque follows the PI controller late and by a lag of first order.

    ``M_b = (K_p + K_i / s) e^(-s t_d) e / (T_m s + 1)``, whatever the speed.
    """
    drive = (p["K_p"] + p["K_i"] / s) * mp.exp(-s * p["t_d"]) / (p["T_m"] * s + 1)
    demand = p["c_set"] * mp.exp(-s * p["t_sp"])
    matrix = mp.matrix([[1, -1, -p["tau_up"] * s], [0, 1, -p["k_q"] - p["tau_dn"] * s], [1, 0, drive]])
    _, torque, speed = mp.lu_solve(matrix, mp.matrix([0, 0, drive * demand]))
    return pick_up(s, p) * speed, torque * telemetry(s, p)


def gauge_pitch(s, p):
    """The same two free bodies, pushed by the governor and by the pitch, solved as they stand in ``M_b, M_s, n``.

    ``M_b - M_s = tau_up s n``, ``M_s - k_q n - q theta_b = tau_dn s n`` and ``M_b = g n + C (demand - n)``.
    """
    engine = governor(s, p)
    demand = p["c_set"] * mp.exp(-s * p["t_sp"])
    theta = p["c_th"] * mp.exp(-s * p["t_th"]) / (p["tau_th"] * s + 1)
    matrix = mp.matrix([[1, -1, -p["tau_up"] * s], [0, 1, -p["k_q"] - p["tau_dn"] * s], [1, 0, engine - p["g"]]])
    _, torque, speed = mp.lu_solve(matrix, mp.matrix([0, 0, engine * demand]))
    _, torque_of_pitch, speed_of_pitch = mp.lu_solve(
        matrix, mp.matrix([0, p["q"] * mp.exp(-s * p["t_blade"]) * theta, 0])
    )
    return (
        pick_up(s, p) * speed,
        pick_up(s, p) * speed_of_pitch,
        telemetry(s, p) * torque,
        telemetry(s, p) * torque_of_pitch,
        mp.mpc(0),
        p["c_pitch"] * theta,
    )


def gauge_combinator(s, p):
    """The same, with the demand of the governor and the pitch from one lever, pushed by both at once."""
    engine = governor(s, p)
    demand = p["c_set"] * mp.exp(-s * p["t_sp"])
    theta = p["c_set"] * p["c_comb"] * mp.exp(-s * p["t_th"]) / (p["tau_th"] * s + 1)
    matrix = mp.matrix([[1, -1, -p["tau_up"] * s], [0, 1, -p["k_q"] - p["tau_dn"] * s], [1, 0, engine - p["g"]]])
    pushed = mp.matrix([0, p["q"] * mp.exp(-s * p["t_blade"]) * theta, engine * demand])
    _, torque, speed = mp.lu_solve(matrix, pushed)
    return pick_up(s, p) * speed, telemetry(s, p) * torque, p["c_pitch"] * theta


def governor_alone(s, p):
    """The rack from the set point, which comes late, and from the speed, which does not; both seen ``t_rack`` late."""
    rack = (p["K_p"] + p["K_i"] / s) * mp.exp(-s * p["t_rack"])
    return rack * p["c_set"] * mp.exp(-s * p["t_sp"]), -rack


def engine(s, p):
    """Speed and torque from the rack: no governor, no set point."""
    lag = p["omega_n"] ** 2 / (s**2 + 2 * p["zeta"] * p["omega_n"] * s + p["omega_n"] ** 2)
    brake = p["v"] * mp.exp(-s * (p["t_d"] - p["t_rack"])) * lag
    speed = brake / ((p["tau_up"] + p["tau_dn"]) * s + p["k_q"] - p["g"])
    return pick_up(s, p) * speed, (p["tau_dn"] * s + p["k_q"]) * telemetry(s, p) * speed


def sailing(s, p, n_set=1, theta_set=0):
    """Speed, torque and speed of the ship of the free-sailing line, with ``v`` eliminated by hand.

    That they follow from the equations of shaft, governor, propeller and ship is shown where those are solved as they
    stand, in the tests of free sailing.
    """
    lag = p["omega_n"] ** 2 / (s**2 + 2 * p["zeta"] * p["omega_n"] * s + p["omega_n"] ** 2)
    drive = (p["K_p"] + p["K_i"] / s) * p["v"] * mp.exp(-s * p["t_d"]) * lag
    settling = p["tau_u"] * s + p["e"] - p["a"]
    load = p["tau_dn"] * s + p["k_q"] / 2 * (2 - p["b"] + p["sigma"] * p["b"] * (2 - p["a"]) / settling)
    forced, pushed = mp.zero, mp.zero
    if theta_set:
        theta = theta_set / (p["tau_th"] * s + 1)
        pushed = p["sigma"] * p["p"] * theta / settling
        forced = p["k_q"] / 2 * (p["q"] * theta + p["b"] * pushed)
    demand = n_set * p["c_set"] * mp.exp(-s * p["t_sp"])
    speed = (drive * demand - forced) / (p["tau_up"] * s - p["g"] + load + drive)
    ship = p["sigma"] * (2 - p["a"]) / settling * speed + pushed
    late = mp.exp(-s * p["t_log"]) if "t_log" in p else 1
    return pick_up(s, p) * speed, telemetry(s, p) * (load * speed + forced), late * ship


def sailing_core(s, p):
    ship = p["tau_u"] * s + p["e"] - p["a"]
    back = p["sigma"] * p["b"] * (2 - p["a"])
    speed = ship / (p["tau_dn"] * s * ship + p["k_q"] / 2 * ((2 - p["b"]) * ship + back))
    return (pick_up(s, p) / telemetry(s, p) * speed,)


def sailing_ship(s, p):
    (speed,) = sailing_core(s, p)
    ship = p["sigma"] * (2 - p["a"]) / (p["tau_u"] * s + p["e"] - p["a"]) * mp.exp(-s * p["t_log"])
    return speed, speed / pick_up(s, p) * ship


def sailing_pitch(s, p):
    by_set_point, by_pitch = sailing(s, p), sailing(s, p, n_set=0, theta_set=1)
    return tuple(x for pair in zip(by_set_point, by_pitch, strict=True) for x in pair)


FORMS = {
    "OL1": lambda s, p: (core(s, p),),
    "OL2": lambda s, p: (governor(s, p),),
    "OL3": lambda s, p: (governor(s, p),),
    "OL4": lambda s, p: (governor(s, p),),
    "OL5": lambda s, p: (governor(s, p),),
    "OL-PID": lambda s, p: (pid(s, p),),
    "CL1": closed,
    "CL3": closed,
    "CL4": closed,
    "CL4-PADE5": lambda s, p: closed(s, p, governor_pade),
    "INITIAL": five_parameters,
    "BENCHMARK": lambda s, p: five_parameters(s, p)[::2],
    "GAUGE-CORE": lambda s, p: (pick_up(s, p) / telemetry(s, p) / (p["tau_dn"] * s + p["k_q"]),),
    "GAUGE-OPEN": gauge_open,
    "GAUGE-CLOSED": gauge_closed,
    "GAUGE-INFLOW": gauge_closed,
    "GAUGE-ELASTIC": gauge_elastic,
    "GAUGE-ELASTIC-ENGINE": lambda s, p: gauge_elastic(s, p, on_engine=True),
    "GAUGE-ECU": gauge_ecu,
    "GAUGE-MOTOR": gauge_motor,
    "GAUGE-PITCH": gauge_pitch,
    "GAUGE-COMBINATOR": gauge_combinator,
    "GAUGE-HYBRID": gauge_hybrid,
    "GOVERNOR": governor_alone,
    "ENGINE": engine,
    "FREE-CORE": sailing_core,
    "FREE-SHIP": sailing_ship,
    "FREE-CLOSED": lambda s, p: sailing(s, p)[:2],
    "FREE-LOG": sailing,
    "FREE-PITCH": sailing_pitch,
}

# A block's own zero is where formulas lose digits or divide by zero: no gain, no delay, no window.
EDGES = {"K_p": 0.0, "t_d": 0.0, "T_average": 0.0, "T_hold": 0.0, "t_pickup": 0.0, "t_sp": 0.0, "g": 0.0, "K_d": 0.0}
# Both sides of the change from series to quotient in the pick-up's windows, at 10.29 rad/s and 200 rad/s.
WINDOWS = {"T_average": 0.0038, "T_hold": 0.000201}


def random_values(shipped, seed):
    """Draw every parameter, held ones too, well inside its bounds."""
    rng = np.random.default_rng(seed)
    return np.array([p.lower + (p.upper - p.lower) * rng.uniform(0.02, 0.98) for p in shipped.parameters])


def exact(name, values, omega):
    shipped = structure(name)
    named = dict(zip(shipped.names, map(mp.mpf, values), strict=True))
    return [FORMS[name](mp.mpc(0, mp.mpf(w)), named) for w in omega]


def exact_slopes(name, values, omega, parameter):
    """Return the derivative of each output."""
    shipped = structure(name)
    named = dict(zip(shipped.names, map(mp.mpf, values), strict=True))
    s = mp.mpc(0, mp.mpf(omega))
    return mp.diff(lambda x: mp.matrix(FORMS[name](s, named | {parameter: x})), named[parameter])


def value_sets(shipped):
    """Three random sets, the defaults, and the edges."""
    yield from (random_values(shipped, seed) for seed in (1, 2, 3))
    yield shipped.vector({})
    yield shipped.vector({name: value for name, value in EDGES.items() if name in shipped.names})
    yield shipped.vector({name: value for name, value in WINDOWS.items() if name in shipped.names})


def test_every_shipped_structure_has_a_closed_form_here():
    assert set(FORMS) == set(STRUCTURES)


@pytest.mark.parametrize("name", FORMS)
def test_responses_equal_the_printed_equations(name):
    shipped = structure(name)
    with mpmath.workdps(DIGITS):
        for values in value_sets(shipped):
            expected = np.array([[complex(x) for x in row] for row in exact(name, values, OMEGA)]).T
            np.testing.assert_allclose(shipped.response(values, 1j * OMEGA), expected, rtol=1e-12, atol=0.0)


@pytest.mark.parametrize("name", ["GAUGE-ELASTIC", "GAUGE-ELASTIC-ENGINE"])
def test_a_coupling_without_end_of_stiffness_is_a_rigid_line(name):
    elastic, rigid = structure(name), structure("GAUGE-CLOSED")
    for seed in (1, 2, 3):
        values = dict(zip(elastic.names, random_values(elastic, seed), strict=True)) | {"k_c": 1e13, "tau_m": 0.1}
        plain = rigid.vector({name: values[name] for name in rigid.names})
        np.testing.assert_allclose(
            elastic.response(elastic.vector(values), 1j * OMEGA), rigid.response(plain, 1j * OMEGA), rtol=1e-7
        )


# of many parameters, each with derivatives of 50 digits
LONG = (
    "FREE-PITCH",
    "GAUGE-PITCH",
    "GAUGE-COMBINATOR",
    "FREE-LOG",
    "FREE-CLOSED",
    "GAUGE-ECU",
    "GAUGE-ELASTIC",
    "GAUGE-ELASTIC-ENGINE",
    "GAUGE-HYBRID",
    "GAUGE-INFLOW",
)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if name in LONG else name for name in FORMS]
)
def test_gradients_of_all_parameters_equal_50_digit_arithmetic(name):
    """Held parameters too; 1e-9 of each complex derivative by itself, at every frequency."""
    shipped = structure(name)
    omega = OMEGA[[0, 3, 4, 7]]
    with mpmath.workdps(DIGITS):
        for values in value_sets(shipped):
            response, slopes = shipped.gradient(values, 1j * omega, shipped.names)
            np.testing.assert_allclose(response, shipped.response(values, 1j * omega), rtol=1e-15)
            for i, parameter in enumerate(shipped.names):
                exact_ones = [exact_slopes(name, values, w, parameter) for w in omega]
                for output in range(len(shipped.channels)):
                    expected = [complex(one[output]) for one in exact_ones]
                    np.testing.assert_allclose(
                        slopes[i, output], expected, rtol=1e-9, atol=1e-40, err_msg=f"{name} {parameter} {output}"
                    )


@pytest.mark.parametrize("name", FORMS)
def test_a_batch_is_a_loop(name):
    shipped = structure(name)
    table = np.array([[random_values(shipped, 10 * i + j) for j in range(3)] for i in range(2)])
    response, slopes = shipped.gradient(table, 1j * OMEGA)
    assert response.shape == (2, 3, len(shipped.channels), OMEGA.size)
    assert slopes.shape == (2, 3, len(shipped.free), len(shipped.channels), OMEGA.size)
    for i, j in np.ndindex(2, 3):
        alone, alone_slopes = shipped.gradient(table[i, j], 1j * OMEGA)
        np.testing.assert_allclose(response[i, j], alone, rtol=1e-14)
        np.testing.assert_allclose(slopes[i, j], alone_slopes, rtol=1e-13, atol=1e-300)


@pytest.mark.parametrize("name", ["BENCHMARK", "CL4", "GAUGE-CLOSED"])
def test_a_factor_on_a_parameter_at_a_line_is_that_parameter_there(name):
    """``k_q`` may differ from line to line: the same as another value of ``k_q`` at each of them."""
    shipped = structure(name)
    values = random_values(shipped, 5)
    place = shipped.names.index("k_q")
    load = np.linspace(0.97, 1.04, OMEGA.size)
    response, slopes = shipped.gradient(values, 1j * OMEGA, shipped.names, factors={"k_q": load, "unknown": load})
    for i, omega in enumerate(OMEGA):
        moved = values.copy()
        moved[place] *= load[i]
        alone, alone_slopes = shipped.gradient(moved, [1j * omega], shipped.names)
        alone_slopes[place] *= load[i]
        np.testing.assert_allclose(response[:, i], alone[:, 0], rtol=1e-14)
        np.testing.assert_allclose(slopes[:, :, i], alone_slopes[:, :, 0], rtol=1e-13, atol=1e-300)
