"""Drives with known truth: a DC motor, and a mass with friction in a position loop."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.signal import lfilter

from shaftprint.spectra import Periodic, plant_from_closed_loop, response_from_arrays
from shaftprint.spectra.records._arbitrary import Arbitrary


def held(a, b, rate_hz):
    """Exact matrices from sample to sample of ``x' = a x + b u`` with ``u`` held."""
    states, inputs = b.shape
    block = np.zeros((states + inputs, states + inputs))
    block[:states] = np.hstack([a, b]) / rate_hz
    block = expm(block)
    return block[:states, :states], block[:states, states:]


def simulate(a, b, u, rate_hz):
    """States at every sample, shape (states, samples), for inputs of shape (inputs, samples)."""
    step, gain = held(a, b, rate_hz)
    driven = gain @ u
    x = np.zeros((len(a), u.shape[1]))
    for k in range(u.shape[1] - 1):
        x[:, k + 1] = step @ x[:, k] + driven[:, k]
    return x


def with_hold(response, frequency_hz, rate_hz, images=4000):
    """What samples show of a continuous response behind a hold: the sum over all images of the spectrum.

    ``sum over k of G(s_k) (1 - exp(-s T)) / (s_k T)`` with ``s_k = j (w + 2 pi k / T)``.
    """
    s = 2j * np.pi * (frequency_hz[:, np.newaxis] + rate_hz * np.arange(-images, images + 1))
    lifted = np.asarray(response(s)) / (s / rate_hz)
    return lifted.sum(axis=-1) * (1.0 - np.exp(-2j * np.pi * frequency_hz / rate_hz))


def coloured(rng, count, pole):
    return lfilter([1.0], [1.0, -pole], rng.standard_normal(count + 500))[500:] * np.sqrt(1.0 - pole**2)


def expect_truth(found, truth):
    """Errors are those that the covariance states: the mean square, and no line far out."""
    size = len(found.outputs)
    error = (found.response[:, 0] - truth)[:, found.used]
    error = np.concatenate([error.real, error.imag]).T
    square = np.einsum("li,lij,lj->l", error, np.linalg.inv(found.covariance[found.used]), error) / (2 * size)
    assert np.mean(square) == pytest.approx(1.0, abs=3.0 * np.std(square) / np.sqrt(square.size))
    std = np.sqrt(np.diagonal(found.covariance[found.used], axis1=1, axis2=2))
    assert np.mean(np.abs(error) < 3.0 * std) > 0.985


# ---- a DC motor: armature and rotor ----

RESISTANCE_OHM, INDUCTANCE_H, CONSTANT_VS = 1.2, 4e-3, 0.06
INERTIA_KGM2, DAMPING_NMS = 2.5e-4, 4e-4
MOTOR_RATE_HZ = 2000.0


def motor(s):
    """Current and speed over voltage: ``L i' = v - R i - K w``, ``J w' = K i - b w``."""
    electric, mechanic = INDUCTANCE_H * s + RESISTANCE_OHM, INERTIA_KGM2 * s + DAMPING_NMS
    common = electric * mechanic + CONSTANT_VS**2
    return np.stack([mechanic / common, CONSTANT_VS / common])


def run_motor(rng, voltage):
    """Armature current and speed with noise of the load torque, which moves both, and of the sensors."""
    a = np.array(
        [
            [-RESISTANCE_OHM / INDUCTANCE_H, -CONSTANT_VS / INDUCTANCE_H],
            [CONSTANT_VS / INERTIA_KGM2, -DAMPING_NMS / INERTIA_KGM2],
        ]
    )
    b = np.array([[1.0 / INDUCTANCE_H, 0.0], [0.0, -1.0 / INERTIA_KGM2]])
    load = 0.002 * coloured(rng, voltage.size, 0.99)
    current, speed = simulate(a, b, np.stack([voltage, load]), MOTOR_RATE_HZ)
    return {
        "current": current + 0.01 * coloured(rng, voltage.size, 0.5),
        "speed": speed + 0.05 * coloured(rng, voltage.size, 0.8),
    }


