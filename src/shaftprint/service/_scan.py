"""From logs to segments: which moves of the lever can be used, what they tell, and why others cannot."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray
from shaftprint.catalogue._gauge import GAUGE_K_I, GAUGE_K_P, GAUGE_OMEGA_N, T_D, T_SP, TAU_DN
from shaftprint.errors import ServiceError
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened
from shaftprint.service._fit import FEWEST_SEGMENTS, sums_of
from shaftprint.service._gather import Gathered, gather, lever_line
from shaftprint.service._model import ServiceModel, service_model
from shaftprint.service._score import Score, noise_of, scores, simulated
from shaftprint.service._segment import LeverLine, Segment
from shaftprint.service._segment_file import USED, write_segments
from shaftprint.service._start import begun
from shaftprint.service._vetting import (
    Found,
    beside_full_load,
    is_other,
    lever_follows_load,
    off_the_line,
    play_of_lever,
    shift_of_lever,
    speed_is_off,
    torque_is_held,
    usual_load,
    way_on,
)
from shaftprint.units import PERCENT, SECONDS_PER_HOUR, rpm_from_rev_s

if TYPE_CHECKING:
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.vessel._vessel import Vessel

TOLD = (GAUGE_K_P.name, GAUGE_K_I.name, T_D.name, T_SP.name, TAU_DN.name, GAUGE_OMEGA_N.name)
"""Numbers of which the table says what each segment tells."""
_TOO_LOUD = 3.0
# Segments that are simulated at most; of a longer log every second, third and so on.
_MOST_SIMULATED = 120
_LIMIT = "meets a limit of the torque, where noise decides how long: the fit leaves it out if it finds that too"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Scan(Shown):
    """What logs of service would tell of a line."""

    segments: tuple[Segment, ...]
    """Every move of the lever; those with a reason are not used."""
    line: LeverLine | None
    """The speed that the lever asks for; None where too little stands still."""
    seconds: dict[str, float]
    """How long the ship was doing what [s]."""
    left_out: tuple[str, ...]
    """What could not be read, in sentences."""
    found: tuple[Found, ...]
    """What was asked of the whole log."""
    refused: str
    """Why nothing may be fitted to it; empty where it may."""
    accuracy: dict[str, float]
    """Standard deviation that the used segments would give each number [its unit]; empty where they are too few."""
    values: dict[str, float]
    """Value of each number with which that was reckoned."""
    rows: tuple[dict[str, str], ...]
    """What the table says of each segment."""
    facts: dict[str, object]
    """What a fit has to know beside the segments."""
    spans_s: Mapping[str, tuple[float, float]]
    """From when to when each log goes, in its own seconds [s]."""

    @property
    def used(self) -> tuple[Segment, ...]:
        """The segments that are used."""
        return tuple(one for one in self.segments if not one.reason)

    @property
    def headline(self) -> str:
        """What the logger saw, and what it would tell, in one sentence."""
        saw = (
            f"Your logger saw {len(self.used)} useful move{'' if len(self.used) == 1 else 's'} of the lever in "
            f"{_how_long(sum(self.seconds.values()))}"
        )
        if self.refused:
            return f"{saw}, but nothing may be fitted to them: {self.refused}"
        if not self.accuracy:
            return f"{saw}; {FEWEST_SEGMENTS} and more are needed: give more logs."
        gain, delay, inertia = (
            f"{PERCENT * self.accuracy[name] / abs(self.values[name]):.2g} %"
            for name in (GAUGE_K_P.name, "delay", TAU_DN.name)
        )
        return (
            f"{saw}; with them K_p would be known to {gain}, the delay to {delay} and the inertia "
            f"behind the gauge to {inertia}."
        )

    def summary(self) -> Summary:
        """Return what was seen, and why moves are not used."""
        reasons = Counter(one.reason for one in self.segments if one.reason)
        facts = {
            "what": self.headline,
            "doing": ", ".join(f"{name} {seconds / 60.0:.0f} min" for name, seconds in self.seconds.items()),
            "not used": shortened([f"{count}: {reason}" for reason, count in reasons.most_common()]),
            "could not be read": shortened(self.left_out),
        }
        return Summary(title="Scan of service", facts=facts)

    def write(self, path: str | Path) -> None:
        """Write the table of segments, and what their channels did beside it.

        Raises
        ------
        ServiceError
            If there is nothing to write, or a file cannot be written.
        """
        if self.line is None:
            raise ServiceError(f"{path}: nothing is written: {self.refused}")
        write_segments(Path(path), self.segments, self.line, self.rows, self.facts)


@refusing_none(ServiceError)
def scan(
    logs: Sequence[str | Path],
    vessel: "Vessel",
    *,
    fingerprint: "Fingerprint | None" = None,
    progress: Callable[[float], None] | None = None,
) -> Scan:
    """Look through logs of ordinary service: moves of the lever, what they would tell, and what speaks against them.

    Parameters
    ----------
    logs
        Files of one logger, in order of time.
    vessel
        The installation.
    fingerprint
        One of an earlier test or of other days, against which the clock of the lever is held.
    progress
        Is told the share that is done, 0 to 1.

    Raises
    ------
    ServiceError
        If a log is too slow, or kept by a historian that compresses, or the line has no model here.
    RecordingError
        If a file cannot be read.
    """
    model = service_model(vessel, fingerprint)
    gathered = gather(logs, vessel, progress=progress)
    left_out = tuple(
        one.reason if one.reason.startswith(one.log) else f"{one.log}, {one.seconds:.0f} s: {one.reason}"
        for one in gathered.left_out
    )
    seconds = dict(gathered.seconds)
    still, at_full_load = beside_full_load(gathered.still, vessel)
    gathered = replace(gathered, still=still)
    try:
        line = lever_line(gathered.still)
    except ServiceError as error:
        return Scan(
            segments=gathered.segments, line=None, seconds=seconds, left_out=left_out, found=(), refused=str(error),
            accuracy={}, values={}, rows=(), facts={}, spans_s=gathered.spans_s,
        )  # fmt: skip
    gathered = _of_one_water(_that_follows(gathered, line), model)
    segments, found, each, model = _judged(gathered, line, model)
    found = (at_full_load, *found)
    simulated_ones = [one for one in each if one is not None]
    beside = [one for one in simulated_ones if not one.meets_limit]
    used = sum(not one.reason for one in segments)
    share = len(beside) / max(len(simulated_ones), 1)
    accuracy, values = _accuracy(beside, model, used=round(share * used))
    load, load_std = _load(gathered)
    refused = " Also: ".join(one.refused for one in found if one.refused)
    return Scan(
        segments=segments,
        line=line,
        seconds=seconds,
        left_out=left_out,
        found=found,
        refused=refused,
        accuracy=accuracy,
        values=values,
        rows=tuple(_row(one, score, line, model) for one, score in zip(segments, each, strict=True)),
        facts={
            "load": load,
            "load_std": load_std,
            "vessel": vessel.name,
            "seconds": seconds,
            "logs": [str(Path(log).name) for log in logs],
            "refused": refused,
            "began": None if gathered.began is None else gathered.began.isoformat(),
        },
        spans_s=gathered.spans_s,
    )


def _judged(
    gathered: Gathered, line: LeverLine, model: ServiceModel
) -> tuple[tuple[Segment, ...], tuple[Found, ...], list[Score | None], ServiceModel]:
    """Return segments with their reasons, what was found of the whole log, what each tells, and at which numbers."""
    usable = [one for one in gathered.segments if not one.reason]
    still = gathered.still
    held = torque_is_held(still, line, speed_rev_s=model.engine_speed_rev_s)
    play = play_of_lever(usable, line)
    found = [off_the_line(still, line), held, lever_follows_load(still), way_on(usable, sails=model.sails), play]
    each: dict[int, Score] = {}
    loud: set[int] = set()
    if usable:
        # what a long log tells is told by segments spread over it: each costs a simulation
        every = max(-(-len(usable) // _MOST_SIMULATED), 1)
        chosen = usable[::every]
        records = model.records(chosen, line)
        model = begun(model, records)
        runs = simulated(records, model, model.theta)
        if model.is_of_fingerprint:
            found.append(shift_of_lever(runs, model))
        each = dict(zip(map(id, chosen), scores(runs, noise_of(runs)), strict=True))
        typical = float(np.median([score.level for score in each.values()]))
        if model.is_of_fingerprint:
            loud = {key for key, score in each.items() if score.level > _TOO_LOUD * typical}
    segments = tuple(
        replace(one, reason="speed and torque do there what no noise of this line does") if id(one) in loud else one
        for one in gathered.segments
    )
    kept = [each.get(id(one)) if not new.reason else None for one, new in zip(gathered.segments, segments, strict=True)]
    return segments, tuple(found), kept, model


def _that_follows(gathered: Gathered, line: LeverLine) -> Gathered:
    """Return what the logs hold, with the reason where the speed does not come to what the lever asks for."""
    segments = (one if one.reason else replace(one, reason=speed_is_off(one, line)) for one in gathered.segments)
    return replace(gathered, segments=tuple(segments))


def _of_one_water(gathered: Gathered, model: ServiceModel) -> Gathered:
    """Return what the logs hold of the water of most moves: of a day at the quay and underway one of both is left."""
    usable = [one for one in gathered.segments if not one.reason]
    if not usable:
        return gathered
    loads = model.loads(usable)
    usual = usual_load(loads)
    left = iter(zip(loads.tolist(), is_other(loads, usual).tolist(), strict=True))
    segments = tuple(one if one.reason else _of_load(one, *next(left), usual) for one in gathered.segments)
    still = gathered.still
    return replace(
        gathered, segments=segments, still=still if model.sails else still.only(~is_other(still.load, usual))
    )


def _of_load(segment: Segment, load: float, is_of_another: bool, usual: float) -> Segment:
    """Return a segment, with the reason where its load is that of another water than the usual one."""
    if not is_of_another:
        return segment
    more = f"{abs(load / usual - 1.0):.0%} {'more' if load > usual else 'less'} torque than in most moves"
    reason = f"the propeller takes {more}: the ship has way on in one of them and not in the other, or turns"
    return replace(segment, reason=reason)


def _accuracy(each: Sequence[Score], model: ServiceModel, *, used: int) -> tuple[dict[str, float], dict[str, float]]:
    """Return standard deviations of numbers and of the sum of the delays, and their values.

    ``each``: what some segments tell. ``used``: how many there are in all.
    """
    if len(each) < FEWEST_SEGMENTS:
        return {}, {}
    sums = sums_of(each, model, model.theta)
    covariance = np.linalg.inv((sums.information - sums.prior) * max(used / len(each), 1.0) + sums.prior)
    delays = np.array([float(name in (T_D.name, T_SP.name)) for name in model.free])
    accuracy = {name: float(np.sqrt(covariance[k, k])) for k, name in enumerate(model.free)}
    accuracy["delay"] = float(np.sqrt(delays @ covariance @ delays))
    values = dict(zip(model.free, model.theta.tolist(), strict=True))
    return accuracy, values | {"delay": values[T_D.name] + values[T_SP.name]}


def _how_long(seconds: float) -> str:
    """Return a length of time as one says it."""
    if seconds >= 3300.0:
        hours = f"{seconds / SECONDS_PER_HOUR:.3g}"
        return f"{hours} hour{'' if hours == '1' else 's'}"
    return f"{seconds / 60.0:.0f} minutes" if seconds >= 120.0 else f"{seconds:.0f} seconds"


def _load(gathered: Gathered) -> tuple[float, float]:
    """Return the mean load over that of the working point and its standard deviation, by still stretches."""
    still = gathered.still
    numbers, place = np.unique(still.stretch, return_inverse=True)
    weight = np.bincount(place).astype(np.float64)
    means: FloatArray = np.bincount(place, weights=still.load) / weight
    mean = float(np.average(means, weights=weight))
    left = weight * (means - mean)
    return mean, float(np.sqrt(np.sum(left**2)) / weight.sum() * np.sqrt(numbers.size / max(numbers.size - 1, 1)))


def _row(segment: Segment, score: Score | None, line: LeverLine, model: ServiceModel) -> dict[str, str]:
    """Return what the table says of a segment."""
    speeds = rpm_from_rev_s(line.speed_rev_s(segment.lever_v)) if segment.lever_v.size else np.zeros(1)
    row = {
        "log": Path(segment.log).name,
        "move_s": f"{segment.move_s:.2f}",
        "seconds": f"{segment.seconds:.1f}" if segment.speed_rev_s.size else "",
        "swing_rpm": f"{np.ptp(speeds):.0f}",
        "from_rpm": f"{speeds[0]:.0f}",
        "to_rpm": f"{speeds[-1]:.0f}",
        "state": segment.state,
        USED: "no" if segment.reason else "yes",
        "reason": segment.reason or ("" if score is None or not score.meets_limit else _LIMIT),
        "noise": "" if score is None else f"{score.level:.3g}",
    }
    for name in TOLD:
        # what it would be known to by this segment alone, were all other numbers known
        information = 0.0 if score is None else float(score.information[model.free.index(name), model.free.index(name)])
        row[f"{name}_percent"] = (
            f"{PERCENT / np.sqrt(information) / abs(model.values[name]):.3g}" if information > 0.0 else ""
        )
    return row
