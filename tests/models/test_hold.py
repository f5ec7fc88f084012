"""What a computer's hold does to a signal."""

import numpy as np
import pytest

from shaftprint.errors import StructureError
from shaftprint.models import Gain, Integrator, Parameter, Structure, ZeroOrderHold, feedback, margins

STEP = 0.02


def test_values_worked_out_by_hand():
    hold = ZeroOrderHold(STEP)
    # (1 - exp(-j pi)) / (j pi), (1 - exp(-2 j pi)) / (2 j pi), and half a step of delay at low frequency
    np.testing.assert_allclose(hold.transfer(1j * np.pi / np.array([STEP]), *()), [2.0 / (1j * np.pi)], rtol=1e-14)
    assert abs(hold.transfer(2j * np.pi / np.array([STEP]))[0]) < 1e-15
    slow = hold.transfer(1j * np.array([1e-6, 1e-3, 1e-1]))
    np.testing.assert_allclose(slow, np.exp(-1j * np.array([1e-6, 1e-3, 1e-1]) * STEP / 2.0), rtol=2e-7)
    assert hold.parameters == ()


def test_an_integrator_behind_a_hold_is_a_staircase_of_ramps():
    # sampled at its steps the held integral answers z^n with T / (z - 1); between them the hold keeps that in the
    # mean of all images, of which the first one alone is off by (f / f_s)^2
    for share in (0.01, 0.03):
        s = np.array([2j * np.pi * share / STEP])
        sampled = STEP / (np.exp(s * STEP) - 1.0)
        held = ZeroOrderHold(STEP).transfer(s) / s
        # of the sum over images (f / (f + k f_s))^2 with its sign, 2 pi^2 / 6 is left
        assert abs(held / sampled - 1.0)[0] == pytest.approx(np.pi**2 / 3.0 * share**2, rel=0.05)


def test_a_held_loop_has_the_margin_of_its_delay():
    # K / s behind a hold: phase -90 deg - w T / 2, crossover at K sinc(K T / 2)
    gain = Parameter("K", "1/s", 0.1, 100.0, 10.0, "gain")
    loop = Structure(
        name="x", title="x", input="r", outputs={"y": feedback(Gain(gain) * ZeroOrderHold(STEP) * Integrator())}
    )
    omega = 10.0
    for _ in range(50):
        omega = 10.0 * np.sinc(omega * STEP / 2.0 / np.pi)
    assert margins(loop, [10.0]).phase_margin_rad == pytest.approx(np.pi / 2.0 - omega * STEP / 2.0, rel=1e-9)


@pytest.mark.parametrize("step", [0.0, -1.0, float("nan"), float("inf")])
def test_a_step_that_is_none_is_refused(step):
    with pytest.raises(StructureError, match=r"hold: expected a period above 0 s, found"):
        ZeroOrderHold(step)
