import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import ValidationError
from shaftprint.validation._prediction import add_quadratic_torque, linear_prediction, simulated_prediction
from shaftprint.validation._run import low_pass

RATE_HZ = 100.0
TIME = np.arange(0.0, 100.0, 1.0 / RATE_HZ)
CL1 = {"tau_n": 0.4, "K_p": 1.0, "K_i": 4.0}
CL4 = {"tau_n": 0.3290, "K_p": 1.6004, "K_i": 4.4388, "t_d": 0.1161, "omega_n": 9.7705, "zeta": 0.4}


def smooth_step(at, width=0.3):
    return 0.5 * (1.0 + np.tanh((TIME - at) / width))


def predicted(name, values, set_point, **more):
    model = structure(name)
    return linear_prediction(model, model.vector(values), set_point, rate_hz=RATE_HZ, **more)


def test_a_first_order_loop_against_its_differential_equation():
    # PI governor and shaft: tau n' = K_p e + E - 2 n, E' = K_i e, by steps of 0.1 ms with Heun's rule
    fine = 1e-3
    time = np.arange(0.0, 30.0, fine)
    set_point = 0.2 * 0.5 * (1.0 + np.tanh((time - 10.0) / 0.3))

    def rate(n, integral, n_set):
        error = n_set - n
        return (error * 1.0 + integral - 2.0 * n) / 0.4, 4.0 * error

    n = integral = 0.0
    speed = np.empty(time.size)
    torque = np.empty(time.size)
    for k in range(time.size):
        speed[k] = n
        torque[k] = set_point[k] - n + integral
        if k + 1 < time.size:
            a, b = rate(n, integral, set_point[k])
            c, d = rate(n + fine * a, integral + fine * b, set_point[k + 1])
            n, integral = n + 0.5 * fine * (a + c), integral + 0.5 * fine * (b + d)
    found, _ = predicted("CL1", CL1, 0.2 * smooth_step(10.0))
    assert found[0, :3000] == pytest.approx(speed[::10], abs=2e-6)
    assert found[1, :3000] == pytest.approx(torque[::10], abs=1e-5)


def test_a_set_point_that_stands_still_gives_steady_running():
    found, _ = predicted("CL4", CL4, np.full(TIME.size, 0.2))
    assert found[0] == pytest.approx(0.2, abs=1e-9)
    assert found[1] == pytest.approx(0.4, abs=1e-9)


def test_a_record_that_ends_elsewhere_does_not_wrap_around():
    whole, _ = predicted("CL4", CL4, 0.3 * smooth_step(95.0))
    longer, _ = linear_prediction(
        structure("CL4"),
        structure("CL4").vector(CL4),
        np.concatenate([0.3 * smooth_step(95.0), np.full(5000, 0.3)]),
        rate_hz=RATE_HZ,
    )
    # the last two seconds may know of what comes behind: what the set point does is rendered by sines
    assert whole[:, :9800] == pytest.approx(longer[:, :9800], abs=1e-4)
    assert whole[:, :1000] == pytest.approx(0.0, abs=1e-6)


def test_derivatives_are_those_of_the_response():
    set_point = 0.2 * smooth_step(20.0)
    _, slopes = predicted("CL4", CL4, set_point, wanted=("K_p", "t_d"))
    for place, (name, step) in enumerate((("K_p", 1e-4), ("t_d", 1e-5))):
        ahead, _ = predicted("CL4", CL4 | {name: CL4[name] + step}, set_point)
        behind, _ = predicted("CL4", CL4 | {name: CL4[name] - step}, set_point)
        assert slopes[place] == pytest.approx((ahead - behind) / (2.0 * step), abs=1e-6)


def test_sines_and_time_steps_agree():
    model = structure("CL4")
    set_point = 0.2 * smooth_step(20.0)
    by_sines, slopes = linear_prediction(model, model.vector(CL4), set_point, rate_hz=RATE_HZ, wanted=("K_p",))
    by_steps, other = simulated_prediction(model, model.vector(CL4), set_point, rate_hz=RATE_HZ, wanted=("K_p",))
    # the simulation goes straight between samples: (0.01 s)^2 / 8 times the largest bend
    assert by_steps == pytest.approx(by_sines, abs=5e-5)
    assert other == pytest.approx(slopes, abs=5e-5)


def test_the_square_of_the_speed_is_the_rest_of_the_propellers_law():
    # (1 + n)^2 - 1 = 2 n + n^2
    linear = np.array([[0.1, -0.2], [0.2, -0.4]])
    slopes = np.array([[[1.0, 1.0], [2.0, 2.0]]])
    add_quadratic_torque(linear, slopes)
    assert linear[1] == pytest.approx([1.1**2 - 1.0, 0.8**2 - 1.0])
    assert slopes[0, 1] == pytest.approx([2.2, 1.6])
    assert linear[0] == pytest.approx([0.1, -0.2])


@pytest.mark.parametrize("predict", [linear_prediction, simulated_prediction])
def test_an_open_loop_cannot_be_held_against_a_set_point(predict):
    model = structure("OL1")
    with pytest.raises(ValidationError, match=r"structure OL1: expected n and M_s from n_set, .* found n from M_s"):
        predict(model, model.vector({}), np.zeros(1000), rate_hz=RATE_HZ)


def test_a_signal_below_the_low_pass_is_left_alone():
    slow = 0.2 * np.sin(2.0 * np.pi * 0.5 * TIME)
    inside = slice(300, -300)
    # a Hamming window leaves a ripple of 0.22 % (Oppenheim and Schafer, Discrete-time signal processing, table 7.2)
    assert low_pass(slow, RATE_HZ, 4.0)[inside] == pytest.approx(slow[inside], abs=0.0023 * 0.2)
    fast = 0.2 * np.sin(2.0 * np.pi * 8.0 * TIME)
    assert low_pass(fast, RATE_HZ, 4.0)[inside] == pytest.approx(0.0, abs=1e-3)
    # at the cut-off half of the amplitude is left, and nothing is late
    edge = np.sin(2.0 * np.pi * 4.0 * TIME)
    assert low_pass(edge, RATE_HZ, 4.0)[inside] == pytest.approx(0.5 * edge[inside], abs=0.01)


def test_a_low_pass_beyond_half_the_rate_does_nothing():
    assert low_pass(TIME, RATE_HZ, 60.0) is TIME
