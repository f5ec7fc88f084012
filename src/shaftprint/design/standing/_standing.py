"""The noun ``Standing``: what is known of a planned test that was sailed so far, and what is still missing.

Whether to stop is decided by predicted deviations, not by those that were estimated with the result: a test that stops
as soon as its estimated deviations are small stops when they happen to be too small, and its intervals then hold the
truth too seldom (Anscombe, Sequential estimation, J. R. Stat. Soc. B 15, 1953). What is predicted rests on the lines of
the plan, the periods that were recorded, the fitted values, and the plan's noise, scaled by one number for all lines.
That noise is estimated from few samples at slow lines, whose number is no matter of chance: what it costs is counted.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.campaign._leg import first_name
from shaftprint.design.inputs._assumed_ship import AssumedShip, ship_of_fit
from shaftprint.design.motion._bounds import bounds_of_leg
from shaftprint.design.motion._motion import motion, motion_noise
from shaftprint.design.plan._plan import Peaks, Plan, peaks_of, predicted_accuracy
from shaftprint.design.planned_test._planned_test import PlannedTest, SailedLeg
from shaftprint.design.planning._finish import FINE, SHARE_HELD, extremes
from shaftprint.design.search._uses import Uses
from shaftprint.design.standing._periods import PeriodInformation, missing_periods, period_information
from shaftprint.errors import DesignError
from shaftprint.identify.prediction._planned_response import planned_lines
from shaftprint.models._working_point import at_working_point
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary
from shaftprint.units import SECONDS_PER_MINUTE

if TYPE_CHECKING:
    from shaftprint.design.plan._leg import Leg
    from shaftprint.identify.fit._identification import Identification

# A further leg has so many periods at least: the noise is what differs between them.
FEWEST_MORE = 2
# The test of fit below which the model does not explain what was recorded.
_LEAST_P_VALUE = 0.01
# Beyond these the noise is not that of the plan, over its density.
_ALIKE = (0.7, 1.4)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Standing(Shown):
    """How far a planned test has come."""

    test: PlannedTest
    """What was planned."""
    fit: "Identification"
    """What the recordings give so far, normalised at the working point of the plan."""
    recorded: Mapping[str, int]
    """Whole periods that were recorded of each leg, by its name."""
    noise_ratio: float
    """Density of the noise over that of the plan, the median over all lines."""
    ratios: Mapping[str, float]
    """Predicted deviation so far over the wish, by name."""
    targets: Mapping[str, float]
    """Wished standard deviations in the numbers' units, by name."""
    more: Mapping[str, int] | None
    """Further periods of each leg that meet every wish, by its name; None where no number of them does."""
    remaining: PlannedTest | None
    """The test that is still missing; None where nothing is, or nothing helps."""

    def summary(self) -> Summary:
        """Return what is met and what is missing."""
        return Summary(title=f"Standing of {self.test.name}", facts={"": " ".join(self.sentences)})

    @property
    def is_enough(self) -> bool:
        """Whether nothing is missing."""
        return self.more is not None and not any(self.more.values())

    @property
    def sentences(self) -> tuple[str, ...]:
        """What is met and what is missing, the answer first."""
        return (self._answer(), *self._missed(), *self._doubts())

    def _answer(self) -> str:
        if self.more is None:
            return (
                "The wishes are not met, and no number of further periods of these lines meets them: plan another test "
                "after this one."
            )
        periods = " and ".join(f"{count} of {name}" for name, count in self.more.items() if count)
        if not periods:
            return "Every wish is met, as predicted." if self.targets else "The whole plan is recorded."
        if not self.targets:
            return f"Nothing is wished; of the plan {periods} periods are missing."
        minutes = 0.0 if self.remaining is None else self.remaining.campaign.duration_s / SECONDS_PER_MINUTE
        return f"The wishes are not all met; {periods} more periods do it, {minutes:.1f} min with their ramps."

    def _missed(self) -> list[str]:
        return [
            f"{name} is predicted to {ratio:.3g} times its wish so far."
            for name, ratio in sorted(self.ratios.items(), key=lambda pair: -pair[1])
            if ratio > 1.0
        ]

    def _doubts(self) -> list[str]:
        sentences = []
        low, high = _ALIKE
        if not low <= self.noise_ratio <= high:
            sentences.append(
                f"The noise is {self.noise_ratio:.2g} times as dense as planned with, which is counted; for another "
                "plan give the recording with --noise-from."
            )
        p_value = self.fit.p_value
        if p_value is not None and p_value < _LEAST_P_VALUE:
            sentences.append(
                f"The model does not explain what was recorded (p = {p_value:.1g}): more periods will not mend that; "
                "look at it with shaftprint identify."
            )
        return sentences


