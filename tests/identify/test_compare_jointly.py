"""Structures compared on responses at two working points at once."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import Settings, compare_fits, identify_jointly
from shaftprint.identify.comparison._compare import compare_jointly
from shaftprint.identify.comparison._hold_out import hold_out
from shaftprint.identify.comparison._nesting import nesting
from shaftprint.models import at_working_point

SETTINGS = Settings(starts=12)
CL3 = {"tau_n": 0.35, "K_p": 1.6, "K_i": 4.4, "omega_n": 9.8, "zeta": 0.5}
CL4 = CL3 | {"t_d": 0.12}
SHARE = 0.7


def at_both(name):
    first = structure(name)
    return first, at_working_point(first, speed_share=SHARE)


def pairs(make_response, name, truth, *names, seed=3):
    """Structures with the responses that a true one gives at both speeds."""
    rng = np.random.default_rng(seed)
    data = [make_response(one, truth, noise=0.02, correlation=0.3, rng=rng) for one in at_both(name)]
    return [list(zip(at_both(wanted), data, strict=True)) for wanted in names]


def test_the_true_structure_of_both_speeds_wins(make_response):
    found = compare_jointly(
        pairs(make_response, "CL4", CL4, "CL1", "CL3", "CL4"), rng=np.random.default_rng(1), settings=SETTINGS
    )
    assert [candidate.name for candidate in found.candidates] == ["CL4", "CL3", "CL1"]
    # 13 lines of one complex value at each of two speeds
    assert found.best.criteria.data == 2 * 13 * 2 * len(structure("CL4").outputs)
    ratio = next(one for one in found.ratios if (one.small, one.large) == ("CL3", "CL4"))
    assert ratio.extra == 1
    assert ratio.p_value < 1e-6
    # what is left out at either speed is predicted from the others as well as the noise allows
    assert found.best.hold_out.square == pytest.approx(found.best.hold_out.expected, rel=0.5)


def test_a_structure_that_fits_each_speed_alone_but_not_both_is_rejected(make_response):
    """A gain that does not go with the speed: unscaled, each response is one of the structure, both are not."""
    rng = np.random.default_rng(5)
    first, second = at_both("CL4")
    data = [make_response(one, CL4, noise=0.02, rng=rng) for one in (first, second)]
    scaled = list(zip((first, second), data, strict=True))
    other = replace(first, name="unscaled")
    found = compare_jointly(
        [scaled, [(other, data[0]), (other, data[1])]], rng=np.random.default_rng(1), settings=SETTINGS
    )
    assert found.best.name == "CL4"
    assert found.best.identification.p_value > 0.01
    assert found.candidates[1].identification.p_value < 1e-6
    assert found.candidates[1].hold_out.square > 5.0 * found.candidates[1].hold_out.expected


def test_one_number_at_two_speeds_written_out(make_response):
    """``K / s`` at 13 lines of two responses: to predict a line from the 25 others costs 1/25."""
    first = structure("OL2").held_at(K_p=0.0)
    rng = np.random.default_rng(1)
    data = [make_response(first, {"K_i": 4.0, "K_p": 0.0}, noise=0.02, rng=rng) for _ in range(2)]
    fit = identify_jointly([(first, one) for one in data], rng=rng, settings=SETTINGS)
    found = hold_out(fit, folds=26, rng=rng)
    # of the two parts of a line only the imaginary one is predicted with an error
    assert found.expected == pytest.approx((1.0 + 1.0 + 1.0 / 25.0) / 2.0, rel=1e-6)
    assert found.folds == 26


def test_nesting_is_seen_at_both_speeds(make_response):
    small, large = (
        identify_jointly(one, rng=np.random.default_rng(4), settings=SETTINGS)
        for one in pairs(make_response, "CL3", CL3, "CL3", "CL4")
    )
    found = nesting(small, large, rng=np.random.default_rng(5))
    assert found is not None
    assert (found.extra, found.at_bound) == (1, ("t_d",))


def test_fits_to_other_responses_are_refused(make_response):
    one, two = (
        identify_jointly(chosen, rng=np.random.default_rng(1), settings=SETTINGS)
        for chosen in (
            *pairs(make_response, "CL3", CL3, "CL3", seed=3),
            *pairs(make_response, "CL3", CL3, "CL4", seed=4),
        )
    )
    with pytest.raises(
        IdentificationError, match="CL3 and CL4 were not fitted to the same lines of the same responses"
    ):
        compare_fits([one, two], rng=np.random.default_rng(1))
