"""Free responses: what a structure shows without input, held against solutions in time that begin in motion."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.models._free_response import free_responses

TRUTH = {"tau_n": 0.39, "K_p": 1.8, "K_i": 4.3, "t_d": 0.12, "omega_n": 9.0, "zeta": 1.2}
GAUGE = {"tau_dn": 0.32, "tau_up": 1.0, "K_p": 5.7, "K_i": 4.27, "t_d": 0.07, "omega_n": 10.3, "zeta": 0.47}


def free_motion(tau, own_tau, of, *, steps_a_second=10_000, duration_s=40.0):
    """Return speed and torque of the loop without input, from an arbitrary state with a full delay line.

    Heun's method on the equations in time; the delay is a whole number of steps.
    """
    step = 1.0 / steps_a_second
    lag, count = round(of["t_d"] / step), round(duration_s / step)
    n, m, given = np.zeros(count), np.zeros(count), np.zeros(count + lag)
    integral, rate = 0.3, -0.7
    n[0], m[0] = 0.2, -0.4
    given[:lag] = 0.5 + 1.5 * np.arange(lag) * step
    w, zeta = of["omega_n"], of["zeta"]
    for i in range(count - 1):
        given[i + lag] = -of["K_p"] * n[i] + of["K_i"] * integral
        d_rate = w * w * (given[i] - m[i]) - 2.0 * zeta * w * rate
        d_n = (m[i] - 2.0 * n[i]) / tau
        n_1, m_1, rate_1 = n[i] + step * d_n, m[i] + step * rate, rate + step * d_rate
        e_rate = w * w * (given[i + 1] - m_1) - 2.0 * zeta * w * rate_1
        m[i + 1] = m[i] + 0.5 * step * (rate + rate_1)
        integral -= 0.5 * step * (n[i] + n_1)
        n[i + 1] = n[i] + 0.5 * step * (d_n + (m_1 - 2.0 * n_1) / tau)
        rate += 0.5 * step * (d_rate + e_rate)
    # torque at the gauge: what turns the part behind it, tau_dn n' + 2 n; without one it is the engine's
    return n, m if own_tau is None else own_tau * (m - 2.0 * n) / tau + 2.0 * n


def left_over(name, truth, outputs, step):
    """Return the share of each transformed motion that no sum of free responses with real sizes can follow."""
    shipped = structure(name)
    shapes, channels = free_responses(shipped)
    frequency = np.fft.rfftfreq(outputs[0].size, step)
    lines = (frequency > 0.0) & (frequency < 4.0)
    found = shapes.response(shapes.vector(truth), 2j * np.pi * frequency[lines])
    shares = []
    for place, values in enumerate(outputs):
        ends = values.copy()
        ends[0] *= 0.5
        transformed = np.fft.rfft(ends)[lines]
        columns = found[[c == place for c in channels]].T
        columns = columns / np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
        a, b = (np.concatenate([x.real, x.imag]) for x in (columns, transformed))
        sizes = np.linalg.lstsq(a, b, rcond=1e-9)[0]
        shares.append(np.linalg.norm(b - a @ sizes) / np.linalg.norm(b))
    return shares


@pytest.mark.slow
def test_free_responses_of_a_loop_with_delay_follow_any_start():
    assert max(left_over("CL4", TRUTH, free_motion(0.39, None, TRUTH), 1e-4)) < 1e-4


@pytest.mark.slow
def test_free_responses_know_the_gauge():
    motion = free_motion(1.32, 0.32, GAUGE, duration_s=60.0)
    assert max(left_over("GAUGE-CLOSED", GAUGE | {"t_sp": 0.03}, motion, 1e-4)) < 1e-3


def test_a_lag_goes_on_with_its_own_two_motions():
    """1 / D and s / D of s^2 + 2 zeta omega s + omega^2, by hand."""
    shapes, channels = free_responses(structure("OL4"))
    s = 2j * np.pi * np.array([0.01, 0.5, 3.0])
    values = {"K_p": 2.0, "K_i": 3.0, "omega_n": 9.0, "zeta": 0.7}
    found = shapes.response(shapes.vector(values), s)
    below = s * s + 2 * 0.7 * 9.0 * s + 81.0
    assert channels == (0, 0, 0)
    np.testing.assert_allclose(found[:2], [1.0 / below, s / below], rtol=1e-12)
    np.testing.assert_allclose(found[2], (81.0 / below) / s, rtol=1e-12)


@pytest.mark.parametrize("delay", [0.4, 1e-3, 1e-7, 0.0])
def test_a_delay_goes_on_with_what_is_under_way(delay):
    """The transforms of 1 / t and of 2 (1 - 2 v / t) / t^2 over 0 < v < t, integrated by many midpoints."""
    shapes, _ = free_responses(structure("OL3"))
    s = 2j * np.pi * np.array([0.02, 0.7, 3.9])
    found = shapes.response(shapes.vector({"K_p": 1.0, "K_i": 0.0, "t_d": delay}), s)
    places = (np.arange(200_000) + 0.5) / 200_000
    late = np.exp(-np.outer(s * delay, places))
    np.testing.assert_allclose(found[0], late.mean(axis=1), rtol=1e-9)
    if delay > 1e-4:
        np.testing.assert_allclose(found[1], 2.0 * (late * (1.0 - 2.0 * places)).mean(axis=1) / delay, rtol=1e-7)
    else:
        # the integral of -2 s v (1 - 2 v / t) / t^2 is s / 3
        np.testing.assert_allclose(found[1], s / 3.0, rtol=1e-4)


@pytest.mark.parametrize(
    ("name", "truth"),
    [
        ("CL4", TRUTH),
        ("GAUGE-CLOSED", GAUGE | {"t_sp": 0.03, "t_gauge": 0.01}),
        ("GAUGE-INFLOW", GAUGE | {"t_sp": 0.03, "t_gauge": 0.01, "kappa": 0.8, "tau_i": 0.15}),
    ],
)
def test_derivatives_are_those_of_the_responses(name, truth):
    shapes, _ = free_responses(structure(name))
    s = 2j * np.pi * np.array([0.003, 0.1, 1.0, 3.9])
    values = shapes.vector(truth)
    _, slopes = shapes.gradient(values, s)
    for place, parameter in enumerate(shapes.free):
        index = shapes.names.index(parameter.name)
        step = 1e-4 * max(abs(values[index]), 0.1)
        row = [values + k * step * np.eye(values.size)[index] for k in (-2, -1, 1, 2)]
        far_below, below, above, far_above = shapes.response(np.array(row), s)
        expected = (8.0 * (above - below) - (far_above - far_below)) / (12.0 * step)
        scale = np.abs(expected).max() + 1e-9
        np.testing.assert_allclose(slopes[place] / scale, expected / scale, atol=2e-6, err_msg=parameter.name)


def test_a_pick_up_with_a_window_goes_on_with_the_mean_of_what_was():
    """A constant before the start leaves a mean over T and late by d with its ramp: (1 - exp(-s d) sinc) / s."""
    free = ("T_average", "t_pickup")
    gauge = structure("GAUGE-CORE").held_at(T_hold=0.0).free_between(T_average=(0.0, 1.0), t_pickup=(0.0, 1.0))
    shapes, _ = free_responses(gauge)
    omega = 2.0 * np.pi * np.array([0.05, 0.7, 3.9])
    values = shapes.vector({"T_average": 0.3, "t_pickup": 0.2})
    found, slopes = shapes.gradient(values, 1j * omega, free)
    late, mean = np.exp(-0.2j * omega), np.sinc(0.15 * omega / np.pi)
    expected = (1.0 - late * mean) / (1j * omega)
    apart = np.abs(found[:, None] - expected).max(axis=(1, 2))
    place = int(np.argmin(apart))
    assert apart[place] < 1e-8
    # d/dT sin(a) / a with a = omega T / 2, and d/dd exp(-s d)
    by_window = -late * (np.cos(0.15 * omega) - mean) / 0.3 / (1j * omega)
    np.testing.assert_allclose(slopes[0, place], by_window, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(slopes[1, place], late * mean, rtol=1e-6, atol=1e-9)


def test_held_parts_that_do_nothing_have_no_free_response():
    """A pick-up without window, hold and delay, and a telemetry without low-pass, remember nothing."""
    _, channels = free_responses(structure("GAUGE-CLOSED"))
    # governor 1, delay 2, lag 2, shaft 1, set-point delay 2; torque besides: the balance 1, telemetry delay 2
    assert (channels.count(0), channels.count(1)) == (8, 11)
