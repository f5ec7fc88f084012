"""Independent routes to the same responses: printed limits, state space, python-control, special cases."""

import warnings

import numpy as np
import pytest

from shaftprint.catalogue import STRUCTURES, structure

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    import control

SET = {"tau_n": 1.2, "K_p": 10.0, "K_i": 3.0, "g": -0.5, "v": 1.1}
OMEGA = np.geomspace(0.01, 200.0, 41)


def response(name, values, s):
    shipped = structure(name)
    found = shipped.response(shipped.vector(values), s)
    return dict(zip(shipped.outputs, found, strict=True))


def test_initial_model_has_the_limits_of_table_2_4_at_low_frequency():
    found = response("INITIAL", SET, [1e-9j])
    assert abs(found["n"][0]) == pytest.approx(1.0, rel=1e-8)
    # (2 - g) / (v K_i) = 2.5 / 3.3
    assert abs(found["E_n"][0]) == pytest.approx(0.757575757575, rel=1e-8)
    assert abs(found["M_s"][0]) == pytest.approx(2.0, rel=1e-8)


def test_initial_model_has_the_limits_of_table_2_4_at_high_frequency():
    found = response("INITIAL", SET, [1e9j])
    assert abs(found["n"][0]) < 1e-8
    assert abs(found["E_n"][0]) < 1e-8
    assert abs(found["M_s"][0]) == pytest.approx(11.0, rel=1e-8)


def test_limits_in_decibel_are_twenty_times_what_table_2_4_prints():
    """The table prints ``log`` of the amplitudes (0.3 for 2); an amplitude of 2 is 6.02 dB."""
    found = response("INITIAL", SET, [1e-9j])
    assert 20.0 * np.log10(abs(found["M_s"][0])) == pytest.approx(6.0206, abs=1e-4)


def test_simplified_closed_loop_has_the_limits_of_table_d_1():
    low = response("CL1", {"tau_n": 0.4, "K_p": 2.5, "K_i": 4.0}, [1e-9j])
    high = response("CL1", {"tau_n": 0.4, "K_p": 2.5, "K_i": 4.0}, [1e9j])
    assert [abs(low["n"][0]), abs(low["M_s"][0])] == pytest.approx([1.0, 2.0], rel=1e-8)
    assert abs(high["n"][0]) < 1e-8
    assert abs(high["M_s"][0]) == pytest.approx(2.5, rel=1e-8)


def test_benchmark_equals_the_state_space_of_the_thesis():
    """Eqs 2.31-2.33 with ``y = C x + D u``."""
    tau, k_p, k_i, g, v = SET["tau_n"], SET["K_p"], SET["K_i"], SET["g"], SET["v"]
    a = np.array([[-(2.0 - g + v * k_p) / tau, v * k_i / tau], [-1.0, 0.0]])
    b = np.array([v * k_p / tau, 1.0])
    c = np.array([[1.0, 0.0], [g - v * k_p, v * k_i]])
    d = np.array([0.0, v * k_p])
    expected = np.array([c @ np.linalg.solve(1j * w * np.eye(2) - a, b) + d for w in OMEGA]).T
    found = response("BENCHMARK", SET, 1j * OMEGA)
    np.testing.assert_allclose(found["n"], expected[0], rtol=1e-12)
    np.testing.assert_allclose(found["M_s"], expected[1], rtol=1e-12)


def test_simplified_closed_loop_equals_the_state_space_of_appendix_d():
    tau, k_p, k_i = 0.3537, 1.1833, 5.3967
    a = np.array([[-(2.0 + k_p) / tau, k_i / tau], [-1.0, 0.0]])
    b = np.array([k_p / tau, 1.0])
    c = np.array([[1.0, 0.0], [-k_p, k_i]])
    expected = np.array([c @ np.linalg.solve(1j * w * np.eye(2) - a, b) + [0.0, k_p] for w in OMEGA]).T
    found = response("CL1", {"tau_n": tau, "K_p": k_p, "K_i": k_i}, 1j * OMEGA)
    np.testing.assert_allclose([found["n"], found["M_s"]], expected, rtol=1e-12)


