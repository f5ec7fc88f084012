"""Profile-likelihood intervals against parabolas, held refits and simulation."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import Prior, Settings, Unweighted, identify, profile, profile_intervals
from shaftprint.models import Combination, Constant, Gain, Parameter, Structure

# Half the 95 % point of chi-square with one degree of freedom.
RISE = 1.9207294103470636


def test_of_a_linear_structure_are_1_96_deviations(make_response):
    response = make_response("OL2", noise=0.05, correlation=0.5, rng=np.random.default_rng(2))
    found = identify(structure("OL2"), response, rng=np.random.default_rng(1))
    for parameter in found.parameters:
        interval = profile_intervals(found)[parameter.name]
        lower, upper = parameter.limits_95
        assert interval.lower == pytest.approx(lower, abs=0.011 * parameter.std)
        assert interval.upper == pytest.approx(upper, abs=0.011 * parameter.std)
        assert not interval.lower_open
        assert not interval.upper_open


@pytest.mark.parametrize("name", ["OL5", "CL4"])
def test_at_each_end_the_best_fit_of_the_rest_costs_1_92_more(make_response, name):
    """Hold the parameter at the end and search again from fifty starts: the cost is half of 3.84 higher."""
    response = make_response(name, noise=0.08, rng=np.random.default_rng(5))
    found = identify(structure(name), response, rng=np.random.default_rng(1))
    unrestricted = Settings(stability="ignored")
    closed_ends = 0
    for parameter in found.parameters:
        interval = profile_intervals(found)[parameter.name]
        for end, is_open in ((interval.lower, interval.lower_open), (interval.upper, interval.upper_open)):
            held = structure(name).held_at(**{parameter.name: end})
            again = identify(held, response, rng=np.random.default_rng(1), settings=unrestricted)
            rise = again.cost - found.cost
            if is_open:
                bounds = {p.name: (p.lower, p.upper) for p in found.structure.free}[parameter.name]
                assert end == pytest.approx(bounds[0], abs=1e-6) or end == pytest.approx(bounds[1], abs=1e-6)
                assert rise < RISE
            else:
                assert rise == pytest.approx(RISE, rel=0.03)
                closed_ends += 1
    assert closed_ends >= 2 * len(found.parameters) - 2


def test_of_a_combination_is_found_along_the_curve(make_response):
    """``v K_p`` has the interval of ``K_p`` when ``v`` is held at 1."""
    shipped = structure("BENCHMARK")
    truth = {"tau_n": 0.4, "K_p": 4.0, "K_i": 5.0, "g": -0.5, "v": 1.0}
    response = make_response(shipped, truth, noise=0.02, rng=np.random.default_rng(4))
    held = profile_intervals(identify(shipped.held_at(v=1.0), response, rng=np.random.default_rng(0)))
    assert held["v K_p"].lower == pytest.approx(held["K_p"].lower, rel=1e-4)
    assert held["v K_p"].upper == pytest.approx(held["K_p"].upper, rel=1e-4)
    loose = profile_intervals(identify(shipped, response, rng=np.random.default_rng(0)))
    for name in ("v K_p", "v K_i", "K_p / K_i", "g", "tau_n"):
        width = held[name].upper - held[name].lower
        assert loose[name].lower == pytest.approx(held[name].lower, abs=0.02 * width)
        assert loose[name].upper == pytest.approx(held[name].upper, abs=0.02 * width)


def test_of_an_unknown_parameter_is_open_at_its_bound(make_response):
    """``v`` alone is free up to its bound 5; the lower end is where ``K_i`` meets its own bound 10."""
    shipped = structure("BENCHMARK")
    truth = {"tau_n": 0.4, "K_p": 4.0, "K_i": 5.0, "g": -0.5, "v": 1.0}
    response = make_response(shipped, truth, noise=0.002, rng=np.random.default_rng(4))
    interval = profile_intervals(identify(shipped, response, rng=np.random.default_rng(0)))["v"]
    assert interval.upper_open
    assert interval.upper == pytest.approx(5.0, abs=1e-6)
    assert interval.lower == pytest.approx(0.5, abs=0.01)


def test_a_prior_narrows_the_interval(make_response):
    response = make_response("OL2", noise=0.05, rng=np.random.default_rng(2))
    plain = identify(structure("OL2"), response, rng=np.random.default_rng(1))
    prior = {"K_i": Prior(4.2725, 0.2 * plain.parameters[1].std)}
    known = identify(structure("OL2"), response, rng=np.random.default_rng(1), settings=Settings(priors=prior))
    wide, narrow = profile_intervals(plain)["K_i"], profile_intervals(known)["K_i"]
    # precisions add: 1 + 25 of them
    assert (narrow.upper - narrow.lower) / (wide.upper - wide.lower) == pytest.approx(26.0**-0.5, rel=0.01)


def test_of_an_infinite_quotient_is_the_whole_axis(make_response):
    shipped = structure("BENCHMARK").held_at(v=1.0)
    truth = {"tau_n": 0.4, "K_p": 4.0, "K_i": -0.002, "g": -0.5}
    response = make_response(shipped, truth, noise=0.01)
    found = profile_intervals(identify(shipped, response, rng=np.random.default_rng(1)))
    quotient = found["K_p / K_i"]
    assert (quotient.lower, quotient.upper) == (-np.inf, np.inf)
    assert quotient.lower_open
    assert quotient.upper_open
    assert found["K_i"].lower == 0.0
    assert found["K_i"].lower_open
    assert list(found)[:4] == ["K_p", "K_i", "tau_n", "g"]


def test_an_unweighted_fit_has_none(make_response):
    settings = Settings(weighting=Unweighted())
    found = identify(structure("OL1"), make_response("OL1"), rng=np.random.default_rng(1), settings=settings)
    with pytest.raises(
        IdentificationError, match=r"structure OL1: a profile likelihood needs a fit weighted by the covariance"
    ):
        profile_intervals(found)


@pytest.mark.slow
def test_cover_the_truth_in_95_of_100_tests_although_the_cost_is_no_parabola(make_response, truths):
    """CL4 from thirteen noisy lines: lag and delay trade along a curved valley."""
    tests = 100
    covered = dict.fromkeys(truths["CL4"], 0)
    for seed in range(tests):
        rng = np.random.default_rng(seed)
        response = make_response("CL4", noise=0.05, rng=rng)
        found = identify(structure("CL4"), response, rng=rng, settings=Settings(starts=10, stability="ignored"))
        for name, interval in profile_intervals(found).items():
            covered[name] += interval.lower <= truths["CL4"][name] <= interval.upper
    # 95 of 100 +/- 2.2
    assert all(88 <= count <= 100 for count in covered.values())
    assert 92 <= np.mean(list(covered.values())) <= 98


def number(name, of):
    return Combination(name=name, unit="-", of=of, meaning="a number")


def test_does_not_depend_on_the_form_of_a_number(make_response):
    """The ends of an increasing function of a parameter are that function of its ends; of a falling one the reverse."""
    response = make_response("CL4", noise=0.08, rng=np.random.default_rng(6))
    found = identify(structure("CL4"), response, rng=np.random.default_rng(1))
    forms = (
        number("root", lambda p: np.sqrt(p["tau_n"])),
        number("fourth", lambda p: p["K_p"] ** 4),
        number("growing", lambda p: np.exp(8.0 * p["zeta"])),
        number("inverse", lambda p: 1.0 / p["t_d"]),
    )
    ends = profile(found, forms).intervals
    for name, of, form in (
        ("tau_n", np.sqrt, "root"),
        ("K_p", lambda x: x**4, "fourth"),
        ("zeta", lambda x: np.exp(8.0 * x), "growing"),
    ):
        assert ends[form].lower == pytest.approx(of(ends[name].lower), rel=2e-3)
        assert ends[form].upper == pytest.approx(of(ends[name].upper), rel=2e-3)
    assert ends["inverse"].lower == pytest.approx(1.0 / ends["t_d"].upper, rel=2e-3)
    assert ends["inverse"].upper == pytest.approx(1.0 / ends["t_d"].lower, rel=2e-3)


def test_of_a_difference_of_two_parameters_of_a_linear_structure(make_response):
    """``K_i - 3 K_p`` has the deviation that the covariance gives it."""
    response = make_response("OL2", noise=0.05, correlation=0.5, rng=np.random.default_rng(2))
    found = identify(structure("OL2"), response, rng=np.random.default_rng(1))
    interval = profile(found, [number("difference", lambda p: p["K_i"] - 3.0 * p["K_p"])]).intervals["difference"]
    slope = np.array([-3.0, 1.0])
    half = 1.959964 * np.sqrt(slope @ found.covariance @ slope)
    middle = slope @ found.values
    assert (interval.lower, interval.upper) == pytest.approx((middle - half, middle + half), abs=1e-5 * half)


def test_at_a_minimum_on_a_bound_reaches_as_far_as_the_cost_says(make_response):
    """By hand: one gain from 0 up, measured as -0.5 +/- 1; the cost ``(x + 0.5)^2 / 2`` is 1.92 higher at 1.523."""
    gain = Structure(
        name="GAIN", title="a gain", input="u", outputs={"y": Gain(Parameter("k", "-", 0.0, 10.0, 1.0, "gain"))}
    )
    response = make_response(gain, {"k": 1.0}, frequency_hz=np.array([1.0]), names=("one",), noise=1.0)
    moved = replace(response, response=np.full((1, 1, 1), -0.5 + 0.0j))
    interval = profile_intervals(identify(gain, moved, rng=np.random.default_rng(1)))["k"]
    assert interval.lower == 0.0
    assert interval.lower_open
    assert interval.upper == pytest.approx(np.sqrt(0.25 + 2.0 * RISE) - 0.5, rel=1e-6)
    assert not interval.upper_open


def test_of_a_parameter_without_influence_is_its_range(make_response):
    idle = Structure(
        name="IDLE",
        title="a gain, and another that is multiplied by nothing",
        input="u",
        outputs={
            "y": Gain(Parameter("k", "-", 0.0, 10.0, 1.0, "gain"))
            + Constant(0.0) * Gain(Parameter("idle", "-", -3.0, 7.0, 1.0, "nothing"))
        },
    )
    response = make_response(idle, {"k": 1.0, "idle": 0.0}, noise=0.1)
    intervals = profile_intervals(identify(idle, response, rng=np.random.default_rng(1)))
    assert (intervals["idle"].lower, intervals["idle"].upper) == (-3.0, 7.0)
    assert intervals["idle"].lower_open
    assert intervals["idle"].upper_open
    # 13 lines of two real data with 10 % each, of which the gain sees the real part
    half = 0.1 * 1.959964 / np.sqrt(13.0)
    assert intervals["k"].upper - intervals["k"].lower == pytest.approx(2.0 * half, rel=1e-3)
