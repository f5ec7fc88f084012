"""Where a fit fails, in words."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.identify import Settings, Unweighted, identify
from shaftprint.identify.judgement._misfit import _in_record, explained, misfit_words, worst_lines


def fitted(response, name="CL4", **settings):
    return identify(structure(name), response, rng=np.random.default_rng(1), settings=Settings(**settings))


@pytest.fixture
def good(make_response):
    return make_response("CL4", noise=0.01, correlation=0.3, rng=np.random.default_rng(3))


def spoilt(response, places, output, by=20.0):
    """The response with one output off by some standard deviations at some lines."""
    data = response.response.copy()
    std = np.sqrt(response.covariance[places, output, output])
    data[output, 0, places] += by * std
    return replace(response, response=data)


def test_lines_that_are_off_are_named_with_their_output_and_frequencies(good):
    held = {p: v for p, v in zip(structure("CL4").names, fitted(good).values, strict=True) if p != "k_q"}
    fixed = structure("CL4").held_at(**{k: v for k, v in held.items() if k != "K_i"})
    found = identify(fixed, spoilt(good, [9, 10, 11], 1), rng=np.random.default_rng(1))
    assert worst_lines(found) == ("S10", "S11", "S12")
    assert misfit_words(found) == "the misfit is largest in M_s at S10 to S12 (2.3 to 10 rad/s)"


def test_a_misfit_of_both_outputs_names_none(good):
    fixed = structure("CL4").held_at(tau_n=0.329, K_p=1.6, t_d=0.116, omega_n=9.77, zeta=0.5)
    both = spoilt(spoilt(good, [4], 1), [4], 0)
    found = identify(fixed, both, rng=np.random.default_rng(1))
    assert misfit_words(found) == "the misfit is largest at S5 (0.25 rad/s), p < 1e-12 by itself"


def test_a_fit_within_the_noise_has_no_worst_line(good):
    found = fitted(good)
    assert explained(found)
    assert worst_lines(found) == ()
    assert misfit_words(found) == "the misfit is spread over all lines"


def test_a_single_line_far_off_is_no_explanation_even_if_the_sum_is(make_response):
    """One of 13 lines 6 standard deviations off, the others perfect: chi-square of all 52 data passes, its own not."""
    found = fitted(spoilt(make_response("CL4", noise=0.01), [2], 1, by=6.0))
    assert found.p_value > 0.01
    assert not explained(found)
    assert worst_lines(found) == ("S3",)


def test_a_wrong_structure_is_not_explained(good):
    assert not explained(fitted(good, "CL1"))


def test_without_weights_it_is_fit_percent_against_what_noise_allows(good):
    right, wrong = (fitted(good, name, weighting=Unweighted()) for name in ("CL4", "CL1"))
    assert explained(right)
    assert not explained(wrong)


class Left:
    """What is left of 20 s of two outputs at 100 Hz: white but for what is added to the second."""

    name, output_names = "record bench", ("omega", "i")
    used_s = 5.0 + 0.01 * np.arange(2000)

    def __init__(self, added):
        self.whitened = np.random.default_rng(3).standard_normal((2000, 2))
        self.whitened[:, 1] += added(self.used_s)


@pytest.mark.parametrize(
    ("added", "words"),
    [
        (lambda t: 5.0 * ((t > 12.0) & (t < 13.0)), ", in i, from 12 to 13 s"),
        (lambda t: 2.0 * np.sin(2.0 * np.pi * 7.0 * t), ", in i, between 5 and 7.5 Hz"),
        (lambda t: 0.0 * t, ""),
    ],
)
def test_the_place_of_a_misfit_in_a_record_is_told(added, words):
    assert _in_record(Left(added)) == words