def test_core_has_its_corner_where_torque_and_inertia_share_equally():
    """``|n / M_s|`` falls to ``1 / (2 sqrt 2)`` and -45 degrees at ``2 / tau_n``."""
    (found,) = response("OL1", {"tau_n": 0.3897}, [1j * 2.0 / 0.3897])["n"]
    assert abs(found) == pytest.approx(0.35355339059, rel=1e-10)
    assert np.degrees(np.angle(found)) == pytest.approx(-45.0, rel=1e-12)


@pytest.mark.parametrize("name", ["CL4", "GAUGE-CLOSED"])
def test_torque_over_speed_sees_only_what_is_downstream_of_the_gauge(name):
    shipped = structure(name)
    tau = "tau_n" if name == "CL4" else "tau_dn"
    found = response(name, {}, 1j * OMEGA)
    expected = 1j * OMEGA * shipped.vector({})[shipped.names.index(tau)] + 2.0
    np.testing.assert_allclose(found["M_s"] / found["n"], expected, rtol=1e-12)


@pytest.mark.parametrize(("gauge", "thesis"), [("GAUGE-CLOSED", "CL4"), ("GAUGE-CORE", "OL1"), ("GAUGE-OPEN", "OL5")])
def test_gauge_aware_structures_without_upstream_inertia_are_those_of_the_thesis(gauge, thesis):
    values = {"K_p": 1.6004, "K_i": 4.4388, "t_d": 0.1161, "omega_n": 9.7705, "zeta": 0.4}
    perfect = {"tau_up": 0.0, "g": 0.0, "c_set": 1.0, "t_sp": 0.0, "k_q": 2.0, "v": 1.0, "tau_dn": 0.329}
    wanted, reference = structure(gauge), structure(thesis)
    found = wanted.response(
        wanted.vector({n: x for n, x in (values | perfect).items() if n in wanted.names}), 1j * OMEGA
    )
    expected = reference.response(
        reference.vector({n: x for n, x in (values | {"tau_n": 0.329}).items() if n in reference.names}), 1j * OMEGA
    )
    # the open one is the quotient of two closed ones: it loses what 1 - n / n_set loses at low frequency
    np.testing.assert_allclose(found, expected, rtol=1e-11 if gauge == "GAUGE-OPEN" else 1e-13)


def test_upstream_inertia_shows_in_torque_over_error_although_the_gauge_is_downstream():
    """``M_s / e -> v K_p tau_dn / (tau_up + tau_dn)`` at high frequency, not ``v K_p``."""
    values = {"K_p": 5.7, "tau_up": 1.016, "tau_dn": 0.32, "omega_n": 60.0, "zeta": 1.0, "t_d": 0.0, "t_sp": 0.0}
    shipped = structure("GAUGE-OPEN")
    omega = np.array([1e5])
    found = shipped.response(shipped.vector(values), 1j * omega)
    lag = 60.0**2 / (1j * omega + 60.0) ** 2
    np.testing.assert_allclose(found[0] / lag, 5.7 * 0.32 / 1.336, rtol=1e-4)


def test_set_point_scale_and_latency_multiply_both_outputs():
    plain = response("GAUGE-CLOSED", {"t_sp": 0.0}, 1j * OMEGA)
    late = response("GAUGE-CLOSED", {"t_sp": 0.25, "c_set": 1.02}, 1j * OMEGA)
    for output in ("n", "M_s"):
        ratio = late[output] / plain[output]
        np.testing.assert_allclose(np.abs(ratio), 1.02, rtol=1e-12)
        np.testing.assert_allclose(np.angle(ratio * np.exp(0.25j * OMEGA)), 0.0, atol=1e-12)


