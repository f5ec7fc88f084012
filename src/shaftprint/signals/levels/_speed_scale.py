"""Whether the speed is off by one factor, as with a wrong number of pulses a turn, or the torque is of another shaft.

A speed that is shown ``s`` times as large makes that of the working point ``s`` times as large, the torque over its
square ``1 / s^2`` times, and the inertia behind the gauge ``1 / s`` times; a gauge that shows ``f`` times the torque
makes the last two ``f`` times as large; another propeller or another load changes the second alone. So each thing that
the files expect is a logarithm ``p ln s + r ln f`` with a standard deviation, and each cause is held against the others
by the sum of the squares that it leaves.

With files that are right a cause of a known factor wins by 12 in fewer than three of ten thousand tests, whatever the
factor: where it is ``d`` standard deviations away that needs one normal deviate beyond ``(12 + d^2) / (2 d)``, at least
3.46. A factor that is fitted has to win by 16, which one chi-square of one degree of freedom passes as seldom.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal

from shaftprint.units import rpm_from_rev_s

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.signals._working_points import WorkingPoint
    from shaftprint.vessel._vessel import Vessel

# Standard deviations of logarithms. What a lever asks for, where campaign or sensor say it: droop, and a line that was
# read off a lever. Where nothing says it, the working point of the vessel file: another lever, a test at another speed.
_ASKED, _ASSUMED = 0.07, 0.2
# Torque over the square of the speed: weather, draught, way of the ship, a card's open-water curve. A pitch that is
# controlled makes of it what it likes.
_LOAD, _LOAD_OF_PITCH = 0.25, 0.7
# The same from one leg of a test to the next: wind and current turn, a ship takes way.
_LOAD_BETWEEN = 0.1
# Of a recording of which nobody says what was done in it, the means of all of its time.
_ANY_SPEED, _ANY_LOAD = 0.4, 0.4
# A governed machine runs between its lowest and its rated speed, and 15 % beyond as the file may err.
_BEYOND, _BEYOND_STD, _MOST_BEYOND = 0.15, 0.07, 9.0
# Voltages this near to the offset of a campaign ask for the speed that it states.
_NEAR_V = 0.3

# What is miscounted: the camshaft, a strip too many or too few, a sensor of two pulses.
_MISCOUNTS: Final = {
    1 / 4: "a quarter of",
    1 / 3: "a third of",
    1 / 2: "half",
    2 / 3: "two thirds of",
    3 / 4: "three quarters of",
    4 / 3: "four thirds of",
    3 / 2: "one and a half times",
    2.0: "twice",
    3.0: "three times",
    4.0: "four times",
}
_CERTAIN, _FITTED = 12.0, 4.0
# A cause that leaves more is none.
_EXPLAINS = 9.0
# A factor nearer to 1 than this is none of counting.
_LEAST = 0.18
_SAME = 0.03


@dataclass(frozen=True, kw_only=True, slots=True)
class ScaleEvidence:
    """One thing that speed and torque make, over what the files expect of it."""

    log: float
    """Natural logarithm of found over expected."""
    std: float
    """Its standard deviation where the scales are right."""
    of_speed: float = 0.0
    """Power of the factor of the speed in it."""
    of_torque: float = 0.0
    """Power of the factor of the torque in it."""
    is_load: bool = False
    """Whether another propeller or load changes it too."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ScaleDoubt:
    """A factor that speed or torque are off by."""

    of: Literal["speed", "torque"]
    """What is off."""
    factor: float
    """Shown over true."""

    @property
    def words(self) -> str:
        """The factor in words, as it goes before *the true one*."""
        near = min(_MISCOUNTS, key=lambda factor: abs(math.log(factor / self.factor)))
        if abs(math.log(near / self.factor)) < _SAME:
            return _MISCOUNTS[near]
        return f"{self.factor:.3g} times"


def scale_evidence(
    point: "WorkingPoint", vessel: "Vessel", campaign: "Campaign | None" = None
) -> tuple[ScaleEvidence, ...]:
    """Return what a mean speed and a mean torque say of their scales.

    ``point``: mean speed and torque, and the set point at which they were. ``vessel``: says which torque belongs to
    which speed. ``campaign``: says which speed was asked for; None where nobody says what was done in the recording.
    """
    found_rpm = rpm_from_rev_s(point.engine_speed_rev_s)
    load_std = _LOAD if vessel.pitch is None else _LOAD_OF_PITCH
    if campaign is None:
        asked_rpm, asked_std = vessel.working_point.engine_speed_rpm, _ANY_SPEED
        load_std = math.hypot(load_std, _ANY_LOAD)
    else:
        asked_rpm, asked_std = asked_speed(point, vessel, campaign)
    speed = ScaleEvidence(log=math.log(found_rpm / asked_rpm), std=asked_std, of_speed=1.0)
    load = load_over_expected(point, vessel)
    if not load > 0.0:
        return (speed,)
    return (speed, ScaleEvidence(log=math.log(load), std=load_std, of_speed=-2.0, of_torque=1.0, is_load=True))


