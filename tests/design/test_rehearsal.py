"""A rehearsal with results that are made up, so that bias, scatter and coverage are known."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.design import rehearse
from shaftprint.design.planned_test._rehearsal import RehearsedTest
from shaftprint.errors import DesignError, IdentificationError
from shaftprint.identify import Estimate


def sailing(plan, truth, *, errors, stated=1.0, limited=0.0):
    """A sailing whose errors and deviations are multiples of what was planned, by name."""
    numbers = []
    for name, error in errors.items():
        std = plan.predicted.estimate(name).std
        numbers.append(Estimate(name=name, unit="-", value=truth[name] + error * std, std=stated * std))
    return RehearsedTest(numbers=numbers, limited_share=limited)


def test_errors_of_known_size(plan, truth):
    """Errors of +2 and -1 planned deviations, stated twice as large: z of 1 and -1/2."""
    shift = {1: 2.0, 2: -1.0}
    rehearsal = rehearse(
        plan,
        lambda seed: sailing(plan, truth, errors={"K_p": shift[seed]}, stated=2.0),
        truth={"K_p": truth["K_p"]},
        seeds=(1, 2),
    )
    assert rehearsal.mean_z["K_p"] == pytest.approx(0.25)
    assert rehearsal.rms_z["K_p"] == pytest.approx(np.sqrt((1.0 + 0.25) / 2.0))
    assert rehearsal.over_planned["K_p"] == pytest.approx(np.sqrt((4.0 + 1.0) / 2.0))
    assert rehearsal.coverage["K_p"] == 1.0
    # two errors may well be that large: a fifth of pairs of normal errors are
    assert rehearsal.sentences == ("Rehearsed with 2 simulated tests; 100 % of the 95 % intervals hold the truth.",)


def test_errors_beyond_chance_are_named(plan, truth):
    """Of 200 normal errors the root mean square is within 13 % of 1 in 99 of 100 cases; 1.6 is beyond that and 1.35."""
    errors = np.random.default_rng(1).normal(size=200)
    errors *= 1.6 / np.sqrt(np.mean(errors**2))
    rehearsal = rehearse(
        plan,
        lambda seed: sailing(plan, truth, errors={"K_p": errors[seed], "t_d": errors[seed] / 1.6}),
        truth={"K_p": truth["K_p"], "t_d": truth["t_d"]},
        seeds=range(200),
    )
    assert rehearsal.sentences[1] == "Error over the planned deviation: K_p 1.6."


def test_coverage_limits_and_failures_are_told(plan, truth):
    def sail(seed):
        if seed == 3:
            raise IdentificationError("no start reached an acceptable optimum.")
        return sailing(plan, truth, errors={"t_d": 3.0 if seed else 0.9}, limited=0.02 * seed)

    rehearsal = rehearse(plan, sail, truth={"t_d": truth["t_d"], "g": 0.0}, seeds=(0, 1, 3))
    assert rehearsal.names == ("t_d",)
    assert rehearsal.coverage == {"t_d": 0.5}
    assert rehearsal.sentences[1].startswith("A limit acted for up to 2 % of the time in the windows")
    assert rehearsal.sentences[2] == "1 of 3 gave no result: no start reached an acceptable optimum."


def test_without_any_result(plan):
    def sail(seed):
        raise IdentificationError("nothing.")

    with pytest.raises(DesignError, match=r"rehearsal with 2 seeds: expected a result of at least one, .* nothing\."):
        rehearse(plan, sail, truth={"K_p": 1.0}, seeds=(1, 2))


def test_a_number_that_the_plan_does_not_show_is_no_error_of_it(plan, truth):
    shown = tuple(replace(one, std=np.inf) if one.name == "g" else one for one in plan.predicted.parameters)
    unknown = replace(plan, predicted=replace(plan.predicted, parameters=shown))
    rehearsal = rehearse(
        unknown,
        lambda seed: sailing(plan, truth, errors={"K_p": 1.0, "g": 50.0}),
        truth={"K_p": truth["K_p"], "g": truth["g"], "no such number": 1.0},
        seeds=(1,),
    )
    assert rehearsal.names == ("K_p",)