def test_a_dc_motor_driven_by_random_steps():
    rng = np.random.default_rng(1)
    voltage = 6.0 + np.repeat(rng.choice([-3.0, 3.0], 2000), rng.integers(2, 40, 2000))[:30_000]
    found = response_from_arrays({"voltage": voltage}, run_motor(rng, voltage), MOTOR_RATE_HZ, band_hz=(0.0, 500.0))
    assert found.used.all()
    assert found.frequency_hz.size > 40
    expect_truth(found, with_hold(motor, found.frequency_hz, MOTOR_RATE_HZ))
    # the speed alone has the same numbers
    alone = found.of_outputs("speed")
    assert alone.response[0] == pytest.approx(found.response[1])
    expect_truth(alone, with_hold(motor, found.frequency_hz, MOTOR_RATE_HZ)[1:])


def test_a_dc_motor_driven_by_a_multisine():
    rng = np.random.default_rng(2)
    lines = np.unique(np.round(np.geomspace(1, 300, 25)))
    period = np.arange(2000) / 2000.0
    one = sum(np.cos(2.0 * np.pi * (k * period + rng.uniform())) for k in lines)
    voltage = np.tile(one, 12)
    found = response_from_arrays(
        {"voltage": voltage}, run_motor(rng, voltage), MOTOR_RATE_HZ, excitation=Periodic(period_s=1.0)
    )
    assert found.frequency_hz.tolist() == pytest.approx(lines.tolist())
    expect_truth(found, with_hold(motor, found.frequency_hz, MOTOR_RATE_HZ))


# ---- a servo: mass and friction, known in a position loop only ----

MASS_KG, FRICTION_NS_M = 20.0, 60.0
POSITION_GAIN_1_S, SPEED_GAIN_NS_M = 25.0, 900.0
SERVO_RATE_HZ = 1000.0


def servo(s):
    """Position over force."""
    return 1.0 / (MASS_KG * s**2 + FRICTION_NS_M * s)


def run_servo(rng, reference, *, coulomb_n=0.0):
    """Force and position under ``F = k_v (k_p (r - x) - x')``, sampled, with noise of force and sensor in the loop."""
    a = np.array([[0.0, 1.0], [0.0, -FRICTION_NS_M / MASS_KG]])
    step, gain = held(a, np.array([[0.0], [1.0 / MASS_KG]]), SERVO_RATE_HZ)
    disturbance = 2.0 * coloured(rng, reference.size, 0.98)
    sensor = 1e-6 * rng.standard_normal(reference.size)
    force, position = np.empty((2, reference.size))
    state, before = np.array([reference[0], 0.0]), reference[0]
    for k, wanted in enumerate(reference):
        position[k] = state[0] + sensor[k]
        speed = (position[k] - before) * SERVO_RATE_HZ
        before = position[k]
        force[k] = SPEED_GAIN_NS_M * (POSITION_GAIN_1_S * (wanted - position[k]) - speed)
        friction = coulomb_n * np.tanh(state[1] / 1e-3)
        state = step @ state + gain[:, 0] * (force[k] + disturbance[k] - friction)
    return {"force": force + 0.5 * rng.standard_normal(reference.size), "position": position}


def trapezoids(rng, moves, *, pause_s=0.2):
    """Positions of moves to and fro at constant acceleration, speed and deceleration."""
    speed = []
    for move in range(moves):
        top, acceleration = rng.uniform(0.05, 0.2), rng.uniform(1.0, 4.0)
        time_s = np.arange(0.0, 0.5 + 2.0 * top / acceleration + rng.uniform(0.0, pause_s), 1.0 / SERVO_RATE_HZ)
        rise = np.minimum(time_s, 0.5 + top / acceleration - time_s) * acceleration
        speed.append((-1.0) ** move * np.clip(rise, 0.0, top))
    return np.cumsum(np.concatenate(speed)) / SERVO_RATE_HZ


