"""A user's own blocks, ties, several inputs, other working points: against results worked out by hand."""

import functools

import mpmath
import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import StructureError
from shaftprint.models import (
    Delay,
    FunctionBlock,
    Gain,
    Integrator,
    Parameter,
    PIGovernor,
    RationalBlock,
    SecondOrderLag,
    Sensitivity,
    Structure,
    feedback,
    is_stable,
    margins,
)
from shaftprint.models._expression import Inverse
from shaftprint.models._nyquist import stable_rows, unstable_poles

S = 1j * np.array([0.05, 0.7, 3.0, 19.0])


def free(name, lower=0.0, upper=10.0, value=1.0):
    return Parameter(name, "-", lower, upper, value, name)


def motor_by_hand(s, k, l, r, j, b):  # noqa: E741
    return k / (l * j * s**2 + (l * b + r * j) * s + r * b + k**2)


def test_a_rational_block_has_exact_derivatives_and_poles():
    # DC motor from voltage to speed, K / (L J s^2 + (L b + R J) s + R b + K^2)
    motor = RationalBlock(
        lambda k, l, r, j, b: ([k], [l * j, l * b + r * j, r * b + k**2]),  # noqa: E741
        tuple(free(name) for name in ("K", "L", "R", "J", "b")),
    )
    drive = Structure(name="motor", title="motor", input="u", outputs={"w": motor})
    values = {"K": 0.3, "L": 0.02, "R": 1.7, "J": 0.004, "b": 0.01}
    response, slopes = drive.gradient(drive.vector(values), S)
    with mpmath.workdps(50):
        at = tuple(mpmath.mpf(values[name]) for name in drive.names)
        for i, s in enumerate(S):
            laplace = mpmath.mpc(complex(s))
            assert abs(response[0, i] - complex(motor_by_hand(laplace, *at))) < 1e-13
            for place in range(5):
                order = tuple(int(other == place) for other in range(5))
                by = mpmath.diff(functools.partial(motor_by_hand, laplace), at, order)
                assert slopes[place, 0, i] == pytest.approx(complex(by), rel=1e-11)
    assert unstable_poles(drive, drive.vector(values)) == 0
    # negative friction that outweighs the back voltage: R b + K^2 < 0
    assert motor.ratio(0.3, 0.02, 1.7, 0.004, -0.1)[1][2] == pytest.approx(-0.08)


def test_a_block_with_a_response_alone_is_differentiated_numerically():
    def belt(s, stiffness, delay):
        return stiffness / (s + stiffness) * np.exp(-s * delay)

    own = Structure(
        name="own", title="own", input="u", outputs={"y": FunctionBlock(belt, (free("k"), free("t", 0.0, 0.5, 0.1)))}
    )
    _, slopes = own.gradient([2.0, 0.07], S)
    to_k = S / (S + 2.0) ** 2 * np.exp(-S * 0.07)
    to_t = -S * 2.0 / (S + 2.0) * np.exp(-S * 0.07)
    np.testing.assert_allclose(slopes[0, 0], to_k, rtol=1e-9)
    np.testing.assert_allclose(slopes[1, 0], to_t, rtol=1e-9)
    at_zero = own.gradient([2.0, 0.0], S)[1][1, 0]
    np.testing.assert_allclose(at_zero, -S * 2.0 / (S + 2.0), rtol=1e-6)


def test_a_formula_that_cannot_be_differentiated_is_refused_with_the_parameter():
    block = RationalBlock(lambda k: ([float(k[0])], [1.0]), (free("k"),))
    odd = Structure(name="odd", title="odd", input="u", outputs={"y": block})
    with pytest.raises(StructureError, match="could not be differentiated to k"):
        odd.gradient([2.0], S)
    tied = structure("OL2").tied("K_i", lambda T_i: float(T_i), free("T_i"))
    with pytest.raises(StructureError, match="tied parameter K_i: its formula could not be differentiated to T_i"):
        tied.gradient([1.0, 1.0], S)


def test_a_tied_parameter_follows_and_carries_its_derivative():
    loop = structure("OL2").tied("K_i", lambda K_p, T_i: K_p / T_i, free("T_i", 0.1, 10.0))
    assert loop.names == ("K_p", "T_i")
    response, slopes = loop.gradient([3.0, 1.5], S)
    np.testing.assert_allclose(response[0], 3.0 + 2.0 / S, rtol=1e-14)
    np.testing.assert_allclose(slopes[0, 0], 1.0 + 1.0 / (1.5 * S), rtol=1e-14)
    np.testing.assert_allclose(slopes[1, 0], -3.0 / (1.5**2 * S), rtol=1e-14)
    assert {name: float(value) for name, value in loop.named([3.0, 1.5]).items()} == {
        "K_p": 3.0,
        "T_i": 1.5,
        "K_i": 2.0,
    }
    assert [c.name for c in loop.combinations] == ["K_i"]


