"""Steady running and small signals away from the working point, against the thesis' scaling and hand-made numbers."""

import numpy as np
import pytest

from shaftprint.catalogue import limited, structure
from shaftprint.errors import StructureError
from shaftprint.models import Diagram, Parameter, Structure, choose, maximum, minimum, table
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


def test_steady_running_below_the_smoke_limit_is_found_by_leading_the_speed_down():
    ship = limited("torque", "smoke")
    found = equilibrium(ship, ship.vector({}), {"n_set": -0.5})
    assert found.outputs["n"] == pytest.approx(-0.5, abs=1e-10)
    assert found.outputs["M_s"] == pytest.approx(-0.75, abs=1e-10)


def test_no_steady_running_is_said():
    # an integral of the error has no rest while the error has none
    open_loop = structure("OL3")
    with pytest.raises(StructureError, match="no steady running was found"):
        equilibrium(open_loop, open_loop.vector({}), {"e": 0.1})


def test_slopes_of_every_function_at_another_point_by_hand():
    gain = Parameter("k", "-", 0.1, 5.0, 2.0, "gain")
    corners = ((-1.0, 0.0), (0.0, 1.0), (2.0, 0.0))
    slopes = {
        "table": (lambda u, k: table(u, corners), -0.5),
        "beyond": (lambda u, k: table(u + 5.0, corners), 0.0),
        "minimum": (lambda u, k: minimum(u, k * u), 1.0),
        "maximum": (lambda u, k: maximum(u, k * u), 2.0),
        "choose": (lambda u, k: choose(u, 0.0, u, k * u * u), 1.2),
        "absolute": (lambda u, k: abs(-u), 1.0),
        "power": (lambda u, k: u**3, 0.27),
        "nothing": (lambda u, k: k * u**0 + 0.0 * u, 0.0),
        "sqrt": (lambda u, k: np.sqrt(k * u), 1.0 / np.sqrt(0.6)),
        "exp": (lambda u, k: np.exp(k * u), 2.0 * np.exp(0.6)),
        "log": (lambda u, k: np.log(k * u), 1.0 / 0.3),
        "sin": (lambda u, k: np.sin(k * u), 2.0 * np.cos(0.6)),
        "cos": (lambda u, k: np.cos(k * u), -2.0 * np.sin(0.6)),
        "tanh": (lambda u, k: np.tanh(k * u), 2.0 / np.cosh(0.6) ** 2),
        "products": (lambda u, k: table(u, corners) * abs(u) * choose(u, k, u, k), 0.51 - 0.045),
        "quotient": (lambda u, k: +u / (1.0 + k * u), 1.0 / 1.6**2),
    }

    def equations(flow, u, p):
        return {name: function(u, p.k) for name, (function, _) in slopes.items()}

    diagram = Diagram("functions", "u", tuple(slopes), equations, (gain,))
    model = Structure(name="functions", title="functions", input="u", outputs=dict(diagram.ports()))
    found = linearise(model, [2.0], {"u": 0.3}).response([0.7j])[:, 0]
    np.testing.assert_allclose(found, [slope for _, slope in slopes.values()], atol=1e-12)


def test_gradients_of_the_limited_loop_are_those_of_the_linear_one():
    ship, linear = limited("torque", "rate"), structure("GAUGE-CLOSED")
    names = ("tau_up", "tau_dn", "K_p", "K_i", "t_d", "omega_n", "zeta", "t_sp", "k_q", "g", "v")
    found, slopes = ship.gradient(ship.vector(TRUTH), 1j * OMEGA, names)
    expected, expected_slopes = linear.gradient(linear.vector(TRUTH), 1j * OMEGA, names)
    np.testing.assert_allclose(found, expected, rtol=1e-10)
    np.testing.assert_allclose(slopes, expected_slopes, rtol=1e-8, atol=1e-10)


def test_a_computer_holds_for_its_period_also_in_the_gradient():
    period = Parameter("T", "s", 0.01, 1.0, 0.2, "period of a computer")
    diagram = Diagram("held", "u", ("y",), lambda flow, u, p: {"y": flow.sampled(u, p.T)}, (period,))
    model = Structure(name="held", title="held", input="u", outputs={"y": diagram.port("y")})
    found, slopes = model.gradient([0.2], [1.3j], ("T",))
    x = 0.26j
    assert found[0, 0] == pytest.approx((1.0 - np.exp(-x)) / x, abs=1e-13)
    assert slopes[0, 0, 0] == pytest.approx(1.3j * (np.exp(-x) * (1.0 + x) - 1.0) / x**2, abs=1e-12)


def test_a_diagram_without_that_output_says_which_it_has():
    diagram = Diagram("held", "u", ("y",), lambda flow, u, p: {"y": u}, ())
    with pytest.raises(StructureError, match="diagram held has no output z; it has y"):
        diagram.port("z")
