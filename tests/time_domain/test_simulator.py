"""Records under the simulation with exact delays: against the frequency response, and from a start in motion."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.time_domain import TimeSettings, output_error, record_from_arrays
from shaftprint.time_domain._simulator import ExactDelays

RATE, OMEGA = 20.0, 2.0 * np.pi * 0.5
VALUES = {"tau_n": 0.33, "K_p": 1.6, "K_i": 4.4, "t_d": 0.116, "omega_n": 9.8, "zeta": 0.5}
TIME = np.arange(1200) / RATE


@pytest.fixture(scope="module")
def loop():
    return structure("CL4")


def sine_record(**changes):
    """A sine at 0.5 Hz; outputs are put in by each test."""
    u = 0.05 * np.sin(OMEGA * TIME)
    record = record_from_arrays("S", {"n_set": u}, {"n": u, "M_s": 2.0 * u}, rate_hz=RATE)
    return replace(record, **changes)


@pytest.mark.parametrize("load", [1.0, 1.1])
def test_settled_sine_is_the_frequency_response_under_its_load(loop, load):
    """Straight lines between samples leave ``sinc^2(f / rate)`` of the sine: 0.9979 at 0.5 Hz and 20 Hz."""
    term = output_error(loop, sine_record(load=load), settings=TimeSettings(drift_degree=-1))
    settled = term.model(loop.vector(VALUES))[400:]
    turn = np.exp(-1j * OMEGA * TIME[400:])
    found = 2.0 * np.mean(settled * turn[:, None], axis=0) / (0.05 / 1j)
    s = np.array([1j * OMEGA])
    exact = loop.response(loop.vector(VALUES), s, factors={"k_q": np.array([load])})[:, 0]
    np.testing.assert_allclose(found, np.sinc(0.5 / RATE) ** 2 * exact, rtol=1e-3)


def test_states_in_motion_are_found(loop):
    """The second half of a chirp, cut out of the whole: its outputs follow from no steady running."""
    u = 0.1 * np.sin(2.0 * np.pi * (0.05 + 0.008 * TIME) * TIME)
    whole = record_from_arrays("C", {"n_set": u}, {"n": u, "M_s": u}, rate_hz=RATE)
    bare = TimeSettings(drift_degree=-1)
    motion = output_error(loop, whole, settings=bare).model(loop.vector(VALUES))
    # delayed signals from before the cut are not known: the first seconds do not count
    half, used = slice(611, None), np.arange(TIME.size - 611) >= 10
    cut = record_from_arrays(
        "cut", {"n_set": u[half]}, {"n": motion[half, 0], "M_s": motion[half, 1]}, rate_hz=RATE, used=used
    )
    theta = np.array([[VALUES[p.name] for p in loop.free]])
    left = {}
    for states in (False, True):
        term = output_error(loop, cut, settings=replace(bare, initial_states=states))
        left[states] = np.sum(term.table(theta)[0, 0] ** 2)
    assert left[True] < 1e-2 * left[False]


def test_derivatives_are_those_of_the_cost(loop):
    term = output_error(loop, sine_record())
    theta = np.array([VALUES[p.name] for p in loop.free])
    table = term.table(theta[None])[0]
    for i, step in enumerate(np.diag(1e-4 * theta)):
        ahead, behind = term.table(np.array([theta + step, theta - step]))
        slope = (np.sum(ahead[0] ** 2) - np.sum(behind[0] ** 2)) / (4.0 * step[i])
        assert table[0] @ table[1 + i] == pytest.approx(slope, rel=1e-4, abs=1e-6 * np.sum(table[0] ** 2))


def test_unstable_loop_runs_away_and_costs_finitely(loop):
    theta = np.array([[{**VALUES, "K_p": 15.0, "t_d": 0.5}[p.name] for p in loop.free]])
    table = output_error(loop, sine_record()).table(theta)
    assert np.isfinite(table).all()
    assert np.sum(table[0, 0] ** 2) > 1e9


def test_rest_at_the_first_input(loop):
    """Steady running has no speed error: the integral of the governor alone carries the torque."""
    record = record_from_arrays(
        "L", {"n_set": np.full(40, 0.1)}, {"n": np.zeros(40), "M_s": np.zeros(40)}, rate_hz=RATE
    )
    values = loop.vector(VALUES)
    states = ExactDelays().rest(loop, values, record)
    still = ExactDelays()(loop, values, record, (), initial=states).outputs
    np.testing.assert_allclose(still["n"], 0.1, rtol=1e-9)
    np.testing.assert_allclose(still["M_s"], 0.2, rtol=1e-9)
