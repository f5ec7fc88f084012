"""Wageningen B against a worked example, and against what must hold for any propeller."""

import math

import numpy as np
import pytest

from shaftprint.errors import PropellerError
from shaftprint.propeller import wageningen_b

TESTED = [(2, 0.30), (3, 0.35), (3, 0.80), (4, 0.40), (4, 1.00), (5, 0.45), (5, 1.05), (6, 0.50), (7, 0.85)]


def test_worked_example_of_kuiper():
    """G. Kuiper, The Wageningen Propeller Series (MARIN 92-001, 1992), chapter 9.3.

    B4-55, P/D 1.0, diameter 7 m, thrust 1393 kN, advance 8.65 m/s in sea water: J 0.699, K_T 0.181, K_Q 0.0310,
    efficiency 0.651, 1.767 rev/s, 1667 kN m.
    """
    point = wageningen_b(blades=4, area_ratio=0.55).at(0.699, 1.0)
    assert point.thrust == pytest.approx(0.181, abs=5e-4)
    assert point.torque == pytest.approx(0.0310, abs=5e-5)
    assert point.efficiency == pytest.approx(0.651, abs=5e-4)
    speed = 8.65 / (0.699 * 7.0)
    assert speed == pytest.approx(1.767, abs=1e-3)
    assert 1025.0 * speed**2 * 7.0**4 * point.thrust == pytest.approx(1393e3, rel=2e-3)
    assert 1025.0 * speed**2 * 7.0**5 * point.torque == pytest.approx(1667e3, rel=2e-3)


@pytest.mark.parametrize(("blades", "area_ratio"), TESTED)
@pytest.mark.parametrize("pitch_ratio", [0.5, 0.8, 1.1, 1.4])
def test_a_free_wheeling_propeller_still_takes_torque(blades, area_ratio, pitch_ratio):
    """Where the thrust ends friction remains: ``K_Q`` above 0 all the way, so that no efficiency reaches 1.

    A digit or a sign wrong in the terms of high order shows here first: ``J^3 (P/D)^6 Z^2`` ten times too large makes
    ``K_Q`` negative.
    """
    curve = wageningen_b(blades=blades, area_ratio=area_ratio)
    last = curve.zero_thrust_advance(pitch_ratio)
    points = [curve.at(j, pitch_ratio) for j in np.linspace(0.0, last, 41)[:-1]]
    assert min(point.torque for point in points) > 0.0
    assert 0.3 < max(point.efficiency for point in points) < 0.9
    # thrust ends where the blades' mean angle of attack does: a little above the geometric pitch
    assert 1.0 < last / pitch_ratio < 1.3


@pytest.mark.parametrize(("blades", "area_ratio"), [(4, 0.70), (5, 0.75)])
def test_thrust_and_torque_fall_with_advance_and_grow_with_pitch(blades, area_ratio):
    curve = wageningen_b(blades=blades, area_ratio=area_ratio)
    for pitch_ratio in (0.7, 1.0, 1.2):
        for advance in (0.1, 0.3, 0.5):
            point = curve.at(advance, pitch_ratio)
            assert min(-point.a, -point.b, point.p, point.q) > 0.0


@pytest.mark.parametrize(("advance", "pitch_ratio"), [(0.0, 1.0), (0.31, 0.83), (0.72, 1.27)])
def test_slopes_are_those_of_the_curve(advance, pitch_ratio):
    curve, step = wageningen_b(blades=4, area_ratio=0.70), 1e-5
    point = curve.at(advance, pitch_ratio)
    more, less = curve.at(advance, pitch_ratio * (1 + step)), curve.at(advance, pitch_ratio * (1 - step))
    assert point.p == pytest.approx(math.log(more.thrust / less.thrust) / (2 * step), rel=1e-6)
    assert point.q == pytest.approx(math.log(more.torque / less.torque) / (2 * step), rel=1e-6)
    if advance:
        ahead, behind = curve.at(advance * (1 + step), pitch_ratio), curve.at(advance * (1 - step), pitch_ratio)
        assert point.a == pytest.approx(math.log(ahead.thrust / behind.thrust) / (2 * step), rel=1e-6)
        assert point.b == pytest.approx(math.log(ahead.torque / behind.torque) / (2 * step), rel=1e-6)


def test_an_open_propeller_has_no_nozzle():
    assert wageningen_b(blades=4, area_ratio=0.70).at(0.3, 1.0).nozzle_thrust == 0.0


@pytest.mark.parametrize(
    ("blades", "area_ratio", "words"),
    [
        (1, 0.5, "from 2 to 7 blades, found 1"),
        (8, 0.5, "from 2 to 7 blades, found 8"),
        (4, 0.35, "A_E/A_0 from 0.4 to 1 for 4 blades, found 0.35"),
        (5, 1.1, "A_E/A_0 from 0.45 to 1.05 for 5 blades, found 1.1"),
    ],
)
def test_propellers_that_were_never_tested_are_refused(blades, area_ratio, words):
    with pytest.raises(PropellerError, match=words):
        wageningen_b(blades=blades, area_ratio=area_ratio)
