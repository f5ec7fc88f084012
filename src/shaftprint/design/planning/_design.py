"""The verb ``design_campaign``: lines, amplitudes and phases of every leg that tell most within limits and time."""

from collections.abc import Mapping, Sequence

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.design.inputs._assumed_ship import AssumedShip
from shaftprint.design.inputs._gauge_range import FULL_SCALE
from shaftprint.design.inputs._limits import Limits
from shaftprint.design.inputs._wish import Wish, numbers_of_line
from shaftprint.design.motion._gauge import share_cut_off
from shaftprint.design.motion._motion import motion
from shaftprint.design.plan._plan import Plan, SailedTest
from shaftprint.design.plan._timetable import Timetable
from shaftprint.design.planning._brief import Brief
from shaftprint.design.planning._finish import SHARE_HELD, plan_of_lines
from shaftprint.design.search._criterion import Criterion, DeterminantWithFloor, WorstWish
from shaftprint.design.search._problem import Possibility, Problem
from shaftprint.design.search._search import Effort, random_start, search
from shaftprint.design.search._uses import Uses, samples_of_period
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.prediction._line_information import LineInformation
from shaftprint.identify.prediction._noise_levels import NoiseLevels


def design_campaign(
    ship: AssumedShip,
    wish: Wish,
    limits: Limits,
    noise: NoiseLevels | Mapping[float, NoiseLevels],
    *,
    speeds: Sequence[float],
    within_s: float,
    rng: np.random.Generator,
    priors: Mapping[str, Prior] | None = None,
    earlier: Sequence[SailedTest] = (),
    timetable: Timetable | None = None,
    effort: Effort | None = None,
) -> Plan:
    """Return the plan of a test that tells most of a propulsion line within its limits and a time.

    The unknowns are the complex amplitudes of odd harmonics of every leg, so that spectrum and phases are chosen
    together. Without wishes the volume of the numbers' ellipsoid is made small; with wishes the worst deviation over
    its wish. Limits hold for 98 % of the possible ships; the accuracy is averaged over some of them.

    Parameters
    ----------
    ship
        What is assumed of the ship, and how well.
    wish
        What is wanted.
    limits
        What ship and engine allow.
    noise
        Noise of the outputs over their working-point values: the same at all speeds, or by the share of the speed,
        between which it is interpolated.
    speeds
        Mean speed of each leg over that of the first working point, in the order in which they are sailed.
    within_s
        Length of the test [s].
    rng
        Draws the possible ships, and the starts of the search.
    priors
        What the fit will know besides, by name of the parameter.
    earlier
        Tests that were sailed before and will be fitted together with this one.
    timetable
        What is spent on other things than windows, and the period.
    effort
        What the search may cost.

    Raises
    ------
    DesignError
        If there is no such plan: no speed, no room below a limit, too little time, an unknown wish.
    """
    brief = Brief.of(
        ship,
        wish,
        limits,
        noise,
        speeds=speeds,
        within_s=within_s,
        priors=priors or {},
        timetable=timetable or Timetable(),
        earlier=earlier,
    )
    return best_plan(brief, effort or Effort(), rng)


def best_plan(brief: Brief, effort: Effort, rng: np.random.Generator) -> Plan:
    """Return the best plan of several random starts.

    The full scale of the gauge is looked for only where a plan that knows nothing of it would pass it: on most ships
    engine and governor keep the torque far below, and their plans are the same with it and without. How much is kept
    free at crests follows from how many samples may be cut off: where crests are long, or orders large, it is more.
    """
    table = brief.ship.draws(effort.peak_draws, rng)
    free = brief.without_gauge()
    plan, found = _best_of_starts(free, effort, rng, table)
    if free.bounds == brief.bounds:
        return plan
    for crest in CRESTS:
        higher = brief.with_crest(crest)
        plan = plan_of_lines(higher, found, table)
        is_enough = is_shown(plan, table)
        if is_enough and not any(peaks.uses[FULL_SCALE] == max(peaks.uses.values()) for peaks in plan.peaks):
            break
        if is_enough or crest == CRESTS[-1]:
            plan, _ = _best_of_starts(higher, effort, rng, table)
            if is_shown(plan, table):
                break
    return plan


