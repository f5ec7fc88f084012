"""Counts, poles and margins against loops whose answers are known, polynomial roots, and the laws they must obey."""

from collections.abc import Mapping
from math import factorial

import numpy as np
import pytest
import scipy.special

from shaftprint.catalogue import structure
from shaftprint.errors import StructureError
from shaftprint.models import (
    Delay,
    Gain,
    Integrator,
    Parameter,
    PIGovernor,
    RationalBlock,
    SecondOrderLag,
    Shaft,
    Structure,
    feedback,
    is_stable,
    margins,
)
from shaftprint.models._margins import poles
from shaftprint.models._nyquist import loop_gain, unstable_poles

CL4 = {"tau_n": 0.329, "K_p": 1.6004, "K_i": 4.4388, "t_d": 0.1161, "omega_n": 9.7705, "zeta": 0.4}


def free(name, lower=0.0, upper=1e3):
    return Parameter(name, "-", lower, upper, 1.0, "test")


def delayed_integrator():
    """``L = k exp(-s T) / s``: everything about it is known in closed form."""
    loop = Gain(free("k")) * Delay(free("T")) * Integrator()
    return Structure(name="delayed", title="", input="r", outputs={"y": feedback(loop)})


def random_cl4(seed) -> Mapping[str, float]:
    shipped = structure("CL4")
    rng = np.random.default_rng(seed)
    values = {p.name: rng.uniform(p.lower, p.upper) for p in shipped.free}
    return values | {"zeta": rng.uniform(0.05, 0.8)}


# ---- loops that are known in closed form ----


@pytest.mark.parametrize(("gain", "delay"), [(0.3, 1.0), (1.2, 1.0), (1.7, 1.0), (9.0, 0.05), (9.0, 1.0), (40.0, 0.5)])
def test_margins_of_a_delayed_integrator(gain, delay):
    """``GM = pi / (2 k T)`` at ``pi / (2 T)``; ``PM = pi / 2 - k T`` at ``k``; delay margin ``pi / (2 k) - T``."""
    found = margins(delayed_integrator(), [gain, delay])
    turns = np.arange(40)
    critical = (np.pi / 2 + 2 * np.pi * turns) / delay
    nearest = critical[np.argmin(np.abs(np.log(critical / gain)))]
    phase = np.angle(np.exp(1j * (np.pi / 2 - gain * delay)))
    stable = gain * delay < np.pi / 2
    # every two poles pass the axis when k T passes pi / 2 + 2 pi m
    assert found.unstable_poles == 2 * np.sum(gain > critical)
    assert found.stable is stable
    assert found.gain_margin == pytest.approx(nearest / gain, rel=1e-12)
    assert found.gain_margin_rad_s == pytest.approx(nearest, rel=1e-12)
    assert found.phase_margin_rad == pytest.approx(phase, abs=1e-12)
    assert found.phase_margin_rad_s == pytest.approx(gain, rel=1e-12)
    if stable:
        assert found.delay_margin_s == pytest.approx(np.pi / (2 * gain) - delay, rel=1e-11)


@pytest.mark.parametrize("product", [0.2, 0.36, 0.37, 1.0, 3.0])
def test_poles_of_a_delayed_integrator_are_branches_of_lambert_w(product):
    """``s exp(s T) = -k`` has the roots ``W_m(-k T) / T``; two real ones meet at ``k T = 1 / e``."""
    delay = 0.4
    found = poles(delayed_integrator(), [product / delay, delay])
    branches = np.array([scipy.special.lambertw(-product, m) for m in (-2, -1, 0, 1, 2)]) / delay
    upper = np.unique(np.round(branches.real + 1j * np.abs(branches.imag), 9))
    for root in upper[(upper.real > -15.0) & (upper.imag < 20.0)]:
        assert np.min(np.abs(found - root)) < 1e-5
    assert found[0].real == pytest.approx(branches.real.max(), abs=1e-6)
    assert np.all(np.diff(found.real) <= 0.0)


def test_loop_that_never_reaches_one_has_no_margins():
    """``K_p / (tau s + 2)`` with ``K_p`` 1: |L| is at most one half, its phase never beyond -90 degrees."""
    shipped = structure("BENCHMARK")
    found = margins(shipped, shipped.vector({"tau_n": 1.0, "K_p": 1.0, "K_i": 0.0, "g": 0.0, "v": 1.0}))
    assert found.stable
    assert (found.gain_margin, found.phase_margin_rad, found.delay_margin_s) == (np.inf, np.inf, np.inf)
    assert np.isnan(found.gain_margin_rad_s)
    assert np.isnan(found.phase_margin_rad_s)
    assert found.peak_sensitivity == pytest.approx(1.0, abs=1e-6)


