"""The verb ``design_campaign``: lines, amplitudes and phases of every leg that tell most within limits and time."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.design._assumed_line import AssumedLine
from shaftprint.design._brief import Brief
from shaftprint.design._leg import Leg, strong_lines
from shaftprint.design._limits import Limits
from shaftprint.design._motion import motion
from shaftprint.design._plan import Peaks, Plan, SailedTest, peaks_of, predicted_accuracy
from shaftprint.design._start import gentle_start
from shaftprint.design._timetable import Timetable
from shaftprint.design._wish import Wish, numbers_of_line
from shaftprint.design.search import (
    Criterion,
    DeterminantWithFloor,
    Effort,
    Possibility,
    Problem,
    Uses,
    WorstWish,
    held_draws,
    random_start,
    search,
)
from shaftprint.identify import NoiseLevels, Prior
from shaftprint.identify.prediction import LineInformation

# Share of the lines that may be for which every limit of every leg holds.
SHARE_HELD = 0.98
# How many times finer the grid is on which the peaks of a finished plan are taken.
_FINE = 4


def design_campaign(
    line: AssumedLine,
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
    """Return the plan of a test that tells most of a line within its limits and a time.

    The unknowns are the complex amplitudes of odd harmonics of every leg, so that spectrum and phases are chosen
    together. Without wishes the volume of the numbers' ellipsoid is made small; with wishes the worst deviation over
    its wish. Limits hold for 98 % of the lines that may be; the accuracy is averaged over some of them.

    Parameters
    ----------
    line
        What is assumed of the line, and how well.
    wish
        What is wanted.
    limits
        What ship and engine allow.
    noise
        Noise of the outputs over their working-point values, the same at all speeds, or that of each speed by its
        share.
    speeds
        Mean speed of each leg over that of the first working point, in the order in which they are sailed.
    within_s
        Length of the test [s].
    rng
        Draws the lines that may be, and the starts of the search.
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
        line, wish, limits, noise, speeds=speeds, within_s=within_s, priors=priors or {},
        timetable=timetable or Timetable(), earlier=earlier,
    )  # fmt: skip
    return best_plan(brief, effort or Effort(), rng)


def best_plan(brief: Brief, effort: Effort, rng: np.random.Generator, start: FloatArray | None = None) -> Plan:
    """Return the best plan of several random starts, or that of one start."""
    table = brief.line.draws(effort.peak_draws, rng)
    possibilities, criterion = _wanted(brief, table[: effort.accuracy_draws])
    problem = Problem(
        possibilities=possibilities,
        uses=tuple(brief.uses(leg, table) for leg in range(len(brief.speeds))),
        seconds=brief.seconds,
        criterion=criterion,
        power=effort.powers[-1],
    )
    starts = [random_start(problem, rng) for _ in range(effort.restarts)] if start is None else [start]
    results = [search(problem, one, effort, share_held=SHARE_HELD) for one in starts]
    _, unknowns = min(results, key=lambda result: result[0])
    return plan_of_lines(brief, problem.split(unknowns), table)


def plan_of_lines(brief: Brief, amplitudes: Sequence[ComplexArray], table: FloatArray) -> Plan:
    """Return the plan of given amplitudes, each leg scaled until its limits hold for as many lines as they must.

    Parameters
    ----------
    amplitudes
        Complex amplitudes of each leg, of any size.
    table
        Lines that may be, the assumed one first, shape (rows, parameters).
    """
    strong = [strong_lines(lines, leg) for lines, leg in zip(brief.harmonics, amplitudes, strict=True)]
    uses = [brief.uses(number, table, harmonics, _FINE) for number, (harmonics, _) in enumerate(strong)]
    held = held_draws(uses, [leg for _, leg in strong], SHARE_HELD)
    legs, peaks = [], []
    for number, (share, (harmonics, leg), use) in enumerate(zip(brief.speeds, strong, uses, strict=True)):
        allowed = use.of_draws(held)
        about = Leg(
            speed_share=share,
            level_rpm=share * brief.limits.engine_speed_rpm,
            period_s=brief.period_s,
            harmonics=harmonics,
            amplitudes=leg,
            periods=brief.periods,
            settle_s=brief.timetable.settle_s,
        )
        turned, start_use = gentle_start(about, brief.structures[number], table[0], brief.bounds[number])
        largest = allowed.largest(turned.amplitudes).max()
        legs.append(replace(turned, amplitudes=turned.amplitudes / largest))
        peaks.append(_peaks(brief, number, legs[-1], allowed, table[held], start_use / largest))
    return Plan(
        line=brief.line, wish=brief.wish, limits=brief.limits, priors=brief.priors, timetable=brief.timetable,
        noise=brief.noise, structures=brief.structures, legs=tuple(legs), peaks=tuple(peaks), earlier=brief.earlier,
        predicted=predicted_accuracy(
            brief.structures, legs, brief.noise, values=brief.line.by_name, priors=brief.priors, earlier=brief.earlier
        ),
    )  # fmt: skip


def _peaks(brief: Brief, number: int, leg: Leg, uses: Uses, table: FloatArray, start_use: float) -> Peaks:
    """Return what a leg asks for, among the lines for which its limits hold."""
    largest: dict[str, float] = {}
    for bound, use in zip(brief.bounds[number], uses.largest(leg.amplitudes).max(axis=1).tolist(), strict=True):
        largest[bound.name] = max(use, largest.get(bound.name, 0.0))
    responses = motion(brief.structures[number], table, 2.0 * np.pi * leg.frequency_hz)
    signals = Uses(
        transfer=responses.swapaxes(0, 1).reshape(-1, len(leg.harmonics)), harmonics=leg.harmonics,
        samples=uses.samples, draws=table.shape[0],
    ).in_time(leg.amplitudes).reshape(responses.shape[1], -1)  # fmt: skip
    return peaks_of(leg, np.stack([signals.min(axis=1), signals.max(axis=1)], axis=1), largest, start_use, brief.limits)


def _wanted(brief: Brief, table: FloatArray) -> tuple[tuple[Possibility, ...], Criterion]:
    """Return information and wanted numbers for some lines that may be, and what is made small."""
    assumed = brief.information(table[0])
    targets = brief.wish.targets(assumed.values) or {
        name: abs(assumed.values[name]) or 1.0 for name in numbers_of_line(brief.line.structure)
    }
    criterion = WorstWish() if brief.wish.names else DeterminantWithFloor(brief.wish.floor)
    every = [assumed, *(brief.information(values) for values in table[1:])]
    return tuple(_possibility(information, targets) for information in every), criterion


def _possibility(information: LineInformation, targets: Mapping[str, float]) -> Possibility:
    """Return a line that may be; a parameter of which nothing is told is known to the width of its bounds.

    Without that a direction that a test cannot show, such as a common factor at a single speed, would make every
    design equally bad.
    """
    columns = [information.slopes[name] / target for name, target in targets.items()]
    return Possibility(
        of_lines=information.of_lines,
        of_priors=information.of_priors + np.diag(1.0 / information.ranges**2),
        slopes=np.stack(columns, axis=1),
    )
