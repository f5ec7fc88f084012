"""Step responses against closed forms and against the method of steps."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import StructureError
from shaftprint.models import Delay, Gain, Integrator, Parameter, Structure, feedback, step_response

GAIN = Parameter("K", "1/s", 0.0, 7.0, 1.0, "gain")
DELAY = Parameter("T", "s", 0.0, 5.0, 0.5, "delay")


def delayed_integrator(*, closed):
    loop = Gain(GAIN) * Integrator() * Delay(DELAY)
    output = feedback(loop) if closed else loop
    return Structure(name="DELAYED", title="delayed integrator", input="u", outputs={"y": output})


def test_of_a_first_order_shaft():
    """``1 / (tau s + 2)``: half of ``1 - exp(-2 t / tau)``."""
    model = structure("OL1")
    time = np.linspace(0.0, 3.0, 61)
    found, slopes = step_response(model, model.vector({"tau_n": 0.4}), time, ["tau_n"])
    np.testing.assert_allclose(found[0, 1:], 0.5 * (1.0 - np.exp(-5.0 * time[1:])), atol=2e-6)
    assert found[0, 0] == 0.0
    np.testing.assert_allclose(slopes[0, 0, 1:], -6.25 * time[1:] * np.exp(-5.0 * time[1:]), atol=1e-5)


def test_of_the_initial_closed_loop():
    """``(a s + b) / (s^2 + c s + b)`` with real poles, by partial fractions."""
    model = structure("BENCHMARK")
    values = {"tau_n": 0.5, "K_p": 2.0, "K_i": 2.0, "g": -1.0, "v": 1.0}
    a, b, c = 2.0 / 0.5, 2.0 / 0.5, (2.0 + 1.0 + 2.0) / 0.5
    slow, fast = np.roots([1.0, c, b])[::-1]
    time = np.linspace(0.05, 12.0, 100)
    exact = 1.0 + sum((a * p + b) / (p * (p - q)) * np.exp(p * time) for p, q in ((slow, fast), (fast, slow)))
    found, _ = step_response(model, model.vector(values), time)
    np.testing.assert_allclose(found[0], exact, atol=2e-5)


def test_of_an_integrator_with_delay_and_feedback():
    """Method of steps: ``K (t - T)``, then ``- K^2 (t - 2 T)^2 / 2``, then ``+ K^3 (t - 3 T)^3 / 6`` ..."""
    model = delayed_integrator(closed=True)
    time = np.linspace(0.0, 3.0, 200)
    exact = sum(
        -((-1.3) ** k) * np.maximum(time - 0.5 * k, 0.0) ** k / float(np.prod(np.arange(1, k + 1))) for k in range(1, 7)
    )
    found, _ = step_response(model, model.vector({"K": 1.3, "T": 0.5}), time)
    np.testing.assert_allclose(found[0], exact, atol=1e-3)
    # a corner is drawn out over milliseconds, all else is exact
    assert np.sort(np.abs(found[0] - exact))[-10] < 3e-5


def test_of_a_line_that_never_settles():
    """A delayed ramp."""
    model = delayed_integrator(closed=False)
    time = np.linspace(0.6, 40.0, 50)
    found, slopes = step_response(model, model.vector({"K": 2.0, "T": 0.5}), time, ["K", "T"])
    np.testing.assert_allclose(found[0], 2.0 * (time - 0.5), rtol=2e-4, atol=2e-3)
    np.testing.assert_allclose(slopes[0, 0], time - 0.5, rtol=2e-4, atol=2e-3)
    np.testing.assert_allclose(slopes[1, 0], -2.0, atol=5e-2)


def test_jump_at_once_rings_no_more_after_a_hundredth_of_the_time():
    """A PI governor: ``K_p + K_i t``."""
    model = structure("OL2")
    time = np.linspace(0.02, 2.0, 100)
    found, _ = step_response(model, model.vector({"K_p": 3.0, "K_i": 4.0}), time)
    np.testing.assert_allclose(found[0], 3.0 + 4.0 * time, atol=2e-3)


def test_derivatives_are_those_of_differences():
    model = structure("CL4")
    values = model.vector({"tau_n": 0.39, "K_p": 1.8, "K_i": 4.3, "t_d": 0.12, "omega_n": 9.0, "zeta": 0.6})
    names = [p.name for p in model.free]
    time = np.linspace(0.1, 4.0, 40)
    found, slopes = step_response(model, values, time, names)
    assert found.shape == (2, 40)
    assert slopes.shape == (6, 2, 40)
    for i, name in enumerate(names):
        moved = values.copy()
        moved[model.names.index(name)] += 1e-5
        ahead, _ = step_response(model, moved, time)
        np.testing.assert_allclose((ahead - found) / 1e-5, slopes[i], atol=2e-3 * np.abs(slopes[i]).max())


@pytest.mark.parametrize("time", [[0.0], [-1.0, 2.0]])
def test_times_are_after_the_step(time):
    model = structure("OL1")
    with pytest.raises(StructureError, match=r"step response of OL1: expected times from 0 s on"):
        step_response(model, model.vector({}), time)