def test_weak_loop_with_delay_has_the_poles_of_its_lag():
    """With ``K_i`` = 0 and a thousandth of gain the loop is almost open: its poles are the lag's and the shaft's."""
    shipped = structure("CL4")
    values = CL4 | {"K_p": 1e-3, "K_i": 0.0, "zeta": 0.5}
    found = poles(shipped, shipped.vector(values))
    for expected in (-2.0 / 0.329, complex(-0.5 * 9.7705, 9.7705 * 0.75**0.5)):
        assert np.min(np.abs(found - expected)) < 0.02
    assert is_stable(shipped, shipped.vector(values))


# ---- against polynomials ----


@pytest.mark.parametrize("seed", range(40))
def test_five_parameter_loop_has_the_poles_of_eq_2_26(seed):
    """Also with an unstable open loop: ``g`` above ``k_q`` is caught by a strong governor or not."""
    rng = np.random.default_rng(seed)
    tau, k_p, k_i, v, g = rng.uniform([0.1, 0.1, 0.1, 0.5, -3.0], [5.0, 6.0, 10.0, 2.0, 9.0])
    shipped = structure("BENCHMARK")
    values = shipped.vector({"tau_n": tau, "K_p": k_p, "K_i": k_i, "g": g, "v": v})
    roots = np.roots([tau, v * k_p - g + 2.0, v * k_i])
    upper = np.unique(np.round(roots.real + 1j * np.abs(roots.imag), 8))
    found = poles(shipped, values)
    assert np.sort_complex(np.round(found, 8)) == pytest.approx(np.sort_complex(upper), abs=2e-8)
    assert unstable_poles(shipped, values) == np.sum(roots.real > 0.0)


def test_governor_tames_an_engine_that_is_unstable_alone():
    """``g`` = 3 > 2: unstable until ``v K_p > g - 2 = 1`` (Routh), one right-half-plane pole in the open loop."""
    shipped = structure("BENCHMARK")
    weak = shipped.vector({"tau_n": 1.0, "K_p": 0.99, "K_i": 0.1, "g": 3.0, "v": 1.0})
    strong = shipped.vector({"tau_n": 1.0, "K_p": 1.01, "K_i": 0.1, "g": 3.0, "v": 1.0})
    assert (unstable_poles(shipped, weak), unstable_poles(shipped, strong)) == (2, 0)
    assert unstable_poles(shipped, shipped.vector({"tau_n": 1.0, "K_p": 0.1, "K_i": 0.001, "g": 3.0, "v": 1.0})) == 2


def pade_polynomials(delay, order):
    """The ``[order/order]`` approximation; its coefficients are ``(2n - k)! / (k! (n - k)!)``."""
    numbers = [factorial(2 * order - k) / (factorial(k) * factorial(order - k)) for k in range(order + 1)]
    below = np.array([c * delay**k for k, c in enumerate(numbers)])
    above = below * (-1.0) ** np.arange(order + 1)
    return above[::-1] / below[0], below[::-1] / below[0]


@pytest.mark.parametrize("seed", range(60))
def test_count_with_exact_delay_equals_the_roots_of_a_close_pade_form(seed):
    """Order 9: true to 1e-6 in all frequencies at which these loops exceed one."""
    values = random_cl4(seed)
    shipped = structure("CL4")
    top, bottom = pade_polynomials(values["t_d"], 9)
    square = values["omega_n"] ** 2
    above = np.polymul(top, np.array([values["K_p"], values["K_i"]]) * square)
    lag = [1.0, 2.0 * values["zeta"] * values["omega_n"], square]
    below = np.polymul(bottom, np.polymul([values["tau_n"], 2.0, 0.0], lag))
    roots = np.roots(np.polyadd(above, below))
    assert unstable_poles(shipped, shipped.vector(values)) == np.sum(roots.real > 0.0)
    dominant = roots[np.argmax(roots.real)]
    (first, *_) = poles(shipped, shipped.vector(values))
    assert abs(first - complex(dominant.real, abs(dominant.imag))) < 1e-4 * (1.0 + abs(dominant))


