"""What two vessel files have in common and where they differ, in sentences and as a table."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from shaftprint.drift._shared_errors import shared_errors
from shaftprint.plain_table import Table, texts

if TYPE_CHECKING:
    from shaftprint.drift._shared_errors import FieldChange
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.fingerprint._line_fingerprint import LineFingerprint
    from shaftprint.fingerprint._vessel_fields import FieldValue

MOST_NAMED = 4
MOST_NUMBERS = 6
# Below this share of the variance of a number a source does not matter to it.
NOTABLE_SHARE = 0.05
NOT_STATED = "not stated"


def vessel_file_sentences(first: "LineFingerprint", other: "LineFingerprint") -> tuple[str, ...]:
    """Return in sentences where the vessel files of two tests differ, and which errors the tests have in common.

    ``first``, ``other``: two fingerprints; a drive has no vessel file.
    """
    shared = shared_errors(first, other)
    sentences = [_files(shared.changes)] if first.noun == "ship" else []
    for sources, words in (
        (shared.common, "Stated alike for both tests, so that the error cancels"),
        (shared.apart, "Not the same in both tests, so that the error counts in full"),
    ):
        if sources:
            named = "; ".join(f"{source}{_numbers(source, first, other)}" for source in sources)
            sentences.append(f"{words}: {named}.")
    return tuple(sentences)


def _numbers(source: str, *fingerprints: "LineFingerprint") -> str:
    """Return in brackets which numbers owe a notable share of their variance to a source, in any of the tests."""
    rows = (row for fingerprint in fingerprints for row in fingerprint.budget_rows)
    notable = (row.name for row in rows if row.variances.get(source, 0.0) > NOTABLE_SHARE * sum(row.variances.values()))
    names = list(dict.fromkeys(notable))
    more = f" and {len(names) - MOST_NUMBERS} more" if len(names) > MOST_NUMBERS else ""
    return f" (in {', '.join(names[:MOST_NUMBERS])}{more})" if names else ""


def _files(changes: "Sequence[FieldChange] | None") -> str:
    if changes is None:
        return "The vessel files are not the same; a fingerprint of an earlier version does not say where they differ."
    if not changes:
        return "Both vessel files state the same."
    named = [f"{one.field} ({_words(one.first)}, then {_words(one.other)})" for one in changes[:MOST_NAMED]]
    more = len(changes) - MOST_NAMED
    return f"The vessel files differ in {'; '.join(named)}{f'; and {more} more' if more > 0 else ''}."


def vessel_file_table(fingerprints: "Mapping[str, Fingerprint]") -> Table:
    """Return all fields in which the vessel files of some fingerprints are not all the same; no row where none is.

    ``fingerprints``: fingerprints by name; those of an earlier version, which do not hold the fields, are left out.
    """
    fields_of = {name: f.vessel_fields for name, f in fingerprints.items() if f.vessel_fields}
    fields = dict.fromkeys(field for stated in fields_of.values() for field in stated)
    rows = tuple(
        (field, *(_words(stated.get(field)) for stated in fields_of.values()))
        for field in fields
        if len({stated.get(field) for stated in fields_of.values()}) > 1
    )
    return Table(title="Where the vessel files differ", columns=texts("field", *fields_of), rows=rows)


def _words(value: "FieldValue | None") -> str:
    if value is None:
        return NOT_STATED
    if isinstance(value, bool):
        return "yes" if value else "no"
    return value if isinstance(value, str) else f"{value:.10g}"
