from dataclasses import replace

import numpy as np
import pytest

from shaftprint.errors import SignalError
from shaftprint.signals import StripAngles, find_strips
from shaftprint.signals.pulses._pulses import number_pulses
from shaftprint.signals.pulses._strips import renumbered, revolutions

# table 3.4 of the thesis, scaled to a whole turn
TABLE_3_4 = np.array([90.40, 87.24, 90.74, 91.64]) / 360.02


def pulses_of(
    angles: np.ndarray, *, turns: int = 1500, wave: float = 0.0, jitter: float = 0.0, seed: int = 0
) -> np.ndarray:
    """Places of the pulses [samples] of a shaft at 5.16 rev/s, its speed waving at 0.3 Hz."""
    places = np.concatenate([[0.0], np.cumsum(angles[:-1])])
    angle = (np.arange(turns)[:, np.newaxis] + places).ravel()
    # t + wave sin(2 pi 0.3 t) / (2 pi 0.3) = angle / 5.16, by fixed-point iteration
    time = angle / 5.16
    for _ in range(60):
        time = angle / 5.16 - wave * np.sin(2 * np.pi * 0.3 * time) / (2 * np.pi * 0.3)
    rng = np.random.default_rng(seed)
    return 2000.0 * time + jitter * rng.standard_normal(time.size)


@pytest.mark.parametrize(
    "angles", [TABLE_3_4, np.array([0.3, 0.33, 0.37]), np.array([0.47, 0.53]), np.full(6, 1.0 / 6.0)]
)
def test_angles_of_a_steady_shaft_are_exact(angles):
    train = number_pulses(pulses_of(angles), channel="P")
    found = find_strips(train, angles.size, channel="P")
    assert found.angle_rev == pytest.approx(angles, abs=1e-9)
    assert found.angle_rev.sum() == pytest.approx(1.0)


def test_angles_under_acceleration_and_jitter_are_within_their_deviation():
    # 30 us of jitter at 2000 Hz, speed waving by 0.3 %
    errors = []
    for seed in range(30):
        train = number_pulses(pulses_of(TABLE_3_4, turns=400, wave=0.003, jitter=0.06, seed=seed), channel="P")
        found = find_strips(train, 4, channel="P")
        errors.append((found.angle_rev - TABLE_3_4) / found.std_rev)
        assert np.abs(found.angle_rev - TABLE_3_4).max() * 360.0 < 0.02
    # the stated deviation is the scatter: chi-square of 120 values
    assert 0.6 < float(np.mean(np.square(errors))) < 1.6


def test_unsteady_revolutions_do_not_count():
    train = number_pulses(pulses_of(TABLE_3_4, turns=800, wave=0.25), channel="P")
    found = find_strips(train, 4, channel="P")
    assert found.angle_rev == pytest.approx(TABLE_3_4, abs=1e-4)


def test_missing_pulse_does_not_turn_the_strips():
    places = pulses_of(TABLE_3_4, turns=300)
    train = number_pulses(np.delete(places, [101, 403, 404]), channel="P")
    found = find_strips(train, 4, channel="P")
    assert found.angle_rev == pytest.approx(TABLE_3_4, abs=1e-9)
    # the angle of the shaft at every pulse that is left
    assert revolutions(train, found.angle_rev) == pytest.approx(
        np.delete(places, [101, 403, 404]) * 5.16 / 2000.0, abs=1e-6
    )


@pytest.mark.parametrize("miscount", [1, -1, 2])
@pytest.mark.parametrize("gap", [400, 1600])
def test_miscounted_gap_is_mended_by_the_pattern(miscount, gap):
    places = pulses_of(TABLE_3_4, turns=500, jitter=0.02)
    true = np.delete(np.arange(2000), np.arange(gap, gap + 6))
    train = number_pulses(np.delete(places, np.arange(gap, gap + 6)), channel="P")
    assert np.array_equal(train.number, true)
    number = train.number.copy()
    number[gap:] += miscount
    mended, positions = renumbered(replace(train, number=number), 4)
    # up to whole revolutions
    assert np.array_equal((mended - true) % 4, np.zeros(true.size))
    assert len(positions) == 1
    assert positions[0] == pytest.approx(places[gap - 1])


def test_right_count_is_left_alone():
    train = number_pulses(np.delete(pulses_of(TABLE_3_4, turns=500, jitter=0.02), [700, 701]), channel="P")
    number, positions = renumbered(train, 4)
    assert np.array_equal(number, train.number)
    assert positions == ()


def test_even_strips_and_short_stretches_give_no_reason_to_recount():
    even = number_pulses(np.delete(pulses_of(np.full(4, 0.25), turns=200), [300]), channel="P")
    assert renumbered(even, 4)[1] == ()
    close = number_pulses(np.delete(pulses_of(TABLE_3_4, turns=200), [300, 303]), channel="P")
    assert renumbered(close, 4)[1] == ()


def test_even_strips_are_not_recounted_by_their_noise():
    """Two hundred trains of even strips with the jitter of a pick-up; stretches between faults hold a few turns."""
    for seed in range(200):
        places = pulses_of(np.full(8, 0.125), turns=250, wave=0.02, jitter=0.1, seed=seed)
        gone = 700 + np.array([0, 40 + seed, 80 + 2 * seed])
        number = np.delete(np.arange(2000), gone)
        train = number_pulses(np.delete(places, gone), channel="P")
        mended, positions = renumbered(train, 8)
        assert positions == (), seed
        assert np.array_equal(mended, number), seed


def test_too_few_revolutions():
    train = number_pulses(pulses_of(TABLE_3_4, turns=15), channel="PTM_4")
    with pytest.raises(
        SignalError, match="channel PTM_4: expected at least 20 steady revolutions to find the angles of its 4"
    ):
        find_strips(train, 4, channel="PTM_4")


def test_fewer_pulses_than_a_few_turns():
    train = number_pulses(np.arange(24.0) * 100.0, channel="P")
    with pytest.raises(SignalError, match="steady revolutions"):
        find_strips(train, 8, channel="P")


def test_angles_that_differ_by_chance_alone_are_even():
    """Eight strips: what a shaft with even ones showed, and the same with one that is clearly off."""
    found_deg = np.array([45.0167, 44.9994, 44.9871, 44.9916, 44.9954, 44.9969, 45.0052, 45.0077])
    std_rev = np.full(8, 0.0085) / 360.0
    even = StripAngles(channel="n", angle_rev=found_deg / found_deg.sum(), std_rev=std_rev)
    assert even.are_even
    off_deg = found_deg + 0.05 * np.eye(8)[0] - 0.05 * np.eye(8)[1]
    assert not StripAngles(channel="n", angle_rev=off_deg / off_deg.sum(), std_rev=std_rev).are_even