@pytest.mark.parametrize("name", ["CL3", "CL4-PADE5"])
def test_all_poles_of_a_rational_loop_are_given(name):
    shipped = structure(name)
    values = shipped.vector(CL4 if name == "CL4-PADE5" else {k: x for k, x in CL4.items() if k != "t_d"})
    found = poles(shipped, values)
    count = int(np.sum(np.where(found.imag > 0.0, 2, 1)))
    assert count == (4 if name == "CL3" else 9)
    assert np.max(np.abs(1.0 + loop_gain(shipped, values, found))) < 1e-9


# ---- laws ----


@pytest.mark.parametrize("seed", range(30))
def test_poles_with_delay_leave_no_residual_and_agree_with_the_count(seed):
    values = random_cl4(seed)
    shipped = structure("CL4")
    found = poles(shipped, shipped.vector(values))
    residual = np.abs(1.0 + loop_gain(shipped, shipped.vector(values), found))
    assert np.max(residual) < 1e-8
    right = found[found.real > 0.0]
    assert np.sum(np.where(right.imag > 0.0, 2, 1)) == unstable_poles(shipped, shipped.vector(values))


@pytest.mark.parametrize("seed", range(60))
def test_gain_and_delay_margins_are_where_poles_pass_the_axis(seed):
    """A hair inside the margin nothing has changed, a hair beyond it two poles have."""
    values = random_cl4(seed)
    shipped = structure("CL4")

    def count(scale=1.0, extra=0.0):
        changed = {"K_p": scale * values["K_p"], "K_i": scale * values["K_i"], "t_d": values["t_d"] + extra}
        return unstable_poles(shipped, shipped.vector({**values, **changed}))

    found = margins(shipped, shipped.vector(values))
    below, above = count(scale=found.gain_margin * (1 - 1e-4)), count(scale=found.gain_margin * (1 + 1e-4))
    assert above - below == 2
    if found.stable:
        assert found.delay_margin_s > 0.0
        assert count(extra=found.delay_margin_s * (1 - 1e-4)) == 0
        assert count(extra=found.delay_margin_s * (1 + 1e-4)) == 2


def test_delay_margin_of_a_stable_loop_is_positive_though_a_resonance_returns_above_one():
    """The resonance lies beyond -180 degrees where |L| > 1 again, so phase *lead* would be missing there, not lag."""
    shipped = structure("CL4")
    values = {"tau_n": 3.596, "K_p": 7.58, "K_i": 5.128, "t_d": 0.465, "omega_n": 7.396, "zeta": 0.08}
    found = margins(shipped, shipped.vector(values))
    assert found.stable
    assert found.delay_margin_s > 0.0
    late = shipped.vector(values | {"t_d": 0.465 + 1.001 * found.delay_margin_s})
    assert unstable_poles(shipped, late) == 2


def test_time_and_frequency_scale_together():
    """All times doubled, all frequencies halved: poles halve, delay margin doubles, gain margin stays."""
    shipped = structure("CL4")
    slow = {k: x * {"tau_n": 2.0, "K_i": 0.5, "t_d": 2.0, "omega_n": 0.5}.get(k, 1.0) for k, x in CL4.items()}
    fast_found, slow_found = margins(shipped, shipped.vector(CL4)), margins(shipped, shipped.vector(slow))
    assert slow_found.gain_margin == pytest.approx(fast_found.gain_margin, rel=1e-10)
    assert slow_found.delay_margin_s == pytest.approx(2.0 * fast_found.delay_margin_s, rel=1e-10)
    assert slow_found.poles[0] == pytest.approx(fast_found.poles[0] / 2.0, rel=1e-7)


def test_peak_sensitivity_is_bounded_by_the_margins():
    """The critical point is nearer than either margin shows: ``GM / (GM - 1)`` and ``1 / (2 sin(PM / 2))``."""
    shipped = structure("CL4")
    found = margins(shipped, shipped.vector(CL4))
    assert found.peak_sensitivity >= found.gain_margin / (found.gain_margin - 1.0) - 1e-3
    assert found.peak_sensitivity >= 0.5 / np.sin(found.phase_margin_rad / 2.0)
    at_peak = loop_gain(shipped, shipped.vector(CL4), [1j * found.peak_sensitivity_rad_s])
    assert 1.0 / abs(1.0 + at_peak[0]) == pytest.approx(found.peak_sensitivity, rel=1e-12)


# ---- structures without feedback ----


