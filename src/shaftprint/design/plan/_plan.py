"""The noun ``Plan``: a test that is designed, with what it would tell and what it asks of ship and engine."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TypeAlias

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.design.inputs._assumed_ship import AssumedShip
from shaftprint.design.inputs._limits import Limits
from shaftprint.design.inputs._wish import Wish
from shaftprint.design.plan._band import Band
from shaftprint.design.plan._leg import Leg
from shaftprint.design.plan._timetable import Timetable
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.prediction._accuracy import Accuracy, predict_joint_accuracy
from shaftprint.identify.prediction._noise_levels import NoiseLevels
from shaftprint.identify.prediction._planned_response import planned_lines
from shaftprint.models._structure import Structure
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra.legs._leg_lines import leg_freedom
from shaftprint.units import SECONDS_PER_MINUTE

# A longer test is stated in hours.
_LONGEST_IN_MINUTES = 200.0

SailedTest: TypeAlias = tuple[Structure, FrequencyResponse]
"""A structure as it is normalised where a test was sailed, and the response that was measured."""

# A limit binds when a leg uses so much of it.
BINDS = 0.98


def length_words(seconds: float) -> str:
    """Return the length of a test in words, the same wherever it is stated."""
    minutes = seconds / SECONDS_PER_MINUTE
    return f"{minutes:.3g} min" if minutes < _LONGEST_IN_MINUTES else f"{minutes / 60.0:,.0f} h"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Peaks(Shown):
    """The most that a leg asks for, among the ships for which its limits hold; noise comes on top."""

    set_point_rpm: float
    """Largest deviation of the set point from its level [rpm]."""
    rate_rpm_per_s: float
    """Fastest change of the set point [rpm/s]."""
    speed_rpm: tuple[float, float]
    """Lowest and highest engine speed [rpm]."""
    brake_torque_nm: tuple[float, float]
    """Lowest and highest brake torque [N m]."""
    torque_demand_nm: tuple[float, float]
    """Lowest and highest brake torque that the governor asks for, before delay and lag [N m]."""
    uses: Mapping[str, float]
    """Largest use of each limit, by its name: peak over what the limit leaves, noise taken off; at most 1."""

    start_use: float
    """Largest use of the limits by the assumed ship from the start of the leg to its window, at most about 1."""

    @property
    def binding(self) -> tuple[str, ...]:
        """Names of the limits that keep the leg from being stronger."""
        return tuple(name for name, use in self.uses.items() if use > BINDS)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class LaidDown:
    """What is laid down before a test is designed."""

    ship: AssumedShip
    """What is assumed of the ship."""
    wish: Wish
    """What is wanted."""
    limits: Limits
    """What ship and engine allow."""
    priors: Mapping[str, Prior]
    """What the fit will know besides."""
    timetable: Timetable
    """How the time is divided."""
    noise: tuple[NoiseLevels, ...]
    """Noise at each leg."""
    structures: tuple[Structure, ...]
    """The structure as it is normalised at each leg."""
    earlier: tuple[SailedTest, ...] = ()
    """Tests that were sailed before and are fitted together with this one."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Plan(LaidDown, Shown):
    """A test that is designed but not rehearsed: its numbers are predicted."""

    legs: tuple[Leg, ...]
    """The legs, in the order in which they are sailed."""
    peaks: tuple[Peaks, ...]
    """The most that each leg asks for."""
    stairs_rpm: tuple[float, ...] = ()
    """Levels of the staircase at the end, as deviations from the level of the first leg [rpm]; none without one."""
    band: Band | None = None
    """How far what is predicted reaches, where ship or noise are not known; None where it was not looked for."""
    predicted: Accuracy
    """How well the numbers would be known, at the assumed values and to first order."""

    def summary(self) -> Summary:
        """Return length, legs, and each wish with what is predicted."""
        promised = self.promised
        numbers = {
            name: f"{promised[name].std:.3g} predicted, {target:.3g} wished" for name, target in self.targets.items()
        }
        facts = {
            "length": f"{length_words(self.duration_s)}, not rehearsed",
            "legs": ", ".join(f"{leg.level_rpm:.0f} rpm +/- {leg.peak_rpm:.0f}" for leg in self.legs),
            **numbers,
            "limits that bind": ", ".join(dict.fromkeys(name for peaks in self.peaks for name in peaks.binding)),
        }
        return Summary(title=f"Plan for {self.ship.structure.name}", facts=facts)

    @property
    def duration_s(self) -> float:
        """Length of the test [s], from the first second to the last: what is put out and recorded."""
        return self.stairs_start_s + self.timetable.dwell_s * len(self.stairs_rpm)

    @property
    def stairs_start_s(self) -> float:
        """When the staircase begins, after the way back to the level of the first leg [s]; the end without one."""
        last = self.legs[-1]
        back_s = self.timetable.ramp_s(last.level_rpm, self.legs[0].level_rpm)
        return self.starts_s[-1] + last.duration_s + back_s + self.timetable.rest_s

    @property
    def starts_s(self) -> tuple[float, ...]:
        """When the multisine of each leg begins, after the ramp to its level [s]."""
        starts = [self.timetable.lead_s]
        for before, leg in pairwise(self.legs):
            starts.append(starts[-1] + before.duration_s + self.timetable.ramp_s(before.level_rpm, leg.level_rpm))
        return tuple(starts)

    @property
    def promised(self) -> dict[str, Estimate]:
        """Every number at its assumed value, with the standard deviation of the middle of the possible ships."""
        middle = {} if self.band is None else self.band.middle
        return {one.name: replace(one, std=one.std * middle.get(one.name, 1.0)) for one in self.predicted.numbers}

    @property
    def targets(self) -> dict[str, float]:
        """Wished standard deviations in the numbers' units, by name."""
        values = {e.name: e.value for e in self.predicted.numbers}
        return self.wish.targets(values)

    @property
    def ratios(self) -> dict[str, float]:
        """Promised standard deviation over the wish, by name; the slack is what is missing to 1."""
        promised = self.promised
        return {name: promised[name].std / target for name, target in self.targets.items()}

    @property
    def is_enough(self) -> bool:
        """Whether every wish is met, as predicted."""
        return all(ratio <= 1.0 for ratio in self.ratios.values())

    @property
    def seconds_per_wish(self) -> dict[str, float]:
        """Length of a test like this one in which each wish alone would be met [s], priors counted as data.

        Deviations fall with the root of the time in the windows; infinite for what such a test does not show.
        """
        window_s = sum(leg.window_s for leg in self.legs)
        return {name: self.duration_s + window_s * (ratio**2 - 1.0) for name, ratio in self.ratios.items()}


