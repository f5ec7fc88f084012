"""Moves of a lever that was made up: where they begin and end, and which are one."""

import numpy as np
import pytest

from shaftprint.service._log import Block
from shaftprint.service._moves import moves_of

RATE_HZ = 100.0


def block(corners, *, seconds=200.0, noise_v=0.0, goes_on=False):
    time = np.arange(round(seconds * RATE_HZ)) / RATE_HZ
    lever = np.interp(time, *zip(*corners, strict=True))
    lever = lever + noise_v * np.random.default_rng(1).standard_normal(time.size)
    ones = np.ones(time.size)
    return Block(
        log="made up",
        began=None,
        start_s=0.0,
        rate_hz=RATE_HZ,
        lever_v=lever,
        speed_rev_s=20.0 * ones,
        torque_nm=1700.0 * ones,
        whole=ones > 0.0,
        new=time.size,
        goes_on=goes_on,
    )


@pytest.mark.parametrize("noise_v", [0.0, 0.001])
def test_a_move_is_found_with_its_segment(noise_v):
    (move,) = moves_of(block([(50.0, -5.0), (50.4, -5.6)], noise_v=noise_v), range_v=-4.7)
    assert move.first / RATE_HZ == pytest.approx(50.0, abs=0.06)
    assert move.last / RATE_HZ == pytest.approx(50.4, abs=0.06)
    assert (move.first - move.start) / RATE_HZ == 2.0
    assert (move.stop - move.last) / RATE_HZ == 25.0
    assert move.is_complete


def test_moves_within_eight_seconds_are_one_and_the_next_ends_a_segment():
    corners = [(50.0, -5.0), (50.2, -5.6), (55.0, -5.6), (55.1, -5.5), (70.0, -5.5), (70.3, -4.0)]
    first, second = moves_of(block(corners), range_v=-4.7)
    assert first.last / RATE_HZ == pytest.approx(55.1, abs=0.06)
    assert first.stop == second.first
    assert second.first / RATE_HZ == pytest.approx(70.0, abs=0.06)


def test_a_lever_that_creeps_does_not_move():
    assert not list(moves_of(block([(20.0, -5.0), (180.0, -5.2)]), range_v=-4.7))


def test_a_segment_that_the_block_cuts_is_not_complete():
    (move,) = moves_of(block([(190.0, -5.0), (190.2, -5.5)]), range_v=-4.7)
    assert not move.is_complete