def _best_of_starts(
    brief: Brief, effort: Effort, rng: np.random.Generator, table: FloatArray
) -> tuple[Plan, list[ComplexArray]]:
    """Return the best plan of random starts, and the amplitudes that it was made of.

    ``table``: possible ships, the assumed one first, shape (rows, parameters).
    """
    possibilities, criterion = _wanted(brief, table[: effort.accuracy_draws])
    problem = Problem(
        possibilities=possibilities,
        uses=tuple(brief.uses(leg, table) for leg in range(len(brief.speeds))),
        seconds=brief.seconds,
        criterion=criterion,
        power=effort.powers[-1],
    )
    begun = [random_start(problem, rng) for _ in range(effort.restarts)]
    found = [problem.split(search(problem, one, effort, share_held=SHARE_HELD)[1]) for one in begun]
    # the search holds few ships and a smooth norm; which start was best is seen when all peaks have been looked at
    plans = [(plan_of_lines(brief, amplitudes, table), amplitudes) for amplitudes in found]
    return min(plans, key=lambda pair: _missing(pair[0]))


def _missing(plan: Plan) -> float:
    """Return what is made small, of a finished plan: the worst ratio to a wish, or the mean logarithm of deviations."""
    if plan.wish.names:
        return max(plan.ratios.values())
    numbers = [plan.predicted.estimate(name) for name in numbers_of_line(plan.ship.structure)]
    return float(np.mean([np.log(np.hypot(one.std / (abs(one.value) or 1.0), plan.wish.floor)) for one in numbers]))


def _wanted(brief: Brief, table: FloatArray) -> tuple[tuple[Possibility, ...], Criterion]:
    """Return information and wanted numbers for some possible ships, and what is made small."""
    assumed = brief.information(table[0])
    targets = brief.wish.targets(assumed.values) or {
        name: abs(assumed.values[name]) or 1.0 for name in numbers_of_line(brief.ship.structure)
    }
    criterion = WorstWish() if brief.wish.names else DeterminantWithFloor(brief.wish.floor)
    every = [assumed, *(brief.information(values) for values in table[1:])]
    return tuple(_possibility(information, targets) for information in every), criterion


def _possibility(information: LineInformation, targets: Mapping[str, float]) -> Possibility:
    """Return a possible ship; a parameter of which nothing is told is known to the width of its bounds.

    Without that a direction that a test cannot show, such as a common factor at a single speed, would make every
    design equally bad.
    """
    columns = [information.slopes[name] / target for name, target in targets.items()]
    return Possibility(
        of_lines=information.of_lines,
        of_priors=information.of_priors + np.diag(1.0 / information.ranges**2),
        slopes=np.stack(columns, axis=1),
    )


CRESTS = (0.8, 0.9, 1.0, 1.1, 1.2, 1.3)
"""How many times the ripple is kept free at crests, tried one after the other; one in 10,000 passes the last."""

# Share of the samples of a test that may be expected to be cut off: for the assumed ship, and for nearly all that are
# possible, whose recordings identify refuses with more.
_USUAL, _MOST = 3e-4, 1e-3
# Samples a period of the fastest line.
_SAMPLES = 16


def is_shown(plan: Plan, table: FloatArray) -> bool:
    """Return whether at most 3 in 10,000 samples of a test are expected beyond full scale, and 1 in 1000 for others.

    ``table``: possible ships, the assumed one first, shape (rows, parameters).
    """
    cut_off = np.zeros(len(table))
    for number, leg in enumerate(plan.legs):
        cut_off += leg.duration_s / plan.duration_s * _cut_off(plan, number, table)
    return bool(cut_off[0] <= _USUAL and np.quantile(cut_off, SHARE_HELD) <= _MOST)


def _cut_off(plan: Plan, number: int, table: FloatArray) -> FloatArray:
    """Return the share of a leg's samples that is cut off for each ship, shape (rows,)."""
    leg = plan.legs[number]
    responses = motion(plan.structures[number], table, 2.0 * np.pi * leg.frequency_hz)
    ships, signals, lines = responses.shape
    samples = samples_of_period(leg.harmonics[-1], _SAMPLES)
    uses = Uses(transfer=responses.reshape(-1, lines), harmonics=leg.harmonics, samples=samples, draws=ships)
    deviations = uses.in_time(leg.amplitudes).reshape(ships, signals, samples)
    return np.array([share_cut_off(plan.limits, leg.speed_share, one) for one in deviations])
