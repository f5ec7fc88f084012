"""An FMU does in time what the simulation of the same structure does: co-simulation and model exchange."""

import numpy as np
import pytest

from shaftprint.catalogue import limited, structure
from shaftprint.simulation import simulate, simulate_exactly

SPEED_RPM, TORQUE_NM = 1183.8, 1740.0
SIZES = {"engine_speed": ("n", SPEED_RPM), "shaft_torque": ("M_s", TORQUE_NM)}
# delays that are no multiple of any step
CL4 = structure("CL4"), {"t_d": 0.0837, "K_p": 2.0, "K_i": 3.0}
GAUGE = structure("GAUGE-CLOSED"), {"t_d": 0.0437, "t_sp": 0.1133, "t_gauge": 0.0071}
TORQUE = limited("torque"), {"t_d": 0.0437, "t_sp": 0.1133, "m_max": 1.1}
MODELS = pytest.mark.parametrize("model", [CL4, GAUGE, TORQUE], ids=lambda model: model[0].name)
SHARE = 1e-5
TIME = np.arange(401) * 0.01


def whole(deviation):
    return SPEED_RPM * (1.0 + deviation)


def step(time):
    return np.where(time >= 0.5 - 1e-7, 0.05, 0.0)


def staircase(time):
    level = np.floor((time + 1e-7) / 0.7)
    return 0.01 * level * np.where(level % 2 == 0, 1.0, -1.0) * (time > 0.5)


def chirp(time):
    return 0.02 * np.sin(2.0 * np.pi * (0.1 * time + 0.1 * time**2))


def misfits(found, trace):
    """Largest difference of each output over its range."""
    shares = []
    for name, (own, size) in SIZES.items():
        expected = size * (1.0 + trace.outputs[own])
        shares.append(np.abs(found[name] - expected).max() / np.ptp(expected))
    return shares


@MODELS
@pytest.mark.parametrize("drive", [step, staircase])
def test_jumps_in_co_simulation(fmu, slave, model, drive):
    chosen, values = model
    deviation = drive(TIME)
    trace = simulate_exactly(chosen, chosen.vector(values), TIME, {"n_set": deviation}, hold=True, longest_step_s=5e-4)
    with slave(fmu(chosen, values)) as own:
        own.start()
        found = own.run(TIME, whole(deviation))
    assert max(misfits(found, trace)) < SHARE / 10.0


@MODELS
def test_chirp_in_co_simulation(fmu, slave, model):
    chosen, values = model
    trace = simulate(chosen, chosen.vector(values), TIME, {"n_set": chirp(TIME)}, longest_step_s=2.5e-4)
    with slave(fmu(chosen, values)) as own:
        own.start()
        found = own.run(TIME, whole(chirp(TIME)), straight=True)
    assert max(misfits(found, trace)) < SHARE


@MODELS
@pytest.mark.parametrize("drive", [step, staircase])
def test_jumps_in_model_exchange(fmu, solved, model, drive):
    chosen, values = model
    deviation = drive(TIME)
    trace = simulate_exactly(chosen, chosen.vector(values), TIME, {"n_set": deviation}, hold=True, longest_step_s=5e-4)
    jumps = TIME[1:][np.diff(deviation) != 0.0]
    with solved(fmu(chosen, values)) as own:
        own.start()
        found = own.solve(TIME, lambda t, begin, end: whole(float(drive(0.5 * (begin + end)))), jumps)
    assert max(misfits(found, trace)) < SHARE


@MODELS
def test_chirp_in_model_exchange(fmu, solved, model):
    chosen, values = model
    fine = np.arange(4001) * 1e-3
    trace = simulate(chosen, chosen.vector(values), fine, {"n_set": chirp(fine)}, longest_step_s=2.5e-4)
    every = {name: output[::10] for name, output in trace.outputs.items()}
    with solved(fmu(chosen, values)) as own:
        own.start()
        found = own.solve(TIME, lambda t, begin, end: whole(float(chirp(t))))
    for name, (own_name, size) in SIZES.items():
        expected = size * (1.0 + every[own_name])
        assert np.abs(found[name] - expected).max() < SHARE * np.ptp(expected)


def test_events_end_when_jumps_have_died_away(fmu, solved):
    chosen, values = CL4
    with solved(fmu(chosen, values)) as own:
        own.start()
        own.solve(TIME, lambda t, begin, end: whole(float(step(0.5 * (begin + end)))), [0.5])
        # the jump, the start and what they become after the delay, two orders of smoothness later
        assert own.events <= 8


def test_sine_has_the_response_of_the_frequency_domain(fmu, slave):
    chosen, values = GAUGE
    omega, rate_hz = 2.0 * np.pi * 0.5, 200.0
    time = np.arange(int(24.0 * rate_hz) + 1) / rate_hz
    with slave(fmu(chosen, values)) as own:
        own.start()
        found = own.run(time, whole(1e-3 * np.sin(omega * time)), straight=True)
    last = slice(-int(8.0 * rate_hz), None)
    turn = np.exp(-1j * omega * time[last])
    expected = chosen.response(chosen.vector(values), [1j * omega])[:, 0]
    # straight lines between samples of a sine have its amplitude times a squared sinc
    straight = np.sinc(omega / (2.0 * np.pi * rate_hz)) ** 2
    for response, (name, (_, size)) in zip(expected, SIZES.items(), strict=True):
        line = 2j * np.mean((found[name][last] / size - 1.0) * turn) / 1e-3
        assert abs(line / straight - response) < 1e-5 * abs(response)


