"""Tables of a class of sister ships: where each stands, and how much they differ."""

from typing import TYPE_CHECKING

from shaftprint.digits import p_value_text, plain, to_digit_of
from shaftprint.plain_table import Table, numbers, texts
from shaftprint.report.comparison._cause_table import odds_text, sized

if TYPE_CHECKING:
    from shaftprint.drift._class_finding import ClassFinding, NumberSpread

NOT_THERE = "–"


def sister_table(finding: "ClassFinding") -> Table:
    """Return every ship of a class with what is most likely other in it, the clearest first.

    ``finding``: what was found.
    """
    rows = []
    for ship in sorted(finding.ships, key=lambda one: one.change.p_value):
        best, *rest = ship.change.candidates
        rows.append(
            (
                ship.name,
                str(ship.tests),
                "yes" if ship.is_odd else "no",
                best.words,
                sized(best),
                plain(best.score, 1),
                odds_text(rest[0]) if rest else NOT_THERE,
                p_value_text(ship.change.p_value),
            )
        )
    return Table(
        title="Each ship against its sisters",
        columns=(
            *texts("ship"),
            *numbers("tests"),
            *texts("other than its sisters", "what is most likely other"),
            *numbers("by", "size / deviation", "odds against the next", "p"),
        ),
        rows=tuple(rows),
        note=(
            f"Judged together: {', '.join(finding.names)}. Deviations hold how much sisters differ as built; of the "
            "ships named one in twenty at most is a sound one in the mean."
        ),
    )


def cause_spread_table(finding: "ClassFinding") -> Table:
    """Return how much sister ships differ along each cause.

    ``finding``: what was found.
    """
    rows = []
    for spread in finding.causes:
        cause = spread.cause
        std = f"{plain(cause.in_unit(spread.std), 2)} {cause.unit}" if spread.std else NOT_THERE
        rows.append((cause.name, std, f"± {plain(cause.in_unit(spread.half_width), 2)} {cause.unit}"))
    return Table(
        title="How much sisters differ along each cause",
        columns=(*texts("cause"), *numbers("deviation between ships", "95 % of new sisters, tested alike")),
        rows=tuple(rows),
        note="The scale of each gauge is as uncertain as its vessel file states.",
    )


def number_spread_table(finding: "ClassFinding") -> Table:
    """Return the mean of each number, how much sisters differ in it, and who is outside.

    ``finding``: what was found.
    """
    return Table(
        title="Numbers of the class",
        columns=(
            *texts("number"),
            *numbers("mean", "deviation between ships", "95 % of new sisters from", "to"),
            *texts("unit", "outside, by this number alone"),
        ),
        rows=tuple(_number_row(finding, spread) for spread in finding.numbers),
    )


def _number_row(finding: "ClassFinding", spread: "NumberSpread") -> tuple[str, ...]:
    low, high = spread.interval_95
    digits = 0.1 * (high - low)
    outside = [ship.name for ship, own in zip(finding.ships, spread.ships, strict=True) if own.is_outside]
    return (
        spread.name,
        to_digit_of(spread.mean, digits),
        to_digit_of(spread.std, 0.3 * spread.std or 1.0),
        to_digit_of(low, digits),
        to_digit_of(high, digits),
        spread.unit,
        ", ".join(outside) or NOT_THERE,
    )
