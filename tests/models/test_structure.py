"""Parameters, composition of blocks, structures of one's own, and what is refused."""

from dataclasses import dataclass

import numpy as np
import pytest

from shaftprint.catalogue import STRUCTURES, ShipRole, structure
from shaftprint.errors import StructureError
from shaftprint.identify import identify_jointly
from shaftprint.models import (
    AveragingSensor,
    Block,
    Combination,
    Constant,
    Delay,
    Diagram,
    FilteredDerivative,
    Gain,
    Integrator,
    Parameter,
    PIGovernor,
    SecondOrderLag,
    Sensitivity,
    Shaft,
    Structure,
    TorqueBalance,
    feedback,
    is_stable,
    margins,
)
from shaftprint.models._expression import Inverse
from shaftprint.models._margins import poles
from shaftprint.models._nyquist import unstable_poles
from shaftprint.spectra import FrequencyResponse

S = 1j * np.array([0.1, 1.0, 7.0])


def parameter(name, value=1.0, **changes):
    return Parameter(
        **({"name": name, "unit": "-", "lower": 0.0, "upper": 10.0, "value": value, "meaning": "t"} | changes)
    )


def of(*, input="u", **outputs):
    return Structure(name="OWN", title="of one's own", input=input, outputs=outputs)


# ---- parameters ----


@pytest.mark.parametrize(("lower", "upper"), [(1.0, 1.0), (2.0, 1.0), (float("nan"), 1.0)])
def test_bounds_out_of_order_are_refused(lower, upper):
    with pytest.raises(StructureError, match=r"parameter K_p: expected lower bound < upper bound, found"):
        parameter("K_p", lower=lower, upper=upper)


@pytest.mark.parametrize("value", [-0.1, 10.1, float("nan")])
def test_value_outside_its_bounds_is_refused(value):
    with pytest.raises(StructureError, match=r"parameter K_p: expected a value from 0\.0 to 10\.0, found"):
        parameter("K_p", value)


def test_a_parameter_is_held_within_its_bounds_only():
    held = parameter("K_p").held_at(8.0)
    assert (held.lower, held.upper, held.value, held.held) == (0.0, 10.0, 8.0, True)
    with pytest.raises(StructureError, match=r"K_p: expected a value from 0\.0 to 10\.0, found 12\.0"):
        parameter("K_p").held_at(12.0)


@pytest.mark.parametrize(("bounds", "value"), [((2.0, 3.0), 2.0), ((0.0, 0.5), 0.5), ((0.5, 3.0), 1.0)])
def test_freeing_a_parameter_moves_its_value_inside(bounds, value):
    freed = parameter("K_p").held_at(1.0).free_between(*bounds)
    assert (freed.lower, freed.upper, freed.value, freed.held) == (*bounds, value, False)


# ---- structures ----


@pytest.mark.parametrize("name", STRUCTURES)
def test_shipped_parameters_are_described_and_start_inside_their_bounds(name):
    for p in structure(name).parameters:
        assert p.meaning
        assert p.unit
        assert p.lower <= p.value <= p.upper


def test_bounds_of_table_5_1_are_the_defaults():
    bounds = {p.name: (p.lower, p.upper) for p in structure("CL4").free}
    assert bounds == {
        "tau_n": (0.0, 5.0),
        "K_p": (0.0, 10.0),
        "K_i": (0.0, 10.0),
        "t_d": (0.0, 0.5),
        "zeta": (0.3, 4.0),
        "omega_n": (7.0, 13.0),
    }


def test_bounds_and_start_of_the_benchmark_are_those_of_eqs_2_35_to_2_40():
    found = {p.name: (p.lower, p.upper, p.value) for p in structure("BENCHMARK").free}
    assert found == {
        "tau_n": (0.0, 5.0, 1.2),
        "K_p": (0.0, 15.0, 10.0),
        "K_i": (0.0, 10.0, 3.0),
        "g": (-3.0, 0.0, -0.5),
        "v": (0.0, 5.0, 1.0),
    }


