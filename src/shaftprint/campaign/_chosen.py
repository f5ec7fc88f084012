"""A campaign with its tests chosen by eye: each moved, its window made longer or shorter, or left out."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

from pydantic import model_validator

from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitation import ROUNDING_S, Excitation
from shaftprint.campaign._excitations import Chirp, Staircase
from shaftprint.campaign._file_text import TESTS
from shaftprint.campaign._leg import Leg
from shaftprint.campaign._multisine import Multisine

# Digits of a time [s], as a file of a campaign has them.
_DIGITS = 12


@dataclass(frozen=True, kw_only=True, slots=True)
class Choice:
    """What is chosen of one test."""

    is_used: bool = True
    """Whether it stays in the campaign."""
    later_s: float = 0.0
    """By how much later the whole test is taken to be [s]."""
    from_later_s: float = 0.0
    """By how much later than that its window begins [s]; a chirp or staircase has no window of its own."""
    to_later_s: float = 0.0
    """By how much later than that its window, and the test, ends [s]."""


class Offered(Campaign):
    """A campaign with tests of which some stand for each other: none that can be sailed before they are chosen."""

    @model_validator(mode="after")
    def _can_be_sailed(self) -> Self:
        return self


def chosen(campaign: Campaign, choices: Mapping[str, Choice]) -> Campaign:
    """Return a campaign with some of its tests moved, or without them.

    A multisine that moves something else goes with the leg beside which it runs. The campaign becomes longer where a
    test ends behind its end.

    ``campaign``: what was asked of the ship, or what a recording shows. ``choices``: what is chosen of each test, by
    its name; a test that is not named stays as it is. Raises ValueError, as a campaign file does, if the result is no
    campaign: two tests overlap, a window holds less than a period, or nothing is left.
    """
    beside = {one.name: leg.name for leg in campaign.legs for one in campaign.beside(leg)}
    tests: dict[str, list[dict[str, Any]]] = {}
    for section in TESTS:
        tests[section] = [
            _moved(test, choice)
            for test in getattr(campaign, section)
            if (choice := choices.get(beside.get(test.name, test.name), Choice())).is_used
        ]
    ends = [one["stop_s"] if "stop_s" in one else _end_of(one) for every in tests.values() for one in every]
    # what comes behind the last test, such as the ramp back, comes behind it still; one that is offered may end later
    within = [one.stop_s for one in campaign.excitations if one.stop_s <= campaign.duration_s + ROUNDING_S]
    behind_s = campaign.duration_s - max(within, default=campaign.duration_s)
    longer = {"duration_s": max((campaign.duration_s, *(end + behind_s for end in ends)))}
    return Campaign.model_validate(campaign.model_dump() | tests | longer)


def window_of(test: Excitation) -> tuple[float, float]:
    """Return from when to when a test is looked at [s]: whole periods once it has settled, or all of it."""
    return (test.start_s, test.stop_s) if isinstance(test, Chirp | Staircase) else (test.settled_s, test.window_stop_s)


def shortest_s(test: Excitation) -> float:
    """Return how long its window is at least [s]; all of it where it has none of its own."""
    if isinstance(test, Chirp | Staircase):
        return test.stop_s - test.start_s
    return 2.0 * test.length_of_period_s if isinstance(test, Leg) else 1.0 / test.frequency_hz


def kind_of_test(test: Excitation) -> str:
    """Return what a test is, in words."""
    match test:
        case Multisine():
            return f"multisine at {test.level_v:.4g} V"
        case Leg():
            return f"binary sequence at {test.level_v:.4g} V"
        case Chirp():
            return f"chirp, {test.start_frequency_hz:.4g} to {test.stop_frequency_hz:.4g} Hz"
        case Staircase():
            return f"staircase of {len(test.levels_v)} levels"
        case _:
            return f"sine of {test.frequency_hz:.4g} Hz"


def _moved(test: Excitation, choice: Choice) -> dict[str, Any]:
    values = test.model_dump()
    later = {"start_s": choice.later_s}
    if "stop_s" in values:
        later["stop_s"] = choice.later_s
    if "settled_s" in values:
        later["settled_s"] = choice.later_s + choice.from_later_s
        later["stop_s"] += choice.to_later_s
    return values | {name: round(values[name] + s, _DIGITS) for name, s in later.items() if s}


def _end_of(stairs: Mapping[str, Any]) -> float:
    return float(stairs["start_s"] + stairs["dwell_s"] * len(stairs["levels_v"]))
