"""A planned test: what it would tell beside what is wished, its legs, and the card for the bridge."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from shaftprint.design.plan._plan import length_words
from shaftprint.digits import fine_unit, interval, plain, rounded, unit_text, with_deviation
from shaftprint.distributions import NORMAL_95
from shaftprint.plain_table import Symbol, Table, numbers, texts
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.design.inputs._lever import Lever
    from shaftprint.design.inputs._set_point_line import SetPointLine
    from shaftprint.design.planned_test._planned_test import PlannedTest
    from shaftprint.design.standing._standing import Standing
    from shaftprint.design.views._abort_card import AbortCard
    from shaftprint.identify.fit._estimate import Estimate

_FIRST_ORDER = "Predicted to first order, for the middle of the possible ships"


def wish_table(test: "PlannedTest") -> Table:
    """Return what is wished, what is predicted, and what a rehearsal made of it; no rows where nothing is wished."""
    targets = test.plan.targets
    table = _number_table(test, test.plan.wish.names, "Wish against prediction")
    if not table.rows:
        return table
    rows = []
    for name, row in zip(test.plan.wish.names, table.rows, strict=True):
        number = test.plan.promised[name]
        factor, _ = fine_unit(number.unit, number.value, number.std)
        wish = (rounded(factor * targets[name], 2), rounded(number.std / targets[name], 2))
        rows.append((*row[:3], *wish, *row[3:]))
    columns = (*table.columns[:3], *numbers("wished std", "of wish"), *table.columns[3:])
    note = f"{_FIRST_ORDER}; of wish: predicted over wished, met up to 1."
    return Table(title=table.title, columns=columns, rows=tuple(rows), note=note)


def predicted_number_table(test: "PlannedTest") -> Table:
    """Return what is predicted of all numbers of which nothing is wished."""
    names = [name for name in test.plan.promised if name not in test.plan.wish.names]
    title = "What it would tell besides" if test.plan.wish.names else "What it would tell"
    return _number_table(test, names, title)


def planned_leg_table(test: "PlannedTest") -> Table:
    """Return the legs: where, how long, how strong, and what keeps them from being stronger."""
    lever = test.line.lever
    # a lever in rpm is moved by what it asks for, which stands there in any case
    own = () if lever is None or lever.unit == "rpm" else numbers(f"set point [{lever.unit}]")
    columns = (
        *texts("leg"),
        *numbers("at [rpm]", "lines", "up to [Hz]", "periods", "of [s]"),
        *own,
        *numbers("set point [V]", "set point [rpm]", "speed [rpm]", "brake torque [N·m]"),
        *texts("bound by"),
    )
    rows = []
    for number, (leg, peaks) in enumerate(zip(test.plan.legs, test.plan.peaks, strict=True), start=1):
        volts = leg.peak_rpm / abs(test.line.slope_rpm_per_v)
        rows.append(
            (
                f"M{number}",
                plain(leg.level_rpm, 0),
                str(len(leg.harmonics)),
                rounded(float(leg.frequency_hz[-1]), 3),
                str(leg.periods),
                plain(leg.period_s, 2),
                *((f"± {rounded(volts / abs(lever.v_per_unit), 3)}",) if own and lever is not None else ()),
                f"± {rounded(volts, 3)}",
                f"± {plain(leg.peak_rpm, 0)}",
                _range(peaks.speed_rpm, 0),
                _range(peaks.brake_torque_nm, 0),
                ", ".join(peaks.binding),
            )
        )
    note = "Speed and torque are the most of all ships that are possible within what is assumed, without noise."
    return Table(title="Legs", columns=columns, rows=tuple(rows), note=note)


def _at_limit(card: "AbortCard") -> str:
    """Return that noise reaches what the engine can give."""
    share = card.share_at_limit
    return (
        "" if share is None else f", at the limits of the engine for at most {plain(PERCENT * share, 2)} % of the time"
    )


def abort_table(card: "AbortCard") -> Table:
    """Return the card for the bridge: what may be seen, and when to stop."""
    lowest, highest = (plain(speed, 0) for speed in card.leave_rpm)
    rows = (
        ("engine speed", f"{_range(card.speed_rpm, 0)} rpm", f"below {lowest} or above {highest} rpm"),
        (
            "brake torque",
            f"{_range(card.brake_torque_nm, 0)} N·m{_at_limit(card)}",
            "the engine smokes, stalls, or goes on hunting",
        ),
        _set_point(card),
        ("speed asked for", f"{_range(card.set_point_rpm, 0)} rpm", "the speed does not come back between swings"),
        ("its fastest change", f"{plain(card.rate_rpm_per_s, 0)} rpm/s{_steps(card)}", ""),
        ("length", length_words(card.duration_s), "the water ahead will not last so long"),
    )
    how = (
        f"Within these numbers all is as planned, noise included. To stop: hold the set point at {_level(card)}, which "
        f"asks for {plain(card.level_rpm, 0)} rpm, take the generator off, then slow down as usual. What was recorded "
        "up to then can be used to its last whole period."
    )
    return Table(title="Card for the bridge", columns=texts("what", "is seen", "stop when"), rows=rows, note=how)


def swing_words(line: "SetPointLine", rpm: float) -> str:
    """Return how far the set point goes for a swing of the engine speed [rpm], in the lever's own unit and in volts."""
    volts = rpm / abs(line.slope_rpm_per_v)
    if line.lever is None or line.lever.unit == "rpm":
        return f"{plain(volts, 2)} V"
    return f"{plain(volts / abs(line.lever.v_per_unit), 2)} {line.lever.unit} ({plain(volts, 2)} V)"


