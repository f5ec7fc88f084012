"""What the numbers of a fingerprint rest on and no recording can show: it is stated with them."""

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.catalogue._roles import ShipRole
from shaftprint.digits import stated
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.judgement._causes import WRONG_SCALE
from shaftprint.identify.judgement._clock_drift import unseen_drift
from shaftprint.identify.judgement._suspects import moved_by
from shaftprint.identify.search._conditional_minimum import Conditional
from shaftprint.identify.uncertainty._profile import Interval
from shaftprint.models._combination import Combination
from shaftprint.models._role import Role
from shaftprint.signals._load_reasons import rests_on_ratio
from shaftprint.spelling import listed
from shaftprint.units import MILLI, PERCENT

if TYPE_CHECKING:
    from shaftprint.vessel._vessel import Vessel

# How far what the vessel file states may be off beside its deviation: rows that were forgotten, a torque that falls
# with the speed as in the maps of some engines.
OTHER_INERTIAS, STEEPEST_ENGINE = (0.8, 1.2), -0.5
# Share by which a gauge whose line bends shows a change of the torque too large, as none is that the zero passes for.
BENT = 0.03
# So much is in the intervals already, as the resolution of a delay.
LEAST_S = 0.0005


def assumptions_of(
    identification: "Identification",
    vessel: "Vessel",
    margins: Sequence[Combination] = (),
    intervals: "Mapping[str, Interval] | None" = None,
) -> tuple[str, ...]:
    """Return the assumptions behind the numbers of one fit, in sentences.

    ``identification``: the fit. ``vessel``: what was tested. ``margins``, ``intervals``: margins as numbers, and the
    profile-likelihood intervals by name; without them it is not said which numbers rest on the inertia upstream of the
    gauge.
    """
    return tuple(_assumptions(identification, vessel, margins, intervals or {}))


def _assumptions(
    identification: "Identification",
    vessel: "Vessel",
    margins: Sequence[Combination],
    intervals: "Mapping[str, Interval]",
) -> Iterator[str]:
    by_role = {parameter.role: parameter.name for parameter in identification.structure.free}
    sensors, propeller = vessel.sensors, vessel.propeller
    if latency := by_role.get(ShipRole.SET_POINT_LATENCY):
        totals = [c.name for c in identification.structure.combinations if c.role == ShipRole.TOTAL_DELAY]
        resting = f"{' and '.join((latency, *totals))} {'rest' if totals else 'rests'}"
        channel = sensors.set_point.channel
        yield (
            f"{resting} on the clock of the set point, and on no filter and no hold between the voltage that the "
            f"governor sees and {channel}: {_widths(identification)}a constant shift of {channel} against the other "
            "channels shows in nothing else."
        )
    if ShipRole.PITCH_DELAY in by_role and sensors.pitch is not None:
        yield from _of_pitch(identification, by_role, vessel)
    if bent := _resting_on_line(identification, margins, intervals):
        other = f"one that shows changes {PERCENT * BENT:.0f} % larger or smaller"
        yield _resting(bent, "a torque gauge whose line does not bend", other)
    if by_role.get(ShipRole.INERTIA_UPSTREAM) in identification.settings.priors:
        yield from _of_engine_side(identification, vessel, margins, intervals)
    scale = sensors.shaft_torque.scale_std
    geared = f", and on a gear ratio of {vessel.gearbox.ratio:g}" if rests_on_ratio(vessel) else ""
    yield (
        f"What is in N m or kg m2 rests on the scale of the torque gauge, known to {PERCENT * scale:.2g} %, on a "
        f"line of it that does not bend{geared}; K_Q besides on the diameter of the propeller, "
        f"{propeller.diameter_m:g} m, and a density of {vessel.water_density_kg_m3:g} kg/m3."
    )
    if vessel.taken_as_usual:
        yield (
            f"The vessel file does not state, and as usual is taken: {'; '.join(vessel.taken_as_usual)}. State them."
        )


def _of_pitch(identification: "Identification", by_role: Mapping[Role | None, str], vessel: "Vessel") -> Iterator[str]:
    """Return what rests on the clocks and scales of the pitch and of what asks for it."""
    sensors, names = vessel.sensors, [one.name for one in identification.parameters]
    moved = sensors.pitch_set_point if ShipRole.PITCH_SCALE in by_role else sensors.set_point
    if moved is None or sensors.pitch is None:
        return
    asked, shown = moved.channel, sensors.pitch.channel
    late = [by_role[ShipRole.PITCH_DELAY]]
    late += [c.name for c in identification.structure.combinations if c.role == ShipRole.PITCH_TOTAL]
    yield (
        f"{listed(late)} {'rest' if late[1:] else 'rests'} on the clocks of {asked} and {shown}, and on no filter in "
        f"either: that {asked} is late, or {shown} early, shows in nothing else."
    )
    slopes = (ShipRole.PITCH_SCALE, ShipRole.COMBINATOR_SLOPE, ShipRole.PITCH_SLOPE)
    scaled = [by_role[role] for role in slopes if by_role.get(role) in names]
    if scaled:
        yield (
            f"{listed(scaled)} {'rest' if scaled[1:] else 'rests'} on the scales of {asked} and {shown}; one that is "
            "off by more than the vessel file allows shows in nothing else."
        )