def test_one_revolution_pick_up_is_blind_at_its_own_frequency():
    """A mean over 50.7 ms has no response to 1 / 50.7 ms; the torque does not pass the pick-up."""
    period = 60.0 / 1183.8
    omega = np.array([2.0 * np.pi / period])
    found = response("GAUGE-CLOSED", {"T_average": period}, 1j * omega)
    plain = response("GAUGE-CLOSED", {}, 1j * omega)
    assert abs(found["n"][0]) < 1e-14 * abs(plain["n"][0])
    assert found["M_s"][0] == plain["M_s"][0]


@pytest.mark.parametrize(("averaging", "hold"), [(0.0507, 0.0507), (0.2, 0.0), (0.0, 0.01)])
def test_pick_up_is_the_mean_over_its_windows(averaging, hold):
    """Two windows one after the other, by Gauss-Legendre quadrature of the two means."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    omega = np.array([0.01, 4.91, 40.0])
    mean = (np.exp(0.5j * omega[:, None] * averaging * nodes) @ weights) / 2.0
    held = (np.exp(0.5j * omega[:, None] * hold * nodes) @ weights) / 2.0
    values = {"T_average": averaging, "T_hold": hold, "t_pickup": averaging / 2 + hold / 2}
    found = response("GAUGE-CORE", values, 1j * omega)["n"] / response("GAUGE-CORE", {}, 1j * omega)["n"]
    np.testing.assert_allclose(found, mean * held * np.exp(-0.5j * omega * (averaging + hold)), rtol=1e-13)


def control_loop(values, governor):
    s = control.tf("s")
    core = 1.0 / (values["tau_n"] * s + 2.0)
    return control.feedback(governor * core, 1.0), control.feedback(governor, core)


@pytest.mark.parametrize("name", ["CL1", "CL3", "CL4-PADE5", "OL4", "OL-PID"])
def test_delay_free_structures_equal_python_control(name):
    shipped = structure(name)
    values = dict(zip(shipped.names, shipped.vector({}), strict=True))
    s = control.tf("s")
    engine = values["K_p"] + values["K_i"] / s
    if "omega_n" in values:
        square = values["omega_n"] ** 2
        engine *= square / (s**2 + 2.0 * values["zeta"] * values["omega_n"] * s + square)
    if name == "CL4-PADE5":
        engine *= control.tf(*control.pade(values["t_d"], 5))
    if name == "OL-PID":
        engine += values["K_d"] * s / (values["T_f"] * s + 1.0)
    systems = (engine,) if name.startswith("OL") else control_loop(values, engine)
    expected = np.array([system(1j * OMEGA) for system in systems])
    np.testing.assert_allclose(shipped.response(shipped.vector({}), 1j * OMEGA), expected, rtol=1e-9)


def test_pade_and_exact_delay_agree_while_the_phase_is_below_four():
    """At ``t_d = 0.1161 s``: to 1e-4 up to 20 rad/s, not at S13 and S14 when it is 0.5 s."""
    exact, approximate = structure("CL4"), structure("CL4-PADE5")
    values = {"tau_n": 0.329, "K_p": 1.6004, "K_i": 4.4388, "t_d": 0.1161, "omega_n": 9.7705, "zeta": 0.4}
    omega = np.linspace(0.1, 20.0, 50)
    np.testing.assert_allclose(
        approximate.response(approximate.vector(values), 1j * omega),
        exact.response(exact.vector(values), 1j * omega),
        rtol=1e-4,
    )
    slow = values | {"t_d": 0.5}
    omega = np.array([21.57, 45.18])
    ratio = approximate.response(approximate.vector(slow), 1j * omega) / exact.response(exact.vector(slow), 1j * omega)
    assert np.all(np.abs(ratio - 1.0) > 0.1)


def test_names_of_structures_are_found_in_capitals_or_not():
    assert structure("gauge-closed").name == "GAUGE-CLOSED"
    for name, make in STRUCTURES.items():
        assert make().name == name
