"""A campaign in time: what is put out, the state at each time, and the campaign as it was played."""

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitation import Excitation
from shaftprint.campaign._excitations import SPEED_SET_POINT, Chirp, Sine, Staircase
from shaftprint.campaign._leg import FEWEST_PERIODS, Leg
from shaftprint.campaign._moves import length_of_move_s
from shaftprint.campaign._setpoint import setpoint
from shaftprint.errors import LiveError
from shaftprint.live._play import Play
from shaftprint.live._state import State

if TYPE_CHECKING:
    from shaftprint.arrays import FloatArray

PLAY_HZ = 200.0
"""Set points a second of a waveform [Hz]."""
# A set point a block, early or late by some ten milliseconds, says nothing of faster lines [Hz].
_WRITTEN_HZ = 5.0
# Nearer than this the set point stands where it is to begin: it was read between two values that are put out [V].
_BEGINS_V = 1e-3
# A window of whole periods may fall short by rounding of its decimal stop time.
_PERIOD_ROUNDING = 1e-6
_TESTS = ("sines", "multisines", "binary_sequences", "chirps", "staircases")


def expect_playable(campaign: Campaign) -> None:
    """Refuse a campaign that moves something else than the set point of the speed.

    Raises LiveError if it does.
    """
    others = [name for name in campaign.inputs if name != SPEED_SET_POINT]
    if others:
        raise LiveError(
            f"campaign {campaign.name}: expected tests of the set point of the speed alone, found some of "
            f"{', '.join(others)}; play those by hand."
        )


def expect_slow(campaign: Campaign) -> None:
    """Refuse lines that are too fast for set points that are written one by one.

    Raises LiveError if there are some.
    """
    hertz = [(one.name, one.frequency_hz) for one in campaign.sines]
    hertz += [(one.name, max(one.lines) / one.length_of_period_s) for one in campaign.legs]
    hertz += [(one.name, max(one.start_frequency_hz, one.stop_frequency_hz)) for one in campaign.chirps]
    for name, fastest_hz in hertz:
        if fastest_hz > _WRITTEN_HZ:
            raise LiveError(
                f"{name}: expected lines up to {_WRITTEN_HZ:g} Hz for a counterpart that plays no waveform, found "
                f"{fastest_hz:g} Hz; set points come too unevenly for faster ones."
            )


def rendered(campaign: Campaign, *, zero_s: float, from_s: float = 0.0, from_v: float | None = None) -> Play:
    """Return what a campaign puts out from a time on.

    ``zero_s``: its second 0 by the counterpart's clock [s]. ``from_s``: time of the campaign at which it begins [s].
    ``from_v``: where the set point stands then [V]: a ramp of the campaign that would be under way, or over, begins
    there and then, as after a hold.
    """
    count = math.ceil((campaign.duration_s - from_s) * PLAY_HZ) + 1
    time_s: FloatArray = from_s + np.arange(count) / PLAY_HZ
    volts = setpoint(campaign, time_s)
    if from_v is not None and abs(from_v - volts[0]) > _BEGINS_V:
        for move in (one for one in campaign.moves if one.free_s[0] <= from_s < one.free_s[1]):
            length_s = length_of_move_s(
                abs(move.to_v - from_v), ramp_s=campaign.ramp_s, ramp_v_per_s=campaign.ramp_v_per_s
            )
            ramp = replace(move, start_s=from_s, stop_s=from_s + length_s, from_v=from_v)
            inside = time_s < move.free_s[1]
            volts[inside] = ramp.value_at(time_s[inside])
    return Play(name=campaign.name, start_s=zero_s + from_s, rate_hz=PLAY_HZ, volts=volts)


def faster_than(volts: "FloatArray", most_v_per_s: float) -> str:
    """Return what is wrong with a waveform that moves faster than it may, in a sentence; nothing where it does not."""
    fastest = float(np.abs(np.diff(volts)).max(initial=0.0)) * PLAY_HZ
    if fastest <= most_v_per_s:
        return ""
    return (
        f"set point: expected at most {most_v_per_s:g} V/s, found {fastest:.4g} V/s; staircases and sines that begin "
        "at once jump, multisines with ramp_s do not."
    )


def test_at(campaign: Campaign, time_s: float) -> Excitation | None:
    """Return the test that is made at a time of the campaign [s]; None between tests."""
    return next((one for one in campaign.excitations if one.start_s <= time_s < one.stop_s), None)


def state_at(campaign: Campaign, time_s: float) -> State:
    """Return what is done at a time of the campaign [s]."""
    test = test_at(campaign, time_s)
    if test is not None:
        settled_s = test.settled_s if isinstance(test, Sine | Leg) else test.start_s
        return State.SETTLE if time_s < settled_s else State.LEG
    if any(one.start_s > time_s for one in campaign.excitations):
        return State.RAMP_IN
    return State.RAMP_OUT


def shifted(campaign: Campaign, by_s: float) -> Campaign:
    """Return a campaign that begins later, as it stands in a recording that began before it."""
    tests = {section: tuple(moved(one, by_s) for one in getattr(campaign, section)) for section in _TESTS}
    return campaign.model_copy(update=tests | {"duration_s": campaign.duration_s + by_s})


def played_until(campaign: Campaign, time_s: float) -> Campaign | None:
    """Return what of a campaign was played until a time [s], whole periods alone; None where that is no test."""
    tests: dict[str, Any] = {
        section: tuple(
            one
            for one in (_until(test, time_s) for test in getattr(campaign, section) if test.start_s < time_s)
            if one is not None
        )
        for section in _TESTS
    }
    if not any(tests.values()):
        return None
    return campaign.model_copy(update=tests | {"duration_s": min(campaign.duration_s, time_s)})


def period_s(test: Excitation | Leg) -> float | None:
    """Return the period of a test [s]; None of one that does not repeat itself."""
    if isinstance(test, Sine):
        return 1.0 / test.frequency_hz
    return test.length_of_period_s if isinstance(test, Leg) else None


def moved(test: Any, by_s: float) -> Any:
    """Return a test that begins later [s]."""
    times = {name: getattr(test, name) + by_s for name in ("start_s", "settled_s", "stop_s") if name in _fields(test)}
    return test.model_copy(update=times)


def _fields(test: Any) -> set[str]:
    return set(type(test).model_fields)


def _until(test: Any, time_s: float) -> Any:
    """Return what of a test was played until a time, None where that is too little."""
    length_s = period_s(test)
    if length_s is None and test.stop_s <= time_s:
        return test
    if isinstance(test, Chirp):
        return None
    if isinstance(test, Staircase):
        whole = math.floor((time_s - test.start_s) / test.dwell_s)
        return test.model_copy(update={"levels_v": test.levels_v[:whole]}) if whole else None
    if length_s is None:
        return None
    stop_s = min(test.stop_s, time_s)
    periods = math.floor((stop_s - test.settled_s) / length_s + _PERIOD_ROUNDING)
    if periods < (FEWEST_PERIODS if isinstance(test, Leg) else 1):
        return None
    if test.stop_s <= time_s:
        return test
    return test.model_copy(update={"stop_s": min(test.settled_s + periods * length_s + _PERIOD_ROUNDING, time_s)})