def _of_engine_side(
    identification: "Identification",
    vessel: "Vessel",
    margins: Sequence[Combination],
    intervals: "Mapping[str, Interval]",
) -> Iterator[str]:
    """Return what rests on the inertia upstream of the gauge and on the slope of the engine, as far as they may err."""
    names = {p.role: p.name for p in identification.structure.free}
    inertia, slope = names[ShipRole.INERTIA_UPSTREAM], names.get(ShipRole.ENGINE_SPEED_SLOPE)
    priors = identification.settings.priors
    if inertia not in intervals:
        return
    rest = resting_on(
        identification, margins, intervals, name=inertia, at=[share * priors[inertia].mean for share in OTHER_INERTIAS]
    )
    if rest:
        known = stated(vessel.inertia_upstream_kg_m2, vessel.inertia_upstream_std_kg_m2, "kg m2")
        also = "" if vessel.motor is None else ", and on a motor torque that does not change with speed"
        other = f"one {PERCENT * (OTHER_INERTIAS[1] - 1.0):.0f} % smaller or larger"
        yield _resting(rest, f"the inertia upstream of the gauge, {known}{also}", other)
    if slope is None or slope not in priors or slope not in intervals:
        return
    rest = resting_on(identification, margins, intervals, name=slope, at=[STEEPEST_ENGINE])
    if rest:
        other = f"{slope} = {STEEPEST_ENGINE:g} as of some engines"
        yield _resting(rest, f"an engine torque that hardly changes with speed ({slope})", other)


def _resting_on_line(
    identification: Identification, margins: Sequence[Combination], intervals: Mapping[str, Interval]
) -> tuple[str, ...]:
    """Return the numbers that leave their intervals where the gauge bends; none at two speeds, which show that."""
    at_one_speed = len({part.structure.channels for part in identification.parts}) == len(identification.parts)
    is_of_lines = identification.is_likelihood and not identification.objective.others
    moved = moved_by(identification, WRONG_SCALE["M_s"]) if at_one_speed and is_of_lines else None
    if moved is None:
        return ()
    bent = identification.values[list(identification.objective.free)] + BENT * np.outer((-1.0, 1.0), moved)
    return _outside(identification, margins, intervals, bent)


def _resting(numbers: Sequence[str], ground: str, other: str) -> str:
    """Return that numbers rest on what is taken as known, and what would move them out of their intervals."""
    alone = len(numbers) == 1
    return (
        f"{listed(list(numbers))} {'rests' if alone else 'rest'} on {ground}: with {other} "
        f"{'it would leave its interval' if alone else 'they would leave their intervals'}."
    )


def _widths(identification: "Identification") -> str:
    """Return what to count beside the intervals for what the recording cannot exclude."""
    response = identification.response
    clock_s = unseen_drift(identification) * float(response.middle_s.max(initial=0.0))
    widths = [
        (response.input_late_s or 0.0, "a filter or hold that its sines would not show"),
        (clock_s, "a clock of its own"),
    ]
    parts = [f"{MILLI * late_s:.2g} ms for {what}" for late_s, what in widths if late_s > LEAST_S]
    return f"count {listed(parts)} beside their intervals; " if parts else ""


# Starts of the search beside the optimum: with one number held elsewhere the best branch may be another.
_STARTS = 8


def resting_on(
    identification: Identification,
    margins: Sequence[Combination],
    intervals: Mapping[str, Interval],
    *,
    name: str,
    at: Sequence[float],
) -> tuple[str, ...]:
    """Return the names of the numbers that leave their 95 % intervals where one parameter is held at another value.

    ``identification``: the fit. ``margins``: its margins as numbers. ``intervals``: the intervals of parameters,
    combinations and margins, by name. ``name``: a free parameter. ``at``: the values at which it is held; those beyond
    its bounds are taken at them.
    """
    objective = identification.objective
    place = [p.name for p in objective.free_parameters].index(name)
    held = np.clip(np.array(at), objective.lower[place], objective.upper[place])
    optimum = identification.values[list(objective.free)]
    moved, _ = Conditional.of(objective, place).lowest(held, optimum[np.newaxis], starts=_STARTS)
    return tuple(one for one in _outside(identification, margins, intervals, moved) if one != name)


def _outside(
    identification: Identification,
    margins: Sequence[Combination],
    intervals: Mapping[str, Interval],
    theta: FloatArray,
) -> tuple[str, ...]:
    """Return the names of the numbers that leave their intervals at one of the free parameters, shape (rows, free)."""
    objective = identification.objective
    named = objective.named(objective.complete(theta))
    with np.errstate(all="ignore"):
        values = {p.name: named[p.name] for p in objective.free_parameters}
        values |= {one.name: np.asarray(one.of(named)) for one in (*objective.combinations, *margins)}
    return tuple(
        number
        for number, there in values.items()
        if number in intervals and np.any((there < intervals[number].lower) | (there > intervals[number].upper))
    )
