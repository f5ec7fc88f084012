"""Which structure holds another as a special case: known pairs, and pairs that only look alike."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.identify import Settings, identify
from shaftprint.identify.comparison._nesting import nesting
from shaftprint.models import Gain, Parameter, PIGovernor, RationalBlock, Structure

SETTINGS = Settings(starts=20)


def fits(response, *structures, settings=SETTINGS):
    return [identify(s, response, rng=np.random.default_rng(4), settings=settings) for s in structures]


TRUTHS = {
    "OL2": {"K_p": 2.0, "K_i": 4.3},
    "OL4": {"K_p": 1.8, "K_i": 4.3, "omega_n": 9.0, "zeta": 1.2},
    "CL3": {"tau_n": 0.35, "K_p": 1.6, "K_i": 4.4, "omega_n": 9.8, "zeta": 0.5},
}


@pytest.fixture
def data(make_response):
    return lambda name: make_response(name, TRUTHS[name], noise=0.03, rng=np.random.default_rng(8))


@pytest.mark.parametrize(
    ("small", "large", "at_bound"), [("OL4", "OL5", ("t_d",)), ("OL2", "OL3", ("t_d",)), ("CL3", "CL4", ("t_d",))]
)
def test_a_delay_of_zero_leads_back_to_the_structure_without_delay(data, small, large, at_bound):
    one, two = fits(data(small), structure(small), structure(large))
    found = nesting(one, two, rng=np.random.default_rng(5))
    assert found is not None
    assert found.at_bound == at_bound
    assert found.meaningless == ()
    assert found.extra == 1
    names = [p.name for p in two.structure.free]
    shared = [names.index(p.name) for p in one.structure.free]
    own = one.values[list(one.objective.free)]
    assert found.values[shared] == pytest.approx(own, rel=1e-4)


def test_a_held_parameter_inside_the_bounds_is_a_regular_case(make_response):
    response = make_response("CL4", noise=0.03, rng=np.random.default_rng(8))
    one, two = fits(response, structure("CL4").held_at(t_d=0.1), structure("CL4"))
    found = nesting(one, two, rng=np.random.default_rng(5))
    assert (found.at_bound, found.meaningless, found.extra) == ((), (), 1)
    assert found.values[[p.name for p in two.structure.free].index("t_d")] == pytest.approx(0.1, rel=1e-6)


def test_a_parameter_that_means_nothing_in_the_smaller_structure_is_named(data):
    """``K_p + K_i / s + a / (T s + 1)`` is a PI governor where ``a`` is 0, and then ``T`` has no influence."""
    k_p, k_i = structure("OL2").parameters
    a = Parameter("a", "-", -5.0, 5.0, 0.0, "test")
    time = Parameter("T", "s", 0.05, 1.0, 0.1, "test")
    lag = RationalBlock(lambda a, time: ((a,), (time, 1.0)), (a, time))
    small = Structure(name="PI", title="", input="e", outputs={"M_s": PIGovernor(k_p, k_i)})
    large = Structure(name="PI+", title="", input="e", outputs={"M_s": PIGovernor(k_p, k_i) + lag})
    one, two = fits(data("OL2"), small, large)
    found = nesting(one, two, rng=np.random.default_rng(5))
    assert found.meaningless == ("T",)
    assert found.at_bound == ()
    assert found.extra == 2


def test_structures_that_cannot_imitate_each_other_are_not_nested(data):
    """No lag within 7 to 13 rad/s is no lag; the larger one never lies within the smaller."""
    two, three, four, five = fits(data("OL4"), *(structure(n) for n in ("OL2", "OL3", "OL4", "OL5")))
    rng = np.random.default_rng(5)
    assert nesting(two, four, rng=rng) is None
    assert nesting(three, five, rng=rng) is None
    assert nesting(five, four, rng=rng) is None
    assert nesting(four, four, rng=rng) is None


def test_one_optimum_that_happens_to_be_the_same_is_not_nesting(make_response):
    """OL3's optimum at a delay of 0 is a PI governor, which ``PI+lead`` can imitate; its delays it cannot."""
    response = make_response("OL2", {"K_p": 2.0, "K_i": 4.0}, noise=0.01)
    k_p, k_i = structure("OL2").parameters
    lead, gain = Parameter("T_l", "s", 0.0, 2.0, 0.1, "test"), Parameter("b", "-", 0.5, 2.0, 1.0, "test")
    leading = RationalBlock(lambda time: ((time, 1.0), (1.0,)), (lead,))
    other = Structure(name="PI+lead", title="", input="e", outputs={"M_s": PIGovernor(k_p, k_i) * leading * Gain(gain)})
    small, large = fits(response, structure("OL3"), other)
    assert small.value("t_d") == pytest.approx(0.0, abs=1e-6)
    assert nesting(small, large, rng=np.random.default_rng(5)) is None