def _set_point(card: "AbortCard") -> tuple[str, str, str]:
    volts, lever = f"{_range(card.set_point_v, 2)} V", card.lever
    if lever is None:
        return ("set point", volts, "the voltage is another")
    low, high = sorted(float(end) for end in lever.reading(card.set_point_v))
    shown = f"{_range((low, high), _decimals(lever))} {lever.unit}"
    return ("set point", f"{shown} ({volts} of the campaign)", f"the lever shows another value in {lever.unit}")


def _level(card: "AbortCard") -> str:
    volts, lever = f"{plain(card.level_v, 2)} V", card.lever
    if lever is None:
        return volts
    (reading,) = lever.reading([card.level_v])
    return f"{plain(float(reading), _decimals(lever))} {lever.unit} ({volts} of the campaign)"


def _decimals(lever: "Lever") -> int:
    return {"mA": 2, "%": 1}.get(lever.unit, 0)


def _steps(card: "AbortCard") -> str:
    return f", at the end steps of {plain(card.step_rpm, 0)} rpm" if card.step_rpm else ""


def standing_table(standing: "Standing") -> Table:
    """Return the wished numbers as they are found so far, with their predicted deviation over the wish."""
    numbers_so_far = {one.name: one for one in (*standing.fit.parameters, *standing.fit.combinations)}
    rows = []
    for name, ratio in standing.ratios.items():
        number, target = numbers_so_far[name], standing.targets[name]
        factor, unit = fine_unit(number.unit, number.value, number.std)
        cells = (with_deviation(factor * number.value, factor * number.std), rounded(factor * target, 2))
        rows.append((Symbol(name), *cells, rounded(ratio, 3), "yes" if ratio <= 1.0 else "no", unit_text(unit)))
    return Table(
        title="Wishes so far",
        columns=(*texts("quantity"), *numbers("value ± std", "wished std", "predicted of wish"), *texts("met", "unit")),
        rows=tuple(rows),
        note=(
            "Decide when to stop from the standard deviation that is predicted with the recorded periods. Stopping "
            "when the estimated one happens to be small makes the intervals too narrow."
        ),
    )


def standing_leg_table(standing: "Standing") -> Table:
    """Return how many periods of each leg were planned and recorded, and how many are missing."""
    missing = standing.more or {}
    rows = []
    for name, leg in zip(standing.recorded, standing.test.plan.legs, strict=True):
        more = str(missing[name]) if name in missing else "–"
        rows.append((name, plain(leg.level_rpm, 0), str(leg.periods), str(standing.recorded[name]), more))
    columns = (*texts("leg"), *numbers("at [rpm]", "planned periods", "recorded", "missing"))
    return Table(title="Periods", columns=columns, rows=tuple(rows))


def _number_table(test: "PlannedTest", names: Sequence[str], title: str) -> Table:
    """Return what is predicted of some numbers, and what a rehearsal made of it."""
    rehearsal = test.rehearsal
    over = {} if rehearsal is None else rehearsal.over_planned
    coverage = {} if rehearsal is None else rehearsal.coverage
    band = test.plan.band
    columns = (*texts("quantity"), *numbers("value ± std", "std [%]", "95 % interval"), *texts("unit"))
    if band is not None:
        columns += numbers("std on 8 of 10 ships")
    if rehearsal is not None:
        columns += numbers("rehearsed error / std", "intervals that hold [%]")
    rows = []
    for name in names:
        number = test.plan.promised[name]
        cells = [Symbol(name), *_predicted(number)]
        if band is not None:
            cells.append(_reach(number, band.deviations[name]) if name in band.deviations else "")
        if rehearsal is not None:
            cells += [plain(over[name], 2), plain(PERCENT * coverage[name], 0)] if name in over else ["", ""]
        rows.append(tuple(cells))
    return Table(title=title, columns=columns, rows=tuple(rows), note=f"{_FIRST_ORDER}.")


def _predicted(number: "Estimate") -> tuple[str, str, str, str]:
    half = NORMAL_95 * number.std
    factor, unit = fine_unit(number.unit, number.value, number.std)
    low, high = factor * (number.value - half), factor * (number.value + half)
    known = math.isfinite(number.std)
    return (
        with_deviation(factor * number.value, factor * number.std),
        rounded(PERCENT * number.std / abs(number.value), 2) if known and number.value != 0.0 else "",
        interval(low, high, factor * number.std) if known else "",
        unit_text(unit),
    )


def _reach(number: "Estimate", ends: tuple[float, float]) -> str:
    """Return the lower and upper standard deviation [%]; in the number's unit where its value is zero."""
    if not math.isfinite(number.std):
        return ""
    factor, unit = fine_unit(number.unit, number.value, number.std)
    scale = factor * number.std if number.value == 0.0 else PERCENT * number.std / abs(number.value)
    words = unit_text(unit) if number.value == 0.0 else "%"
    low, high = (rounded(scale * end, 2) for end in ends)
    return f"{low} to {high} {words}".rstrip(" -")


def _range(ends: tuple[float, float], decimals: int) -> str:
    return f"{plain(ends[0], decimals)} to {plain(ends[1], decimals)}"
