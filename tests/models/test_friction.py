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


SPEED_DROP = 8.0


def coasting(rate_hz, states, **values):
    """A rotor that dry friction alone brings to a stop, at 8 rad/s^2."""
    parameters = (SIZE, Parameter("t_w", "s", 1e-6, 1.0, 1e-3, "time within which friction follows"))

    def equations(flow, torque, p):
        speed = flow.state("speed")
        dry = coulomb_friction(flow, speed, p.T_C, yielding=1e-3, within_s=p.t_w)
        flow.rate(speed, SPEED_DROP / 2.0 * (torque - dry))
        return {"y": speed}

    diagram = Diagram("rotor", "u", ("y",), equations, parameters)
    rotor = Structure(name="ROTOR", title="a rotor", input="u", outputs=dict(diagram.ports()))
    time = np.arange(0.0, 2.0, 1.0 / rate_hz)
    values = rotor.vector(values)
    moved = simulate(rotor, values, time, {"u": np.zeros(time.size)}, longest_step_s=1.0 / rate_hz, initial=states)
    return time, moved.outputs["y"]


@pytest.mark.parametrize(("rate_hz", "within_s"), [(20.0, 1e-3), (200.0, 1e-4)])
def test_steps_follow_dry_friction_in_motion_too(rate_hz, within_s):
    """At rest bristles stand still and show no time of their own; steps of a sample would run away in motion.

    On a way of 1e-3, by which what is held yields, the rotor reaches or loses sqrt(2 8 1e-3) = 0.13 rad/s.
    """
    time, speed = coasting(rate_hz, [10.0, 1.0], t_w=within_s)
    assert speed == pytest.approx(np.maximum(10.0 - SPEED_DROP * time, 0.0), abs=0.13)


@pytest.mark.parametrize("speed", [10.0, -10.0])
def test_bristles_that_are_bent_too_far_give_no_impulse(speed):
    """A search for the states of a start that met one would follow the noise of the first sample with it."""
    _, bent = coasting(200.0, [speed, np.sign(speed)])
    _, too_far = coasting(200.0, [speed, 1e5 * np.sign(speed)])
    assert too_far == pytest.approx(bent, abs=1e-9)
