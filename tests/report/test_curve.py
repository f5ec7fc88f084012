import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import StructureError
from shaftprint.report import Curve
from shaftprint.report._curve import closed_loop_curve, open_loop_curve

S = 1j * np.geomspace(0.05, 30.0, 30)


def test_closed_loop_of_ol1_and_ol5_is_cl4():
    values = {"K_p": 1.6, "K_i": 4.4, "t_d": 0.116, "omega_n": 9.77, "zeta": 0.4}
    core = Curve.at(structure("OL1"), {"tau_n": 0.329})
    joined = closed_loop_curve(core, Curve.at(structure("OL5"), values))
    cl4 = structure("CL4")
    expected = cl4.response(cl4.vector(values | {"tau_n": 0.329}), S)
    np.testing.assert_allclose(joined.structure.response(joined.values, S), expected, rtol=1e-12)
    assert joined.label == "OL1+OL5"
    assert joined.covariance is None


def test_open_loop_of_cl4_is_ol5(fits):
    closed = Curve.of(fits["CL4"])
    opened = open_loop_curve(closed)
    ol5 = structure("OL5")
    values = ol5.vector({name: fits["CL4"].value(name) for name in ol5.names})
    np.testing.assert_allclose(opened.structure.response(opened.values, S), ol5.response(values, S), rtol=1e-9)
    assert opened.covariance is closed.covariance


def test_open_loop_of_the_benchmark_keeps_the_engine_s_slope():
    """M_s / e = v C (tau s + 2) / (tau s + 2 - g), derived from M_s = g n + v C e and n = M_s / (tau s + 2)."""
    tau, gain, integral, slope, rack = 0.4, 3.0, 2.0, -0.5, 1.2
    named = {"tau_n": tau, "K_p": gain, "K_i": integral, "g": slope, "v": rack}
    opened = open_loop_curve(Curve.at(structure("BENCHMARK"), named))
    expected = rack * (gain + integral / S) * (tau * S + 2.0) / (tau * S + 2.0 - slope)
    np.testing.assert_allclose(opened.structure.response(opened.values, S)[0], expected, rtol=1e-9)


def test_the_wrong_kind_of_model_is_refused():
    core, governor = (Curve.at(structure(name), {}) for name in ("OL1", "OL2"))
    with pytest.raises(StructureError, match="OL1: expected outputs n and M_s of n_set"):
        open_loop_curve(core)
    with pytest.raises(StructureError, match="expected n of M_s and M_s of e, found M_s of e, n of M_s"):
        closed_loop_curve(governor, core)