def test_a_servo_in_its_loop():
    rng = np.random.default_rng(3)
    reference = lfilter([0.02], [1.0, -0.98], 0.01 * rng.standard_normal(40_000))
    channels = run_servo(rng, reference)
    joint = response_from_arrays({"reference": reference}, channels, SERVO_RATE_HZ, band_hz=(0.0, 100.0))
    found = plant_from_closed_loop(joint, input="force", output="position")
    assert (found.inputs, found.outputs) == (("force",), ("position",))
    assert found.used.sum() > 25
    truth = with_hold(servo, found.frequency_hz, SERVO_RATE_HZ)
    expect_truth(found, truth[np.newaxis])
    # straight from force to position, the answer of the controller to the noise is taken for the plant
    direct = response_from_arrays(
        {"force": channels["force"]}, {"position": channels["position"]}, SERVO_RATE_HZ, band_hz=(0.0, 3.0)
    )
    miss = (direct.response[0, 0] - with_hold(servo, direct.frequency_hz, SERVO_RATE_HZ))[:3]
    assert np.all(np.abs(miss) > 5.0 * np.sqrt(direct.covariance[:3].trace(axis1=1, axis2=2)))


def test_a_servo_on_trapezoids_is_known_where_they_move_it():
    rng = np.random.default_rng(4)
    reference = trapezoids(rng, 40)
    joint = response_from_arrays({"reference": reference}, run_servo(rng, reference), SERVO_RATE_HZ)
    found = plant_from_closed_loop(joint, input="force", output="position")
    truth = with_hold(servo, found.frequency_hz, SERVO_RATE_HZ)
    # moves of half a second with edges of 50 ms: holes in between, nothing above 60 Hz
    assert found.used[(found.frequency_hz > 0.5) & (found.frequency_hz < 30.0)].mean() > 0.7
    assert not found.used[found.frequency_hz > 60.0].any()
    assert set(found.remarks) == {line for line, used in zip(found.lines, found.used, strict=True) if not used}
    expect_truth(found, truth[np.newaxis])


def test_a_servo_with_dry_friction_gives_what_its_periods_agree_on():
    # a bang-bang reference, repeated: dry friction answers in every period alike, so that it is no noise, but bends
    # the response of position over force; between records with other amplitudes it shows
    rng = np.random.default_rng(5)
    runs = []
    for amplitude in (0.02, 0.03, 0.04, 0.05, 0.06, 0.07):
        period = lfilter([0.02], [1.0, -0.98], np.tile(np.repeat([amplitude, -amplitude], 500), 6))
        runs.append((period, run_servo(rng, period, coulomb_n=20.0)))
    given = [{"reference": run} for run, _ in runs], [channels for _, channels in runs], SERVO_RATE_HZ
    stated = []
    for between in (False, True):
        excitation = Periodic(period_s=1.0, settling_periods=2, between_records=between)
        joint = response_from_arrays(*given, excitation=excitation, band_hz=(0.0, 12.0))
        found = plant_from_closed_loop(joint, input="force", output="position")
        assert found.frequency_hz.tolist() == pytest.approx([1.0, 3.0, 5.0, 7.0, 9.0, 11.0])
        stated.append(found.covariance.trace(axis1=1, axis2=2))
    assert np.all(stated[1] > 4.0 * stated[0])


def test_chosen_lines_of_a_motor():
    rng = np.random.default_rng(6)
    voltage = 3.0 * rng.standard_normal(20_000)
    chosen = Arbitrary(lines_hz=[2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 400.0])
    found = response_from_arrays({"voltage": voltage}, run_motor(rng, voltage), MOTOR_RATE_HZ, excitation=chosen)
    expect_truth(found, with_hold(motor, found.frequency_hz, MOTOR_RATE_HZ))
