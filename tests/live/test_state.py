"""States of a live test: what may follow what."""

import numpy as np
import pytest

from shaftprint.errors import LiveError
from shaftprint.live._play import Play
from shaftprint.live._state import State, following


@pytest.mark.parametrize("state", State)
def test_an_abort_may_follow_every_state(state):
    assert following(state, State.ABORT) is State.ABORT


@pytest.mark.parametrize("state", [State.IDLE, State.ABORT])
def test_nothing_is_played_that_was_not_armed(state):
    with pytest.raises(LiveError, match='found "ramp in"'):
        following(state, State.RAMP_IN)


@pytest.mark.parametrize("state", [State.SETTLE, State.LEG])
def test_a_campaign_may_begin_with_a_test_at_once(state):
    # a sine at 0 s needs no ramp before it
    assert following(State.ARMED, state) is state
    with pytest.raises(LiveError, match='found "idle"'):
        following(state, State.IDLE)


def test_a_play_holds_its_ends():
    play = Play(name="M1", start_s=10.0, rate_hz=2.0, volts=np.array([1.0, 3.0, 2.0]))
    assert play.stop_s == 11.0
    assert play.value_at(np.array([9.0, 10.25, 11.0, 20.0])).tolist() == [1.0, 2.0, 2.0, 2.0]