def test_a_transformed_parameter_is_a_tie_to_itself_in_another_form():
    loop = structure("OL1").tied("tau_n", lambda log_tau: np.exp(log_tau), free("log_tau", -5.0, 2.0, -1.0))
    tau = np.exp(-1.2)
    _, slopes = loop.gradient(loop.vector({"log_tau": -1.2}), S)
    np.testing.assert_allclose(slopes[0, 0], -S * tau / (tau * S + 2.0) ** 2, rtol=1e-13)


def test_a_tied_loop_has_the_margins_of_the_loop_it_stands_for():
    plain, tied = structure("CL4"), structure("CL4").tied("K_i", lambda K_p, T_i: K_p / T_i, free("T_i", 0.1, 10.0))
    values = {"tau_n": 1.3, "K_p": 3.0, "t_d": 0.07, "omega_n": 10.0, "zeta": 0.5}
    one = margins(plain, plain.vector(values | {"K_i": 2.0}))
    two = margins(tied, tied.vector(values | {"T_i": 1.5}))
    assert two.gain_margin == one.gain_margin
    assert two.delay_margin_s == one.delay_margin_s


def test_ties_and_outputs_that_do_not_exist_are_refused():
    with pytest.raises(StructureError, match="has no parameter K_x"):
        structure("OL2").tied("K_x", lambda K_p: K_p)
    with pytest.raises(StructureError, match="has no parameter T_i"):
        structure("OL2").tied("K_i", lambda K_p, T_i: K_p / T_i)
    with pytest.raises(StructureError, match="has a parameter K_p already"):
        structure("OL2").tied("K_i", lambda K_p: K_p, free("K_p"))
    with pytest.raises(StructureError, match="has no output thrust; it has n, M_s"):
        structure("CL1").of_outputs("thrust")


def test_another_working_point_scales_parameters_and_their_derivatives():
    first = structure("OL1")
    faster = first.scaled(tau_n=0.5)
    response, slopes = faster.gradient([0.4, 2.0], S)
    np.testing.assert_allclose(response[0], 1.0 / (0.2 * S + 2.0), rtol=1e-14)
    np.testing.assert_allclose(slopes[0, 0], -0.5 * S / (0.2 * S + 2.0) ** 2, rtol=1e-14)
    with pytest.raises(StructureError, match="has no parameter tau_x"):
        first.scaled(tau_x=2.0)


def test_a_loop_at_another_working_point_has_the_stability_of_its_scaled_gain():
    # K / (s (s + 1)^2) is stable for K < 2
    gain = free("K")
    lag = RationalBlock(lambda: ([1.0], [1.0, 2.0, 1.0, 0.0]), ())
    loop = Structure(name="third", title="third", input="r", outputs={"y": feedback(Gain(gain) * lag)})
    assert is_stable(loop, [1.9])
    assert not is_stable(loop.scaled(K=1.1), [1.9])
    assert margins(loop.scaled(K=0.5), [2.0]).gain_margin == pytest.approx(2.0, rel=1e-6)


def test_some_outputs_keep_the_parameters_that_they_show():
    speed = structure("GAUGE-CLOSED").of_outputs("n")
    assert tuple(speed.outputs) == ("n",)
    assert "t_gauge" not in speed.names
    full = structure("GAUGE-CLOSED")
    np.testing.assert_array_equal(speed.response(speed.vector({}), S)[0], full.response(full.vector({}), S)[0])
    torque = full.of_outputs("M_s")
    assert "t_gauge" in torque.names
    assert "t_pickup" not in torque.names


def test_a_combination_of_a_tied_parameter_stays_with_its_output():
    full = structure("GAUGE-CLOSED").tied("K_i", lambda K_p, T_i: K_p / T_i, free("T_i", 0.1, 10.0))
    names = [c.name for c in full.of_outputs("n").combinations]
    assert "K_i" in names
    assert "K_p / K_i" in names


