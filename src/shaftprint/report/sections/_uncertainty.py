"""The section of a report on the uncertainty: shares of the sources, and how far parabolas can be trusted."""

from shaftprint.report.figures._profiles import profile_chart
from shaftprint.report.sections._sections import Inputs, Picture, Section
from shaftprint.tables._fingerprint import budget_table


def uncertainty_section(inputs: Inputs) -> list[Section]:
    """Return where the uncertainty comes from in numbers, and the profiles; nothing where no number is known."""
    budget = inputs.fingerprint.budget
    if not any(row.shares for row in budget.rows):
        return []
    pictures = []
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
            title="Uncertainty in numbers",
            tables=(budget_table(budget),),
            pictures=pictures,
        )
    ]
