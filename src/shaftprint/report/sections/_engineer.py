"""The engineer's summary: verdict, numbers, model and data, and where the uncertainty comes from, on two pages."""

from dataclasses import replace
from typing import TYPE_CHECKING

from shaftprint.digits import unit_text, with_deviation
from shaftprint.plain_table import MEANING, Column
from shaftprint.report.figures._covariance import budget_chart
from shaftprint.report.sections._sections import Inputs, Picture, Section
from shaftprint.tables._fingerprint import quantity_table

if TYPE_CHECKING:
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.identify.fit._estimate import Estimate

BUDGET_OPENING = (
    "From the noise of the measured lines, and from priors: the inertias of the vessel file (TVC), scale and latency "
    "of the torque gauge, the slope g of the engine. More lines or longer ones lower the share of the noise only."
)


def verdict_section(inputs: Inputs) -> Section:
    """Return the verdict on the fit: what it is of, the reason, what is in doubt and what is close to it."""
    verdict = inputs.fingerprint.verdict
    doubts = [reason.sentence for reason in verdict.reasons if reason.sentence not in verdict.reason]
    suspects = [suspect.sentence for suspect in verdict.suspects]
    return Section(
        key="verdict",
        title=f"Verdict: the fit is {verdict.words}",
        paragraphs=(_conditions(inputs.fingerprint), verdict.reason),
        points=tuple(dict.fromkeys((*doubts, *suspects, *verdict.cautions))),
    )


def _conditions(fingerprint: "Fingerprint") -> str:
    conditions = fingerprint.conditions
    speed, torque = conditions.engine_speed, conditions.shaft_torque
    total = len(conditions.lines_used) + len(conditions.lines_left_out)
    return (
        f"{conditions.vessel}, test “{conditions.campaign}”. Working point: engine speed "
        f"{with_deviation(speed.value, speed.std)} {unit_text(speed.unit)}, shaft torque "
        f"{with_deviation(torque.value, torque.std)} {unit_text(torque.unit)}. The structure {fingerprint.structure} "
        f"was fitted to {len(conditions.lines_used)} of {total} spectral lines, each weighted by its noise; those that "
        "are clear of it the verdict counts as good."
    )


def number_section(inputs: Inputs) -> Section:
    """Return all identified numbers in one table, each with whether the verdict lets it be used, or why not."""
    fingerprint = inputs.fingerprint
    groups = (fingerprint.parameters, fingerprint.combinations, fingerprint.physical, fingerprint.margins)
    quantities = [*fingerprint.working_point, *(quantity for group in groups for quantity in group)]
    table = quantity_table("Identified numbers", quantities)
    # the appendix has the differences; a unit stands with its value, which leaves room for the meaning
    kept = [place for place, column in enumerate(table.columns[:-2]) if place > 1 and column.heading != "difference"]
    rows = tuple(
        (row[0], f"{row[1]} {row[-2]}".strip(), *(row[i] for i in kept), *_usable(fingerprint, quantity))
        for row, quantity in zip(table.rows, quantities, strict=True)
    )
    columns = (*table.columns[:2], *(table.columns[i] for i in kept), Column("usable"), MEANING)
    shown = replace(table, columns=columns, rows=rows)
    return Section(key="numbers", title="What was identified", tables=(shown,))


def _usable(fingerprint: "Fingerprint", quantity: "Estimate") -> tuple[str, str]:
    """Return whether a number may be used, and its meaning with the reason why not."""
    verdict = fingerprint.verdict
    doubt = verdict.not_trusted.get(quantity.name) if verdict.trustworthy else None
    if doubt:
        return "no", f"{quantity.meaning}. Not to be used: {doubt}"
    return "yes" if verdict.trustworthy else "no", quantity.meaning


def budget_section(inputs: Inputs) -> list[Section]:
    """Return where the uncertainty comes from, as bars; nothing where no number is known."""
    budget = inputs.fingerprint.budget
    if not any(row.shares for row in budget.rows):
        return []
    return [
        Section(
            key="budget",
            title="Where the uncertainty comes from",
            paragraphs=(BUDGET_OPENING,),
            pictures=(
                Picture(
                    name="budget",
                    caption="Share of each source in the variance of every number; the appendix has them in numbers. A "
                    "share is negative, and the others pass 100 %, where errors of the two outputs make up for each "
                    "other.",
                    alt="One horizontal bar for each number, divided by the share of each source in its variance.",
                    chart=lambda: budget_chart(budget),
                ),
            ),
        )
    ]


def folded(section: Section) -> Section:
    """Return a section as one of the appendix."""
    return replace(section, folded=True)
