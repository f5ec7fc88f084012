"""Changes of a timetable on the way: a test is cut, and others follow in another order, again, or not at all."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from shaftprint.campaign._binary_sequence import BinarySequence
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitation import Excitation
from shaftprint.campaign._excitations import Chirp, Sine, Staircase
from shaftprint.campaign._leg import FEWEST_PERIODS, Leg, first_name, name_again
from shaftprint.campaign._moves import ends_of_move, length_of_move_s
from shaftprint.campaign._multisine import Multisine
from shaftprint.live._timetable import moved

Periodic: TypeAlias = Multisine | BinarySequence
"""A leg of any kind."""

# Beyond the fewest periods of a leg so many are there at first: what is known after those is known a period later.
_ROOM = 2
_SECTIONS: Mapping[type[Any], str] = {
    Sine: "sines",
    Multisine: "multisines",
    BinarySequence: "binary_sequences",
    Chirp: "chirps",
    Staircase: "staircases",
}


@dataclass(frozen=True, kw_only=True, slots=True)
class Advice:
    """What is still to be played for the wishes of a plan."""

    more: Mapping[str, int]
    """Further periods of each leg of the plan, by its name."""
    recorded: Mapping[str, int]
    """Whole periods that this counts on, by the name of what was played, such as ``M1-2``."""
    sentence: str = ""
    """What is known so far, in words."""

    @property
    def is_enough(self) -> bool:
        """Whether nothing is missing."""
        return not any(self.more.values())


def end_of_cut(test: Excitation, at_s: float) -> float:
    """Return when a test ends that is to end at a time [s]: stairs and sweeps, which have no periods, play on.

    A sine, after which no ramp goes on from where it stands, ends where it passes through its middle next.
    """
    if isinstance(test, Sine):
        before = test.phase_rad / math.pi
        halves = math.ceil(2.0 * test.frequency_hz * max(at_s - test.start_s, 0.0) + before)
        return min(max(test.start_s + (halves - before) / (2.0 * test.frequency_hz), at_s), test.stop_s)
    return max(at_s, test.start_s) if isinstance(test, Leg) else test.stop_s


def begun_until(campaign: Campaign, at_s: float) -> tuple[tuple[Excitation, ...], tuple[Excitation, ...]]:
    """Return the tests that have begun at a time [s], the last of them cut there, and those to come.

    A ramp that is under way goes on to the test that it leads to, which is then cut where it begins.
    """
    under_way = {move.free_s[1] for move in campaign.moves if move.start_s <= at_s < move.free_s[1]}
    begun = [one for one in campaign.excitations if one.start_s <= at_s or one.start_s in under_way]
    to_come = campaign.excitations[len(begun) :]
    if begun and begun[-1].stop_s > at_s and isinstance(begun[-1], Sine | Leg):
        begun[-1] = begun[-1].model_copy(update={"stop_s": end_of_cut(begun[-1], at_s)})
    return tuple(begun), to_come


def followed_by(
    campaign: Campaign,
    begun: Sequence[Excitation],
    to_come: Sequence[Excitation],
    *,
    from_s: float,
    like: Campaign,
    from_v: float | None = None,
) -> Campaign:
    """Return a campaign of tests that have begun, and others that follow one after the other, each after its ramp.

    ``from_s``: when the first of them may begin to be gone to [s]. ``like``: the campaign that was asked for: between
    tests that need no ramp, and after the last, as much time passes as there. ``from_v``: where the set point stands at
    that time [V], where that is not where the last test has ended.
    """
    ramps = {"ramp_s": campaign.ramp_s, "ramp_v_per_s": campaign.ramp_v_per_s}

    def ramp_s(before: Excitation | None, after: Excitation | None, stands_v: float | None) -> float:
        ended_v, to_v = ends_of_move(before, after, offset_v=campaign.offset_v)
        return length_of_move_s(abs(to_v - (ended_v if stands_v is None else stands_v)), **ramps)

    last, free_s, follow = (begun[-1] if begun else None), from_s, list[Excitation]()
    for test in to_come:
        needs_ramp = isinstance(last, Leg) or isinstance(test, Leg)
        start_s = free_s + (ramp_s(last, test, from_v) if needs_ramp else _gap_s(like, first_name(test.name)))
        last, from_v = moved(test, start_s - test.start_s), None
        follow.append(last)
        free_s = last.stop_s
    asked = like.excitations[-1]
    spare_s = like.duration_s - asked.stop_s - ramp_s(asked, None, None)
    sections: dict[str, tuple[Excitation, ...]] = {
        section: tuple(one for one in (*begun, *follow) if isinstance(one, kind)) for kind, section in _SECTIONS.items()
    }
    return campaign.model_copy(
        update=sections | {"duration_s": free_s + ramp_s(last, None, from_v) + max(spare_s, 0.0)}
    )


def again(test: Excitation, campaign: Campaign, *, periods: int | None = None) -> Excitation:
    """Return a test to be played once more under a name of its own; ``periods``: of a leg, as many as it has."""
    names = {one.name for one in campaign.excitations}
    repeated = test.model_copy(update={"name": name_again(test.name, names)})
    return repeated if periods is None or not isinstance(repeated, Periodic) else lasting(repeated, periods)


def lasting(leg: Periodic, periods: int) -> Periodic:
    """Return a leg of so many periods."""
    return leg.model_copy(update={"stop_s": leg.settled_s + periods * leg.length_of_period_s})


def by_information(
    campaign: Campaign,
    leg: Periodic,
    advice: Advice,
    *,
    played: int,
    soonest: int,
    fewest: int,
    most_s: float,
    like: Campaign,
) -> Campaign | None:
    """Return what is played from here on, by what a period of each leg tells of the wishes; None: as it stands.

    The leg that runs ends where nothing more is wished of it, and goes on where it would end too early. Legs to come
    follow by what they tell, each for at least ``fewest`` periods; one that was played is played again where no other
    tells as much. What does not fit into the time is left out. Steps and sweeps behind the legs are played behind them.

    ``leg``: the one that runs. ``played``: whole periods of it that have come. ``soonest``: periods after which a
    change can reach the device. ``fewest``: periods of a leg that are played at least. ``most_s``: longest that the
    campaign may take [s]. ``like``: the campaign that was asked for.
    """
    name = first_name(leg.name)
    more = advice.more.get(name, 0)
    # what is still wished of it may change until its last period but one
    if soonest > leg.periods or (more and played < leg.periods - 1):
        return None
    before = [one for one in campaign.excitations if one.start_s < leg.start_s]
    to_come = [one for one in campaign.excitations if one.start_s > leg.start_s]
    legs = [one for one in to_come if isinstance(one, Periodic)]
    # steps and sweeps behind the legs stay what they are
    rest = to_come[len(legs) :]
    if to_come[: len(legs)] != legs:
        return None
    follow = [
        lasting(one, max(min(one.periods, fewest + _ROOM), advice.more.get(first_name(one.name), 0))) for one in legs
    ]
    follow.sort(key=lambda one: -advice.more.get(first_name(one.name), 0))
    others = {first_name(one.name) for one in (leg, *follow)}
    done = {of: one for one in before if isinstance(one, Periodic) and (of := first_name(one.name)) not in others}
    repeated = [
        again(one, campaign, periods=max(FEWEST_PERIODS, advice.more[of]))
        for of, one in done.items()
        if advice.more.get(of)
    ]
    follow += [one for one in repeated if isinstance(one, Periodic)]
    now = lasting(leg, max(advice.recorded.get(leg.name, 0) + more if more else 0, soonest))
    while True:
        changed = followed_by(campaign, (*before, now), (*follow, *rest), from_s=now.stop_s, like=like)
        if changed.duration_s <= most_s:
            return changed
        shorter = _shorter(now, follow, advice, soonest=soonest, fewest=fewest)
        if shorter is None:
            return changed
        now, follow = shorter


def _shorter(
    now: Periodic, follow: list[Periodic], advice: Advice, *, soonest: int, fewest: int
) -> tuple[Periodic, list[Periodic]] | None:
    """Return legs with a period less in all: of one that has more than is wished, else of the one with most to spare.

    None where none has any.
    """
    least = [soonest, *(FEWEST_PERIODS if one.name != first_name(one.name) else fewest for one in follow)]
    wished = [now.periods, *(advice.more.get(first_name(one.name), 0) for one in follow)]
    legs = [now, *follow]
    spare = [one.periods - few for one, few in zip(legs, least, strict=True)]
    beyond = [max(0, min(one.periods - wish, free)) for one, wish, free in zip(legs, wished, spare, strict=True)]
    place = max(range(len(legs)), key=lambda one: (beyond[one], spare[one]))
    if spare[place] > 0:
        legs[place] = lasting(legs[place], legs[place].periods - 1)
    elif follow and follow[-1].name != first_name(follow[-1].name):
        legs.pop()
    else:
        return None
    return legs[0], legs[1:]


def _gap_s(like: Campaign, name: str) -> float:
    """Return the time between a test and the one before it [s]."""
    tests = like.excitations
    place = next((number for number, one in enumerate(tests) if one.name == name), 0)
    return tests[place].start_s - (tests[place - 1].stop_s if place else 0.0)
