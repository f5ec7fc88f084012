"""A diesel with an electric machine at large: small signals are GAUGE-HYBRID's, and a clutch gives what it holds."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.catalogue._hybrid_at_large import limited_hybrid
from shaftprint.errors import StructureError
from shaftprint.simulation import simulate

OMEGA = np.geomspace(0.05, 10.0, 25)
LINE = {"K_p": 4.0, "K_i": 2.5, "t_d": 0.06, "omega_n": 11.0, "zeta": 0.5, "g": -0.1, "tau_dn": 0.3, "tau_up": 1.0}
LINE |= {"k_q": 2.0, "t_sp": 0.05, "s_m": 0.35, "c_m": 1.02, "t_gauge": 0.001}
TORQUE = {"m_max": 2.0, "m_min": -0.4, "T_aw": 0.5}


def of(model, values):
    return model.vector({name: value for name, value in values.items() if name in model.names})


def test_small_signals_without_a_clutch_are_those_of_the_linear_structure():
    linear, large = structure("GAUGE-HYBRID"), limited_hybrid("torque")
    expected = linear.response(of(linear, LINE), 1j * OMEGA)
    found = large.response(of(large, LINE | TORQUE), 1j * OMEGA)
    for output in ("n", "M_s"):
        for source in ("n_set", "M_m"):
            one, other = (
                response[list(model.channels).index((output, source))]
                for response, model in ((expected, linear), (found, large))
            )
            np.testing.assert_allclose(other, one, rtol=1e-9)


def test_a_clutch_that_holds_changes_half_a_percent():
    rigid, closed = limited_hybrid("torque"), limited_hybrid("torque", "clutch")
    values = LINE | TORQUE | {"m_c": 5.0, "k_c": 1e4, "c_c": 30.0, "s_c": 0.1}
    time = np.arange(0.0, 10.0, 0.001)
    # a jump of the machine meets the clutch first: its spring takes some milliseconds
    inputs = {"n_set": np.where(time < 1.0, 0.0, 0.05), "M_m": -0.2 * np.clip(time - 5.0, 0.0, 1.0)}
    one = simulate(rigid, of(rigid, values), time, inputs).outputs
    other = simulate(closed, of(closed, values), time, inputs).outputs
    for name in ("n", "n_l", "M_s"):
        np.testing.assert_allclose(other[name], one[name], atol=0.005 * np.abs(one[name]).max())


def test_a_clutch_slips_at_what_it_holds_and_closes_again():
    model = limited_hybrid("torque", "clutch")
    # the diesel gives 0.65 of the torque; when the machine trips it would have to give all of it
    values = LINE | TORQUE | {"c_m": 1.0, "s_m": 0.35, "m_c": 0.8, "s_c": 0.1, "t_sp": 0.0}
    time = np.arange(0.0, 60.0, 0.0025)
    trips = (time > 2.0) & (time < 20.0)
    inputs = {"n_set": np.zeros_like(time), "M_m": np.where(trips, -0.35, 0.0)}
    found = simulate(model, of(model, values), time, inputs).outputs
    torque = 0.65 + found["M_c"]
    assert torque.max() == pytest.approx(0.8, abs=1e-9)
    # slipping steadily, the line turns as 0.8 of the torque turns it: n^2 = 0.8
    at = np.searchsorted(time, 19.9)
    assert found["n_l"][at] == pytest.approx(np.sqrt(0.8) - 1.0, abs=1e-3)
    # the governor keeps the diesel at its speed meanwhile
    assert found["n"][at] == pytest.approx(0.0, abs=2e-3)
    # the machine comes back: both speeds meet, and are what they were
    assert np.abs(found["n"][-1] - found["n_l"][-1]) < 1e-6
    assert found["n_l"][-1] == pytest.approx(0.0, abs=2e-3)


def test_an_unknown_limit_is_refused():
    with pytest.raises(StructureError, match="there is no limit 'brake'"):
        limited_hybrid("brake")