def standing_of(
    test: PlannedTest,
    fit: "Identification",
    sailed: Sequence[SailedLeg],
    recorded: Mapping[str, int],
    *,
    now: datetime,
    seed: int = 1,
) -> Standing:
    """Return how far a planned test has come.

    ``test``: what was planned. ``fit``: the joint fit of all that was recorded, normalised at the working point of the
    plan. ``sailed``: legs of this recording, by their names in the campaign of the plan. ``recorded``: whole periods of
    each of them, by name. ``now``: when it is done, with time zone. ``seed``: of the possible ships whose peaks are
    looked at. Raises DesignError if nothing of the plan was recorded, or the fit is of another structure.
    """
    plan, names = test.plan, tuple(f"M{number}" for number in range(1, len(test.plan.legs) + 1))
    # what was played again counts with what it repeats
    counts = tuple(sum(many for one, many in recorded.items() if first_name(one) == name) for name in names)
    if not any(counts):
        raise DesignError(f"plan {test.name}: expected a leg such as {names[0]} in the recording, found none.")
    ship = updated_ship(plan, fit)
    ratio = _noise_ratio(plan, names, sailed, recorded)
    noise = tuple(level.times(ratio) for level in plan.noise)
    costs = [_cost(leg, name, sailed) for leg, name in zip(plan.legs, names, strict=True)]
    so_far = period_information(plan, noise, values=ship.by_name, costs=costs)
    legs, peaks = legs_within(plan, ship, np.random.default_rng(seed))
    further = period_information(replace(plan, legs=tuple(legs)), noise, values=ship.by_name, costs=costs)
    further = replace(further, before=so_far.after(counts))
    more = _more(plan, further, counts)
    by_name = None if more is None else dict(zip(names, more, strict=True))
    remaining = None
    if more is not None and any(more):
        changed = replace(plan, ship=ship, legs=legs, peaks=peaks, noise=noise)
        remaining = _remaining(replace(test, plan=changed), sailed, more, now=now)
    return Standing(
        test=test,
        fit=fit,
        recorded=dict(zip(names, counts, strict=True)),
        noise_ratio=ratio,
        ratios=so_far.ratios(counts),
        targets=so_far.targets,
        more=by_name,
        remaining=remaining,
    )


def _more(plan: Plan, information: PeriodInformation, counts: tuple[int, ...]) -> tuple[int, ...] | None:
    """Return the further periods of each leg: for the wishes, or what is left of a plan without any."""
    if plan.wish.names:
        return missing_periods(information, fewest=FEWEST_MORE)
    left = [max(leg.periods - count, 0) for leg, count in zip(plan.legs, counts, strict=True)]
    return tuple(max(count, FEWEST_MORE) if count else 0 for count in left)


def _remaining(test: PlannedTest, sailed: Sequence[SailedLeg], more: Sequence[int], *, now: datetime) -> PlannedTest:
    """Return the legs that are still missing, with what was recorded as earlier tests."""
    plan = test.plan
    kept = [place for place, count in enumerate(more) if count]
    legs = tuple(replace(plan.legs[place], periods=more[place]) for place in kept)
    every = (*test.sailed, *sailed)
    structures, levels = tuple(plan.structures[place] for place in kept), tuple(plan.noise[place] for place in kept)
    earlier = tuple(
        (
            at_working_point(plan.ship.structure, speed_share=one.speed_share, torque_share=one.torque_share),
            one.response,
        )
        for one in every
    )
    further = replace(
        plan,
        legs=legs,
        structures=structures,
        noise=levels,
        peaks=tuple(plan.peaks[place] for place in kept),
        # it is about the level of the first leg, for which its height was found
        stairs_rpm=plan.stairs_rpm if 0 in kept else (),
        # the noise is known now
        band=None,
        earlier=earlier,
        predicted=predicted_accuracy(
            structures, legs, levels, values=plan.ship.by_name, priors=plan.priors, earlier=earlier
        ),
    )
    return replace(test, plan=further, created=now, rehearsal=None, remedies=(), sailed=every)


def _cost(leg: "Leg", name: str, sailed: Sequence[SailedLeg]) -> FloatArray:
    """Return by what factor the covariance of each line counts larger, as it is estimated; 1 of what was not sailed."""
    factors = {
        line.rpartition("/")[2]: factor
        for one in sailed
        if first_name(one.name) == name
        for line, factor in zip(one.response.lines, one.response.weight_factors.tolist(), strict=True)
    }
    return np.array([factors.get(str(harmonic), 1.0) for harmonic in leg.harmonics])


