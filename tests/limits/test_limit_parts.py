"""Parts of the search for limits, each against what follows without them."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals

from shaftprint.campaign import Campaign
from shaftprint.catalogue import limited_governor
from shaftprint.identify import Estimate
from shaftprint.limits import Kind, LimitFit, limit_hints
from shaftprint.limits._identify_limits import LEAST_OFFSET_STD, _offset_std
from shaftprint.limits._numbers import _doubt, doubt_of_governor, hardly_seen
from shaftprint.limits.prediction._noise_colour import ORDER, innovations
from shaftprint.spectra import Harmonics
from shaftprint.time_domain.nonlinear._drive import jumps_in, with_jumps
from shaftprint.tug import Tug


def test_a_jump_lies_where_it_is_between_two_samples():
    campaign = Campaign.model_validate(
        {"name": "step", "duration_s": 20.0, "offset_v": -5.0, "sample_rate_hz": 2000.0}
        | {"staircases": [{"name": "St1", "levels_v": (-4.0, -5.0), "dwell_s": 5.0, "start_s": 5.0}]}
    )
    time = np.arange(4000) / 200.0
    # a filter that rings for 40 ms keeps the area of a jump at 10.0013 s
    fine = np.arange(0.0, 20.0, 1e-4)
    exact = np.where(fine < 10.0013, 0.2, 0.0)
    kernel = np.hanning(401)
    smooth = np.convolve(exact, kernel / kernel.sum(), "same")
    drive = np.interp(time, fine, smooth)
    jumps = jumps_in(time, drive, campaign)
    found = with_jumps(time, drive, jumps)
    near = (time > 9.5) & (time < 10.5)
    # what the jump takes away from 9.5 s on: 0.2 for 0.5013 s
    assert np.sum(found[near]) / 200.0 == pytest.approx(0.2 * 0.5013, abs=0.2 * 0.0025 + 2e-4)
    moving = np.flatnonzero(np.abs(np.diff(found[near])) > 1e-3)
    assert moving.size <= 2


def test_innovations_of_known_noise_are_its_source():
    rng = np.random.default_rng(3)
    source = rng.standard_normal(40000)
    noise = np.empty(source.size)
    noise[:2] = source[:2]
    for place in range(2, source.size):
        noise[place] = 1.2 * noise[place - 1] - 0.5 * noise[place - 2] + source[place]
    used = np.ones(noise.size, dtype=bool)
    used[20000:20010] = False
    broken = np.where(used, noise, 1e3)
    found = innovations(broken, used)
    assert found.count == noise.size - ORDER - 10 - ORDER
    np.testing.assert_allclose(found.taps[:3], [1.0, -1.2, 0.5], atol=0.03)
    assert found.squares / found.count == pytest.approx(1.0, abs=0.03)
    left = found.values[found.kept] - source[ORDER:][found.kept]
    assert np.std(left) < 0.05


@pytest.mark.parametrize(
    ("interval", "at_bound", "doubt"),
    [
        ((0.9, 1.1, False, False), False, ""),
        ((0.9, 1.1, False, False), True, "bound"),
        ((0.9, 5.0, False, True), False, "no upper end"),
        ((0.6, 1.5, False, False), False, "hardly known"),
    ],
)
def test_numbers_that_are_not_known_are_not_trusted(interval, at_bound, doubt):
    said = _doubt(1.0, _interval(*interval), at_bound=at_bound)
    assert (said == "") if doubt == "" else (doubt in said)


def _interval(lower, upper, lower_open, upper_open):
    return SimpleNamespace(lower=lower, upper=upper, lower_open=lower_open, upper_open=upper_open)


def harmonics(third):
    return Harmonics(
        lines=("S1", "S2"),
        outputs=("n", "M_s"),
        orders=(2, 3),
        fundamental=np.full((2, 2), 0.1),
        amplitude=np.array([[[0.004, 0.0], [0.005, 0.0]], [[0.004, 0.0], [0.005, third]]]),
        standard_deviation=np.full((2, 2, 2), 5e-4),
        expected_second_torque=np.full(2, 0.005),
    )


def test_a_third_harmonic_points_to_limits_and_a_second_does_not():
    (quiet,) = limit_hints(harmonics(5e-4))
    assert "shaftprint limits" not in quiet
    hint, where = limit_hints(harmonics(8e-3))
    assert "S2, M_s 8.0 %" in hint
    assert "S1" not in hint
    assert "shaftprint limits" in where


def test_steps_that_a_model_of_sines_fails_point_to_limits():
    hint, where = limit_hints(harmonics(5e-4), ["St1 step 1", "St1 step 7"])
    assert "St1 step 1, St1 step 7" in hint
    assert "shaftprint limits" in where
    (quiet,) = limit_hints(harmonics(5e-4), [])
    assert "shaftprint limits" not in quiet


def test_a_limit_that_a_search_has_named_is_not_passed_over():
    (only,) = limit_hints(harmonics(5e-4), [], named=["rate limit of the set point, not trusted"])
    assert "Nothing hints" not in only
    assert "rate limit of the set point, not trusted" in only
    _, last = limit_hints(harmonics(8e-3), [], named=["smoke limit"])
    assert last == "The search for limits has found: smoke limit."


@pytest.mark.parametrize(
    ("moved", "said"),
    [
        ({}, ""),
        ({"omega_n": 40.0}, "omega_n"),
        ({"c_set": 0.95002, "e_set": -0.05}, "c_set, e_set"),
        ({"t_sp": 0.0}, "t_sp"),
    ],
)
def test_nothing_is_trusted_beside_a_governor_at_the_ends_of_its_range(moved, said):
    structure = limited_governor("torque").free_between(omega_n=(3.0, 40.0), t_sp=(0.0, 0.3))
    values = {
        "K_p": 5.4,
        "K_i": 4.3,
        "t_d": 0.07,
        "omega_n": 10.3,
        "zeta": 0.47,
        "t_sp": 0.05,
        "c_set": 1.0,
        "e_set": 0.0,
    }
    # a level at the end of its range says nothing of the governor
    fit = SimpleNamespace(term=SimpleNamespace(structure=structure), values=values | {"m_max": 6.0} | moved)
    fit.values |= {p.name: p.value for p in structure.free if p.name not in fit.values}
    doubt = doubt_of_governor(fit)
    assert (doubt == "") if not said else (f"({said})" in doubt)


def limit_fit(*numbers):
    """What is found, of numbers given as kind, symbol and doubt."""
    estimates = tuple(
        Estimate(limit=kind.value, name=name, unit="-", value=1.0, std=0.1, interval_95=(0.8, 1.2), doubt=doubt)
        for kind, name, doubt in numbers
    )
    gains = dict.fromkeys([kind for kind, _, _ in numbers], 100.0)
    return LimitFit(
        numbers=estimates, gains=gains, governor=(), not_seen={}, identification=None, reached="It went far."
    )


def test_a_limit_counts_by_its_level_and_a_smoke_limit_by_the_torque_limit_too():
    found = limit_fit(
        (Kind.TORQUE, "share", "at its bound"), (Kind.TORQUE, "T_aw", ""), (Kind.SMOKE, "a_0", ""),
        (Kind.MOTORING, "m_min", ""), (Kind.MOTORING, "M_min", "hardly known"),
    )  # fmt: skip
    assert found.trusted_kinds == (Kind.MOTORING,)
    assert found.doubts[Kind.TORQUE] == "at its bound"
    assert "torque limit" in found.doubts[Kind.SMOKE]
    assert limit_fit((Kind.SMOKE, "a_0", ""), (Kind.SMOKE, "tau_tc", "hardly known")).trusted_kinds == (Kind.SMOKE,)


@pytest.mark.parametrize(
    ("gain", "interval", "named"),
    [
        (36.0, (-0.87, -0.38), False),
        (61.0, (-math.inf, -0.5), False),
        (61.0, (-0.7, -0.5), True),
        (450.0, (-0.87, -0.38), True),
    ],
)
def test_a_limit_that_gains_little_at_a_level_that_is_hardly_known_is_not_named(gain, interval, named):
    level, lag = (
        Estimate(limit=Kind.MOTORING.value, name=name, unit="-", value=value, std=0.1, interval_95=ends, doubt="")
        for name, value, ends in (("m_min", -0.6, interval), ("T_aw", 0.02, (-math.inf, 0.2)))
    )
    sure = Estimate(
        limit=Kind.TORQUE.value, name="share", unit="-", value=1.0, std=0.3, interval_95=(0.1, 2.0), doubt=""
    )
    # a few jumps tell a cycle of messages to a factor of two, and are sure of it
    held = replace(level, limit=Kind.HELD.value, name="T_set", value=0.06, interval_95=(0.04, 0.12))
    weak = hardly_seen((sure, level, lag, held), {Kind.TORQUE: 2000.0, Kind.MOTORING: gain, Kind.HELD: 60.0})
    assert list(weak) == ([] if named else [Kind.MOTORING])
    assert named or "m_min = -0.6" in weak[Kind.MOTORING]


def test_none_found_says_how_far_the_test_went():
    sentence = limit_fit().sentence
    assert "It went far." in sentence
    assert "No limit acts" not in sentence


def test_a_held_demand_comes_late_by_half_a_message(vessel):
    """A ramp of the set point in messages of 80 ms: the speed follows as if 40 ms later."""
    campaign = Campaign.model_validate(
        {"name": "slow", "duration_s": 60.0, "offset_v": -5.0, "sample_rate_hz": 2000.0}
        | {"sines": [{"name": "S1", "frequency_hz": 0.1, "amplitude_v": 0.4, "start_s": 5.0, "settled_s": 20.0,
                      "stop_s": 50.1}]}
    )  # fmt: skip
    tug = Tug()
    phases = []
    for one in (tug, replace(tug, demand_cycle_s=0.08)):
        ideal = simulate_signals(vessel, campaign, tug=one, rate_hz=100.0)
        inside = (ideal.time_s >= 20.0) & (ideal.time_s < 50.0)
        turn = np.exp(-2j * np.pi * 0.1 * ideal.time_s[inside])
        phases.append(np.angle(np.sum(turn * ideal.engine_speed_rev_s[inside])))
    late_s = (phases[0] - phases[1]) / (2.0 * np.pi * 0.1)
    assert late_s == pytest.approx(0.04, abs=0.002)


def test_the_offset_of_the_set_point_is_as_unknown_as_its_line():
    """A line that is known to 0.02 rev/s at the working point, of 20 rev/s: 0.1 %."""
    signals = SimpleNamespace(working_point=SimpleNamespace(engine_speed_rev_s=20.0, engine_speed_std_rev_s=0.02))
    assert _offset_std(signals) == pytest.approx(np.hypot(0.001, LEAST_OFFSET_STD), rel=1e-9)
