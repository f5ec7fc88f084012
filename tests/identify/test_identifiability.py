"""What a test can find at all: ranks and combinations derived by hand from the transfer functions.

With ``den = s^2 + (v K_p - g + 2) / tau_n s + v K_i / tau_n`` the initial linear model is
``n = (v K_p s + v K_i) / tau_n / den`` and ``M_s = (tau_n s + 2) n`` (thesis eqs 2.26-2.28): the coefficients of ``n``
fix ``v K_p / tau_n``, ``v K_i / tau_n`` and ``(2 - g) / tau_n``, the ratio of both outputs ``tau_n``.
"""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import STRUCTURES, structure
from shaftprint.errors import StructureError
from shaftprint.identify import identifiability
from shaftprint.identify.prediction._formulas import unit_of
from shaftprint.models import (
    Delay,
    FunctionBlock,
    Gain,
    Parameter,
    PIGovernor,
    RationalBlock,
    Sensitivity,
    Shaft,
    Structure,
)

S = 1j * np.geomspace(0.01, 100.0, 40)


def found_in(wanted, *outputs, seed=1):
    return identifiability(wanted, outputs=outputs or None, rng=np.random.default_rng(seed))


def without_combinations(name):
    """The shipped structure as a user might have written it, who names no combination."""
    return replace(structure(name), combinations=())


def value_of(found, name, **values):
    chosen = next(c for c in (*found.combinations, *found.also) if c.name == name)
    return float(chosen.of({name: np.array(value) for name, value in values.items()}))


# ---- the initial linear model: thesis eq. 2.34 ----


@pytest.mark.parametrize("name", ["INITIAL", "BENCHMARK"])
@pytest.mark.parametrize("seed", range(5))
def test_both_outputs_of_the_initial_model_give_the_four_of_the_thesis(name, seed):
    found = found_in(structure(name), seed=seed)
    assert found.names == ("tau_n", "g", "K_p / K_i", "v K_p")
    assert (found.rank, len(found.structure.free)) == (4, 5)
    assert found.identifiable == ("tau_n", "g")
    assert found.lost == ("K_p", "K_i", "v")
    assert [c.name for c in found.also] == ["v K_i"]
    assert [c.unit for c in found.combinations] == ["s", "-"]


@pytest.mark.parametrize("seed", range(5))
def test_speed_alone_leaves_three(seed):
    found = found_in(structure("INITIAL"), "n", seed=seed)
    assert set(found.names) == {"v K_p / tau_n", "v K_i / tau_n", "(2 - g) / tau_n"}
    assert found.rank == 3
    assert found.identifiable == ()
    assert "K_p / K_i" in [c.name for c in found.also]
    assert value_of(found, "(2 - g) / tau_n", g=-0.5, tau_n=0.5) == 5.0
    assert value_of(found, "v K_i / tau_n", v=1.5, K_i=4.0, tau_n=0.5) == 12.0


def test_names_are_found_where_none_are_given():
    assert found_in(without_combinations("INITIAL")).names == ("tau_n", "g", "K_p / K_i", "v K_p")
    single = found_in(without_combinations("INITIAL"), "n")
    assert set(single.names) == {"v K_p / tau_n", "v K_i / tau_n", "(2 - g) / tau_n"}
    assert {c.name: c.unit for c in single.combinations} == dict.fromkeys(single.names, "1/s") | {
        "v K_i / tau_n": "1/s2"
    }


def test_torque_alone_is_as_good_as_both():
    """``M_s = (tau_n s + 2) (v K_p s + v K_i) / tau_n / den`` tends to 2 and to ``v K_p``, so ``tau_n`` is in it."""
    assert found_in(structure("INITIAL"), "M_s").names == ("tau_n", "g", "K_p / K_i", "v K_p")


def test_integrated_error_alone_is_as_good_as_speed():
    assert found_in(structure("INITIAL"), "E_n").rank == 3


def test_words_for_the_initial_model():
    both = found_in(structure("INITIAL"))
    assert both.sentences == (
        "From n, E_n and M_s a test finds 4 numbers for the 5 free parameters of INITIAL: tau_n, g, K_p / K_i, v K_p.",
        "v K_i follows from these.",
        "K_p, K_i and v cannot be found on their own: K_p and K_i up and v down by the same factor leave every "
        "response unchanged.",
        "One of K_p, K_i and v known from elsewhere makes all of them known.",
    )
    speed = found_in(structure("INITIAL"), "n")
    assert "K_p and K_i up and v down by the same factor leave every response unchanged" in speed.text
    assert "v, tau_n and 2 - g up by the same factor leave every response unchanged" in speed.text
    assert "K_p / K_i follows from these." in speed.sentences
    assert "2 of them must be known from elsewhere to find the rest." in speed.text