def test_combinations_of_the_benchmark_are_those_of_eq_2_34():
    values = {"K_p": 6.0, "K_i": 3.0, "v": 0.5}
    found = {c.name: c.of(values) for c in structure("BENCHMARK").combinations}
    assert found == {"K_p / K_i": 2.0, "v K_p": 3.0, "v K_i": 1.5}


def test_combinations_of_the_gauge_aware_structures():
    values = {"K_p": 6.0, "K_i": 3.0, "v": 1.5, "g": -0.4, "k_q": 2.1, "tau_up": 1.0, "tau_dn": 0.5}
    found = {c.name: c.of(values | {"t_d": 0.07, "t_sp": 0.05}) for c in structure("GAUGE-OPEN").combinations}
    assert found["t_d + t_sp"] == pytest.approx(0.12)
    assert found["K_p / K_i"] == 2.0
    assert found["v K_i / (k_q - g)"] == pytest.approx(1.8)
    assert found["v K_p / (tau_up + tau_dn)"] == pytest.approx(6.0)


def test_unknown_structure_is_refused_with_the_names_that_exist():
    with pytest.raises(StructureError, match=r"there is no structure 'CL9'; the shipped ones are OL1, OL2"):
        structure("CL9")


def test_holding_and_freeing_keeps_the_rest():
    held = structure("CL4").held_at(t_d=0.07, k_q=2.1)
    assert [p.name for p in held.free] == ["tau_n", "K_p", "K_i", "omega_n", "zeta"]
    assert held.vector({})[held.names.index("k_q")] == 2.1
    freed = held.free_between(k_q=(1.5, 2.5))
    assert "k_q" in [p.name for p in freed.free]
    assert freed.names == held.names == structure("CL4").names
    assert freed.combinations == held.combinations


@pytest.mark.parametrize(
    "act",
    [
        lambda s: s.held_at(K_d=1.0),
        lambda s: s.free_between(K_d=(0.0, 1.0)),
        lambda s: s.vector({"K_d": 1.0}),
        lambda s: s.gradient(s.vector({}), S, ["K_d"]),
    ],
)
def test_foreign_parameter_names_are_refused(act):
    with pytest.raises(StructureError, match=r"structure OL3 has no parameter K_d; it has K_p, K_i, t_d\."):
        act(structure("OL3"))


@pytest.mark.parametrize("values", [[1.0, 2.0], [[1.0, 2.0, 3.0, 4.0]], 1.0])
def test_wrong_number_of_values_is_refused(values):
    with pytest.raises(StructureError, match=r"structure OL3: expected 3 parameter values \(K_p, K_i, t_d\), found"):
        structure("OL3").response(values, S)


def test_one_name_for_two_different_parameters_is_refused():
    with pytest.raises(StructureError, match=r"structure OWN: parameter k occurs twice with different"):
        of(y=Gain(parameter("k")) * Gain(parameter("k", 2.0)))


def test_the_response_at_one_frequency_has_the_frequency_axis_too():
    assert structure("CL1").response(structure("CL1").vector({}), 1j).shape == (2, 1)


# ---- composition ----


def test_one_parameter_in_two_blocks_has_one_derivative():
    """``y = k^2``: value 9, derivative 2 k = 6, at every frequency."""
    k = parameter("k", 3.0)
    response, slopes = of(y=Gain(k) * Gain(k)).gradient([3.0], S)
    assert response == pytest.approx(np.full((1, 3), 9.0))
    assert slopes == pytest.approx(np.full((1, 1, 3), 6.0))
    response, slopes = of(y=Gain(k) + Gain(k)).gradient([3.0], S)
    assert response == pytest.approx(np.full((1, 3), 6.0))
    assert slopes == pytest.approx(np.full((1, 1, 3), 2.0))


def test_one_parameter_twice_in_one_block_has_one_derivative():
    """``1 / ((tau + tau) s + 1)`` with both inertias the same parameter: derivative ``-2 s / (2 tau s + 1)^2``."""
    tau, slope = parameter("tau"), parameter("k_q")
    _, slopes = of(n=Shaft((tau, tau), slope)).gradient([0.5, 1.0], S, ["tau"])
    assert slopes[0, 0] == pytest.approx(-2.0 * S / (S + 1.0) ** 2)


