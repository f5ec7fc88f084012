"""The section of a report on the uncertainty: which source contributes what, and how far parabolas can be trusted."""

from typing import TYPE_CHECKING

from shaftprint.report._numbers import decimals_of, plain
from shaftprint.report._symbols import unit_text
from shaftprint.report._table import Cell, Table, symbol_html
from shaftprint.report.figures import PERCENT, plot_budget, plot_profiles
from shaftprint.report.plots import budget_plot, profile_plot
from shaftprint.report.sections._sections import Inputs, Picture, Section

if TYPE_CHECKING:
    from shaftprint.identify.uncertainty import Budget

# A share that is printed as 0 % says as much.
SMALLEST_PERCENT = 0.5
NOTE = (
    "Shares of the variance, to first order; they add up to 100 %. Noise of two outputs is correlated: each has half "
    "of what they share, and a share is negative where their errors make up for each other."
)
OPENING = (
    "Every estimate hangs on the noise of the measured lines and on what was known beforehand: the torsional vibration "
    "calculation (TVC), the accuracy of the torque gauge, the latency of its telemetry, and the slope g of the engine. "
    "More lines or longer ones lower the share of the noise only."
)


def uncertainty_section(inputs: Inputs) -> list[Section]:
    """Return where the uncertainty comes from; nothing where no number is known."""
    stated = inputs.fingerprint.budget
    if not any(row.shares for row in stated.rows):
        return []
    pictures = [
        Picture(
            name="budget",
            caption="Share of each source in the variance of every number.",
            alt="One horizontal bar for each number, divided by the share of each source in its variance.",
            draw=lambda: plot_budget(stated),
            plot=lambda: budget_plot(stated),
        )
    ]
    if inputs.identification.is_likelihood:
        pictures.append(
            Picture(
                name="profiles",
                caption=(
                    "Profiles: the lowest cost at each value of a parameter, all others fitted again. Where the "
                    "profile leaves the parabola of the standard deviation, go by the 95 % interval, which is where "
                    "the profile passes the dotted line. A profile that ends below it has met a bound of the search."
                ),
                alt="One small panel for each parameter with the profile of the cost and the parabola beside it.",
                draw=lambda: plot_profiles(inputs.identification),
                plot=lambda: profile_plot(inputs.identification),
            )
        )
    return [
        Section(
            key="uncertainty",
            title="Where the uncertainty comes from",
            paragraphs=(OPENING,),
            tables=(budget_table(stated),),
            pictures=pictures,
        )
    ]


def budget_table(stated: "Budget") -> Table:
    """Return standard deviation and shares of all sources for every number whose uncertainty is known."""
    rows: list[tuple[Cell, ...]] = []
    for row in stated.rows:
        if not row.shares:
            continue
        shares = (PERCENT * row.shares.get(source, 0.0) for source in stated.sources)
        rows.append(
            (
                symbol_html(row.name),
                f"{plain(row.std, decimals_of(row.value, row.std))} {unit_text(row.unit)}".strip(),
                *(_percent(share) for share in shares),
            )
        )
    return Table(
        caption="Uncertainty budget",
        header=("quantity", "one std", *(symbol_html(source) for source in stated.sources)),
        rows=tuple(rows),
        note=NOTE,
    )


def _percent(share: float) -> str:
    return "–" if abs(share) < SMALLEST_PERCENT else f"{plain(share, 0)} %"