def test_holding_one_breaks_the_tie():
    assert found_in(structure("INITIAL").held_at(v=1.0)).names == ("K_p", "K_i", "tau_n", "g")
    assert found_in(structure("INITIAL").held_at(v=1.0, g=0.0), "n").names == ("K_p", "K_i", "tau_n")


# ---- the other shipped structures ----


@pytest.mark.parametrize("name", ["OL1", "OL2", "OL3", "OL4", "OL5", "OL-PID", "CL1", "CL3", "CL4", "GAUGE-CORE"])
def test_structures_of_which_everything_can_be_found(name):
    found = found_in(structure(name))
    assert found.names == tuple(p.name for p in structure(name).free)
    assert found.combinations == ()
    assert found.directions == ()
    assert f"all {len(found.names)} free parameters" in found.text or found.rank == 1


def test_one_parameter_in_words():
    assert found_in(structure("OL1")).sentences == ("From n a test finds the free parameter of OL1: tau_n.",)


SINGLE_IN_GAUGE = {"t_d", "omega_n", "zeta", "tau_dn", "k_q", "t_sp", "c_set", "t_gauge"}


@pytest.mark.parametrize("name", ["GAUGE-CLOSED", "GAUGE-OPEN"])
def test_gauge_aware_structures_lose_one_direction(name):
    """``L = v C exp(-s t_d) F / (tau s + k_q - g)``: only ratios of ``K_p``, ``K_i``, ``tau`` and ``k_q - g``."""
    found = found_in(structure(name))
    assert found.rank == 11
    assert set(found.identifiable) == SINGLE_IN_GAUGE
    assert [c.name for c in found.combinations] == [
        "K_p / K_i",
        "v K_i / (k_q - g)",
        "v K_p / (tau_up + tau_dn)",
    ]
    assert "K_p, K_i, tau_dn + tau_up and k_q - g up by the same factor leave every response unchanged" in found.text
    assert "One of K_p, K_i, tau_up and g known from elsewhere makes all of them known." in found.text


def test_gauge_aware_without_names_of_its_own():
    """The ratios of four numbers, whichever three."""
    found = found_in(without_combinations("GAUGE-CLOSED"))
    assert found.rank == 11
    assert len(found.combinations) == 3
    values = {"K_p": 5.7, "K_i": 4.3, "tau_up": 1.0, "tau_dn": 0.3, "k_q": 2.0, "g": -0.2}
    factor = 1.7
    moved = values | {"K_p": 5.7 * factor, "K_i": 4.3 * factor, "tau_up": 1.3 * factor - 0.3, "g": 2.0 - 2.2 * factor}
    for combination in found.combinations:
        one, other = (float(combination.of({n: np.array(v) for n, v in set_.items()})) for set_ in (values, moved))
        assert one == pytest.approx(other, rel=1e-12)
        shifted = float(combination.of({n: np.array(v) for n, v in (values | {"K_p": 6.0, "g": 0.1}).items()}))
        assert shifted != pytest.approx(one, rel=1e-3)


def test_gauge_aware_from_speed_alone():
    """No torque: neither ``tau_dn`` nor ``k_q`` alone, and ``t_gauge`` does not show at all."""
    found = found_in(structure("GAUGE-CLOSED"), "n")
    assert found.rank == 8
    assert set(found.identifiable) == {"t_d", "omega_n", "zeta", "t_sp", "c_set"}
    assert [c.name for c in found.combinations] == ["K_p / K_i", "v K_i / (k_q - g)", "v K_p / (tau_up + tau_dn)"]
    assert "t_gauge does not show in n." in found.text
    assert "tau_dn up and tau_up down by the same amount leave every response unchanged" in found.text
    assert "k_q and g up by the same amount leave every response unchanged" in found.text


def test_gauge_aware_from_torque_alone():
    """``M_s = c_set (tau_dn s + k_q) exp(-s (t_sp + t_gauge)) L / (1 + L)``; ``L`` itself is known up to its ratios."""
    found = found_in(structure("GAUGE-CLOSED"), "M_s")
    assert found.rank == 9
    assert found.identifiable == ("t_d", "omega_n", "zeta")
    assert {c.name for c in found.combinations} >= {"K_p / K_i", "v K_i / (k_q - g)", "v K_p / (tau_up + tau_dn)"}
    assert {"t_sp + t_gauge", "tau_dn c_set", "k_q c_set"} <= {c.name for c in (*found.combinations, *found.also)}
    assert "t_sp up and t_gauge down by the same amount leave every response unchanged" in found.text
    assert (
        "tau_dn and k_q up and c_set down by the same factor, with tau_dn + tau_up and k_q - g kept, leave every "
        "response unchanged"
    ) in found.text


