"""Friction and play as parts of equations: what they do at constant speed, at rest and where the motion turns."""

import numpy as np
import pytest

from shaftprint.models import Diagram, Parameter, Structure, backlash, coulomb_friction, stribeck_friction
from shaftprint.simulation import simulate

SIZE = Parameter("T_C", "N m", 0.0, 10.0, 2.0, "friction")
EXCESS = Parameter("b", "-", 1.0, 3.0, 1.5, "friction of what begins to move over that of what moves")
GAP = Parameter("gap", "rad", 0.0, 1.0, 0.3, "play")
T = np.arange(0.0, 4.0, 0.001)


def answer(equations, parameters, signal, **values):
    diagram = Diagram("part", "u", ("y",), equations, parameters)
    part = Structure(name="PART", title="a part", input="u", outputs=dict(diagram.ports()))
    moved = simulate(part, part.vector(values), T, {"u": signal}, wanted=[p.name for p in parameters])
    return moved.outputs["y"], moved.derivatives["y"]


def dry(flow, speed, p):
    return {"y": coulomb_friction(flow, speed, p.T_C, yielding=1e-3, within_s=1e-3)}


def stribeck(flow, speed, p):
    friction = stribeck_friction(flow, speed, p.T_C, breakaway=p.b, fading_speed=0.5, yielding=1e-3, within_s=1e-3)
    return {"y": friction}


def test_dry_friction_has_the_sign_of_the_speed():
    friction, slopes = answer(dry, (SIZE,), np.where(T < 2.0, 3.0, -3.0))
    assert friction[500:1990] == pytest.approx(2.0)
    assert friction[2020:] == pytest.approx(-2.0)
    assert slopes[0, 1000] == pytest.approx(1.0)


def test_dry_friction_holds_what_was_moved_by_less_than_it_yields():
    """A move of half of the angle by which it yields bends the bristles by half, and they stay bent."""
    friction, _ = answer(dry, (SIZE,), np.where((T > 1.0) & (T < 1.1), 5e-3, 0.0))
    assert friction[:990] == pytest.approx(0.0, abs=1e-12)
    assert friction[1500] == pytest.approx(2.0 * (1.0 - np.exp(-0.5)), rel=0.05)
    assert friction[-1] == pytest.approx(friction[1500])


@pytest.mark.parametrize("speed", [0.05, 0.5, 2.0])
def test_stribeck_friction_fades_with_the_speed(speed):
    friction, _ = answer(stribeck, (SIZE, EXCESS), np.full(T.size, speed))
    assert friction[-1] == pytest.approx(2.0 * (1.0 + 0.5 * np.exp(-((speed / 0.5) ** 2))), rel=1e-6)


def test_play_lets_a_signal_turn_without_moving_the_other():
    swing = np.sin(np.pi * T)
    pushed, _ = answer(lambda flow, u, p: {"y": backlash(flow, u, p.gap, within_s=2e-3)}, (GAP,), swing)
    last = T > 2.0
    assert pushed[last].max() == pytest.approx(1.0 - 0.15, abs=0.01)
    assert pushed[last].min() == pytest.approx(-(1.0 - 0.15), abs=0.01)
    crest = (T > 2.5) & (swing > 1.0 - 0.28) & (T < 3.0)
    assert np.ptp(pushed[crest]) < 0.01
