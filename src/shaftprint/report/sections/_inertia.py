"""The section of a report on the inertia by calculation and the torsional modes of the line."""

from shaftprint.fingerprint._inertia import inertia_beside
from shaftprint.report.figures._modes import mode_chart
from shaftprint.report.sections._sections import Inputs, Picture, Section
from shaftprint.tables._inertia import expected_inertia_table, inertia_budget_table, mode_table, water_table
from shaftprint.torsion._line import torsional_line
from shaftprint.torsion._modes import modes

OPENING = (
    "Inertia by the table of the vessel file, at the measured working point. The torque gauge cuts the "
    "line: shaft torque and speed show what is downstream of it, the loop of governor and engine turns both sides."
)


def inertia_section(inputs: Inputs) -> list[Section]:
    """Return the inertia by calculation beside the identified, and the modes where the vessel file has links."""
    vessel = inputs.vessel
    expected, comparisons = inertia_beside(inputs.fingerprint, vessel)
    tables = [expected_inertia_table(expected, comparisons), inertia_budget_table(expected), water_table(expected)]
    pictures = []
    if vessel.links:
        vibrations = modes(torsional_line(vessel))
        tables.append(mode_table(vibrations))
        pictures.append(
            Picture(
                name="modes",
                caption=(
                    "Shapes of the slowest torsional modes by calculation. Well below the first of them the line turns "
                    "as one."
                ),
                alt="One panel for each mode with the amplitude of every mass along the line.",
                chart=lambda: mode_chart(vibrations),
            )
        )
    return [
        Section(
            key="inertia",
            title="Inertia by calculation",
            paragraphs=(OPENING,),
            tables=tuple(table for table in tables if table.rows),
            pictures=pictures,
        )
    ]
