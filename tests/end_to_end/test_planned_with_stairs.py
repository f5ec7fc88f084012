"""A test as ``plan`` recommends it, legs and a staircase: the program that recommends it judges it."""

from datetime import UTC, datetime

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.design import Effort, SetPointLine, Wish, assumed_ship, limits_from_vessel, plan_test
from shaftprint.design.inputs._knowledge import Knowledge
from shaftprint.limits import Kind, identify_limits
from shaftprint.survey import STAN_TUG_NOISE_AT_SPEEDS, run
from shaftprint.survey._shipped_noise import STAN_TUG_LINE
from shaftprint.tug import Tug, sail
from shaftprint.vessel import load_vessel

QUICK = Effort(steps=40, restarts=1, accuracy_draws=1, peak_draws=1, active_draws=1)


@pytest.fixture(scope="module")
def surveyed(tmp_path_factory):
    """Seven minutes on the simulated tug, and what is identified of them."""
    vessel, shares = load_vessel("stan-tug-1205"), (1.15, 0.78)
    closed = structure("GAUGE-CLOSED")
    knowledge = Knowledge(
        vessel=vessel.name,
        ship=assumed_ship(closed, {closed.named_as(role): value for role, value in STAN_TUG_LINE.items()}, std={}),
        limits=limits_from_vessel(vessel, set_point_rpm=251.0),
        line=SetPointLine(slope_rpm_per_v=-250.97, offset_v=-5.0),
        noise={share: STAN_TUG_NOISE_AT_SPEEDS[1.0].of_outputs(*closed.outputs) for share in shares},
        noise_source="stored",
        priors={},
    )
    planned = plan_test(
        knowledge, Wish(), name="With stairs", within_s=420.0, now=datetime(2026, 11, 28, tzinfo=UTC), effort=QUICK
    )
    path = tmp_path_factory.mktemp("stairs") / "recording.nc"
    sail(vessel, planned.campaign, path, tug=Tug(), seed=5)
    return planned, run(path, vessel, planned.campaign, rng=np.random.default_rng(1))


@pytest.mark.long
def test_it_is_no_longer_than_asked_for(surveyed):
    planned, _ = surveyed
    assert [stairs.name for stairs in planned.campaign.staircases] == ["St1"]
    assert 400.0 < planned.campaign.duration_s <= 420.0


@pytest.mark.long
def test_the_model_of_its_legs_is_held_against_its_steps(surveyed):
    _, survey = surveyed
    assert survey.fingerprint.verdict.trustworthy
    (validation,) = survey.validations
    assert {one.excerpt.record for one in validation.comparisons} == {"St1"}
    assert validation.outcome != "fails"
    assert survey.remarks == ()


@pytest.mark.long
def test_limits_are_looked_for_in_it_and_none_is_invented(surveyed):
    """The simulated tug has a torque limit, which nothing in the test reaches."""
    planned, survey = surveyed
    found = identify_limits(survey.signals, planned.campaign, survey.vessel)
    assert found.numbers == ()
    assert Kind.TORQUE in found.not_seen
