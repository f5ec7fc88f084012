"""How long a test has to be, what would help, and the sentences that say so."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.design import Wish, design_campaign, no_worse_than, plan_sentences, remedies, shortest
from shaftprint.errors import DesignError
from shaftprint.identify import Prior
from shaftprint.survey import STAN_TUG_NOISE


def designer(tug, limits, quick, wish, **changed):
    """A function that plans with one of the fields left open."""

    def design(**fields):
        fields = {"speeds": (1.15, 0.70), "within_s": 720.0} | changed | fields
        return design_campaign(tug, wish, limits, STAN_TUG_NOISE, rng=np.random.default_rng(1), effort=quick, **fields)

    return design


@pytest.mark.slow
def test_shortest_test_is_just_long_enough(tug, limits, quick):
    design = designer(tug, limits, quick, Wish(relative={"K_p": 0.03, "t_d": 0.10}))
    plan = shortest(lambda within_s: design(within_s=within_s), longest_s=1800.0)
    assert plan.is_enough
    assert max(plan.ratios.values()) > 0.93
    assert plan.duration_s < 600.0
    assert not design(within_s=0.8 * plan.duration_s).is_enough


@pytest.mark.slow
def test_shortest_of_what_is_impossible_is_the_longest(tug, limits, quick):
    design = designer(tug, limits, quick, Wish(relative={"t_d": 0.001}))
    plan = shortest(lambda within_s: design(within_s=within_s), longest_s=600.0)
    assert not plan.is_enough
    assert 580.0 < plan.duration_s <= 600.0


def test_shortest_without_a_wish_is_refused(tug, limits, quick):
    design = designer(tug, limits, quick, Wish())
    with pytest.raises(DesignError, match="shortest test within 10 min: expected a wish, found none"):
        shortest(lambda within_s: design(within_s=within_s), longest_s=600.0)


@pytest.mark.slow
def test_one_speed_does_not_show_the_gains(tug, limits, quick):
    """At one speed a common factor of gains and inertias is free; a second speed, or one inertia, fixes it."""
    design = designer(tug, limits, quick, Wish(relative={"K_p": 0.03}), speeds=(1.0,))
    plan = design()
    assert np.isinf(plan.predicted.estimate("K_p").std)
    helps = remedies(plan, lambda speeds: design(speeds=speeds))
    words = plan_sentences(plan, helps)
    assert words[0] == "12 min at 1184 rpm do not meet the wish for K_p."
    assert words[1] == "K_p: such a test does not show it, however long."
    assert words[-1] == "The plan was not rehearsed."
    second = next(one for one in helps if one.name.startswith("half of the time at"))
    assert second.sentence == "With half of the time at 829 rpm every wish would be met."
    latency = next(one for one in helps if one.name == "the latency of the set point known to 5 ms")
    assert latency.sentence.endswith("K_p would still not be known.")
    # knowing more cannot make it worse
    assert helps[0].worst <= second.worst


def test_remedy_is_what_a_prior_gives(plan, tug, limits, quick, truth):
    """The remedy against the same plan made with the prior of the fit: the same lines, the same information."""
    wished = replace(plan, wish=Wish(relative={"t_d": 0.01}))
    latency = next(one for one in remedies(wished) if one.name == "the latency of the set point known to 5 ms")
    # t_d + t_sp is known far better than t_sp, so that t_d is as good as the latency or the test, whichever is better
    both = 1.0 / np.hypot(1.0 / 0.005, 1.0 / plan.predicted.estimate("t_d").std)
    assert latency.ratios["t_d"] == pytest.approx(both / (0.01 * truth["t_d"]), rel=0.05)
    sharp = replace(wished, priors={"t_sp": Prior(truth["t_sp"], 0.005)})
    assert all("latency" not in one.name for one in remedies(sharp))


def test_wish_of_a_fit_leaves_out_what_is_not_known(plan):
    numbers = [*plan.predicted.parameters, replace(plan.predicted.parameters[0], name="lost", std=np.inf)]
    wish = no_worse_than(numbers, but=("c_set",))
    assert set(wish.absolute) == {e.name for e in plan.predicted.parameters} - {"c_set"}
    assert replace(plan, wish=wish).ratios == pytest.approx(dict.fromkeys(wish.names, 1.0))


def test_wish_that_cannot_be_meant():
    with pytest.raises(DesignError, match="found K_p = 0, t_d twice"):
        Wish(relative={"K_p": 0.0, "t_d": 0.1}, absolute={"t_d": 0.01})
