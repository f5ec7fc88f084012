"""What is asked of a whole log, on levers and loads that were made up."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.errors import ServiceError
from shaftprint.service._gather import StillMeans, lever_line
from shaftprint.service._segment import LeverLine, Segment
from shaftprint.service._vetting import (
    beside_full_load,
    is_other,
    lever_follows_load,
    off_the_line,
    play_of_lever,
    speed_is_off,
    torque_is_held,
    usual_load,
    way_on,
)
from shaftprint.vessel import load_vessel


@pytest.fixture(scope="module")
def vessel():
    return load_vessel("stan-tug-1205-service")


def still(gain, *, count=600, seed=3):
    """Return a lever that is trimmed by a gain against the load of five seconds before, ten stretches."""
    rng = np.random.default_rng(seed)
    load = 1.0 + 0.014 * np.cumsum(rng.standard_normal(count)) / 5.0
    lever = -5.0 + 1e-3 * rng.standard_normal(count)
    lever[1:] += gain * 4.7 * 0.5 * (load[:-1] - 1.0)
    stretch = np.repeat(np.arange(10.0), count // 10)
    return StillMeans(lever_v=lever, speed_rev_s=-4.0 * lever, load=load, stretch=stretch)


@pytest.mark.parametrize("gain", [1.0, 0.3])
def test_somebody_who_trims_against_the_load_is_seen(gain):
    found = lever_follows_load(still(gain))
    assert found.value > 8.0
    assert "trims it against the load" in found.refused


@pytest.mark.parametrize("seed", range(8))
def test_a_lever_that_is_left_alone_does_not_follow(seed):
    assert not lever_follows_load(still(0.0, seed=seed)).refused


def test_a_lever_without_any_noise_tells_nothing():
    alone = still(0.0)
    quiet = StillMeans(
        lever_v=np.full(alone.load.size, -5.0), speed_rev_s=alone.speed_rev_s, load=alone.load, stretch=alone.stretch
    )
    found = lever_follows_load(quiet)
    assert np.isnan(found.value)
    assert not found.refused


def segment(before, after, exponent, rng):
    """Return a move between two speeds [rev/s] of a propeller whose torque goes with a power of the speed."""
    time = np.arange(540) / 20.0
    speed = np.where(time < 2.0, before, after) * (1.0 + 0.005 * rng.standard_normal(time.size))
    return Segment(
        log="made up",
        start_s=0.0,
        move_s=2.0,
        move_end_s=2.3,
        rate_hz=100.0,
        every=5,
        lever_v=np.zeros(1),
        speed_rev_s=speed,
        torque_nm=1725.0 * (speed / 20.0) ** exponent * (1.0 + 0.03 * rng.standard_normal(time.size)),
        state="ahead",
    )


@pytest.mark.parametrize(("exponent", "is_refused"), [(2.0, False), (2.42, True)])
def test_way_on_shows_in_the_torque_across_moves(exponent, is_refused):
    rng = np.random.default_rng(5)
    found = way_on([segment(*rng.uniform(12.0, 26.0, 2), exponent, rng) for _ in range(40)])
    assert found.value == pytest.approx(exponent - 2.0, abs=0.05)
    assert bool(found.refused) == is_refused


@pytest.mark.parametrize("share", [0.2, 0.5, 0.8])
def test_loads_of_two_waters_are_told_apart_and_one_water_that_wanders_stays_whole(share):
    rng = np.random.default_rng(4)
    under = rng.random(200) < share
    loads = np.where(under, 0.78, 1.0) * (1.0 + 0.025 * rng.standard_normal(200))
    usual = usual_load(loads)
    assert usual == pytest.approx(0.78 if share > 0.5 else 1.0, rel=0.01) or share == 0.5
    other = is_other(loads, usual)
    assert np.array_equal(other, under != (usual < 0.9))
    wandering = 1.0 + 0.06 * np.sin(np.linspace(0.0, 9.0, 200))
    assert not is_other(wandering, usual_load(wandering)).any()


@pytest.mark.parametrize(("exponent", "is_refused"), [(2.0, True), (2.42, False)])
def test_a_file_of_a_ship_underway_asks_for_way_on(exponent, is_refused):
    rng = np.random.default_rng(5)
    found = way_on([segment(*rng.uniform(12.0, 26.0, 2), exponent, rng) for _ in range(40)], sails=True)
    assert ("makes no way" in found.refused) == is_refused


def test_bend_of_the_lever_is_measured_as_far_as_its_scatter_tells_it():
    rng = np.random.default_rng(3)
    stretch = np.repeat(np.arange(40.0), 6)
    lever = np.repeat(rng.uniform(-7.0, -3.0, 40), 6)
    moved = lever + 5.0
    speed = 20.0 - 4.183 * moved * (1.0 + 0.5 * 0.004 * moved) + 0.005 * rng.standard_normal(lever.size)
    still = StillMeans(lever_v=lever, speed_rev_s=speed, load=np.ones(lever.size), stretch=stretch)
    line = lever_line(still)
    assert line.bend_per_v == pytest.approx(0.004, rel=0.15)
    assert line.speed_rev_s(lever) == pytest.approx(speed, abs=0.02)
    # a line that scatters by a tenth of its speed tells no bend
    loose = lever_line(replace(still, speed_rev_s=speed + np.repeat(0.15 * rng.standard_normal(40), 6)))
    assert abs(loose.bend_per_v) < 0.01


def test_line_of_the_lever_is_found_beside_a_stretch_that_is_off():
    rng = np.random.default_rng(2)
    stretch = np.repeat(np.arange(20.0), 6)
    lever = np.repeat(rng.uniform(-7.0, -3.0, 20), 6)
    speed = -1.39 - 4.183 * lever + 0.01 * rng.standard_normal(lever.size)
    speed[stretch == 4.0] += 3.0
    line = lever_line(StillMeans(lever_v=lever, speed_rev_s=speed, load=np.ones(lever.size), stretch=stretch))
    assert line.slope_rev_s_per_v == pytest.approx(-4.183, abs=0.01)
    assert line.stretches == 19


LINE = LeverLine(slope_rev_s_per_v=-4.0, middle_v=-5.0, middle_rev_s=20.0, spread_rpm=2.0, stretches=20)


@pytest.mark.parametrize(("held_share", "is_refused"), [(0.05, False), (0.3, True)])
def test_a_load_controller_behind_the_lever_shows_where_it_stands_still(held_share, is_refused):
    rng = np.random.default_rng(6)
    lever = rng.uniform(-7.0, -4.0, 200)
    speed = LINE.speed_rev_s(lever) + 0.03 * rng.standard_normal(200)
    fastest = np.argsort(speed)[200 - round(200 * held_share) :]
    speed[fastest] -= 1.0
    found = off_the_line(StillMeans(lever_v=lever, speed_rev_s=speed, load=speed, stretch=np.zeros(200)), LINE)
    assert found.value == pytest.approx(100.0 * held_share, abs=1.0)
    assert bool(found.refused) == is_refused


def held_above(most, *, hunts=0.0, calm=1.0, seed=8, logged=False):
    """Return forty stretches of a line whose torque goes up to a limit, and whose governor hunts at high torques."""
    rng = np.random.default_rng(seed)
    stretch = np.repeat(np.arange(40.0), 12)
    asked = np.repeat(rng.uniform(650.0, 1500.0, 40), 12)
    load = 1.0 + calm * (0.05 * np.repeat(rng.standard_normal(40), 12) + 0.01 * rng.standard_normal(480))
    swing = np.where(asked > 1300.0, hunts, 1.0) * rng.standard_normal(480)
    speed = np.minimum(asked + swing, 1183.8 * np.sqrt(most / load))
    # a lever that bends by 40 rpm, a pick-up that jitters, and a load that is reckoned with what it shows
    if logged:
        asked = speed
    lever = -(asked + 40.0 * (asked / 1000.0) ** 2) / 240.0
    shown = speed + 0.2 * rng.standard_normal(480)
    return StillMeans(lever_v=lever, speed_rev_s=shown / 60.0, load=load * (speed / shown) ** 2, stretch=stretch)


@pytest.mark.parametrize(("most", "held"), [(1.2, "117%|118%|119%|120%"), (1.5, "147%|148%|149%|150%")])
def test_a_torque_that_is_held_gives_way_to_the_load_with_its_root(most, held):
    found = torque_is_held(held_above(most), LINE, speed_rev_s=1183.8 / 60.0)
    assert found.value == pytest.approx(-0.5, abs=0.1)
    assert "a load controller or a limit behind the lever" in found.refused
    assert any(f"from about {one} of" in found.refused for one in held.split("|"))


def test_a_held_torque_is_told_beside_a_stretch_in_which_another_lever_was_in_command():
    """At 0 V the line asks for no speed, which a logarithm of it would not survive."""
    means = held_above(1.2)
    elsewhere = replace(means, lever_v=np.where(means.stretch == 3.0, 0.0, means.lever_v))
    found = torque_is_held(elsewhere, LINE, speed_rev_s=1183.8 / 60.0)
    assert "a load controller or a limit behind the lever" in found.refused


def test_a_demand_that_is_logged_behind_the_load_controller_is_followed():
    assert torque_is_held(held_above(1.2, logged=True), LINE, speed_rev_s=19.73).value == pytest.approx(0.0, abs=0.1)


@pytest.mark.parametrize(("hunts", "calm"), [(1.0, 1.0), (12.0, 1.0), (1.0, 0.0)])
def test_a_governor_that_hunts_where_the_torque_is_high_and_calm_water_are_no_load_controller(hunts, calm):
    found = [
        torque_is_held(held_above(9.0, hunts=hunts, calm=calm, seed=k), LINE, speed_rev_s=19.73) for k in range(20)
    ]
    assert not any(one.refused for one in found)


@pytest.mark.parametrize(("rpm", "is_off"), [(5.0, False), (40.0, True)])
def test_a_move_to_a_speed_that_is_not_reached_is_not_used(rpm, is_off):
    one = segment(18.0, 24.0, 2.0, np.random.default_rng(7))
    time = np.arange(2900) / 100.0
    lever = np.where(time < 3.0, -4.5, -6.0 - rpm / 60.0 / 4.0)
    one = replace(one, lever_v=lever)
    assert bool(speed_is_off(one, LINE)) == is_off


def moved(rng, *, play_rpm, count=40):
    """Return segments of a lever with play, that moves up and down and is mended by a fifth now and then."""
    made, volts, followed = [], -4.7, -4.7
    half_v = 0.5 * play_rpm / 240.0
    for _ in range(count):
        lever = np.full(1400, volts)
        ways = [rng.choice([-1.0, 1.0]) * rng.uniform(0.1, 0.6)]
        ways += [-0.2 * ways[0]] * int(rng.uniform() < 0.3)
        for place, way in zip((100, 160), ways, strict=False):
            lever[place:] = lever[place - 1] + way
        for level in (lever[110], lever[-1]):
            followed = float(np.clip(followed, level - half_v, level + half_v))
        volts = lever[-1] if abs(lever[-1] + 4.7) < 0.8 else -4.7
        made.append(
            Segment(
                log="log", start_s=0.0, move_s=1.0, move_end_s=2.0, rate_hz=50.0, every=1, lever_v=lever,
                speed_rev_s=np.full(1000, -4.0 * followed + 5e-3 * rng.standard_normal()),
                torque_nm=np.ones(1000), state="ahead",
            )
        )  # fmt: skip
    return made


def test_play_of_the_lever_is_measured_and_refused():
    rng = np.random.default_rng(4)
    found = play_of_lever(moved(rng, play_rpm=4.0), LINE)
    assert 2.0 * abs(found.value) == pytest.approx(4.0, rel=0.1)
    assert "the lever has play" in found.refused
    assert not play_of_lever(moved(rng, play_rpm=0.0), LINE).refused


def test_a_few_moves_tell_no_play():
    assert np.isnan(play_of_lever(moved(np.random.default_rng(4), play_rpm=4.0, count=8), LINE).value)


def test_full_pull_is_no_load_controller(vessel):
    """Where the engine gives all it has it holds the torque and no speed; below it holds the speed."""
    rng = np.random.default_rng(7)
    point = vessel.working_point
    at_point_nm = point.driving_torque_nm / vessel.gearbox.shaft_over_brake
    asked = np.repeat(rng.uniform(900.0, 1780.0, 40), 5)
    load = 1.6 + 0.05 * rng.standard_normal(asked.size)
    full = np.sqrt(vessel.machine.full_load_nm(1600.0) / (load * at_point_nm)) * point.engine_speed_rpm
    shown = np.minimum(asked, full)
    still = StillMeans(
        lever_v=-asked / 240.0, speed_rev_s=shown / 60.0, load=load, stretch=np.repeat(np.arange(40.0), 5)
    )
    kept, found = beside_full_load(still, vessel)
    torque_nm = load * (shown / point.engine_speed_rpm) ** 2 * at_point_nm
    full_nm = np.array([vessel.machine.full_load_nm(one) for one in shown])
    assert found.value == pytest.approx(100.0 * np.mean(torque_nm > 0.95 * full_nm))
    assert 5.0 < found.value < 60.0
    assert lever_line(kept).spread_rpm < 1.0
    with pytest.raises(ServiceError, match="expected a speed that follows the lever"):
        lever_line(still)
