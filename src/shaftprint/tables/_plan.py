"""A planned test: what it would tell beside what is wished, its legs, and the card for the bridge."""

import math
from typing import TYPE_CHECKING

from shaftprint.digits import fine_unit, interval, plain, rounded, unit_text, with_deviation
from shaftprint.distributions import NORMAL_95
from shaftprint.tables._table import Column, Symbol, Table, numbers, texts
from shaftprint.units import SECONDS_PER_MINUTE

if TYPE_CHECKING:
    from shaftprint.design import AbortCard, PlannedTest
    from shaftprint.identify.fit import Estimate

PERCENT = 100.0


def wish_table(test: "PlannedTest") -> Table:
    """Return what is wished of which number, what is predicted, and what a rehearsal made of it."""
    plan = test.plan
    every = (*plan.predicted.parameters, *plan.predicted.combinations)
    # what is wished first, in the order of the wishes
    names = [*plan.wish.names, *(one.name for one in every if one.name not in plan.wish.names)]
    over = {} if test.rehearsal is None else test.rehearsal.over_planned
    coverage = {} if test.rehearsal is None else test.rehearsal.coverage
    headings: tuple[Column, ...] = (
        *texts("quantity"),
        *numbers("value ± std", "std [%]", "wished std", "of wish", "95 % interval"),
        *texts("unit"),
    )
    if test.rehearsal is not None:
        headings += numbers("rehearsed error / std", "intervals that hold [%]")
    rows = []
    for name in names:
        number = plan.predicted.estimate(name)
        cells = [Symbol(name), *_predicted(number, plan.targets.get(name))]
        if test.rehearsal is not None:
            cells += [plain(over[name], 2), plain(PERCENT * coverage[name], 0)] if name in over else ["", ""]
        rows.append(tuple(cells))
    note = "Predicted for the assumed values, to first order; of wish: predicted over wished, met up to 1."
    return Table(title="Wish against prediction", columns=headings, rows=tuple(rows), note=note)


def planned_leg_table(test: "PlannedTest") -> Table:
    """Return the legs: where, how long, how strong, and what keeps them from being stronger."""
    columns = (
        *texts("leg"),
        *numbers("speed [rpm]", "lines", "highest [Hz]", "periods", "period [s]", "set point [V]", "set point [rpm]"),
        *numbers("speed [rpm] from", "to", "brake torque [N m] from", "to"),
        *texts("bound by"),
    )
    rows = []
    for number, (leg, peaks) in enumerate(zip(test.plan.legs, test.plan.peaks, strict=True), start=1):
        rows.append(
            (
                f"M{number}",
                plain(leg.level_rpm, 0),
                str(len(leg.harmonics)),
                rounded(float(leg.frequency_hz[-1]), 3),
                str(leg.periods),
                plain(leg.period_s, 2),
                f"± {rounded(leg.peak_rpm / abs(test.line.slope_rpm_per_v), 3)}",
                f"± {plain(leg.peak_rpm, 0)}",
                plain(peaks.speed_rpm[0], 0),
                plain(peaks.speed_rpm[1], 0),
                plain(peaks.brake_torque_nm[0], 0),
                plain(peaks.brake_torque_nm[1], 0),
                ", ".join(peaks.binding),
            )
        )
    note = "Speed and torque are the most of all ships that are possible within what is assumed, without noise."
    return Table(title="Legs", columns=columns, rows=tuple(rows), note=note)


def abort_table(card: "AbortCard") -> Table:
    """Return the card for the bridge: what may be seen, and when to stop."""
    leave_low, leave_high = card.leave_rpm
    rows = (
        (
            "engine speed",
            plain(card.speed_rpm[0], 0),
            plain(card.speed_rpm[1], 0),
            "rpm",
            f"stop below {plain(leave_low, 0)} or above {plain(leave_high, 0)} rpm",
        ),
        (
            "brake torque",
            plain(card.brake_torque_nm[0], 0),
            plain(card.brake_torque_nm[1], 0),
            "N·m",
            "stop if the engine smokes, hunts on, or stalls",
        ),
        ("set point", plain(card.set_point_rpm[0], 0), plain(card.set_point_rpm[1], 0), "rpm", ""),
        ("set point", plain(card.set_point_v[0], 2), plain(card.set_point_v[1], 2), "V", "stop if it is another"),
        ("fastest change of the set point", "", plain(card.rate_rpm_per_s, 0), "rpm/s", ""),
        ("length", "", plain(card.duration_s / SECONDS_PER_MINUTE, 1), "min", "keep clear water ahead that long"),
    )
    how = (
        f"To stop: hold the set point at {plain(card.level_v, 2)} V, which asks for {plain(card.level_rpm, 0)} rpm, "
        "take the generator off, then slow down as usual. What was recorded up to then can be used to its last whole "
        "period."
    )
    return Table(
        title="Card for the bridge",
        columns=(*texts("what"), *numbers("lowest", "highest"), *texts("unit", "when to stop")),
        rows=rows,
        note=how,
    )


def _predicted(number: "Estimate", target: float | None) -> tuple[str, ...]:
    half = NORMAL_95 * number.std
    ends = (number.value - half, number.value + half)
    factor, unit = fine_unit(number.unit, number.value, number.std)
    known = math.isfinite(number.std)
    return (
        with_deviation(factor * number.value, factor * number.std),
        _percent(number.std, number.value),
        "" if target is None else rounded(factor * target, 2),
        "" if target is None else rounded(number.std / target, 2),
        interval(factor * ends[0], factor * ends[1], factor * number.std) if known else "",
        unit_text(unit),
    )


def _percent(std: float, value: float) -> str:
    if not math.isfinite(std) or value == 0.0:
        return ""
    return rounded(PERCENT * std / abs(value), 2)
