"""How strong lines may be beside noise, what a staircase asks for, and how far the promise of a plan reaches."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.stats

from shaftprint.campaign import setpoint
from shaftprint.design import Wish, campaign_of, design_campaign, expected_operation, length_words, plan_sentences
from shaftprint.design.motion import SIGNALS, Bound
from shaftprint.design.plan import STAIRS, Timetable
from shaftprint.design.planning import with_band
from shaftprint.design.search import Uses
from shaftprint.identify import STAN_TUG_NOISE
from shaftprint.vessel import load_vessel

SHARE = 3e-4
SPEED = np.eye(len(SIGNALS))[SIGNALS.index("speed")]


def strength_of_sine(*, room, noise):
    """How strong a sine of the amplitude 1 may be below a bound."""
    bounds = (Bound(name="limit", weights=SPEED, room=room, noise=noise),)
    responses = np.zeros((1, len(SIGNALS), 1), dtype=complex)
    responses[0, SIGNALS.index("speed")] = 1.0
    uses = Uses.of(responses, bounds, (1,), fold=64)
    (strength,) = uses.strengths(np.array([1.0 + 0.0j]), bounds, SHARE)
    return strength


def test_without_noise_the_crest_may_reach_the_limit():
    assert strength_of_sine(room=0.4, noise=0.0) == pytest.approx(0.4)


@pytest.mark.parametrize("noise", [0.01, 0.05, 0.1])
def test_noise_takes_a_sine_beyond_the_limit_for_the_stated_share_of_the_time(noise):
    """The share is the mean over a turn of the probability that normal noise passes what is left."""
    strength = strength_of_sine(room=0.4, noise=noise)
    turn = np.linspace(0.0, 2.0 * np.pi, 10_000, endpoint=False)
    share = scipy.stats.norm.sf((0.4 - strength * np.cos(turn)) / noise).mean()
    assert share == pytest.approx(SHARE, rel=0.02)
    # a crest lasts a small part of a turn, so that less than four deviations have to stay free
    assert 0.4 - 4.0 * noise < strength < 0.4


# ---- the staircase ----


@pytest.fixture(scope="module")
def with_stairs(tug, limits, quick):
    return design_campaign(
        tug,
        Wish(relative={"K_p": 0.05}),
        limits,
        STAN_TUG_NOISE,
        speeds=(1.15, 0.70),
        within_s=360.0,
        rng=np.random.default_rng(1),
        effort=quick,
        timetable=Timetable(stairs=STAIRS),
    )


@pytest.mark.slow
def test_a_test_is_at_most_as_long_as_asked_for_with_all_that_belongs_to_it(with_stairs):
    campaign = campaign_of(with_stairs, name="with steps", offset_v=-5.0, slope_rpm_per_v=-251.0)
    assert campaign.duration_s == with_stairs.duration_s <= 360.0
    # what settles too early is not made up for
    assert campaign.duration_s > 340.0
    assert setpoint(campaign, [campaign.duration_s]) == pytest.approx(campaign.offset_v)


@pytest.mark.slow
def test_steps_keep_the_limits_in_time(with_stairs, limits, truth):
    """Simulated with the square of the propeller torque, which the plan of the staircase does not have."""
    vessel = load_vessel("stan-tug-1205")
    campaign = campaign_of(with_stairs, name="with steps", offset_v=-5.0, slope_rpm_per_v=-251.0)
    (stairs,) = campaign.staircases
    assert len(stairs.levels_v) == 6
    assert stairs.stop_s == pytest.approx(campaign.duration_s)
    operation = expected_operation(campaign, vessel, truth, slope_rpm_per_v=campaign.slope_rpm_per_v)
    there = operation.time_s >= stairs.start_s
    speed, torque = operation.speed_rpm[there], operation.brake_torque_nm[there]
    full = np.interp(speed, *np.array(limits.full_load).T)
    assert 0.5 < (torque / full).max() < 1.02
    assert torque.min() > -450.0
    assert limits.lowest_speed_rpm < speed.min() < speed.max() < limits.highest_speed_rpm


# ---- how far a promise reaches ----


def test_noise_that_is_known_to_a_factor_makes_deviations_known_to_that_factor(plan):
    """Deviations go with the amplitude of the noise: a tenth of log-normal noises lies above exp(1.28 s)."""
    reached = with_band(plan, noise_spread=0.2, rng=np.random.default_rng(1))
    for name in ("K_p", "tau_dn", "k_q"):
        low, high = reached.band.deviations[name]
        assert low == pytest.approx(np.exp(-0.2 * 1.2816), rel=0.03)
        assert high == pytest.approx(np.exp(0.2 * 1.2816), rel=0.03)
    assert reached.band.seconds is None


def test_a_known_ship_in_known_noise_has_no_band(plan):
    assert with_band(plan, noise_spread=0.0, rng=np.random.default_rng(1)).band is None


@pytest.mark.slow
def test_wishes_need_a_span_of_time(with_stairs):
    """Twice the variance of the noise needs twice the time in the windows."""
    reached = with_band(with_stairs, noise_spread=0.2, rng=np.random.default_rng(1))
    low, high = reached.band.seconds
    window_s = sum(leg.window_s for leg in reached.legs)
    rest_s = reached.duration_s - window_s
    assert (high - rest_s) / (low - rest_s) == pytest.approx(np.exp(4.0 * 0.2 * 1.2816), rel=0.1)
    said = " ".join(plan_sentences(reached))
    assert f"to {length_words(high)}." in said


def test_one_length_in_every_place(plan):
    assert length_words(719.0) == "12 min"
    assert plan_sentences(plan)[0].startswith(f"{length_words(plan.duration_s)} at ")
    assert replace(plan, stairs_rpm=()).duration_s == plan.duration_s
