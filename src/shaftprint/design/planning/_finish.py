"""From amplitudes of any size to a plan: each leg as strong as its limits let it be, and what it then asks for."""

from collections.abc import Sequence
from dataclasses import fields, replace

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.design.motion._motion import motion
from shaftprint.design.plan._leg import Leg, strong_lines
from shaftprint.design.plan._plan import LaidDown, Peaks, Plan, peaks_of, predicted_accuracy
from shaftprint.design.planning._brief import Brief
from shaftprint.design.planning._stairs import stairs_of
from shaftprint.design.planning._start import gentle_start
from shaftprint.design.search._uses import Uses, held_draws

# Share of the possible ships for which every limit of every leg holds.
SHARE_HELD = 0.98
# How many times finer the grid is on which the peaks of a finished plan are taken.
FINE = 4


def plan_of_lines(brief: Brief, amplitudes: Sequence[ComplexArray], table: FloatArray) -> Plan:
    """Return the plan of given amplitudes, each leg scaled until its limits hold for as many ships as they must.

    ``brief``: legs without their amplitudes, and what binds them. ``amplitudes``: complex amplitudes of each leg, of
    any size. ``table``: possible ships, the assumed one first, shape (rows, parameters).
    """
    strong = [strong_lines(lines, leg) for lines, leg in zip(brief.harmonics, amplitudes, strict=True)]
    uses = [brief.uses(number, table, harmonics, FINE) for number, (harmonics, _) in enumerate(strong)]
    held = held_draws(uses, [leg for _, leg in strong], SHARE_HELD)
    finished = []
    for number, ((harmonics, leg), use) in enumerate(zip(strong, uses, strict=True)):
        turned, start_use = gentle_start(
            _of_any_phase(brief, number, harmonics, leg), brief.structures[number], table[0], brief.bounds[number]
        )
        finished.append(_scaled(brief, number, turned, start_use, use.of_draws(held), table[held]))
    legs = tuple(leg for leg, _ in finished)
    predicted = predicted_accuracy(
        brief.structures, legs, brief.noise, values=brief.ship.by_name, priors=brief.priors, earlier=brief.earlier
    )
    return Plan(
        **{field.name: getattr(brief, field.name) for field in fields(LaidDown)},
        legs=legs,
        peaks=tuple(peaks for _, peaks in finished),
        stairs_rpm=stairs_of(brief, table[held]),
        predicted=predicted,
    )


def _of_any_phase(brief: Brief, number: int, harmonics: tuple[int, ...], amplitudes: ComplexArray) -> Leg:
    """Return a leg whose first period begins anywhere, of any size."""
    share = brief.speeds[number]
    return Leg(
        speed_share=share,
        level_rpm=share * brief.limits.engine_speed_rpm,
        period_s=brief.period_s,
        harmonics=harmonics,
        amplitudes=amplitudes,
        periods=brief.periods,
        settle_s=brief.timetable.settle_s,
    )


def _scaled(brief: Brief, number: int, leg: Leg, start_use: float, uses: Uses, table: FloatArray) -> tuple[Leg, Peaks]:
    """Return a leg as strong as its limits let it be for some ships, and what it asks of them.

    ``start_use``: largest use of its limits while it settles. ``uses``: uses of the bounds by the ships that are
    allowed for. ``table``: their parameters, shape (rows, parameters).
    """
    strengths = uses.strengths(leg.amplitudes, brief.bounds[number], brief.limits.share_over)
    strength = float(strengths.min())
    scaled = replace(leg, amplitudes=strength * leg.amplitudes)
    by_name: dict[str, float] = {}
    for bound, use in zip(brief.bounds[number], (strength / strengths).tolist(), strict=True):
        by_name[bound.name] = max(use, by_name.get(bound.name, 0.0))
    responses = motion(brief.structures[number], table, 2.0 * np.pi * leg.frequency_hz)
    ends = extremes(responses, scaled, uses.samples)
    return scaled, peaks_of(scaled, ends, by_name, strength * start_use, brief.limits)


def extremes(responses: ComplexArray, leg: Leg, samples: int) -> FloatArray:
    """Return the lowest and highest deviation of each of ``SIGNALS`` over all ships, shape (signals, 2)."""
    ships, signals, lines = responses.shape
    rows = responses.swapaxes(0, 1).reshape(-1, lines)
    deviations = Uses(transfer=rows, harmonics=leg.harmonics, samples=samples, draws=ships).in_time(leg.amplitudes)
    of_signals = deviations.reshape(signals, -1)
    return np.stack([of_signals.min(axis=1), of_signals.max(axis=1)], axis=1)