def test_control_unit_splits_governor_and_engine():
    """``X`` gives the governor; of the engine ``v``, ``tau`` and ``k_q - g`` are left up to a common factor."""
    found = found_in(structure("GAUGE-ECU"))
    assert found.rank == 13
    assert found.lost == ("v", "tau_up", "g")
    assert {"K_p", "K_i", "t_d", "t_rack"} <= set(found.identifiable)
    assert "v, tau_dn + tau_up and k_q - g up by the same factor leave every response unchanged" in found.text


def test_engine_alone_knows_the_difference_of_its_delays():
    """The channel of the rack is late itself: ``exp(-s (t_d - t_rack))``."""
    found = found_in(structure("ENGINE"))
    assert "t_d - t_rack" in [c.name for c in found.combinations]
    assert "t_d and t_rack up by the same amount leave every response unchanged" in found.text


def test_speed_of_cl4_alone_still_gives_everything():
    assert found_in(structure("CL4"), "n").rank == 6


@pytest.mark.parametrize("name", STRUCTURES)
def test_null_space_leaves_the_response_as_it_is(name):
    """A law: a small step along each direction that is called lost changes no response to first order."""
    found = found_in(structure(name))
    values = found.structure.vector({})
    for direction in found.directions:
        step = np.zeros(values.size)
        for parameter, change in direction.at_default.items():
            step[found.structure.names.index(parameter)] = 1e-5 * change
        response = found.structure.response(values + step, S) - found.structure.response(values - step, S)
        moved = np.abs(response).max()
        alone = 0.0
        for place in np.flatnonzero(step):
            one = np.where(np.arange(step.size) == place, step, 0.0)
            change = found.structure.response(values + one, S) - found.structure.response(values - one, S)
            alone = max(alone, np.abs(change).max())
        assert moved < 1e-5 * alone
    assert len(found.directions) == len(found.structure.free) - found.rank


# ---- ties, several inputs, structures of a user's own ----


def test_tied_parameter():
    """``K_i = K_p / T_i`` makes the reset time a parameter: it is found on its own."""
    reset = Parameter("T_i", "s", 0.1, 5.0, 1.0, "reset time")
    tied = structure("INITIAL").tied("K_i", lambda K_p, T_i: K_p / T_i, reset)
    found = found_in(tied)
    assert found.identifiable == ("tau_n", "g", "T_i")
    assert [c.name for c in found.combinations] == ["v K_p"]


def disturbed():
    """Speed under set point and propeller load: ``n = T n_set - S M_load / (tau_n s + 2 - g)``."""
    shipped = structure("INITIAL")
    parameter = dict(zip(shipped.names, shipped.parameters, strict=True))
    line = Shaft((parameter["tau_n"],), parameter["k_q"], parameter["g"])
    loop = PIGovernor(parameter["K_p"], parameter["K_i"]) * Gain(parameter["v"]) * line
    closed = Sensitivity(loop)
    return Structure(
        name="DISTURBED",
        title="speed under set point and load",
        inputs=("n_set", "M_load"),
        outputs={"n": {"n_set": loop * closed, "M_load": line * closed}},
    )


def test_a_second_input_makes_the_inertia_known():
    found = found_in(disturbed())
    assert found.names == ("tau_n", "g", "K_p / K_i", "v K_p")


def motor(*extra):
    """A DC motor from voltage to speed: ``K_t / (L J s^2 + (L b + R J) s + R b + K_t K_e)``."""
    names = ("R", "L", "K_t", "K_e", "J", "b")
    units = ("ohm", "H", "N m/A", "V s/rad", "kg m2", "N m s")
    parts = tuple(Parameter(n, u, 0.1, 3.0, 1.0, "of the motor") for n, u in zip(names, units, strict=True))

    def coefficients(r, ell, k_t, k_e, j, b):
        return [k_t], [ell * j, ell * b + r * j, r * b + k_t * k_e]

    block = RationalBlock(coefficients, parts)
    return Structure(name="MOTOR", title="DC motor", input="u", outputs={"omega": block})


