"""Which numbers may be trusted: each reason for doubt, on a fit of which the right answer is known."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import Prior, Requirements, Settings, identify, profile
from shaftprint.identify.judgement._number_precision import _beyond, doubts_of
from shaftprint.models import Combination, Gain, Parameter, PIGovernor, Structure
from shaftprint.spectra import FrequencyResponse


def fitted(response, made_of, **settings):
    return identify(made_of, response, rng=np.random.default_rng(1), settings=Settings(starts=15, **settings))


def trusted(fit, *, profiled=False, **requirements):
    numbers = (*fit.parameters, *fit.combinations)
    doubts = doubts_of(fit, numbers, profile(fit) if profiled else None, Requirements(**requirements))
    return tuple(number.name for number in numbers if number.name not in doubts), doubts


@pytest.mark.parametrize("profiled", [False, True])
def test_well_known_numbers_are_trusted(make_response, profiled):
    fit = fitted(make_response("CL4", noise=0.002, rng=np.random.default_rng(3)), structure("CL4"))
    names, doubts = trusted(fit, profiled=profiled)
    assert names == ("tau_n", "K_p", "K_i", "t_d", "omega_n", "zeta")
    assert doubts == {}


@pytest.mark.parametrize("profiled", [False, True])
def test_a_number_that_is_hardly_known_is_not(make_response, profiled):
    """One line at 0.01 Hz knows ``K_i`` of a PI governor, not ``K_p``: 2 beside 64."""
    response = make_response("OL2", {"K_p": 2.0, "K_i": 4.0}, noise=0.02, rng=np.random.default_rng(3))
    few = identify(structure("OL2"), response, rng=np.random.default_rng(1), lines=["S2", "S3"])
    names, doubts = trusted(few, profiled=profiled)
    assert names == ("K_i",)
    assert list(doubts) == ["K_p"]
    share = few.parameters[0].std / few.value("K_p")
    assert doubts["K_p"] == f"it is known to {100 * share:.0f} % only" or profiled
    assert trusted(few, largest_std=10.0)[1] == {}


def test_a_search_without_an_end_is_not_told_as_an_end_that_the_data_did_not_set(make_response):
    fit = fitted(make_response("OL2", noise=0.002, rng=np.random.default_rng(3)), structure("OL2"))
    found = profile(fit)
    ends = found.intervals | {"K_p": replace(found.intervals["K_p"], upper_failed=True)}
    assert doubts_of(fit, fit.parameters, replace(found, intervals=ends)) == {
        "K_p": "the search for the upper end of its interval came to none"
    }


def test_a_number_at_its_bound_is_not(make_response):
    fit = fitted(make_response("OL2", {"K_p": -0.3, "K_i": 4.0}), structure("OL2"))
    assert trusted(fit)[1] == {"K_p": "it stopped at its bound 0"}


def two_gains(v=(0.2, 5.0)):
    k_p, k_i = structure("OL2").parameters
    gain = Parameter("v", "-", *v, 1.0, "test")
    product = Combination(name="v K_p", unit="-", of=lambda p: p["v"] * p["K_p"], meaning="test")
    quotient = Combination(name="K_i / zero", unit="-", of=lambda p: p["K_i"] / (p["v"] - p["v"]), meaning="test")
    return Structure(
        name="own", title="", input="e", outputs={"M_s": PIGovernor(k_p, k_i) * Gain(gain)},
        combinations=(product, quotient),
    )  # fmt: skip


def test_of_a_product_the_factors_are_not_trusted_but_the_product_is(make_response):
    own = two_gains()
    fit = fitted(make_response(own, {"K_p": 2.0, "K_i": 3.0, "v": 1.0}, noise=0.01), own)
    with np.errstate(all="ignore"):
        names, doubts = trusted(fit)
    assert names == ("v K_p",)
    assert doubts["K_p"] == doubts["K_i"] == doubts["v"] == "the data say nothing about it"
    assert doubts["K_i / zero"] == "it has no value at the estimate"


@pytest.mark.parametrize(("upper", "ends"), [(0.5, "lower"), (0.005, "lower and upper")])
def test_an_interval_that_only_a_bound_closes_is_no_measurement(make_response, upper, ends):
    """A delay of 3 ms among noise of 5 %: it may be 0, and within 5 ms it may be anything."""
    own = structure("OL3").free_between(t_d=(0.0, upper))
    late = fitted(make_response("OL3", {"K_p": 2.0, "K_i": 4.0, "t_d": 0.003}, noise=0.05), own)
    assert trusted(late, profiled=True)[1]["t_d"] == f"the data set no {ends} end to it"


def test_a_number_that_was_known_beforehand_is_not_measured(make_response):
    own = two_gains()
    response = make_response(own, {"K_p": 2.0, "K_i": 3.0, "v": 1.0}, noise=0.01)
    fit = fitted(response, own, priors={"v": Prior(1.0, 0.01)})
    with np.errstate(all="ignore"):
        names, doubts = trusted(fit)
    assert doubts["v"] == "the test adds almost nothing to what was known before"
    assert {"K_p", "K_i", "v K_p"} <= set(names)


def test_a_number_of_either_sign_is_compared_with_its_range():
    """A gain of 0.001 +/- 0.005 within -1 to 1 is known to 0.25 % of its range; within 0 to 1 it is not known."""
    for lower, known in ((-1.0, True), (0.0, False)):
        gain = Parameter("k", "-", lower, 1.0, 0.5, "test")
        own = Structure(name="own", title="", input="u", outputs={"y": Gain(gain)})
        response = FrequencyResponse(
            frequency_hz=np.array([1.0]),
            response=np.array([[[0.001 + 0.0j]]]),
            covariance=0.005**2 * np.eye(2)[None],
            inputs=("u",),
            outputs=("y",),
        )
        names, _ = trusted(fitted(response, own))
        assert (names == ("k",)) is known


def test_requirements_are_positive():
    with pytest.raises(IdentificationError, match="requirement gain_margin: expected a positive number, found 0"):
        Requirements(gain_margin=0.0)
    assert Requirements(lowest_line_snr_db=-3.0).lowest_line_snr_db == -3.0


@pytest.mark.parametrize(("percent", "words"), [(10.26, "10.26"), (13.4, "13"), (10.6, "11"), (99.7, "100")])
def test_a_share_beyond_the_limit_shows_that_it_is(percent, words):
    """Ten per cent are allowed: what is said to be "10 % only" looks allowed."""
    assert _beyond(percent, 10.0) == words