def noise_freedom(legs: Sequence[Leg]) -> list[FloatArray]:
    """Return the degrees of freedom from which the noise of each line will be estimated, an array a leg."""
    return [leg_freedom(leg.harmonics, leg.periods) for leg in legs]


def predicted_accuracy(
    structures: Sequence[Structure],
    legs: Sequence[Leg],
    noise: Sequence[NoiseLevels],
    *,
    values: Mapping[str, float],
    priors: Mapping[str, Prior],
    earlier: Sequence[SailedTest] = (),
) -> Accuracy:
    """Return how well the legs and earlier tests together would find the parameters, in noise that is known."""
    pairs = [
        (
            structure,
            planned_lines(
                leg.frequency_hz,
                noise=level,
                amplitude=np.abs(leg.amplitudes),
                duration_s=leg.window_s,
            ),
        )
        for structure, leg, level in zip(structures, legs, noise, strict=True)
    ]
    return predict_joint_accuracy([*pairs, *earlier], values=values, priors=priors)


def peaks_of(leg: Leg, extremes: FloatArray, uses: Mapping[str, float], start_use: float, limits: Limits) -> Peaks:
    """Return the peaks of a leg in the units of the ship.

    ``extremes``: lowest and highest deviation of each of ``SIGNALS``, shape (signals, 2). ``uses``: largest use of each
    limit.
    """
    speed, torque = leg.level_rpm, leg.speed_share**2 * limits.brake_torque_nm
    low, high = extremes.T.tolist()
    return Peaks(
        set_point_rpm=speed * max(-low[0], high[0]),
        rate_rpm_per_s=speed * max(-low[1], high[1]),
        speed_rpm=(speed * (1.0 + low[2]), speed * (1.0 + high[2])),
        brake_torque_nm=(torque * (1.0 + low[3]), torque * (1.0 + high[3])),
        torque_demand_nm=(torque * (1.0 + low[4]), torque * (1.0 + high[4])),
        uses=dict(uses),
        start_use=start_use,
    )