def test_feedback_through_a_second_path():
    """``G = k``, ``H = 1 / s``: ``G / (1 + G H) = k s / (s + k)``."""
    k = parameter("k")
    found = of(y=feedback(Gain(k), Integrator())).response([2.0], S)
    assert found[0] == pytest.approx(2.0 * S / (S + 2.0))


@pytest.mark.parametrize("order", ["filter before the loop", "loop written backwards", "loop inside out"])
def test_closed_loops_written_another_way_have_the_same_derivatives(order):
    """``a k s / (s + k b)`` for a filter ``a``, forward gain ``k`` and back path ``b / s``, written in three ways."""
    a, k, b = (Gain(parameter(name)) for name in "akb")
    back = b * Integrator()
    own = {
        "filter before the loop": of(y=a * (k * Sensitivity(k * back))),
        "loop written backwards": of(y=(a * k) * Sensitivity(back * k)),
        "loop inside out": of(y=a * Sensitivity(k * back) * k),
    }[order]
    values = {"a": 0.7, "k": 2.0, "b": 3.0}
    response, slopes = own.gradient(own.vector(values), S, ["a", "k", "b"])
    below = S + 6.0
    assert response[0] == pytest.approx(0.7 * 2.0 * S / below)
    assert slopes[0, 0] == pytest.approx(2.0 * S / below)
    assert slopes[1, 0] == pytest.approx(0.7 * S**2 / below**2)
    assert slopes[2, 0] == pytest.approx(-0.7 * 4.0 * S / below**2)


def test_difference_and_inverse():
    """``1 / (1 - k)`` and its derivative ``1 / (1 - k)^2``."""
    k = parameter("k")
    error = Constant(1.0) + Constant(-1.0) * Gain(k)
    response, slopes = of(y=Inverse(error)).gradient([0.2], S)
    assert response[0] == pytest.approx(np.full(3, 1.25))
    assert slopes[0, 0] == pytest.approx(np.full(3, 1.5625))


def test_polynomials_follow_the_composition():
    """``(1 - k) / s`` beside 2, inverted: ``s / (2 s + 1 - k)``; that as a loop: ``(2 s + 1 - k) / (3 s + 1 - k)``."""
    k = parameter("k")
    path = (Constant(1.0) + Constant(-1.0) * Gain(k)) * Integrator() + Constant(2.0)
    above, below = Inverse(path).polynomials({"k": 0.25})
    s = 1.7
    assert np.polyval(above, s) / np.polyval(below, s) == pytest.approx(s / (2 * s + 0.75))
    above, below = Sensitivity(Inverse(path)).polynomials({"k": 0.25})
    assert np.polyval(above, s) / np.polyval(below, s) == pytest.approx((2 * s + 0.75) / (3 * s + 0.75))


def test_a_delay_anywhere_makes_an_expression_irrational():
    k, late = Gain(parameter("k")), Delay(parameter("T"))
    values = {"k": 1.0, "T": 0.1}
    for expression in (k * late, late * k, k + late, Inverse(late), Sensitivity(late)):
        assert expression.polynomials(values) is None


def test_pid_loop_has_the_poles_of_its_polynomial():
    """``(1 + 2/s + 0.5 s / (0.1 s + 1)) / (s + 2)``: denominator times numerator of ``1 + L`` by hand."""
    governor = PIGovernor(parameter("K_p"), parameter("K_i")) + FilteredDerivative(parameter("K_d"), parameter("T_f"))
    loop = governor * Shaft((parameter("tau"),), parameter("k_q"))
    own = of(n=feedback(loop))
    values = own.vector({"K_p": 1.0, "K_i": 2.0, "K_d": 0.5, "T_f": 0.1, "tau": 1.0, "k_q": 2.0})
    # (s + 2)(0.1 s + 1) s + (s + 2)(0.1 s + 1) + 0.5 s^2 = 0.1 s^3 + 1.8 s^2 + 3.2 s + 2
    expected = np.roots([0.1, 1.8, 3.2, 2.0])
    upper = expected[expected.imag >= 0.0]
    assert np.sort_complex(poles(own, values)) == pytest.approx(np.sort_complex(upper), abs=1e-9)
    assert is_stable(own, values)