def test_several_inputs_and_outputs_lie_in_channel_order():
    # two masses on a spring: forces on each, positions of each
    mass, stiff = free("m"), free("k")
    own = RationalBlock(lambda m, k: ([m, 0.0, k], [m * m, 0.0, 2.0 * m * k, 0.0, 0.0]), (mass, stiff))
    cross = RationalBlock(lambda m, k: ([k], [m * m, 0.0, 2.0 * m * k, 0.0, 0.0]), (mass, stiff))
    pair = Structure(
        name="pair",
        title="pair",
        inputs=("F_1", "F_2"),
        outputs={"x_1": {"F_1": own, "F_2": cross}, "x_2": {"F_2": own, "F_1": cross}},
    )
    assert pair.input == "F_1"
    assert pair.channels == (("x_1", "F_1"), ("x_1", "F_2"), ("x_2", "F_1"), ("x_2", "F_2"))
    found = pair.response(pair.vector({"m": 2.0, "k": 5.0}), S)
    for i, s in enumerate(S):
        stiffness = np.array([[2.0 * s * s + 5.0, -5.0], [-5.0, 2.0 * s * s + 5.0]])
        np.testing.assert_allclose(found[:, i].reshape(2, 2), np.linalg.inv(stiffness), rtol=1e-9)
    with pytest.raises(StructureError, match="output y: expected a response to each of a, b, found a"):
        Structure(name="x", title="x", inputs=("a", "b"), outputs={"y": {"a": own}})
    with pytest.raises(StructureError, match="expected a named input and at least one output"):
        Structure(name="x", title="x", outputs={"y": own})


def cascade(inner_gain, outer_gain):
    """Return an outer loop around an inner loop around 1 / (s - 1): the inner one is stable for gains above 1."""
    plant = RationalBlock(lambda: ([1.0], [1.0, -1.0]), ())
    inner = feedback(Gain(inner_gain) * plant)
    outer = Gain(outer_gain) * inner * Integrator()
    return Structure(name="cascade", title="cascade", input="r", outputs={"y": feedback(outer)})


@pytest.mark.parametrize(("inner", "outer"), [(3.0, 0.5), (1.2, 0.5), (0.6, 0.5), (0.6, 5.0), (0.99, 0.02), (3.0, 9.0)])
def test_a_loop_in_a_loop_is_counted_like_its_polynomial(inner, outer):
    # s (s - 1 + a) + a b = 0
    roots = np.roots([1.0, inner - 1.0, inner * outer])
    drive = cascade(free("a"), free("b"))
    assert unstable_poles(drive, drive.vector({"a": inner, "b": outer})) == int(np.sum(roots.real > 0.0))


@pytest.mark.slow
def test_an_inverse_in_the_loop_is_counted_by_its_zeros():
    # 1 / (s - a) written as an inverse, gain b around it: stable for b > a
    pole, gain = free("a"), free("b")
    plant = Inverse(RationalBlock(lambda a: ([1.0, -a], [1.0]), (pole,)))
    loop = Structure(name="inverse", title="inverse", input="r", outputs={"y": feedback(Gain(gain) * plant)})
    assert is_stable(loop, loop.vector({"a": 2.0, "b": 2.1}))
    assert unstable_poles(loop, loop.vector({"a": 2.0, "b": 1.9})) == 1
    late = Inverse(Delay(pole))
    odd = Structure(name="late", title="late", input="r", outputs={"y": feedback(Gain(gain) * late)})
    with pytest.raises(StructureError, match="the inverse of an expression with a delay"):
        is_stable(odd, [1.0, 1.0])


@pytest.mark.parametrize("name", ["CL1", "CL3", "CL4", "GAUGE-CLOSED"])
def test_many_parameter_sets_are_judged_as_one_by_one(name):
    loop = structure(name)
    rng = np.random.default_rng(3)
    lower, upper = (np.array([getattr(p, end) for p in loop.parameters]) for end in ("lower", "upper"))
    table = np.where(
        [p.held for p in loop.parameters], loop.vector({}), lower + rng.random((60, lower.size)) * (upper - lower)
    )
    one_by_one = [is_stable(loop, row) for row in table]
    np.testing.assert_array_equal(stable_rows(loop, table), one_by_one)
    if name != "CL1":
        assert 0 < sum(one_by_one) < 60
    np.testing.assert_array_equal(stable_rows(structure("OL5"), [structure("OL5").vector({})] * 2), [True, True])


def test_the_critical_delay_of_a_loop_splits_stable_rows():
    # exp(-s t) K / s is stable for K t < pi / 2
    gain, delay = free("K"), free("t", 0.0, 5.0, 0.1)
    late = Structure(
        name="late", title="late", input="r", outputs={"y": feedback(Gain(gain) * Integrator() * Delay(delay))}
    )
    table = [[1.0, 1.56], [1.0, 1.58], [4.0, 0.39], [4.0, 0.395]]
    np.testing.assert_array_equal(stable_rows(late, table), [True, False, True, False])


def test_a_cascade_goes_through_the_exact_count_row_by_row():
    drive = cascade(free("a"), free("b"))
    rows = [drive.vector({"a": 3.0, "b": 0.5}), drive.vector({"a": 0.6, "b": 5.0})]
    np.testing.assert_array_equal(stable_rows(drive, rows), [True, False])
    lag = SecondOrderLag(free("omega_n"), free("zeta"))
    governor = PIGovernor(free("K_p"), free("K_i"))
    assert Structure(name="s", title="s", input="e", outputs={"y": Sensitivity(governor * lag)}).loop is not None
