"""The shaft torque at the working point under the mean load of a recording."""

import numpy as np
import pytest

from shaftprint.campaign import load_campaign
from shaftprint.errors import SignalError
from shaftprint.signals import Gap
from shaftprint.signals._gaps import Coverage
from shaftprint.signals.levels._load import torque_of_mean_load

RATE_HZ = 20.0
INERTIA_NM_S2 = 100.0


def speed_of(campaign):
    """Speed that stands at 20 rev/s, swings by a tenth in the sines and goes down and up in the staircase."""
    time_s = np.arange(round(campaign.duration_s * RATE_HZ)) / RATE_HZ
    speed = np.full(time_s.size, 20.0)
    for sine in campaign.sines:
        inside = (time_s >= sine.start_s) & (time_s < sine.stop_s)
        speed[inside] += 2.0 * np.sin(2.0 * np.pi * sine.frequency_hz * (time_s[inside] - sine.start_s))
    for stairs in campaign.staircases:
        for place, level in enumerate(stairs.levels_v):
            begin = stairs.start_s + place * stairs.dwell_s
            speed[(time_s >= begin) & (time_s < begin + stairs.dwell_s)] -= 4.0 * (level + 5.0)
    # half a second of lag: a step in one sample has no derivative
    keep = np.exp(-1.0 / (0.5 * RATE_HZ))
    followed, state = np.empty(speed.size), 20.0
    for place, asked in enumerate(speed.tolist()):
        followed[place] = state = keep * state + (1.0 - keep) * asked
    return followed


@pytest.fixture(scope="module")
def speed():
    return speed_of(load_campaign("short"))


def torque_at_the_gauge(speed, load):
    """``load n^2`` and what accelerates the propeller, N m, with 40 N m of zero."""
    return load * speed**2 + INERTIA_NM_S2 * np.gradient(speed) * RATE_HZ + 40.0


def test_of_a_propeller_with_inertia_and_a_zero_of_the_gauge(speed):
    """At 20 rev/s the propeller takes 4.2 * 400 = 1680 N m, the gauge shows 1720, however the speed swings."""
    torque, std = torque_of_mean_load(speed, torque_at_the_gauge(speed, 4.2), about_rev_s=20.0, rate_hz=RATE_HZ)
    assert torque == pytest.approx(1720.0, abs=0.5)
    assert std < 0.5


def test_is_the_mean_load_of_the_recording_and_not_that_of_a_stretch(speed):
    """The load is 3 % high for the first four minutes, in which all quiet stretches lie, and 1 % low afterwards."""
    early = np.arange(speed.size) < 240.0 * RATE_HZ
    load = np.where(early, 1.03, 0.99) * 4.0
    torque, std = torque_of_mean_load(speed, load * speed**2, about_rev_s=20.0, rate_hz=RATE_HZ)
    # the mean over time is 1.001; what wanders as slowly as this leaves more than a per cent open
    assert abs(torque / 1600.0 - 1.001) < 2.0 * std / 1600.0
    assert 0.003 < std / 1600.0 < 0.03


@pytest.mark.slow
def test_stated_deviation_holds_the_truth_with_sines_and_staircase(speed):
    """Wander of 2 % and 40 s: of 100 tests 95 are expected within 1.96 deviations, 90 in one of forty runs."""
    rng = np.random.default_rng(8)
    keep = np.exp(-1.0 / (40.0 * RATE_HZ))
    hits = 0
    for _ in range(100):
        white = 0.02 * np.sqrt(1.0 - keep**2) * rng.standard_normal(speed.size)
        wander, state = np.empty(speed.size), 0.02 * rng.standard_normal()
        for place, step in enumerate(white.tolist()):
            state = keep * state + step
            wander[place] = state
        shown = torque_at_the_gauge(speed, 4.2 * (1.0 + wander))
        torque, std = torque_of_mean_load(speed, shown, about_rev_s=20.0, rate_hz=RATE_HZ)
        hits += abs(torque - 1720.0) < 1.96 * std
    assert hits > 90


def test_of_one_quiet_stretch_and_of_a_staircase_alone():
    quiet = np.full(round(20.0 * RATE_HZ), 20.0)
    torque, std = torque_of_mean_load(quiet, 4.2 * quiet**2, about_rev_s=20.0, rate_hz=RATE_HZ)
    assert (torque, std) == (pytest.approx(1680.0), pytest.approx(0.0, abs=1e-6))
    levels = np.repeat([18.0, 20.0, 22.0, 20.0], round(30.0 * RATE_HZ))
    torque, _ = torque_of_mean_load(levels, 4.2 * levels**2 + 40.0, about_rev_s=20.0, rate_hz=RATE_HZ)
    assert torque == pytest.approx(1720.0, abs=0.5)


def test_what_lies_in_a_gap_or_far_away_is_left_out(speed):
    """The recording begins at 100 s; what stands in its gap from 350 to 370 s is a straight line somewhere else."""
    torque = torque_at_the_gauge(speed, 4.2)
    torque[round(250.0 * RATE_HZ) : round(270.0 * RATE_HZ)] *= 2.0
    away = speed.copy()
    away[9000:9400] = 5.0
    coverage = Coverage(gaps=(Gap(channel="M_s", start_s=350.0, stop_s=370.0, reason="has no values"),))
    found, _ = torque_of_mean_load(away, torque, about_rev_s=20.0, rate_hz=RATE_HZ, start_s=100.0, coverage=coverage)
    assert found == pytest.approx(1720.0, abs=0.5)


def test_a_speed_that_is_never_near_is_refused(speed):
    with pytest.raises(SignalError, match=r"expected at least \d stretches of time"):
        torque_of_mean_load(speed, 4.2 * speed**2, about_rev_s=60.0, rate_hz=RATE_HZ)
