"""A drive behind a held input, sampled: against exact discretisation by the matrix exponential."""

import numpy as np
import pytest
from scipy.linalg import expm

from shaftprint.models import Delay, Held, Parameter, RationalBlock, Structure, is_stable

R, L, K, J, B = 1.2, 4e-3, 0.06, 2.5e-4, 4e-4
T = 1.0 / 2000.0


def free(name, value):
    return Parameter(name, "-", 0.0, 10.0, value, name)


RESISTANCE, INDUCTANCE = free("R", R), free("L", L)


def below(r, l):  # noqa: E741
    return [l * J, l * B + r * J, r * B + K * K]


def motor():
    current = RationalBlock(lambda r, l: ([J, B], below(r, l)), (RESISTANCE, INDUCTANCE))  # noqa: E741
    speed = RationalBlock(lambda r, l: ([K], below(r, l)), (RESISTANCE, INDUCTANCE))  # noqa: E741
    return {"i": Held(current, T), "w": Held(speed, T)}


def exact(omega, r=R, l=L):  # noqa: E741
    """Sampled response of L i' = v - R i - K w, J w' = K i - b w with v held: C (z - A)^-1 B."""
    a = np.array([[-r / l, -K / l, 1.0 / l], [K / J, -B / J, 0.0], [0.0, 0.0, 0.0]])
    step = expm(a * T)
    return np.array([np.linalg.solve(np.exp(1j * w * T) * np.eye(2) - step[:2, :2], step[:2, 2]) for w in omega]).T


OMEGA = np.array([3.0, 50.0, 700.0, 3000.0, 6000.0])


def test_the_response_is_that_of_the_exact_discretisation_up_to_nyquist():
    drive = Structure(name="motor", title="motor", input="v", outputs=motor())
    found = drive.response(drive.vector({}), 1j * OMEGA)
    np.testing.assert_allclose(found, exact(OMEGA), rtol=1e-6)
    # without the images the current is off by far more than a good measurement
    plain = (J * 1j * OMEGA + B) / (L * J * (1j * OMEGA) ** 2 + (L * B + R * J) * 1j * OMEGA + R * B + K * K)
    plain = plain * np.exp(-0.5j * OMEGA * T) * np.sinc(OMEGA * T / 2.0 / np.pi)
    assert np.abs(plain / exact(OMEGA)[0] - 1.0)[2:].min() > 1e-3


def test_derivatives_are_those_of_the_exact_discretisation():
    drive = Structure(name="motor", title="motor", input="v", outputs=motor())
    _, slopes = drive.gradient(drive.vector({}), 1j * OMEGA)
    for place, (up, down, width) in enumerate(
        (
            ({"r": R * (1 + 1e-5)}, {"r": R * (1 - 1e-5)}, 2e-5 * R),
            ({"l": L * (1 + 1e-5)}, {"l": L * (1 - 1e-5)}, 2e-5 * L),
        )
    ):
        expected = (exact(OMEGA, **up) - exact(OMEGA, **down)) / width
        np.testing.assert_allclose(slopes[place], expected, rtol=1e-4)


def test_many_parameter_sets_and_a_factor_at_each_line():
    drive = Structure(name="motor", title="motor", input="v", outputs=motor())
    table = np.array([[1.0, 3e-3], [1.5, 6e-3]])
    factor = np.linspace(0.9, 1.1, OMEGA.size)
    batch = drive.response(table, 1j * OMEGA, factors={"R": factor})
    for row, (r, l) in enumerate(table):  # noqa: E741
        for line, omega in enumerate(OMEGA):
            expected = exact([omega], r=r * factor[line], l=l)[:, 0]
            np.testing.assert_allclose(batch[row, :, line], expected, rtol=1e-6)


def test_a_delay_of_whole_samples_passes_through():
    late = free("t", 3.0 * T)
    integrator = RationalBlock(lambda: ([1.0], [1.0, 0.0]), ())
    drive = Structure(name="late", title="late", input="u", outputs={"y": Held(integrator * Delay(late), T)})
    # the held integrator is T / (z - 1)
    z = np.exp(1j * OMEGA * T)
    np.testing.assert_allclose(drive.response([3.0 * T], 1j * OMEGA)[0], T / (z - 1.0) * z**-3, rtol=1e-6)
    assert drive.path("y").polynomials({"t": 0.0}) is None
    assert is_stable(drive, [3.0 * T])


@pytest.mark.parametrize("gain", [0.0, 2.0])
def test_a_gain_is_seen_in_the_middle_of_its_jumps(gain):
    """What does not fall towards high frequencies jumps when the sample is taken: the mean of before and after."""
    flat = RationalBlock(lambda k: ([k], [1.0]), (free("k", gain),))
    drive = Structure(name="flat", title="flat", input="u", outputs={"y": Held(flat, T)})
    expected = gain * (1.0 + np.exp(-1j * OMEGA * T)) / 2.0
    np.testing.assert_allclose(drive.response([gain], 1j * OMEGA)[0], expected, rtol=1e-6, atol=1e-12)