def test_loop_with_torque_balance_and_lag_has_the_poles_of_its_polynomial():
    """``k (0.5 s + 2) / (s^2 + 2 s + 4)`` with ``k`` 3: ``s^2 + 3.5 s + 10``."""
    loop = (
        Gain(parameter("k", upper=99.0))
        * TorqueBalance(parameter("tau"), parameter("k_q"))
        * SecondOrderLag(parameter("omega_n"), parameter("zeta"))
    )
    own = of(n=feedback(loop))
    values = own.vector({"k": 0.75, "tau": 0.5, "k_q": 2.0, "omega_n": 2.0, "zeta": 0.5})
    assert poles(own, values) == pytest.approx([np.roots([1.0, 3.5, 10.0])[0]], abs=1e-9)


def test_loop_through_the_pick_up_loses_phase_to_it():
    """The delay margin of a loop closed through a pick-up is the plain one minus the pick-up's delay."""
    governor = PIGovernor(parameter("K_p"), parameter("K_i")) * Shaft((parameter("tau"),), parameter("k_q"))
    zero = {"T_average": 0.0, "T_hold": 0.0}
    sensor = AveragingSensor(*(parameter(name, 0.0) for name in ("T_average", "T_hold", "t_pickup")))
    values = {"K_p": 2.0, "K_i": 4.0, "tau": 0.4, "k_q": 2.0}
    plain, late = of(n=feedback(governor)), of(n=feedback(governor, sensor))
    before = margins(plain, plain.vector(values)).delay_margin_s
    after = margins(late, late.vector(values | zero | {"t_pickup": 0.05})).delay_margin_s
    assert after == pytest.approx(before - 0.05, rel=1e-9)


@dataclass(frozen=True, slots=True, eq=False)
class FirstOrderLag(Block):
    """A user's own block: transfer and derivatives only."""

    time: Parameter

    @property
    def parameters(self):
        return (self.time,)

    def transfer(self, s, *values):
        return 1.0 / (values[0] * s + 1.0)

    def derivatives(self, s, response, *values):
        return (-s * response**2,)


def test_a_block_of_ones_own_needs_no_polynomials():
    """``2 (1 + 1/s)`` around ``1 / (T s + 1)``: the count is Nyquist's, poles are Newton's."""
    own = of(y=feedback(PIGovernor(parameter("K_p"), parameter("K_i")) * FirstOrderLag(parameter("T"))), input="n_set")
    values = own.vector({"K_p": 2.0, "K_i": 2.0, "T": 0.5})
    # T s^2 + 3 s + 2
    assert np.sort(poles(own, values).real) == pytest.approx(np.sort(np.roots([0.5, 3.0, 2.0])), abs=1e-6)
    assert unstable_poles(own, values) == 0
    _, slopes = own.gradient(values, S, ["T"])
    closed = (2 * S + 2) / (0.5 * S**2 + 3 * S + 2)
    assert slopes[0, 0] == pytest.approx(-closed * S**2 / (0.5 * S**2 + 3 * S + 2))


def test_combination_is_kept_by_a_structure_of_ones_own():
    double = Combination(name="2 k", unit="-", of=lambda p: 2.0 * p["k"], meaning="twice")
    own = Structure(
        name="OWN", title="", input="u", outputs={"y": Gain(parameter("k"))}, combinations=(double,)
    ).held_at(k=3.0)
    assert own.combinations[0].of(dict(zip(own.names, own.vector({}), strict=True))) == 6.0


# ---- other names ----


