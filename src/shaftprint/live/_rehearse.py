"""The verb ``rehearse``: a test played on a simulated ship, by the engine that plays it on board."""

import asyncio
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from shaftprint.errors import RequestError
from shaftprint.live._block import Event
from shaftprint.live._engine import LiveTest
from shaftprint.live._outcome import Operator, Outcome
from shaftprint.live._over import ship_over
from shaftprint.live._page import LivePages, watched
from shaftprint.live._record import Left
from shaftprint.live._recorded import recorded
from shaftprint.live._stop_rule import advice_by
from shaftprint.live.counterparts._faults import LinkFaults, Spell
from shaftprint.live.counterparts._simulated import SimulatedCounterpart, SimulatedShip
from shaftprint.tug._like_stan_tug import like_stan_tug_1205, with_lever_of
from shaftprint.tug._stepped import SteppedTug

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.design.planned_test._planned_test import PlannedTest
    from shaftprint.live._envelope import Envelope
    from shaftprint.tug._tug import Tug
    from shaftprint.vessel._vessel import Vessel

# Beside the campaign: channels alive, revert, arming, ramps of an abort [s].
_BESIDE_S = 120.0
_SPELLS = {
    "frozen": "frozen",
    "silent": "silent",
    "stale": "stale",
    "not-a-number": "not_a_number",
    "stuck": "stuck_set_point",
    "deaf": "deaf",
}
_LATE_S = 3.0


def _silent(event: Event) -> None:
    """Say nothing."""


def simulated_ship_of(
    vessel: "Vessel", campaign: "Campaign", *, seed: int, faults: LinkFaults, tug: "Tug | None" = None
) -> SimulatedShip:
    """Return a ship like the Stan Tug behind a device that keeps the contract, but for its faults."""
    truth = tug or _usual_ship(vessel, campaign)
    ship = SteppedTug(truth, vessel, first_v=campaign.offset_v, duration_s=campaign.duration_s + _BESIDE_S, seed=seed)
    faults = replace(faults, channel=vessel.sensors.shaft_torque.channel)
    return SimulatedShip(ship, lever_v=campaign.offset_v, faults=faults)


def rehearse(
    vessel: "Vessel",
    campaign: "Campaign",
    envelope: "Envelope",
    path: Path,
    *,
    seed: int = 1,
    pace: float | None = None,
    over: str | None = None,
    faults: LinkFaults | None = None,
    tug: "Tug | None" = None,
    operator: Operator | None = None,
    planned: "PlannedTest | None" = None,
    proves: "Callable[[Campaign], Sequence[str]] | None" = None,
    most_s: float | None = None,
    told: Callable[[Event], None] = _silent,
    pages: LivePages | None = None,
) -> tuple[Outcome, Left]:
    """Play a test on a simulated ship, and write what it leaves.

    Parameters
    ----------
    vessel, campaign, envelope
        The ship, what is played, and what bounds it.
    path
        The recording to write.
    seed
        Of all randomness.
    pace
        Times the clock; as fast as it can be calculated without it.
    over
        Server behind which the ship sails in the time of the clock, ``opcua`` or ``mqtt``; in this process without.
    faults
        What goes wrong.
    tug
        The truth; like the Stan Tug where not given.
    operator
        Who may stop it.
    planned
        The plan by whose wishes legs end early, go on and come again.
    proves
        Says why a changed campaign may not be played; nothing is changed without it but that it is held.
    most_s
        Longest time that is played by what is known [s]; that of the campaign where not given.
    told
        Is told each event.
    pages
        Show the test in a browser of this computer.

    Raises
    ------
    RecordingError
        If the recording is there already or cannot be written.
    """
    truth = tug or _usual_ship(vessel, campaign)
    make = partial(simulated_ship_of, vessel, campaign, seed=seed, faults=faults or LinkFaults(), tug=truth)

    test = partial(
        LiveTest,
        vessel=vessel,
        campaign=campaign,
        envelope=envelope,
        operator=operator or Operator(),
        slope_rpm_per_v=truth.set_point_slope_rpm_per_v,
        **watched(told, pages),
        waits=pace is None and over is None,
        advises=None if planned is None else advice_by(planned),
        proves=proves,
        most_s=most_s,
    )
    if over is None:
        _, outcome, left = asyncio.run(recorded(SimulatedCounterpart(make(), pace=pace), path, test))
    else:
        with ship_over(over, make) as reached:
            _, outcome, left = asyncio.run(recorded(reached, path, test))
    return outcome, left


def rehearsed_slope(vessel: "Vessel", campaign: "Campaign") -> float:
    """Return what one volt asks for on the simulated ship [rpm/V]."""
    return _usual_ship(vessel, campaign).set_point_slope_rpm_per_v


def _usual_ship(vessel: "Vessel", campaign: "Campaign") -> "Tug":
    return with_lever_of(like_stan_tug_1205(vessel, offset_v=campaign.offset_v), vessel, campaign)


def faults_named(words: Sequence[str]) -> LinkFaults:
    """Return faults by what was typed, such as ``silent@60``.

    Raises RequestError if there is no such fault, or its time is none.
    """
    faults = LinkFaults()
    for word in words:
        kind, _, second = word.partition("@")
        if kind == "late-revert" and not second:
            faults = replace(faults, revert_s=_LATE_S)
            continue
        try:
            start_s = float(second)
        except ValueError:
            start_s = -1.0
        if kind not in _SPELLS or not 0.0 <= start_s < math.inf:
            raise RequestError(
                f"--fault: expected {', '.join(_SPELLS)} with a second, such as silent@60, or late-revert, found "
                f'"{word}".'
            )
        spell: dict[str, Any] = {_SPELLS[kind]: Spell(start_s=start_s)}
        faults = replace(faults, **spell)
    return faults
