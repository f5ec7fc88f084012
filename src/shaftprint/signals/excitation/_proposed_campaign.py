"""The campaign that a recording really shows, to be put in place of the one that was planned."""

import math
from typing import Any

from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitations import Chirp, Sine, Staircase
from shaftprint.campaign._leg import Leg
from shaftprint.campaign._multisine import Multisine
from shaftprint.errors import SignalError
from shaftprint.signals.excitation._found_test import FoundTest

# Digits of a time [s]: a degree of a sine of 3 Hz.
_DIGITS = 3
_SAME_S = 0.1


def proposed_campaign(found: tuple[FoundTest, ...], campaign: Campaign) -> Campaign:
    """Return the campaign with begin, phase, sign and frequency of every test as the set point shows them.

    A sine begins where it rises through its middle, the time nearest to its real begin that leaves the test before it
    alone, or at its real begin, with its phase there, where that would be too late for its window. Its analysis begins
    as long after the real begin as was planned. Tests that were not found are left out.

    Parameters
    ----------
    found
        From ``found_tests``.
    campaign
        The campaign that was planned.

    Raises
    ------
    SignalError
        If none was found.
    """
    tests: dict[str, list[dict[str, Any]]] = {
        "sines": [],
        "multisines": [],
        "binary_sequences": [],
        "chirps": [],
        "staircases": [],
    }
    last_s = 0.0
    for test in found:
        if not test.is_found:
            continue
        match test.planned:
            case Sine() as sine:
                values = _sine(test, sine, last_s)
                if values is None:
                    continue
                tests["sines"].append(values)
                last_s = values["stop_s"]
            case Leg() as leg:
                later_s = max(_rounded(test.begin_s), last_s) - leg.start_s
                times = {name: _rounded(getattr(leg, name) + later_s) for name in ("start_s", "settled_s", "stop_s")}
                tests["multisines" if isinstance(leg, Multisine) else "binary_sequences"].append(
                    leg.model_dump() | times
                )
                last_s = times["stop_s"]
            case Chirp() as chirp:
                length_s = chirp.stop_s - chirp.start_s
                begin_s = max(_rounded(test.begin_s), last_s)
                last_s = _rounded(begin_s + length_s)
                tests["chirps"].append(chirp.model_dump() | {"start_s": begin_s, "stop_s": last_s})
            case Staircase() as stairs:
                levels = stairs.levels_v
                if test.is_inverted:
                    levels = tuple(2.0 * campaign.offset_v - level for level in levels)
                begin_s = max(_rounded(test.begin_s), last_s)
                last_s = begin_s + stairs.dwell_s * len(levels)
                tests["staircases"].append(stairs.model_dump() | {"levels_v": levels, "start_s": begin_s})
    if not any(tests.values()):
        raise SignalError(
            f'expected the tests of campaign "{campaign.name}" in the set point, found none of them; check that '
            "campaign and recording belong together and that the channel is the set point."
        )
    return Campaign.model_validate(campaign.model_dump() | {"duration_s": max(campaign.duration_s, last_s)} | tests)


def _sine(test: FoundTest, sine: Sine, last_s: float) -> dict[str, Any] | None:
    """Return the settings of a sine; nothing where less than a period of it is left."""
    if not test.differences and sine.start_s >= last_s:
        return sine.model_dump()
    period_s = 1.0 / test.frequency_hz
    start_s = test.rising_s + max(math.ceil((last_s - test.rising_s) / period_s), 0) * period_s
    begin_s, stop_s = max(_rounded(start_s), last_s), math.floor(test.end_s * 10.0**_DIGITS) / 10.0**_DIGITS
    # a slow sine leaves its middle so slowly that its phase knows the begin better
    real_s = start_s if abs(start_s - test.begin_s) < _SAME_S else test.begin_s
    settled_s = max(_rounded(real_s + sine.settled_s - sine.start_s), last_s)
    phase_rad = 0.0
    if begin_s > settled_s:
        # no such instant between the test before it and its window: the begin itself, with the phase that it has there
        begin_s = max(_rounded(min(test.begin_s, settled_s)), last_s)
        turn_rad = 2.0 * math.pi * test.frequency_hz * (begin_s - test.rising_s)
        phase_rad = round(math.remainder(turn_rad, 2.0 * math.pi), _DIGITS)
    if (stop_s - settled_s) * test.frequency_hz < 1.0:
        return None
    times = {"start_s": begin_s, "settled_s": settled_s, "stop_s": stop_s}
    same = {"frequency_hz": float(f"{test.frequency_hz:.6g}"), "phase_rad": phase_rad}
    return sine.model_dump() | times | same


def _rounded(time_s: float) -> float:
    return max(round(time_s, _DIGITS), 0.0)