@pytest.mark.parametrize("verb", [margins, lambda s, v: loop_gain(s, v, [1j])])
def test_margins_of_a_structure_without_loop_are_refused(verb):
    shipped = structure("OL5")
    with pytest.raises(StructureError, match=r"OL5 has no feedback loop.*closed loop first"):
        verb(shipped, shipped.vector({}))


def test_structure_without_loop_has_the_poles_of_its_blocks():
    shipped = structure("OL5")
    values = shipped.vector({"omega_n": 10.0, "zeta": 0.6})
    assert poles(shipped, values) == pytest.approx([0.0, complex(-6.0, 8.0)], abs=1e-12)
    assert is_stable(shipped, values)


def test_unstable_block_without_loop_is_counted():
    slope, g = free("k_q"), free("g")
    alone = Structure(name="alone", title="", input="M_s", outputs={"n": Shaft((free("tau"),), slope, g)})
    values = alone.vector({"tau": 1.0, "k_q": 2.0, "g": 2.5})
    assert unstable_poles(alone, values) == 1
    assert not is_stable(alone, values)
    assert poles(alone, values) == pytest.approx([0.5])


def test_structure_of_delays_only_has_no_poles():
    alone = Structure(name="late", title="", input="u", outputs={"y": Delay(free("T"))})
    assert poles(alone, [0.1]).size == 0
    assert is_stable(alone, [0.1])


def test_two_feedback_loops_in_one_structure_are_refused():
    governor = PIGovernor(free("K_p"), free("K_i"))
    lag = SecondOrderLag(free("omega_n"), free("zeta"))
    with pytest.raises(StructureError, match="expected one outermost feedback loop, found 2"):
        Structure(name="two", title="", input="r", outputs={"a": feedback(governor), "b": feedback(lag)})


def open_structure(expression):
    return Structure(name="open", title="open", input="u", outputs={"y": expression})


def test_poles_of_an_inverse_without_a_loop_are_the_zeros_of_what_is_inverted():
    # J s + b - g: a machine whose torque rises faster with speed than its friction runs away, at (g - b) / J
    inertia, friction, rise = (Parameter(name, "-", 0.0, 10.0, 1.0, name) for name in ("J", "b", "g"))
    machine = open_structure(1 / (RationalBlock(lambda j, b: ([j, b], [1.0]), (inertia, friction)) - Gain(rise)))
    assert is_stable(machine, machine.vector({"J": 2.0, "b": 3.0, "g": 2.9}))
    assert unstable_poles(machine, machine.vector({"J": 2.0, "b": 3.0, "g": 3.5})) == 1
    np.testing.assert_allclose(poles(machine, machine.vector({"J": 2.0, "b": 3.0, "g": 3.5})), [0.25])


def test_a_block_below_a_fraction_gives_zeros_not_poles():
    # 1 / (1 / (s - 1)) = s - 1 has no pole, and 1 / ((s - 1) / (s + 2)) has the pole 1 of its numerator
    spring = RationalBlock(lambda: ([1.0], [1.0, -1.0]), ())
    assert is_stable(open_structure(1 / spring), [])
    assert poles(open_structure(1 / spring), []).size == 0
    quotient = open_structure(1 / RationalBlock(lambda: ([1.0, -1.0], [1.0, 2.0]), ()))
    np.testing.assert_allclose(poles(quotient, []), [1.0])
    assert not is_stable(quotient, [])


def test_a_belt_between_two_masses_has_the_poles_of_its_equations():
    # J_1 s w_1 = T - M, J_2 s w_2 = M - b w_2, M = (c + k / s) (w_1 - w_2)
    j_1, j_2, k, c, b = 0.004, 0.015, 60.0, 0.05, 0.02
    matrix = np.array([[-c / j_1, c / j_1, -k / j_1], [c / j_2, -(b + c) / j_2, k / j_2], [1.0, -1.0, 0.0]])
    motor = RationalBlock(lambda: ([j_1, 0.0], [1.0]), ())
    belt, load = RationalBlock(lambda: ([c, k], [1.0, 0.0]), ()), RationalBlock(lambda: ([1.0], [j_2, b]), ())
    drive = open_structure(1 / (motor + 1 / (1 / belt + load)))
    expected = [p for p in np.linalg.eigvals(matrix) if p.imag >= 0.0]
    np.testing.assert_allclose(poles(drive, []), sorted(expected, key=lambda p: -p.real), rtol=1e-9)