def evidence_between(
    point: "WorkingPoint", beside: "WorkingPoint", vessel: "Vessel", campaign: "Campaign"
) -> tuple[ScaleEvidence, ...]:
    """Return what mean speed and torque of one leg say of their scales, those of another leg being right.

    ``point``, ``beside``: of the one leg, and of the other. ``vessel``: says whether a pitch changes the load.
    ``campaign``: says which speeds were asked for.
    """
    (asked_rpm, asked_std), (beside_rpm, _) = (asked_speed(one, vessel, campaign) for one in (point, beside))
    speed = math.log(point.engine_speed_rev_s / beside.engine_speed_rev_s)
    loads = [load_over_expected(one, vessel) for one in (point, beside)]
    of_speed = ScaleEvidence(log=speed - math.log(asked_rpm / beside_rpm), std=asked_std, of_speed=1.0)
    if not min(loads) > 0.0:
        return (of_speed,)
    load_std = _LOAD_BETWEEN if vessel.pitch is None else _LOAD_OF_PITCH
    load = math.log(loads[0] / loads[1])
    return (of_speed, ScaleEvidence(log=load, std=load_std, of_speed=-2.0, of_torque=1.0, is_load=True))


def asked_speed(point: "WorkingPoint", vessel: "Vessel", campaign: "Campaign") -> tuple[float, float]:
    """Return the engine speed that was asked for [rpm], and the standard deviation of its logarithm."""
    of_sensor = vessel.sensors.set_point.asked_rpm(point.set_point_v)
    if of_sensor is not None and of_sensor > 0.0:
        return of_sensor, _ASKED
    offset_rpm, beside_v = campaign.offset_rpm, point.set_point_v - campaign.offset_v
    slope = campaign.slope_rpm_per_v
    asked_rpm = vessel.working_point.engine_speed_rpm if offset_rpm is None else offset_rpm
    is_near = abs(beside_v) < _NEAR_V
    along_rpm = asked_rpm + (slope or 0.0) * beside_v
    if offset_rpm is None or not (is_near or slope) or not along_rpm > 0.0:
        return asked_rpm, _ASSUMED if is_near else _ANY_SPEED
    return along_rpm, _ASKED


def load_over_expected(point: "WorkingPoint", vessel: "Vessel") -> float:
    """Return torque over the square of the speed, over that of the working point of the vessel file."""
    expected = vessel.working_point
    share = rpm_from_rev_s(point.engine_speed_rev_s) / expected.engine_speed_rpm
    return point.shaft_torque_nm / expected.driving_torque_nm / share**2


def scale_doubt(
    evidence: Sequence[ScaleEvidence], vessel: "Vessel", *, levels_rpm: Iterable[float] = ()
) -> ScaleDoubt | None:
    """Return the factor of speed or torque that explains what is far from the files; None where none has to.

    ``evidence``: from `scale_evidence`, and the inertia behind the gauge where a fit gives it. ``vessel``: the vessel
    file. ``levels_rpm``: mean engine speeds that were governed [rpm].
    """
    levels = tuple(levels_rpm)

    def left(*, speed: float = 1.0, torque: float = 1.0) -> float:
        """Return what factors of speed and torque leave unexplained."""
        scales = math.log(speed), math.log(torque)
        misses = (item.log - item.of_speed * scales[0] - item.of_torque * scales[1] for item in evidence)
        squares = sum((miss / item.std) ** 2 for miss, item in zip(misses, evidence, strict=True))
        return squares + _beyond([level / speed for level in levels], vessel)

    healthy, ratio = left(), vessel.gearbox.ratio
    of_gear = [factor for factor in (ratio, 1.0 / ratio) if abs(math.log(factor)) > _LEAST]
    speed, torque = _fitted(evidence, "of_speed"), _fitted(evidence, "of_torque")
    causes: list[tuple[float, ScaleDoubt | None]] = [
        *((left(speed=one), ScaleDoubt(of="speed", factor=one)) for one in (*_MISCOUNTS, *of_gear)),
        *((left(torque=one), ScaleDoubt(of="torque", factor=one)) for one in of_gear),
        # of another propeller and of a gauge that is off by any factor, other rooms judge
        (left(torque=torque) + _FITTED, None),
        (
            sum((item.log / item.std) ** 2 for item in evidence if not item.is_load)
            + _beyond(levels, vessel)
            + _FITTED,
            None,
        ),
    ]
    if abs(math.log(speed)) > _LEAST:
        causes.append((left(speed=speed) + _FITTED, ScaleDoubt(of="speed", factor=speed)))
    cost, doubt = min(causes, key=lambda cause: cause[0])
    return doubt if healthy - cost > _CERTAIN and cost < _EXPLAINS else None


def _fitted(evidence: Sequence[ScaleEvidence], scale: Literal["of_speed", "of_torque"]) -> float:
    """Return the factor of one scale that explains most, by least squares."""
    powers = [(getattr(item, scale), item) for item in evidence]
    weight = sum((power / item.std) ** 2 for power, item in powers)
    return math.exp(sum(power * item.log / item.std**2 for power, item in powers) / weight) if weight else 1.0


def _beyond(levels_rpm: Sequence[float], vessel: "Vessel") -> float:
    """Return how much mean speeds speak against themselves by being beyond what is governed."""
    limits, machine = vessel.limits, vessel.machine
    lowest = min(machine.lowest_governed_rpm, limits.lowest_speed_rpm or math.inf)
    highest = max(machine.rated_speed_rpm, limits.highest_speed_rpm or 0.0)
    farthest = max(
        (max(math.log(lowest / level), math.log(level / highest)) - _BEYOND for level in levels_rpm), default=0.0
    )
    return min((max(farthest, 0.0) / _BEYOND_STD) ** 2, _MOST_BEYOND)