@pytest.mark.parametrize("seed", [1, 2])
def test_steps_of_any_length(fmu, slave, seed):
    """Where the set point does not change, it does not matter how often the master calls."""
    chosen, values = TORQUE
    rng = np.random.default_rng(seed)
    length = 10.0 ** rng.uniform(-5.0, 0.0, size=40)
    time = np.concatenate([[0.0, 0.3], 0.3 + np.cumsum(length)])
    target = time[-1]
    with slave(fmu(chosen, values)) as own:
        own.start()
        found = own.run(time, whole(np.where(time >= 0.3, 0.08, 0.0)))
    with slave(fmu(chosen, values)) as own:
        own.start()
        other = own.run(np.array([0.0, 0.3, target]), whole(np.array([0.0, 0.08, 0.08])))
    for name, (_, size) in SIZES.items():
        assert abs(found[name][-1] - other[name][-1]) < 1e-7 * size


@pytest.mark.slow
def test_rate_limit_of_every_step_is_that_of_ever_shorter_steps(fmu, slave):
    chosen = limited("torque", "rate")
    values = {"t_d": 0.0437, "t_sp": 0.1133, "m_max": 1.3, "r_x": 1.5}
    time = TIME[:201]
    deviation = step(time)
    # the simulation takes a limited rack a step early: twice that of half the step less that of the step is prompt
    coarse, fine = (
        simulate(chosen, chosen.vector(values), time, {"n_set": deviation}, hold=True, longest_step_s=h)
        for h in (1e-4, 5e-5)
    )
    with slave(fmu(chosen, values)) as own:
        own.start()
        found = own.run(time, whole(deviation))
    for name, (own_name, size) in SIZES.items():
        expected = size * (1.0 + 2.0 * fine.outputs[own_name] - coarse.outputs[own_name])
        assert np.abs(found[name] - expected).max() < SHARE * np.ptp(expected)


@pytest.mark.slow
def test_computer_with_a_period(fmu, slave):
    chosen = limited("torque", "rate", period_s=0.02, name="PERIOD")
    values = {"t_d": 0.0437, "t_sp": 0.1133, "m_max": 1.3, "r_x": 1.5}
    time = TIME[:201]
    deviation = step(time)
    coarse, fine = (
        simulate(chosen, chosen.vector(values), time, {"n_set": deviation}, hold=True, longest_step_s=h)
        for h in (1e-4, 5e-5)
    )
    with slave(fmu(chosen, values)) as own:
        own.start()
        found = own.run(time, whole(deviation))
    for name, (own_name, size) in SIZES.items():
        expected = size * (1.0 + 2.0 * fine.outputs[own_name] - coarse.outputs[own_name])
        assert np.abs(found[name] - expected).max() < SHARE * np.ptp(expected)


def test_starts_in_steady_running(fmu, slave):
    """By hand: ``n`` is the set point, ``M_s = ((1 + n)^2 - 1) k_q / 2`` for a quadratic propeller with ``k_q = 2``."""
    chosen, values = TORQUE
    with slave(fmu(chosen, values)) as own:
        own.start(set_point=SPEED_RPM * 0.9)
        assert own.get("engine_speed", "shaft_torque") == pytest.approx([0.9 * SPEED_RPM, 0.81 * TORQUE_NM], rel=1e-9)
        own.fmu.doStep(0.0, 5.0)
        assert own.get("engine_speed", "shaft_torque") == pytest.approx([0.9 * SPEED_RPM, 0.81 * TORQUE_NM], rel=1e-9)


@pytest.mark.slow
def test_late_mean_starts_in_steady_running(fmu, slave):
    """A pick-up that averages and is late shows the set point at once where the ship has run at it for ever."""
    chosen = structure("FREE-PITCH").free_between(T_average=(0.0, 1.0), t_pickup=(0.0, 1.0))
    values = {"T_average": 0.1, "t_pickup": 0.2}
    with slave(fmu(chosen, values)) as own:
        own.start(set_point=SPEED_RPM * 1.02)
        for begin, duration in ((0.0, 0.03), (0.03, 0.1), (0.13, 0.4)):
            assert own.get("engine_speed") == pytest.approx([1.02 * SPEED_RPM], rel=1e-9)
            own.fmu.doStep(begin, duration)
        assert own.get("engine_speed") == pytest.approx([1.02 * SPEED_RPM], rel=1e-9)


def test_torque_limit_holds_the_engine(fmu, slave):
    """By hand: an engine of 1.1 times the working-point torque turns a propeller no faster than ``sqrt(1.1)``."""
    chosen, values = TORQUE
    with slave(fmu(chosen, values)) as own:
        own.start()
        own.set(engine_speed_set_point=1.3 * SPEED_RPM)
        own.fmu.doStep(0.0, 30.0)
        assert own.get("engine_speed", "shaft_torque") == pytest.approx(
            [np.sqrt(1.1) * SPEED_RPM, 1.1 * TORQUE_NM], rel=1e-6
        )
