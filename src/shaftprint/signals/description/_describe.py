"""The campaign that a recorded set point shows, without any campaign to begin with."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby, product
from typing import Any

import numpy as np
from pydantic import ValidationError

from shaftprint.arrays import FloatArray, runs_of
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._moves import length_of_move_s
from shaftprint.campaign._setpoint import setpoint
from shaftprint.errors import SignalError
from shaftprint.signals.description._course import Course, course_of
from shaftprint.signals.description._excitations import multisine_fields, register_fields, stairs_fields, wave_fields
from shaftprint.signals.description._holds_of import SHORTEST_DWELL_S, holds_of, is_level, stairs_of, with_one_dwell
from shaftprint.signals.description._parse import Unexplained, pieces_of, with_exact_borders
from shaftprint.signals.description._pieces import Piece, Repeated, Stairs, Straight, Wave
from shaftprint.signals.description._plain import plainest
from shaftprint.signals.description._register import Hold, begun_behind_ramp, register_of, two_valued
from shaftprint.signals.description._waves import locally_wrong

_LETTERS = {"staircases": "St", "sines": "S", "multisines": "M", "binary_sequences": "B", "chirps": "C"}
# The set point of the proposal differs where it is off by this share of all motion for a while [s].
_OTHER_SHARE, _OTHER_S = 0.03, 0.3
_MOTIONLESS = 20.0
# A generator that holds its voltage jumps so many samples early or late.
_SAMPLES = 2.0
# A ramp that takes all the time between two legs may lack some of it by rounding: tried one after the other.
_FASTER = (1.0, 1.0005, 1.001, 1.002, 1.005, 1.01, 1.02, 1.05)


@dataclass(frozen=True, kw_only=True, slots=True)
class Description:
    """What a recorded set point shows, as a campaign."""

    campaign: Campaign
    """The campaign."""
    unexplained_s: tuple[tuple[float, float], ...]
    """Stretches that move otherwise than the campaign says, begin and end [s], in order of time."""
    difference_v: float
    """Root mean square of what differs elsewhere [V]."""


def described(
    set_point_v: FloatArray, *, rate_hz: float, start_s: float, name: str, sample_rate_hz: float | None = None
) -> Description:
    """Return the campaign that a recorded set point shows.

    ``set_point_v``: set point on a grid [V], shape (samples,). ``rate_hz``, ``start_s``: the grid. ``name``: name of
    the campaign. ``sample_rate_hz``: rate of the logger [Hz]. Raises SignalError if the set point does not move, or
    shows no excitation that a campaign file can describe.
    """
    course = course_of(np.asarray(set_point_v), rate_hz=rate_hz, start_s=start_s)
    if course.range_v <= _MOTIONLESS * course.noise_v:
        raise SignalError(
            f"expected a set point that moves, found {course.offset_v:.4g} V with steps of {course.range_v:.2g} V from "
            "start to end; check that the channel is the set point and that the test was made."
        )
    pieces = with_exact_borders(course, pieces_of(course))
    fields = _Fields(course)
    for standing, group in groupby(range(len(pieces)), key=lambda k: is_level(pieces[k])):
        places = list(group)
        if standing:
            beside = [pieces[k] if 0 <= k < len(pieces) else None for k in (places[0] - 1, places[-1] + 1)]
            fields.add_levels(
                [piece for k in places if isinstance(piece := pieces[k], Piece)],
                before=beside[0] if isinstance(beside[0], Piece) else None,
                before_ramp=isinstance(beside[1], Straight),
            )
            continue
        for k in places:
            fields.add_moving(pieces[k])
    campaign = fields.campaign(pieces, name=name, sample_rate_hz=sample_rate_hz)
    return _judged(course, campaign)


class _Fields:
    """The excitations of a campaign as they are found, in order of time."""

    def __init__(self, course: Course) -> None:
        self._course = course
        self._tests: dict[str, list[dict[str, Any]]] = {kind: [] for kind in _LETTERS}
        self._last_s = 0.0
        self._names: Counter[str] = Counter()
        self._has_legs = False

    def add_levels(self, pieces: list[Piece], *, before: Piece | None, before_ramp: bool) -> None:
        """Add binary sequences and staircases of pieces that stand and jump; behind a leg the set point may wait."""
        same_v = 2.0 * self._course.flat_v
        holds = holds_of(pieces, same_v=same_v)
        holds = holds[1:] if isinstance(before, Repeated) else holds
        if not holds:
            return
        place = two_valued(holds, tolerance_v=same_v)
        match = register_of(holds[slice(*place)]) if place else None
        if place is None or match is None:
            self._add_stairs(holds)
            return
        if isinstance(before, Straight) and not place[0]:
            match = begun_behind_ramp(match, float(before.value_at(np.array([before.end_s]))[0]))
        self._add_stairs([*holds[: place[0]], *_before(holds[place[0]], match.begin_s)])
        self._has_legs = True
        self._add("binary_sequences", register_fields(match, self._name("binary_sequences"), self._last_s))
        rest = [*_after(holds[place[1] - 1], match.end_s), *holds[place[1] :]]
        self._add_stairs(rest[1:] if before_ramp else rest)

    def add_moving(self, piece: Piece | Unexplained) -> None:
        """Add what a piece is that does not stand."""
        match piece:
            case Wave():
                kind = "chirps" if piece.rate else "sines"
                self._add(kind, wave_fields(self._course, piece, self._name(kind), self._last_s))
            case Repeated():
                self._has_legs = True
                self._add("multisines", multisine_fields(self._course, piece, self._name("multisines"), self._last_s))

    def _add_stairs(self, holds: list[Hold]) -> None:
        same_v = 2.0 * self._course.flat_v
        groups = stairs_of(holds, offset_v=self._course.offset_v, same_v=same_v)
        for stairs in [part for group in groups for part in with_one_dwell(group)]:
            fields = stairs_fields(self._course, stairs, self._name("staircases"), self._last_s)
            if fields is not None and fields["dwell_s"] >= SHORTEST_DWELL_S:
                self._add("staircases", fields)

    def _name(self, kind: str) -> str:
        return f"{_LETTERS[kind]}{self._names[kind] + 1}"

    def _add(self, kind: str, fields: dict[str, Any] | None) -> None:
        if fields is None:
            return
        self._names[kind] += 1
        self._tests[kind].append(fields)
        dwell_s = fields.get("dwell_s", 0.0) * len(fields.get("levels_v", ()))
        self._last_s = fields["stop_s"] if "stop_s" in fields else fields["start_s"] + dwell_s

    def campaign(self, pieces: list[Piece | Unexplained], *, name: str, sample_rate_hz: float | None) -> Campaign:
        """Return the campaign of all that was found."""
        course = self._course
        if not any(self._tests.values()):
            raise SignalError(
                "expected sines, multisines, binary sequences, chirps or staircases in the set point, found none that "
                "a campaign file can describe."
            )
        values: dict[str, Any] = {
            "name": name,
            "duration_s": max(math.floor((course.start_s + course.count / course.rate_hz) * 1e3) / 1e3, self._last_s),
            "offset_v": plainest(course.offset_v, 0.1 * course.noise_v + 1e-6),
            "sample_rate_hz": sample_rate_hz,
        }
        tests = {kind: tuple(tests) for kind, tests in self._tests.items()}
        ramps = self._ramps(pieces) if self._has_legs else {}
        legs = [(kind, leg) for kind in ("multisines", "binary_sequences") for leg in tests[kind]]
        # where the ramps of one leg find no room, the rest is proposed without it
        tries = [tests, *({**tests, kind: tuple(one for one in tests[kind] if one is not leg)} for kind, leg in legs)]
        faults = ""
        # a recording that breaks off within a leg lacks the ramp behind it
        room_s = length_of_move_s(course.range_v, ramp_s=ramps.get("ramp_s"), ramp_v_per_s=ramps.get("ramp_v_per_s"))
        lengths = ({}, {"duration_s": values["duration_s"] + math.ceil(room_s)}) if ramps else ({},)
        for tried, length, faster in product(tries, lengths, _FASTER):
            with_ramps = values | length | tried | ramps_made_faster(ramps, faster)
            try:
                return Campaign.model_validate(with_ramps)
            except ValidationError as error:
                faults = faults or "; ".join(str(fault["msg"]) for fault in error.errors())
        raise SignalError(f"the set point was taken apart, but not to a campaign that can be sailed: {faults}")

    def _ramps(self, pieces: list[Piece | Unexplained]) -> dict[str, float]:
        """Return the time or rate of the ramps to legs and back."""
        legs = [k for k, piece in enumerate(pieces) if isinstance(piece, Repeated | Stairs)]
        return ramp_fields([piece for k in ramps_beside(pieces, legs) if isinstance(piece := pieces[k], Straight)])


def _before(hold: Hold, time_s: float) -> list[Hold]:
    """Return the part of a hold before a time, where there is one."""
    part = Hold(level_v=hold.level_v, begin_s=hold.begin_s, end_s=min(time_s, hold.end_s))
    return [part] if part.length_s > 0.0 else []


def _after(hold: Hold, time_s: float) -> list[Hold]:
    """Return the part of a hold after a time, where there is one."""
    part = Hold(level_v=hold.level_v, begin_s=max(time_s, hold.begin_s), end_s=hold.end_s)
    return [part] if part.length_s > 0.0 else []


def _judged(course: Course, campaign: Campaign) -> Description:
    """Return the campaign with the stretches in which the recorded set point is another."""
    beside = [course.times(0, course.count) + shift / course.rate_hz for shift in (-_SAMPLES, 0.0, _SAMPLES)]
    near = np.array([setpoint(campaign, time_s) for time_s in beside])
    # a jump is known to some samples
    residual = course.values_v - np.clip(course.values_v, near.min(axis=0), near.max(axis=0))
    other = locally_wrong(residual, _OTHER_SHARE * course.range_v + 5.0 * course.noise_v, course)
    joined = np.convolve(other, np.ones(2 * round(course.rate_hz) + 1), mode="same") > 0.5
    stretches = []
    for first, stop in runs_of(joined):
        inside = np.flatnonzero(other[first:stop])
        begin, end = first + int(inside[0]), first + int(inside[-1]) + 1
        if np.count_nonzero(other[begin:end]) >= _OTHER_S * course.rate_hz:
            stretches.append((course.start_s + begin / course.rate_hz, course.start_s + end / course.rate_hz))
    rest = (course.values_v - near[1])[~joined]
    return Description(
        campaign=campaign,
        unexplained_s=tuple(stretches),
        difference_v=float(np.sqrt(np.mean(rest**2))) if rest.size else 0.0,
    )


# Rates are alike within this share; times count where rates are not.
_ALIKE = 0.02
# Where no ramp was seen the set point jumped: a ramp that is none [s].
_JUMP_S = 0.01


def ramp_fields(ramps: Sequence[Straight]) -> dict[str, float]:
    """Return the time or rate of ramps, whichever they share; that of a jump where there are none."""
    if not ramps:
        return {"ramp_s": _JUMP_S}
    lengths = np.array([ramp.length_s for ramp in ramps])
    slopes = np.abs([ramp.slope_v_per_s for ramp in ramps])
    apart_s, apart_v = (float(np.ptp(values) / values.mean()) for values in (lengths, slopes))
    apart_v = 0.0 if apart_v <= _ALIKE else apart_v
    weights = lengths**3
    if apart_v <= apart_s:
        rate = float(slopes @ weights / weights.sum())
        return {"ramp_v_per_s": plainest(rate, 1e-3 * rate)}
    # the end of a ramp of few volts is seen badly
    volts = (slopes * lengths) ** 2
    time_s = float(lengths @ volts / volts.sum())
    return {"ramp_s": plainest(time_s, 0.005 * time_s)}


def ramps_beside(pieces: Sequence[Piece | object], legs: Sequence[int]) -> list[int]:
    """Return the places of the ramps that lead to legs or away from them, with a wait beside them at most."""
    found = set()
    for leg in legs:
        for step in (-1, 1):
            k = leg + step
            if step == 1 and _is_level(pieces, k):
                k += step
            if 0 <= k < len(pieces):
                piece = pieces[k]
                if isinstance(piece, Straight) and piece.slope_v_per_s != 0.0:
                    found.add(k)
    return sorted(found)


def _is_level(pieces: Sequence[Piece | object], place: int) -> bool:
    if not 0 <= place < len(pieces):
        return False
    piece = pieces[place]
    return isinstance(piece, Straight) and piece.slope_v_per_s == 0.0


def ramps_made_faster(fields: dict[str, float], times: float) -> dict[str, float]:
    """Return the time or rate of ramps that are so many times as fast."""
    return {name: value * times if name == "ramp_v_per_s" else value / times for name, value in fields.items()}
