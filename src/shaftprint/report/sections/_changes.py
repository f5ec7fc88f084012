"""The section of a report on an earlier test: what has changed since, along causes and number by number."""

from shaftprint.drift._differ import differ
from shaftprint.report.comparison._cause_table import cause_table
from shaftprint.report.comparison._differences import differences
from shaftprint.report.comparison._tables import difference_table
from shaftprint.report.comparison._vessel_file_words import vessel_file_sentences
from shaftprint.report.sections._comparison_cover import not_alike
from shaftprint.report.sections._sections import Inputs, Section

EARLIER, LATER = "earlier test", "this test"


def change_section(inputs: Inputs) -> list[Section]:
    """Return the differences from an earlier test; nothing where none was named."""
    previous, fingerprint = inputs.previous, inputs.fingerprint
    if previous is None:
        return []
    tested = previous.conditions.tested_at or previous.created
    finding = differ(previous, fingerprint)
    of_the_ship = [one for one in differences(previous, fingerprint) if not one.normalised]
    return [
        Section(
            key="changes",
            title=f"Changes since {tested:%Y-%m-%d}",
            paragraphs=(*not_alike(previous, LATER, fingerprint), *vessel_file_sentences(previous, fingerprint)),
            tables=(
                *(() if finding.because else (cause_table(LATER, finding),)),
                *((difference_table(EARLIER, LATER, of_the_ship),) if of_the_ship else ()),
            ),
        )
    ]
