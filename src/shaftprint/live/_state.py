"""The states of a live test, and which may follow which."""

from enum import StrEnum

from shaftprint.errors import LiveError


class State(StrEnum):
    """What a live test does now; the value is the word on the pages."""

    IDLE = "idle"
    ARMED = "armed"
    RAMP_IN = "ramp in"
    SETTLE = "settle"
    LEG = "leg"
    RAMP_OUT = "ramp out"
    HOLD = "hold"
    ABORT = "abort"


_PLAYED = frozenset({State.RAMP_IN, State.SETTLE, State.LEG, State.RAMP_OUT, State.HOLD})
_MAY_FOLLOW = {
    State.IDLE: {State.ARMED},
    # a campaign may begin with a test that needs no ramp
    State.ARMED: _PLAYED | {State.IDLE},
    **dict.fromkeys(_PLAYED, _PLAYED),
    State.RAMP_OUT: _PLAYED | {State.IDLE},
    State.ABORT: {State.IDLE},
}
"""Besides, an abort may follow everything."""


def following(state: State, wanted: State) -> State:
    """Return the state that is wanted, if it may follow; an abort may follow every state.

    Raises LiveError if it may not.
    """
    if wanted is state:
        return state
    if wanted is State.ABORT or wanted in _MAY_FOLLOW[state]:
        return wanted
    may = ", ".join(sorted(_MAY_FOLLOW[state]))
    raise LiveError(f'live test: expected one of {may} or abort after "{state}", found "{wanted}".')