def test_motor_of_which_only_coefficients_can_be_found():
    found = found_in(motor())
    assert found.rank == 3
    assert len(found.combinations) == 3
    assert found.unnamed == 0
    rng = np.random.default_rng(3)
    r, ell, k_t, k_e, j, b = rng.uniform(0.5, 2.0, size=6)
    base = {"R": r, "L": ell, "K_t": k_t, "K_e": k_e, "J": j, "b": b}
    # electrical side in other units of voltage over current, mechanical side in others of torque
    one = base | {"R": 1.5 * r, "L": 1.5 * ell, "K_t": 1.5 * k_t}
    two = base | {"J": 0.7 * j, "b": 0.7 * b, "K_t": 0.7 * k_t}
    s = np.array([0.3 + 1.0j, 2.0j])
    for other in (one, two):
        assert found.structure.response(found.structure.vector(other), s) == pytest.approx(
            found.structure.response(found.structure.vector(base), s), rel=1e-12
        )
        for combination in found.combinations:
            assert float(combination.of(other)) == pytest.approx(float(combination.of(base)), rel=1e-9)


def test_more_lost_parameters_than_sums_of_products_can_be_tried_for():
    """The coefficients of the motor with each parameter split in two factors: ten lost ones and more."""
    names = [f"{name}_{i}" for name in ("R", "L", "K", "J", "b") for i in (1, 2)]
    parts = tuple(Parameter(name, "-", 0.1, 3.0, 1.0, "of the motor") for name in names)

    def coefficients(r1, r2, l1, l2, k1, k2, j1, j2, b1, b2):
        r, ell, k, j, b = r1 * r2, l1 * l2, k1 * k2, j1 * j2, b1 * b2
        return [k], [ell * j, ell * b + r * j, r * b + k * k]

    found = found_in(Structure(name="SPLIT", title="", input="u", outputs={"y": RationalBlock(coefficients, parts)}))
    assert (found.rank, found.unnamed) == (3, 3 - len(found.combinations))
    assert len(found.directions) == 7


def test_a_combination_without_a_short_formula_is_counted():
    """``tanh(a) + b^3 c`` is one number, and no product of powers."""
    parts = tuple(Parameter(name, "-", 0.2, 2.0, 1.0, "of a test") for name in "abc")
    block = FunctionBlock(lambda s, a, b, c: np.exp(-s * (np.tanh(a) + b**3 * c)), parts)
    found = found_in(Structure(name="ODD", title="odd", input="x", outputs={"y": block}))
    assert (found.rank, found.names, found.unnamed) == (1, (), 1)
    assert "1 combination of a, b and c without a short formula" in found.text
    assert len(found.directions) == 2
    assert "together leave every response unchanged" in found.text


def test_square_of_a_parameter():
    parts = (Parameter("a", "-", 0.2, 2.0, 1.0, "of a test"), Parameter("b", "-", 0.2, 2.0, 1.0, "of a test"))
    block = RationalBlock(lambda a, b: ([1.0], [1.0, a * a / b]), parts)
    found = found_in(Structure(name="SQUARE", title="", input="x", outputs={"y": block}))
    assert found.names == ("a^2 / b",)
    assert found.combinations[0].of({"a": np.array(3.0), "b": np.array(2.0)}) == 4.5


def test_delays_in_series_are_found_as_their_sum():
    parts = [Parameter(f"t_{i}", "s", 0.0, 1.0, 0.2, "delay") for i in (1, 2)]
    found = found_in(Structure(name="TWO", title="", input="x", outputs={"y": Delay(parts[0]) * Delay(parts[1])}))
    assert found.names == ("t_1 + t_2",)
    assert found.combinations[0].unit == "s"
    assert "t_1 up and t_2 down by the same amount leave every response unchanged" in found.text


@pytest.mark.parametrize(
    ("powers", "expected"),
    [
        ((("rad/s", 1),), "rad/s"),
        ((("rad/s", 1), ("s", 1)), "-"),
        ((("-", 1), ("rad/s", -1)), "s"),
        ((("1/s", 1), ("s", -1)), "1/s2"),
        ((("kg m2", 1), ("N m s/rad", -1)), "kg m/(N s)"),
        ((("N m", 2), ("A", -1)), "N2 m2/A"),
    ],
)
def test_unit_of_a_product(powers, expected):
    assert unit_of(*powers) == expected


# ---- refusals ----


def test_unknown_output():
    with pytest.raises(StructureError, match="structure CL4 has no output X; it has n, M_s"):
        found_in(structure("CL4"), "X")


def test_response_that_is_finite_nowhere():
    block = FunctionBlock(lambda s, gain: gain * s * np.inf, (Parameter("k", "-", 0.1, 1.0, 0.5, "gain"),))
    with pytest.raises(StructureError, match="structure DEAD: its response is finite at no frequency"):
        found_in(Structure(name="DEAD", title="", input="x", outputs={"y": block}))


def test_nothing_free():
    with pytest.raises(StructureError, match="structure OL1 has no free parameter"):
        found_in(structure("OL1").held_at(tau_n=0.4))
