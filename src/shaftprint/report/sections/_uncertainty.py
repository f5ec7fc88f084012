"""The section of a report that draws the uncertainty: shares of the sources, and how far parabolas can be trusted."""

from shaftprint.report.figures._covariance import budget_chart
from shaftprint.report.figures._profiles import profile_chart
from shaftprint.report.sections._sections import Inputs, Picture, Section


def uncertainty_section(inputs: Inputs) -> list[Section]:
    """Return where the uncertainty comes from; nothing where no number is known."""
    budget = inputs.fingerprint.budget
    if not any(row.shares for row in budget.rows):
        return []
    pictures = [
        Picture(
            name="budget",
            caption="Share of each source in the variance of every number.",
            alt="One horizontal bar for each number, divided by the share of each source in its variance.",
            chart=lambda: budget_chart(budget),
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
                chart=lambda: profile_chart(inputs.identification),
            )
        )
    return [
        Section(
            key="uncertainty",
            title="Uncertainty, drawn",
            pictures=pictures,
        )
    ]