def _noise_ratio(plan: Plan, names: Sequence[str], sailed: Sequence[SailedLeg], recorded: Mapping[str, int]) -> float:
    """Return the median, over the used lines, of the measured covariance of the errors over that of the plan."""
    ratios: list[float] = []
    for one in sailed:
        place = names.index(first_name(one.name))
        leg, response = plan.legs[place], one.response
        planned = planned_lines(
            leg.frequency_hz,
            noise=plan.noise[place].of_outputs(*response.outputs),
            amplitude=np.abs(leg.amplitudes),
            duration_s=recorded[one.name] * leg.period_s,
            lines=[f"{one.name}/{harmonic}" for harmonic in leg.harmonics],
        )
        rows = {name: row for row, name in enumerate(planned.lines)}
        of_errors = response.covariance / response.weight_factors[:, np.newaxis, np.newaxis]
        for line, name in enumerate(response.lines):
            if response.used[line] and name in rows:
                whitened = np.linalg.solve(planned.covariance[rows[name]], of_errors[line])
                ratios.append(float(np.trace(whitened)) / len(whitened))
    return float(np.median(ratios)) if ratios else 1.0


_SHIPS = 200


def updated_ship(plan: Plan, fit: "Identification") -> AssumedShip:
    """Return the ship as it was assumed and as it was found, together: two normal distributions of one ship.

    What was assumed to be exact is taken as it was found, without a deviation: it does not move peaks.
    """
    assumed, measured = plan.ship, ship_of_fit(plan.ship.structure, fit)
    prior, data = assumed.covariance, measured.covariance
    open_ = np.flatnonzero((np.diag(prior) > 0.0) & (np.diag(data) > 0.0) & np.isfinite(np.diag(data)))
    if not open_.size:
        return replace(measured, covariance=frozen_float(np.zeros_like(prior)))
    block = np.ix_(open_, open_)
    before, told = np.linalg.inv(prior[block]), np.linalg.inv(data[block])
    covariance = np.zeros_like(prior)
    covariance[block] = np.linalg.inv(before + told)
    values = measured.values.copy()
    values[open_] = covariance[block] @ (before @ assumed.values[open_] + told @ measured.values[open_])
    return replace(measured, values=frozen_float(values), covariance=frozen_float(covariance))


def legs_within(plan: Plan, ship: AssumedShip, rng: np.random.Generator) -> tuple[tuple["Leg", ...], tuple[Peaks, ...]]:
    """Return the legs of a plan, weakened where a ship asks for more than its limits, and what they ask for.

    Limits hold for 98 % of the possible ships, as in the plan. Where most of those are unstable, so that nothing can be
    said of their peaks, the ship alone counts.
    """
    try:
        table = ship.draws(_SHIPS, rng)
    except DesignError:
        table = ship.values[None, :]
    every = [_leg_within(plan, place, ship, table) for place in range(len(plan.legs))]
    return tuple(leg for leg, _ in every), tuple(peaks for _, peaks in every)


def _leg_within(plan: Plan, place: int, ship: AssumedShip, table: "FloatArray") -> tuple["Leg", Peaks]:
    leg, structure = plan.legs[place], plan.structures[place]
    bounds = bounds_of_leg(plan.limits, leg.speed_share, motion_noise(structure, ship.values, plan.noise[place]))
    responses = motion(structure, table, 2.0 * np.pi * leg.frequency_hz)
    uses = Uses.of(responses, bounds, leg.harmonics, FINE)
    largest = uses.largest(leg.amplitudes)
    held = np.argsort(largest.max(axis=0), kind="stable")[: int(np.ceil(SHARE_HELD * len(table)))]
    strengths = uses.of_draws(held).strengths(leg.amplitudes, bounds, plan.limits.share_over)
    strength = min(1.0, float(strengths.min()))
    scaled = replace(leg, amplitudes=strength * leg.amplitudes)
    by_name: dict[str, float] = {}
    for bound, use in zip(bounds, (strength / strengths).tolist(), strict=True):
        by_name[bound.name] = max(use, by_name.get(bound.name, 0.0))
    ends = extremes(responses[held], scaled, uses.samples)
    return scaled, peaks_of(scaled, ends, by_name, strength * plan.peaks[place].start_use, plan.limits)
