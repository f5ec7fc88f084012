"""A free-sailing ship at large: small signals against the linear structure, steady running against the curves."""

import numpy as np
import pytest
from tests.catalogue.sailing_at_large import pitch_actuator, sailing_at_large

from shaftprint.catalogue import KnownPropeller, structure, with_known_propeller
from shaftprint.errors import StructureError
from shaftprint.models import Diagram, Parameter, Structure
from shaftprint.propeller import ka4_70_in_19a
from shaftprint.simulation import equilibrium, simulate

OMEGA = np.geomspace(0.01, 20.0, 30)
# the reference tug at 9.9 kn and 1800 rpm
PROPELLER = KnownPropeller(
    curve=ka4_70_in_19a(),
    pitch_ratio=1.11,
    diameter_m=1.05,
    propellers=2,
    water_density_kg_m3=1025.0,
    shaft_speed_rev_s=1800.0 / 60.0 / 3.82,
    ship_speed_m_s=9.9 * 0.514444,
)
SHIP = {"tau_up": 0.7, "tau_dn": 0.22, "K_p": 3.0, "K_i": 2.5, "omega_n": 10.3, "zeta": 0.6, "t_d": 0.05, "g": -0.1}
SHIP |= {"t_sp": 0.03, "e": 4.0, "tau_u": 6.8, "sigma": 1.0}


@pytest.mark.parametrize("sigma", [1.0, 0.5])
def test_small_signals_are_those_of_the_slopes_of_the_curves(sigma):
    ship = sailing_at_large(PROPELLER)
    a, b = PROPELLER.slopes(np.asarray(0.2))
    linear = structure("FREE-LOG")
    expected = linear.response(linear.vector(SHIP | {"a": float(a), "b": float(b), "sigma": sigma}), 1j * OMEGA)
    found = ship.response(ship.vector(SHIP | {"w": 0.2, "sigma": sigma}), 1j * OMEGA)
    for output, response in zip(ship.outputs, found, strict=True):
        place = list(linear.outputs).index(output)
        np.testing.assert_allclose(response, expected[place], rtol=1e-10)


def test_steady_running_is_where_thrust_meets_resistance():
    ship = sailing_at_large(PROPELLER)
    found = equilibrium(ship, ship.vector(SHIP | {"w": 0.2}), {"n_set": -0.2})
    v = found.outputs["v_s"]
    assert found.outputs["n"] == pytest.approx(-0.2, abs=1e-9)
    speed = 0.8 * PROPELLER.shaft_speed_rev_s
    advance = (1.0 + v) * PROPELLER.ship_speed_m_s * 0.8 / (speed * PROPELLER.diameter_m)
    before = PROPELLER.ship_speed_m_s * 0.8 / (PROPELLER.shaft_speed_rev_s * PROPELLER.diameter_m)
    now, then = PROPELLER.curve.at(advance, 1.11), PROPELLER.curve.at(before, 1.11)
    assert 0.64 * now.thrust / then.thrust == pytest.approx((1.0 + v) ** 4.0, rel=1e-9)
    assert 1.0 + found.outputs["M_s"] == pytest.approx(0.64 * now.torque / then.torque, rel=1e-9)


def test_a_ship_that_sails_freely_speeds_up_slowly_after_its_shaft():
    ship = sailing_at_large(PROPELLER, "torque")
    time = np.arange(0.0, 80.0, 0.01)
    demand = 0.1 * np.clip(time - 1.0, 0.0, 1.0)
    found = simulate(ship, ship.vector(SHIP | {"w": 0.2, "m_max": 2.0}), time, {"n_set": demand})
    settled = equilibrium(ship, ship.vector(SHIP | {"w": 0.2, "m_max": 2.0}), {"n_set": 0.1})
    for output in ("n", "M_s", "v_s"):
        assert found.outputs[output][-1] == pytest.approx(settled.outputs[output], abs=1e-6)
    # the shaft has done half of its way when the ship has done a tenth; until it follows, a turn takes more torque
    at = np.searchsorted(time, 2.0)
    assert found.outputs["n"][at] > 0.45 * settled.outputs["n"]
    assert found.outputs["v_s"][at] < 0.15 * settled.outputs["v_s"]
    per_turn = settled.outputs["M_s"] / settled.outputs["n"]
    assert found.outputs["M_s"][at] / found.outputs["n"][at] > per_turn + 0.3


def test_wake_as_a_parameter_reaches_the_simulation():
    ship = with_known_propeller(structure("FREE-LOG"), PROPELLER, mass_kg=57240.0)
    values = ship.vector({key: value for key, value in SHIP.items() if key in ship.names} | {"w": 0.2, "R": 43000.0})
    time = np.arange(0.0, 60.0, 0.01)
    found = simulate(ship, values, time, {"n_set": np.where(time > 0.5, 1e-3, 0.0)}, wanted=("w",))
    assert found.outputs["n"][-1] == pytest.approx(1e-3, rel=1e-5)
    moved = values.astype(np.complex128)
    moved[ship.names.index("w")] += 1e-30j
    stepped = simulate(ship, moved, time, {"n_set": np.where(time > 0.5, 1e-3, 0.0)})
    exact = np.imag(stepped.outputs["M_s"]) / 1e-30
    np.testing.assert_allclose(found.derivatives["M_s"][0], exact, atol=1e-10 * np.abs(exact).max())


def test_pitch_moves_no_faster_than_its_pumps():
    lag = Parameter("tau_th", "s", 0.0, 5.0, 0.5, "lag")

    def equations(flow, u, p):
        return {"theta": pitch_actuator(flow, u, lag_s=p.tau_th, fastest=0.1)}

    diagram = Diagram("pitch", "theta_set", ("theta",), equations, (lag,))
    model = Structure(name="pitch", title="pitch", input="theta_set", outputs=dict(diagram.ports()))
    time = np.arange(0.0, 20.0, 0.01)
    found = simulate(model, [0.5], time, {"theta_set": np.where(time >= 1.0, 1.0, 0.0)}).outputs["theta"]
    # a ramp of 0.1 / s behind the lag: 0.1 (t - tau (1 - exp(-t / tau))) while it lasts
    t = time - 0.99
    ramp = (t > 0.0) & (t < 9.5)
    np.testing.assert_allclose(found[ramp], 0.1 * (t - 0.5 * (1.0 - np.exp(-t / 0.5)))[ramp], atol=2e-3)
    assert found[-1] == pytest.approx(1.0, abs=1e-6)


def test_a_pitch_that_cannot_move_is_refused():
    diagram = Diagram(
        "pitch",
        "u",
        ("y",),
        lambda flow, u, p: {"y": pitch_actuator(flow, u, lag_s=1.0, fastest=0.0)},
        (Parameter("k", "-", 0.0, 1.0, 0.5, "number"),),
    )
    model = Structure(name="pitch", title="pitch", input="u", outputs=dict(diagram.ports()))
    with pytest.raises(StructureError, match="expected a fastest change above zero"):
        simulate(model, [0.5], np.arange(3.0), {"u": np.zeros(3)})
