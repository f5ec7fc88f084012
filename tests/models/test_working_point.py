"""The same line at another working point, against equations of motion in physical units."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import StructureError
from shaftprint.models import at_working_point, check_structure


def test_bollard_pull_from_physical_constants():
    """``2 pi I dn/dt``, ``K_p`` in N m/(rev/s) and ``A_1`` stay; torque goes with the square of the speed.

    Normalised, ``tau = 2 pi I n_0 / M_0`` and the like are then larger by one over the speed (thesis eqs 2.14-2.25).
    """
    gauge = structure("GAUGE-CLOSED")
    values = gauge.vector({"K_p": 5.7, "K_i": 4.27, "tau_dn": 0.32, "tau_up": 1.016, "g": -0.2})
    s = 2j * np.pi * np.geomspace(0.03, 3.0, 20)
    speed_rev_s, torque_nm = 0.7 * 5.165, 0.7**2 * 1725.0

    def normalised(physical):
        return physical * speed_rev_s / torque_nm

    physical = {
        name: values[gauge.names.index(name)] * 1725.0 / 5.165 for name in ("K_p", "K_i", "tau_dn", "tau_up", "g")
    }
    other = gauge.vector({"t_d": 0.1} | {name: normalised(value) for name, value in physical.items()})
    expected = gauge.response(other, s)
    assert at_working_point(gauge, speed_share=0.7).response(values, s) == pytest.approx(expected, rel=1e-12)


def test_torque_that_does_not_go_with_the_square():
    gauge = structure("GAUGE-CLOSED")
    moved = at_working_point(gauge, speed_share=0.8, torque_share=0.6)
    over_torque = dict.fromkeys(("tau_dn", "tau_up", "K_p", "K_i", "g"), 0.8 / 0.6)
    assert moved.factors == pytest.approx({**over_torque, "k_q": 1.0 / 0.6})


def test_zero_of_the_gauge():
    """``Q n^2 + z`` is shown, and ``d ln M / d ln n`` is ``2 Q n^2 / (Q n^2 + z)``: another number at each speed."""
    gauge, q, zero = structure("GAUGE-CLOSED"), 1.5, 0.02
    shown = [q * speed**2 + zero for speed in (1.0, 0.7)]
    slopes = [2.0 * q * speed**2 / torque for speed, torque in zip((1.0, 0.7), shown, strict=True)]
    torque_share = shown[1] / shown[0]
    moved = at_working_point(gauge, speed_share=0.7, torque_share=torque_share)
    s = 2j * np.pi * np.geomspace(0.03, 3.0, 20)
    values = dict(zip(gauge.names, gauge.vector({}), strict=True))
    other = values | {name: values[name] * 0.7 / torque_share for name in ("tau_dn", "tau_up", "K_p", "K_i", "g")}
    expected = gauge.response(gauge.vector(other | {"k_q": slopes[1]}), s)
    assert moved.response(gauge.vector({"k_q": slopes[0]}), s) == pytest.approx(expected, rel=1e-12)
    check_structure(moved)


def test_a_rack_that_does_not_go_with_the_torque():
    """``dX = K dn`` and ``dM = V dX`` in physical units: normalised ``K n_0 / X_0`` and ``V X_0 / M_0``."""
    ecu = structure("GAUGE-ECU")
    physical = {"K_p": 0.12, "K_i": 0.09, "v": 4200.0}
    points = ((5.165, 1725.0, 0.4), (4.1, 1000.0, 0.27))

    def values(speed, torque, rack):
        gains = {name: physical[name] * speed / rack for name in ("K_p", "K_i")}
        times = {name: second * speed / torque for name, second in (("tau_dn", 110.0), ("tau_up", 330.0), ("g", 30.0))}
        return ecu.vector(gains | times | {"v": physical["v"] * rack / torque})

    speed, torque, rack = (second / first for first, second in zip(*points, strict=True))
    s = 2j * np.pi * np.geomspace(0.03, 3.0, 20)
    moved = at_working_point(ecu, speed_share=speed, torque_share=torque, shown_share=1.0, rack_share=rack)
    assert moved.response(values(*points[0]), s) == pytest.approx(ecu.response(values(*points[1]), s), rel=1e-12)


def test_shares_that_are_not_positive():
    with pytest.raises(StructureError, match="expected positive shares of speed, torque and rack, found 0, 0 and 0"):
        at_working_point(structure("GAUGE-CLOSED"), speed_share=0.0)