def test_a_renamed_structure_answers_as_before():
    before = structure("GAUGE-CLOSED")
    after = before.renamed(t_d="t_d_7", K_p="K_p_7")
    assert after.names == tuple({"t_d": "t_d_7", "K_p": "K_p_7"}.get(name, name) for name in before.names)
    values = {"K_p": 4.0, "t_d": 0.05, "tau_dn": 0.3}
    renamed = {"K_p_7": 4.0, "t_d_7": 0.05, "tau_dn": 0.3}
    response, slopes = before.gradient(before.vector(values), S)
    again, slopes_again = after.gradient(after.vector(renamed), S)
    assert np.array_equal(response, again)
    assert np.array_equal(slopes, slopes_again)
    assert after.named_as(ShipRole.LOOP_DELAY) == "t_d_7"
    of = {one.name: float(one.of(after.named(after.vector(renamed)))) for one in after.combinations}
    assert of["t_d_7 + t_sp"] == 0.05 + before.vector({})[before.names.index("t_sp")]
    assert "K_p_7 / K_i" in of
    assert "v K_i / (k_q - g)" in of


def test_a_renamed_parameter_keeps_factor_and_tie():
    gain, slow = Gain(parameter("k")), parameter("x")
    made = of(y=gain * Gain(parameter("m"))).scaled(k=3.0).tied("m", lambda k: 2.0 * k).renamed(k="k_2")
    # 3 k_2 times 2 k_2
    assert made.response(made.vector({"k_2": 0.5}), S)[0] == pytest.approx(1.5 * 1.0)
    with pytest.raises(StructureError, match="structure OWN has a parameter k already"):
        of(y=Gain(slow) * gain).renamed(x="k")
    with pytest.raises(StructureError, match="structure OWN has no parameter q; it has k_2"):
        made.renamed(q="r")


def test_two_records_with_delays_of_their_own_share_the_rest():
    shared = of(y=Gain(parameter("k")) * Delay(parameter("t", 0.1, unit="s", upper=0.5)))
    rng = np.random.default_rng(4)
    hertz = np.linspace(0.1, 2.0, 12)

    def measured(delay):
        noise = 0.01 * (rng.standard_normal(12) + 1j * rng.standard_normal(12))
        values = 2.0 * np.exp(-2j * np.pi * hertz * delay) + noise
        covariance = np.broadcast_to(1e-4 * np.eye(2), (12, 2, 2))
        return FrequencyResponse(
            frequency_hz=hertz, response=values[None, None], covariance=covariance, inputs=("u",), outputs=("y",)
        )

    pairs = [(shared.renamed(t=f"t_{one}"), measured(delay)) for one, delay in ((1, 0.10), (2, 0.13))]
    fit = identify_jointly(pairs, rng=rng)
    assert {one.name for one in fit.parameters} == {"k", "t_1", "t_2"}
    for name, true in (("k", 2.0), ("t_1", 0.10), ("t_2", 0.13)):
        (found,) = (one for one in fit.parameters if one.name == name)
        assert abs(found.value - true) < 4.0 * found.std < 0.02
    assert fit.p_value > 0.01


def driven(equations):
    """Return a structure of two outputs that share equations with the parameter ``K_p``."""
    drive = Diagram(name="drive", input="u", outputs=("y", "z"), equations=equations, of=(parameter("K_p"),))
    return of(**drive.ports())


def test_a_parameter_in_equations_is_renamed_once_for_all_their_outputs():
    limited = driven(lambda flow, u, p: {"y": p.K_p * u, "z": 2.0 * u})
    twice = limited.renamed(K_p="K_p (a)").renamed(**{"K_p (a)": "K_p (b)"})
    assert twice.names == ("K_p (b)",)
    assert twice.response(twice.vector({"K_p (b)": 3.0}), S)[:, 0] == pytest.approx([3.0, 2.0])
    assert limited.response(limited.vector({"K_p": 5.0}), S)[0, 0] == pytest.approx(5.0)
    assert len({id(block.diagram) for block in twice.blocks}) == 1


def test_a_parameter_that_equations_ask_for_by_name_is_not_renamed():
    limited = driven(lambda flow, u, p: {"y": flow.parameter("K_p") * u, "z": u})
    renamed = limited.renamed(K_p="K_p_2")
    with pytest.raises(StructureError, match="expected a parameter K_p, found K_p_2"):
        renamed.response(renamed.vector({}), S)
